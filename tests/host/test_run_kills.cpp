// Host, controller or device killed (SIGKILL) at random moments of a run: nobody stays behind, and nothing that was
// complete is lost. The host's own file and the controller's, written after the host had died, make one recording that
// replays to the same bits down to zero force. PALPATE_KILLS=1000 in the environment makes more of them.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <thread>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recover.h"
#include "sim_host/record/replay.h"
#include "sim_host/run/process.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

// What can be read: a process may be gone between opening its file and reading it, on which an iterator would throw.
std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Kills : public BallRun {
 protected:
  Kills() : record_(folder_ / "run.plr"), part_(folder_ / "run.plr.part") {
    setenv("PALPATE_KILL_TEST", folder_.c_str(), 1);  // inherited by all three: what they are known by
  }
  ~Kills() override {
    for (const char* name : {"palpate", "palpate-rt", "palpate-device"})
      for (const pid_t pid : pids_of(name)) kill(pid, SIGKILL);
    all_gone(10'000);
    unsetenv("PALPATE_KILL_TEST");
  }

  // Processes of this test called `name`.
  std::vector<pid_t> pids_of(const std::string& name) const {
    std::vector<pid_t> pids;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const std::string number = entry.path().filename();
      if (number.find_first_not_of("0123456789") != std::string::npos) continue;
      if (text_of(entry.path() / "comm") != name + "\n") continue;
      if (text_of(entry.path() / "environ").find("PALPATE_KILL_TEST=" + folder_.string()) == std::string::npos)
        continue;
      pids.push_back(std::stoi(number));
    }
    return pids;
  }
  bool all_gone(int timeout_ms) const {
    for (int waited_ms = 0; waited_ms < timeout_ms; waited_ms += 10) {
      if (pids_of("palpate-rt").empty() && pids_of("palpate-device").empty()) return true;
      std::this_thread::sleep_for(milliseconds(10));
    }
    return false;
  }
  Process start(bool virtual_time) {
    return Process::start(options_.program_folder + "/palpate",
                          {"run", options_.scene, virtual_time ? "--virtual-time" : "--real-time", "--device",
                           "loopback", "--priority", "0", "--duration", "600", "--record", record_, "--quiet"},
                          {});
  }
  // False when the run ended by itself, by a fault of this busy computer.
  bool wait_for_ticks(Process& host) const {
    std::error_code none;
    for (int i = 0; i < 3000 && host.running(); ++i) {  // 30 s
      if (std::filesystem::file_size(part_, none) > 400'000 && !none) return true;
      std::this_thread::sleep_for(milliseconds(10));
    }
    return false;
  }
  // Whole ticks in a recording, and whether the last one is without force; 0 when it does not replay.
  std::uint64_t ticks_of(const std::string& path, bool& at_rest) const {
    const MappedFile file(path);
    RecordingReader reader(file.bytes());
    const RecordedScene scene(reader, "");
    TickRecord last{};
    const ReplayResult result =
        replay(reader, scene.model(), [&](const TickRecord& r, const TickRecord&) { last = r; });
    at_rest = last.output.device_w == Wrench{};
    EXPECT_FALSE(result.differs) << result.stage << " " << result.field << " at tick " << result.tick;
    EXPECT_EQ(result.lost, 0u);
    return result.differs ? 0 : result.ticks;
  }
  std::uint64_t complete_ticks(const std::string& path) const {
    const MappedFile file(path);
    RecordingReader reader(file.bytes());
    TickRecord record;
    while (reader.next(record)) {
    }
    return reader.records();
  }

  std::filesystem::path record_, part_;
};

TEST_F(Kills, NothingThatWasCompleteIsLost) {
  const char* asked = std::getenv("PALPATE_KILLS");
  const int kills = asked != nullptr ? std::atoi(asked) : 60;
  const char* const kVictims[] = {"palpate", "palpate-rt", "palpate-device"};
  std::mt19937 random(7);
  int joined = 0, hosts = 0;
  for (int i = 0; i < kills; ++i) {
    const std::string victim = kVictims[i % 3];
    SCOPED_TRACE(std::to_string(i) + " " + victim);
    for (const char* ending : {"", ".part", ".recovering"}) std::filesystem::remove(record_.string() + ending);
    std::filesystem::remove(crash_path(record_));
    // Every fourth in real time, where a second's silence takes a second.
    Process host = start(i % 4 != 0);
    if (!wait_for_ticks(host)) {
      ASSERT_FALSE(host.running()) << "neither ticks nor an end";
      continue;
    }
    std::this_thread::sleep_for(milliseconds(random() % 120));
    const std::vector<pid_t> found = pids_of(victim);
    if (found.empty()) continue;  // a fault of this busy computer ended the run by itself
    kill(found[0], SIGKILL);
    // A run whose device died before it was armed waits for it: then the user ends it.
    if (!host.wait(victim == "palpate-device" ? 5'000 : 30'000)) host.signal(SIGINT);
    ASSERT_TRUE(host.wait(30'000));
    ASSERT_TRUE(all_gone(30'000)) << "an orphan";
    bool at_rest = false;
    if (victim != "palpate") {
      ASSERT_TRUE(std::filesystem::exists(record_));
      EXPECT_GT(ticks_of(record_, at_rest), 0u);
      continue;
    }
    if (!std::filesystem::exists(part_)) continue;  // it had just finished
    hosts += 1;
    const std::uint64_t complete = complete_ticks(part_);
    const Recovered recovered = recover_recording(part_, "");
    EXPECT_GE(recovered.records, complete);
    EXPECT_EQ(ticks_of(record_, at_rest), recovered.records);
    joined += recovered.from_crash > 0 ? 1 : 0;
    EXPECT_TRUE(at_rest || recovered.from_crash == 0) << "the controller's own file goes on to zero force";
  }
  // In virtual time the ring may have gone round before the controller's main thread looked: then the two do not meet.
  EXPECT_GT(joined, hosts / 6) << hosts;
  std::printf("%d kills, %d of the host, %d joined with the controller's own file\n", kills, hosts, joined);
}

}  // namespace
}  // namespace palpate
