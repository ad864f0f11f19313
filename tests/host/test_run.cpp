// Whole runs: the real controller and the simulated device as processes over the loopback, recorded and replayed; in
// virtual time but for the one whose name says otherwise. What is checked in real time is function, never time: on a
// loaded machine ticks come late.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "sim_host/bake/image_file.h"
#include "sim_host/exit_codes.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorder.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/record/replay.h"
#include "sim_host/run/controller_link.h"
#include "sim_host/run/device_process.h"
#include "sim_host/run/hand_path_file.h"
#include "sim_host/run/run_session.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

class Run : public BallRun {
 protected:
  Run() {
    options_.record = (folder_ / "run.plr").string();
    options_.duration_s = 1.0;
    options_.time = RunTime::kVirtual;
  }

  // Every record of the finished run is there and replays to the same bits.
  void expect_whole_and_identical(std::uint64_t ticks) {
    const MappedFile file(options_.record);
    RecordingReader reader(file.bytes());
    const ImageFile image(reader.header().image_path);
    const ReplayResult replayed = replay(reader, image.model());
    EXPECT_TRUE(replayed.identical()) << replayed.tick << " " << replayed.stage << " " << replayed.field << " "
                                      << replayed.damage << " " << replayed.lost;
    EXPECT_EQ(replayed.ticks, ticks);
  }
};

TEST_F(Run, RecordsAndReplaysToTheSameBits) {
  const RunResult result = run_session(options_);
  EXPECT_GT(result.summary.ticks, 0u);
  EXPECT_EQ(result.lost, 0u);
  EXPECT_EQ(result.recorder_error, "");
  EXPECT_EQ(result.controller_exit, 0);
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_GT(result.summary.contact_force_max_N, 0.05) << "the hand must have touched the ball";
  expect_whole_and_identical(result.summary.ticks);
  EXPECT_NE(summary_text(result.summary, result.lost).find("virtual time"), std::string::npos);
}

TEST_F(Run, InRealTimeAsWell) {
  options_.time = RunTime::kReal;
  const RunResult result = run_session(options_);
  EXPECT_FALSE(result.virtual_time);
  EXPECT_GT(result.summary.ticks, 0u);
  EXPECT_EQ(result.lost, 0u);
  expect_whole_and_identical(result.summary.ticks);
  const std::string text = summary_text(result.summary, result.lost);
  EXPECT_NE(text.find("wake-up latency"), std::string::npos);
  EXPECT_NE(text.find("solve"), std::string::npos);
}

TEST_F(Run, EndsWithZeroForceEvenWhenInterrupted) {
  options_.duration_s = 60;
  bool sent = false;  // while the run takes the signal: a loaded computer starts late, or latches a fault early
  options_.progress = [&](const LiveState&) {
    if (!sent) kill(getpid(), SIGINT);
    sent = true;
  };
  const RunResult result = run_session(options_);
  EXPECT_TRUE(result.interrupted || result.faulted());
  expect_whole_and_identical(result.summary.ticks);
  const MappedFile file(options_.record);
  RecordingReader reader(file.bytes());
  TickRecord last{}, record;
  while (reader.next(record)) last = record;
  EXPECT_EQ(last.output.device_w, Wrench{});
  EXPECT_TRUE(last.output.mode == Mode::kIdle || last.output.mode == Mode::kFault);
}

TEST_F(Run, ReplayCommandExitCodes) {
  run_session(options_);
  const std::string palpate = options_.program_folder + "/palpate";
  const auto exit_code_of = [&](const std::string& arguments) {
    const int status =
        std::system((palpate + " replay " + arguments + " > " + (folder_ / "out.txt").string() + " 2>&1").c_str());
    return WEXITSTATUS(status);
  };
  const auto output = [&] {
    std::ifstream file(folder_ / "out.txt");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(exit_code_of(options_.record + " --dump " + (folder_ / "run.csv").string()), 0);
  EXPECT_EQ(output().rfind("identical: ", 0), 0u) << output();
  EXPECT_GT(std::filesystem::file_size(folder_ / "run.csv"), 1000u);
  EXPECT_EQ(exit_code_of((folder_ / "missing.plr").string()), 2);
  EXPECT_NE(output().find("missing.plr"), std::string::npos) << output();
  std::filesystem::resize_file(options_.record, std::filesystem::file_size(options_.record) - 3);
  EXPECT_EQ(exit_code_of(options_.record), 1);
  EXPECT_NE(output().find("damaged recording: offset"), std::string::npos) << output();
}

// The simulated device keeps the image's period, which nobody tells it: at 1 kHz three of four ticks had no sample.
TEST_F(Run, AnImageOfFourKilohertzHasItsDevice) {
  options_.overlays.setting = {"device.period_ms=0.25"};
  options_.duration_s = 0.3;
  const std::uint64_t ticks = run_session(options_).summary.ticks;
  EXPECT_GE(ticks, 1200u);
  options_.scene = (folder_ / "ball.pal").string();
  options_.overlays = {};
  options_.path = (folder_ / "p.csv").string();
  std::ofstream(options_.path) << "0,0,75,0\n0.3,0,65,0\n";
  const RunResult result = run_session(options_);
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_GE(result.summary.ticks, 1200u);
  EXPECT_EQ(result.summary.stale_ticks, 0u);
}

TEST_F(Run, ClassicFramesWorkAsWell) {
  options_.device = "loopback,classic";
  options_.duration_s = 0.5;
  const RunResult result = run_session(options_);
  EXPECT_GT(result.summary.ticks, 0u);
  expect_whole_and_identical(result.summary.ticks);
}

TEST_F(Run, UnknownDeviceMissingProgramAndBrokenSceneAreNamed) {
  const auto error_of = [&](auto change) {
    RunOptions options = options_;
    change(options);
    try {
      run_session(options);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(error_of([](RunOptions& o) { o.device = "serial:3"; }).find("can:IFACE"), std::string::npos);
  EXPECT_NE(error_of([](RunOptions& o) { o.scene += "x.toml"; }).find("x.toml"), std::string::npos);
  run_session(options_);
  EXPECT_NE(error_of([&](RunOptions& o) { o.program_folder = "/nonexistent"; }).find("/nonexistent"),
            std::string::npos);
  std::ofstream(folder_ / "broken.pal") << "not an image";
  EXPECT_NE(error_of([&](RunOptions& o) {
              o.scene = (folder_ / "broken.pal").string();
              o.path = (folder_ / "p.csv").string();
              std::ofstream(o.path) << "0,0,0,45\n";
            }).find("broken.pal: "),
            std::string::npos);
}

TEST_F(Run, ControllerKilledInTheMiddleLeavesEverythingBeforeInTheRecording) {
  const SceneImage scene = prepare_scene(options_.scene, "", options_.record);
  DeviceProcess device(options_.program_folder + "/palpate-device", scene, "", "loopback", 0);
  ControllerLink link(options_.program_folder + "/palpate-rt",
                      {"--image", scene.image_path, "--device", "loopback", "--device-fd", "4", "--priority", "0"},
                      device.controller_end());
  device.close_controller_end();
  const TelemetryHeader& header = link.telemetry().header;
  const ImageFile image(scene.image_path);
  const StatePtr initial = make_state(image.model());
  RecordingWriter file(options_.record, recording_header(header), *initial);
  Recorder recorder(link.telemetry(), &file, {});
  recorder.start();
  TelemetryReader reader(link.telemetry());
  TickRecord newest{};
  for (int i = 0; i < 500 && newest.sequence < 100; ++i) {
    link.mailbox().beat();
    reader.newest(newest);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GE(newest.sequence, 100u);
  link.process().signal(SIGKILL);
  EXPECT_TRUE(link.process().wait(2000));
  EXPECT_EQ(link.process().exit_code(), 128 + SIGKILL);
  const std::uint64_t last = link.telemetry().newest.load();
  recorder.stop();
  EXPECT_EQ(recorder.lost(), 0u);
  EXPECT_EQ(recorder.records(), last);
  expect_whole_and_identical(last);
}

TEST_F(Run, ControllerWhoseHostDiesStopsByItself) {
  const SceneImage scene = prepare_scene(options_.scene, "", options_.record);
  DeviceProcess device(options_.program_folder + "/palpate-device", scene, "", "loopback", 0);
  ControllerLink link(options_.program_folder + "/palpate-rt",
                      {"--image", scene.image_path, "--device", "loopback", "--device-fd", "4", "--priority", "0"},
                      device.controller_end());
  device.close_controller_end();
  link.mailbox().set(Command::kArm, false);
  EXPECT_TRUE(link.process().wait(20'000));  // no heartbeat: silent after 2 s
  EXPECT_EQ(link.process().exit_code(), kExitFault);
  TelemetryReader reader(link.telemetry());
  TickRecord last{};
  ASSERT_TRUE(reader.newest(last));
  EXPECT_NE(last.output.fault, 0u);
  EXPECT_EQ(last.output.device_w, Wrench{});
}

TEST_F(Run, DeviceThatNeverSpeaksIsNamedByItsExitCode) {
  const SceneImage scene = prepare_scene(options_.scene, "", options_.record);
  int pair[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair), 0);
  ControllerLink link(options_.program_folder + "/palpate-rt",
                      {"--image", scene.image_path, "--device", "loopback", "--device-fd", "4", "--priority", "0"},
                      pair[0]);
  for (int i = 0; i < 2000 && !link.process().wait(10); ++i) link.mailbox().beat();
  EXPECT_EQ(link.process().exit_code(), kExitSilent);
  close(pair[0]);
  close(pair[1]);
}

TEST(RunPath, CsvIsReadAndItsErrorsNameTheLine) {
  const std::string path = (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_path.csv")).string();
  std::vector<HandPose> poses;
  std::string error;
  const auto read = [&](const char* text) {
    std::ofstream(path) << text;
    return read_hand_path(path, poses, error);
  };
  ASSERT_TRUE(read("time_s,x_mm,y_mm,z_mm\n# a comment\n0, 1, 2, 3\n\n0.5,4,5,6\r\n")) << error;
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].time_s, 0.5);
  EXPECT_EQ(poses[1].pose.position_m, (Vec3{4e-3, 5e-3, 6e-3}));
  ASSERT_TRUE(read("0,0,0,0,0,0,90\n")) << error;
  EXPECT_NEAR(rotate(poses[0].pose.orientation, {1, 0, 0}).y, 1.0, 1e-12);
  EXPECT_FALSE(read("0,1,2,3\n1,2,3\n"));
  EXPECT_NE(error.find(":2: expected time_s"), std::string::npos) << error;
  EXPECT_FALSE(read("0,1,2,nan\n"));
  EXPECT_FALSE(read("0,1,2,3x\n"));
  EXPECT_FALSE(read("0,1,2,3\n0,1,2,3\n"));
  EXPECT_NE(error.find("must rise"), std::string::npos) << error;
  EXPECT_FALSE(read("time_s\n"));
  EXPECT_NE(error.find("no poses"), std::string::npos) << error;
  std::filesystem::remove(path);
  EXPECT_FALSE(read_hand_path("/nonexistent.csv", poses, error));
}

TEST(RunPath, SceneMotionSurvivesTheTripThroughCsv) {
  SceneDesc scene;
  scene.path.point = {{0, {0.001, 0.002, 0.003}, {}}, {1.25, {0.1, -0.2, 0.3}, {0, 0.5, 0}}};
  const std::string path = (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_trip.csv")).string();
  std::ofstream(path) << path_csv(scene);
  std::vector<HandPose> poses;
  std::string error;
  ASSERT_TRUE(read_hand_path(path, poses, error)) << error;
  std::filesystem::remove(path);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_NEAR(norm(poses[1].pose.position_m - scene.path.point[1].position_m), 0, 1e-15);
  EXPECT_NEAR(norm(rotation_vector(poses[1].pose.orientation) - scene.path.point[1].rotation_rad), 0, 1e-12);
}

}  // namespace
}  // namespace palpate
