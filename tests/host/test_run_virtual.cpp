// Whole runs in virtual time: three processes in lock step give the same file on a busy machine, and what happens to
// one of them happens to the run as it would on a wire.
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>
#include <vector>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/replay.h"
#include "sim_host/run/settings_port.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

class RunVirtual : public BallRun {
 protected:
  RunVirtual() {
    options_.time = RunTime::kVirtual;
    options_.device = "loopback";
    options_.record = (folder_ / "run.plr").string();
    options_.duration_s = 1.5;
    options_.overwrite = true;
  }
  std::string recording() const {
    std::ifstream file(options_.record, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

// Two processes per core that do nothing but compute.
class BusyMachine {
 public:
  BusyMachine() {
    for (unsigned i = 0; i < 2 * std::max(1u, std::thread::hardware_concurrency()); ++i) {
      const pid_t pid = fork();
      if (pid == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that dies leaves nobody busy
        for (volatile unsigned long n = 0;;) n = n + 1;
      }
      if (pid > 0) child_.push_back(pid);
    }
  }
  ~BusyMachine() {
    for (const pid_t pid : child_) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
  }

 private:
  std::vector<pid_t> child_;
};

// Kills our child with this program name; false if there is none.
bool kill_child(const std::string& name) {
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream children(task.path() / "children");
    for (pid_t pid; children >> pid;) {
      std::ifstream comm("/proc/" + std::to_string(pid) + "/comm");
      std::string text;
      if (std::getline(comm, text) && text == name && pid > 1) return kill(pid, SIGKILL) == 0;
    }
  }
  return false;
}

TEST_F(RunVirtual, GivesTheSameBytesFiveTimesOnABusyMachine) {
  const RunResult idle = run_session(options_);
  const std::string expected = recording();
  EXPECT_TRUE(idle.virtual_time);
  EXPECT_TRUE(is_virtual(idle.summary));
  EXPECT_EQ(idle.controller_exit, 0);
  EXPECT_EQ(idle.summary.missed_ticks + idle.summary.stale_ticks + idle.lost, 0u);
  EXPECT_GT(idle.summary.contact_force_max_N, 0.05);
  ASSERT_GT(expected.size(), 100'000u);
  const BusyMachine busy;
  for (int i = 0; i < 5; ++i) {
    const RunResult result = run_session(options_);
    EXPECT_EQ(result.summary.ticks, idle.summary.ticks);
    EXPECT_TRUE(recording() == expected) << "run " << i;
  }
}

TEST_F(RunVirtual, AKilledDeviceIsASilentOne) {
  options_.duration_s = 4;
  bool killed = false;
  options_.progress = [&](const LiveState& state) {
    if (killed || state.elapsed_s < 1) return;
    killed = kill_child("palpate-device");
  };
  const RunResult result = run_session(options_);
  ASSERT_TRUE(killed);
  EXPECT_EQ(result.summary.fault, Fault::kDeviceSilent);
  EXPECT_EQ(result.summary.last_mode, Mode::kFault);
  EXPECT_TRUE(result.device_died);
  EXPECT_LT(result.elapsed_s, 2);
}

// In real time its silence is ridden through, as a stall of this machine would be; so the run has to notice by itself.
TEST_F(RunVirtual, InRealTimeAKilledDeviceEndsTheRun) {
  options_.time = RunTime::kReal;
  options_.duration_s = 60;
  options_.progress = [](const LiveState&) { kill_child("palpate-device"); };
  const RunResult result = run_session(options_);
  EXPECT_TRUE(result.device_died);
  EXPECT_LT(result.elapsed_s, 50);
  EXPECT_EQ(result.summary.last_mode, Mode::kIdle);
}

TEST_F(RunVirtual, AnInterruptedRunIsTheBeginningOfAWholeOne) {
  run_session(options_);
  const std::string whole = recording();
  options_.duration_s = 60;
  options_.progress = [&](const LiveState&) { kill(getpid(), SIGINT); };
  const RunResult result = run_session(options_);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.controller_exit, 0);
  EXPECT_EQ(result.summary.last_mode, Mode::kIdle);
  const std::string part = recording();
  const std::size_t same = static_cast<std::size_t>(
      std::mismatch(part.begin(), part.end(), whole.begin(), whole.end()).first - part.begin());
  EXPECT_GT(same, part.size() / 2);
}

TEST_F(RunVirtual, BelongsToTheSimulatedDevice) {
  options_.device = "can:vcan77";
  EXPECT_THROW(runs_in_virtual_time(options_), std::runtime_error);
  options_.time = RunTime::kAutomatic;
  EXPECT_FALSE(runs_in_virtual_time(options_));
  options_.device = "loopback";
  EXPECT_FALSE(runs_in_virtual_time(options_)) << "named: real time";
  options_.time = RunTime::kVirtual;
  EXPECT_TRUE(runs_in_virtual_time(options_));
  options_.device = "loopback:elsewhere";
  EXPECT_THROW(runs_in_virtual_time(options_), std::runtime_error);
}

// Settings asked for from outside and by a companion: they come with the recording, and the replay makes the same bits.
TEST_F(RunVirtual, LiveSettingsAreRecordedAndReplayed) {
  int look = 0;
  std::string answer, refusal;
  std::thread asker;
  options_.companion.look = std::chrono::milliseconds(10);
  options_.companion.live = [&](LiveSettings& wanted) {
    if (++look == 50) wanted.stiffness = 0.5f;
    if (look == 90) {
      asker = std::thread([&] {
        answer = ask_run(getpid(), "friction=0 coupling=0.5");
        try {
          ask_run(getpid(), "stiffness=7");
        } catch (const std::runtime_error& error) {
          refusal = error.what();
        }
      });
      // It waits for the run's looks; give it the time to ask.
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  };
  options_.pace = true;
  const RunResult result = run_session(options_);
  asker.join();
  EXPECT_EQ(answer, "stiffness=0.5 friction=0 force_limit=1 coupling=0.5");
  EXPECT_NE(refusal.find("0.1 to 2"), std::string::npos) << refusal;
  EXPECT_EQ(result.summary.fault, 0u);

  const MappedFile file(options_.record);
  RecordingReader recording(file.bytes());
  const RecordedScene scene(recording, "");
  bool softened = false, both = false;
  const ReplayResult again = replay(recording, scene.model(), [&](const TickRecord& record, const TickRecord&) {
    softened = softened || record.input.live == LiveSettings{0.5f, 1, 1, 1};
    both = both || record.input.live == LiveSettings{0.5f, 0, 1, 0.5f};
  });
  EXPECT_TRUE(again.identical()) << again.stage << " " << again.field;
  EXPECT_TRUE(softened && both);
}

TEST(SettingsPort, WordsAreAppliedAllOrNone) {
  LiveSettings settings;
  EXPECT_EQ(apply_settings("stiffness=0.5  force_limit=0.1", settings), "");
  EXPECT_EQ(settings, (LiveSettings{0.5f, 1, 0.1f, 1}));
  for (const char* wrong : {"stiffness", "stiffness=", "stiffness=nan", "stiffness=1x", "force_limit=1.1", "mass=1",
                            "friction=1 coupling=0", "=1", "stiffness=inf"}) {
    EXPECT_NE(apply_settings(wrong, settings), "") << wrong;
    EXPECT_EQ(settings, (LiveSettings{0.5f, 1, 0.1f, 1})) << wrong;
  }
  EXPECT_EQ(settings_text(settings), "stiffness=0.5 friction=1 force_limit=0.1 coupling=1");
  EXPECT_THROW(ask_run(getpid(), ""), std::runtime_error);  // no run here
}

}  // namespace
}  // namespace palpate
