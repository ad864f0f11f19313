// Whole runs that end badly or may not start: the controller killed, and a bus that cannot carry the scene.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "sim_host/bake/image_file.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "sim_host/run/run_session.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

class RunBlackBox : public BallRun {
 protected:
  RunBlackBox() {
    options_.record.clear();
    options_.image = (folder_ / "ball.pal").string();
    options_.black_box = (folder_ / "box").string();
  }

  // Our own child that runs palpate-rt.
  static pid_t controller() {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      std::ifstream file(entry.path() / "stat");
      std::string pid, comm, mode;
      pid_t parent = 0;
      if (file >> pid >> comm >> mode >> parent && comm == "(palpate-rt)" && parent == getpid()) return std::stoi(pid);
    }
    return 0;
  }
};

TEST_F(RunBlackBox, AKilledControllerLeavesItsLastSecondsEvenWithoutARecording) {
  options_.duration_s = 30;
  options_.progress = [](const LiveState& state) {
    const pid_t pid = controller();
    if (state.all->ticks > 100 && pid > 0) kill(pid, SIGKILL);
  };
  const RunResult result = run_session(options_);
  EXPECT_LT(result.elapsed_s, 30);
  ASSERT_EQ(result.dumps.size(), 1u);
  EXPECT_EQ(result.black_box_error, "");
  if (result.summary.fault == 0) {  // a loaded machine may have latched an overrun before
    EXPECT_EQ(result.controller_exit, 128 + SIGKILL);
    EXPECT_EQ(result.dumps[0].cause, "controller killed by signal 9");
  }
  const MappedFile file(result.dumps[0].recording);
  RecordingReader reader(file.bytes());
  const ImageFile image(reader.header().image_path);
  const ReplayResult replayed = replay(reader, image.model());
  EXPECT_TRUE(replayed.identical()) << replayed.field << replayed.damage;
  EXPECT_EQ(replayed.ticks, result.summary.ticks);
  EXPECT_GT(std::filesystem::file_size(result.dumps[0].log), 0u);
}

TEST_F(RunBlackBox, ABusThatCannotCarryTheSceneIsRefusedWithTheTable) {
  std::ofstream(options_.scene, std::ios::app) << "[device]\nperiod_ms = 0.5\n";
  options_.profile = std::string(PALPATE_SOURCE_DIR) + "/config/devices/sim-6dof.toml";
  const auto error_of = [&](const char* device) {
    options_.device = device;
    try {
      run_session(options_);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("started");
  };
  // The interface does not exist: the refusal comes before anything is opened.
  const std::string classic = error_of("can:nocan0,classic");
  EXPECT_NE(classic.find("nocan0 cannot carry"), std::string::npos) << classic;
  EXPECT_NE(classic.find("ClassicOrientation"), std::string::npos) << classic;
  EXPECT_NE(classic.find("worst case 706.0 us of 450.0 us"), std::string::npos) << classic;
}

TEST_F(RunBlackBox, ARunThatIsNotArmedHasNoForce) {
  options_.duration_s = 1;
  options_.arm = false;
  options_.black_box.clear();
  const RunResult result = run_session(options_);
  EXPECT_GT(result.summary.ticks, 0u);
  EXPECT_EQ(result.summary.device_force_max_N, 0.0);
  EXPECT_TRUE(result.dumps.empty());
}

}  // namespace
}  // namespace palpate
