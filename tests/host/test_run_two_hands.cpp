// Whole runs of two hands with two simulated devices, by the real processes: a ball in one hand, pressed with a ball in
// the other.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

class RecordedBallRun : public BallRun {
 protected:
  RecordedBallRun() {
    options_.time = RunTime::kVirtual;
    options_.record = (folder_ / "run.plr").string();
    options_.duration_s = 1.5;
  }
  std::string recording() const {
    std::ifstream file(options_.record, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // Replays to the bit, and runs again to the same bytes.
  void expect_the_same_again() {
    const MappedFile file(options_.record);
    RecordingReader again(file.bytes());
    const RecordedScene scene(again, "");
    EXPECT_TRUE(replay(again, scene.model(), [](const TickRecord&, const TickRecord&) {}).identical());
    const std::string bytes = recording();
    run_session(options_);
    EXPECT_TRUE(recording() == bytes) << "virtual time: the same bytes again";
  }
};

class RunTwoHands : public RecordedBallRun {
 protected:
  RunTwoHands() { options_.overlays.setting = {"device.holds=both", "device.grip_mm=[0, -10, 0]"}; }
  // Largest force on the hand at the ball, and how far it is from being the opposite of the other's.
  std::pair<double, double> forces() const {
    const MappedFile file(options_.record);
    RecordingReader recording(file.bytes());
    TickRecord record;
    std::pair<double, double> found{0, 0};
    while (recording.next(record)) {
      found.first = std::max(found.first, norm(record.output.second_w.force_N));
      found.second = std::max(found.second, norm(record.output.second_w.force_N + record.output.device_w.force_N));
    }
    return found;
  }
};

TEST_F(RunTwoHands, PressOneAnotherAndReplay) {
  const RunResult result = run_session(options_);
  EXPECT_EQ(result.controller_exit, 0);
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_EQ(result.summary.missed_ticks + result.summary.stale_ticks + result.lost, 0u);
  const auto [most_N, apart_N] = forces();
  EXPECT_GT(most_N, 0.3);
  EXPECT_LT(apart_N, 1e-14);
  expect_the_same_again();
}

// The other hand lifts the ball by 3 mm towards the tool meanwhile: more force.
TEST_F(RunTwoHands, TheSecondHandHasAPathOfItsOwn) {
  run_session(options_);
  const double still_N = forces().first;
  options_.second_path = (folder_ / "second.csv").string();
  std::ofstream(options_.second_path) << "0,0,-10,0\n0.2,0,-10,0\n0.6,0,-7,0\n";
  const RunResult result = run_session(options_);
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_GT(forces().first, 1.3 * still_N);
}

TEST_F(RunTwoHands, WhatDoesNotGoWithTheSceneIsRefused) {
  const auto error = [&] {
    try {
      run_session(options_);
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  options_.second_device = "can:can0";
  EXPECT_THAT(error(), testing::HasSubstr("has its own time"));
  options_.overlays = {};
  EXPECT_THAT(error(), testing::HasSubstr("one hand moves this scene"));
  options_.second_device = "";
  options_.scene = (folder_ / "ball.pal").string();
  options_.overlays.setting = {"device.holds=both"};
  EXPECT_THAT(error(), testing::HasSubstr("name the .toml"));
}

// A ball between two hands with a ball each, by tool points: the second one's way is the scene's.
TEST_F(RecordedBallRun, TwoToolsOnOneBodyAndReplay) {
  std::string text = kBallScene;
  text.replace(text.find("[path]"), 6, "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\nhand = 2\n[path]");
  std::ofstream(options_.scene) << text << R"(
[[path.second]]
time_s = 0
position_mm = [45, 30, 0]
[[path.second]]
time_s = 0.5
position_mm = [36, 30, 0]
)";
  options_.overlays.setting = {"device.holds=two_tools"};
  const RunResult result = run_session(options_);
  EXPECT_EQ(result.controller_exit, 0);
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_EQ(result.summary.missed_ticks + result.summary.stale_ticks + result.lost, 0u);
  const MappedFile file(options_.record);
  RecordingReader ticks(file.bytes());
  Vec3 first, second;
  double apart_m = 0;
  for (TickRecord record; ticks.next(record);) {
    if (norm(record.output.device_w.force_N) > norm(first)) first = record.output.device_w.force_N;
    if (norm(record.output.second_w.force_N) > norm(second)) second = record.output.second_w.force_N;
    apart_m = std::max(apart_m, norm(record.output.second_tool_w.position_m - record.output.second_handle_w_m));
  }
  EXPECT_GT(first.y, 0.3);   // pressed from above
  EXPECT_GT(second.x, 0.3);  // and from the right
  EXPECT_GT(apart_m, 1e-4);  // the second tool stands on the ball, before its handle
  expect_the_same_again();
  // One hand's press of it is refused: the other one would stand by.
  const std::string told = (folder_ / "told.txt").string();
  EXPECT_NE(std::system((options_.program_folder + "/palpate press " + options_.scene +
                         " --set device.holds=two_tools --path demo >" + told + " 2>&1")
                            .c_str()),
            0);
  std::ifstream file_told(told);
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(file_told), {}), testing::HasSubstr("palpate run"));
}

}  // namespace
}  // namespace palpate
