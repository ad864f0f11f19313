// Whole runs on simulated drives: the programs of a run, the shipped profiles, either protocol.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iterator>

#include "config/scene/scene.h"
#include "hal/drives/moved_record.h"
#include "sim_host/exit_codes.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

using testing::HasSubstr;

class RunDrives : public BallRun {
 protected:
  RunDrives() {
    options_.time = RunTime::kVirtual;
    options_.duration_s = 2.5;                         // the search for the drives takes up to 0.8 s of it
    options_.record = (folder_ / "run.plr").string();  // tests of this file run side by side
  }
  static std::string read(const std::string& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static std::string shipped(const char* name) { return std::string(PALPATE_SOURCE_DIR) + "/config/devices/" + name; }
  std::string write(const char* name, const std::string& text) const {
    const std::string file = (folder_ / name).string();
    std::ofstream(file) << text;
    return file;
  }
  // A run of the profile's drives, and one of the simulated device that its [device] describes.
  void expect_like_its_plain_device() {
    const RunResult drives = run_session(options_);
    const std::string whole = read(options_.profile);
    options_.profile = write("plain.toml", whole.substr(0, whole.find("[frame]")));
    const RunResult plain = run_session(options_);
    for (const RunResult* run : {&drives, &plain}) {
      EXPECT_EQ(run->summary.fault, 0u);
      EXPECT_EQ(run->summary.armed_stale_ticks + run->summary.missed_ticks, 0u);
      EXPECT_GT(run->summary.device_force_max_N, 0.5);
    }
    EXPECT_NEAR(drives.summary.device_force_max_N, plain.summary.device_force_max_N, 0.06);
  }
};

// The hand feels what it feels of the plain simulated device with the same [device]: the positions of either differ by
// less than an encoder step of 0.03 mm, times a coupling of 2 N/mm is 0.06 N.
TEST_F(RunDrives, FeelLikeADeviceThatReportsItsPose) {
  for (const char* name : {"example-arm-odrive.toml", "example-delta-cia402.toml", "example-arm-moteus.toml"}) {
    SCOPED_TRACE(name);
    options_.profile = shipped(name);
    expect_like_its_plain_device();
  }
}

// Six drives at the rate their bus has room for, each found by its index mark; the ball is pressed beside the handle's
// axis, so that they hold a moment, too.
TEST_F(RunDrives, ASixDriveArmFeelsLikeADeviceThatReportsItsPose) {
  options_.profile = shipped("example-gimbal-cia402.toml");
  options_.overlays.setting = {"device.period_ms=2"};
  std::string scene = kBallScene;
  scene.insert(scene.find("[path]"), "position_mm = [15, 0, 0]\n");
  for (const auto& [at, beside] : {std::pair{"[0, 75", "[-15, 75"}, {"[0, 65", "[-15, 65"}, {"[5, 65", "[-10, 65"}})
    scene.replace(scene.find(at), 6, beside);
  options_.scene = write("beside.toml", scene);
  options_.overlays.file = {options_.profile};
  options_.duration_s = 3.5;
  expect_like_its_plain_device();
}

// The linkages no shipped profile has: slides, and two motors in the plane that the hand stays in. Numbers of no
// device.
TEST_F(RunDrives, SlidesAndAFiveBarFeelLikeADeviceThatReportsItsPose) {
  const std::string whole = read(shipped("example-arm-odrive.toml"));
  const std::string device = whole.substr(0, whole.find("[frame]"));
  const auto from_drives = whole.substr(whole.find("[drives]"));
  const std::string drives_table = from_drives.substr(0, from_drives.find("[[axis]]"));
  const auto axis = [](int node, const std::string& joint) {
    return "[[axis]]\nnode = " + std::to_string(node) + "\nserial = " + std::to_string(100 + node) +
           "\ncounts_per_turn = 16384\ndirection = -1\nhome_turns = 0\ntorque_max_Nm = 0.25\n" + joint;
  };
  const std::string slide = "mm_per_turn = 20\nhome_mm = 0\nlowest_mm = -150\nhighest_mm = 150\n";
  const std::string left = "ratio = 12\nhome_deg = 120\nlowest_deg = 45\nhighest_deg = 200\n";
  const std::string right = "ratio = 12\nhome_deg = 60\nlowest_deg = -20\nhighest_deg = 135\n";
  const std::string slides = "[frame]\n[linkage]\nkind = \"cartesian\"\ncalibrate = \"absolute\"\n" + drives_table +
                             axis(1, slide) + axis(2, slide) + axis(3, slide);
  const std::string five_bar =
      "[frame]\nposition_y_mm = -110\n[linkage]\nkind = \"five_bar\"\ncalibrate = \"absolute\"\nupper_mm = 100\n"
      "fore_mm = 150\nbase_mm = 100\n" +
      drives_table + axis(1, left) + axis(2, right);
  for (const std::string& tables : {slides, five_bar}) {
    SCOPED_TRACE(tables);
    options_.profile = write("drives.toml", device + tables);
    expect_like_its_plain_device();
  }
}

// A Falcon is weaker and later than the ball's scene supposes, and says so; baked for it, it feels alike, too: its
// encoders count steps of 0.04 mm, its base takes a coupling of 1 N/mm.
TEST_F(RunDrives, AFalconFeelsLikeADeviceThatReportsItsPose) {
  options_.profile = shipped("example-falcon.toml");
  EXPECT_THAT([this] { run_session(options_); }, testing::ThrowsMessage<std::runtime_error>(HasSubstr("--with")));
  options_.overlays.file = {options_.profile};
  expect_like_its_plain_device();
}

// The same bytes in the same order, whatever the machine does meanwhile.
TEST_F(RunDrives, GiveTheSameRecordingTwice) {
  options_.profile = shipped("example-delta-cia402.toml");
  run_session(options_);
  const std::string first = read(options_.record);
  run_session(options_);
  EXPECT_GT(first.size(), 10'000u);
  EXPECT_TRUE(first == read(options_.record));
}

TEST_F(RunDrives, AProfileWithDrivesIsLaidOverASceneByItsDeviceTable) {
  SceneOverlays overlays;
  overlays.file = {shipped("example-arm-odrive.toml")};
  const SceneDesc scene = load_scene(options_.scene, overlays);
  EXPECT_DOUBLE_EQ(scene.device.mass_kg, 0.2);
}

// The controller's profile names another drive on axis 2 than there is.
TEST_F(RunDrives, AnotherDriveThanTheProfilesIsNotDriven) {
  const std::string true_profile = shipped("example-arm-odrive.toml"), name = "drives" + std::to_string(getpid());
  std::string text = read(true_profile);
  text.replace(text.find("61925406831666"), 14, "61925406831999");
  const std::string other = write("other.toml", text), out = (folder_ / "out.txt").string(),
                    image = (folder_ / "ball.pal").string(), bin = options_.program_folder + "/";
  ASSERT_EQ(std::system((bin + "palpate bake " + options_.scene + " --with " + true_profile + " -o " + image + " > " +
                         out + " 2>&1")
                            .c_str()),
            0)
      << read(out);
  const int status = std::system((bin + "palpate-device --device loopback:" + name + " --profile " + true_profile +
                                  " & " + bin + "palpate-rt --image " + image + " --device loopback:" + name +
                                  " --profile " + other + " --priority 0 > " + out + " 2>&1")
                                     .c_str());
  EXPECT_EQ(WEXITSTATUS(status), kExitUnavailable);
  EXPECT_THAT(read(out),
              HasSubstr("no motor was enabled: axis 2 (ODrive node 2): serial number 61925406831666 is not that"));
}

// A profile that asks for the check by hand is driven once that passed with this very text.
TEST_F(RunDrives, AProfileMayAskToHaveBeenMovedByHand) {
  std::string text = read(shipped("example-arm-odrive.toml"));
  text.insert(text.find("watchdog_ms"), "moved_by_hand = 1\n");
  options_.duration_s = 1;
  options_.profile = write("asks.toml", text);
  EXPECT_FALSE(is_moved(options_.profile));
  EXPECT_EQ(run_session(options_).controller_exit, kExitUnavailable);
  ASSERT_EQ(record_moved(options_.profile), "");
  EXPECT_EQ(run_session(options_).controller_exit, 0);
  write("asks.toml", text + "# changed\n");
  EXPECT_FALSE(is_moved(options_.profile));
  EXPECT_EQ(run_session(options_).controller_exit, kExitUnavailable);
}

TEST_F(RunDrives, DeviceTestFindsThemAndDoctorSaysHow) {
  const std::string profile = shipped("example-delta-cia402.toml"), name = "drives" + std::to_string(getpid()),
                    out = (folder_ / "out.txt").string(), bin = options_.program_folder + "/";
  const auto run = [&](const std::string& command) {
    const int status = std::system((command + " > " + out + " 2>&1").c_str());
    return WEXITSTATUS(status);
  };
  EXPECT_EQ(run(bin + "palpate-device --device loopback:" + name + " --profile " + profile + " & " + bin +
                "palpate device-test loopback:" + name + " --profile " + profile),
            kExitOk)
      << read(out);
  EXPECT_THAT(read(out), HasSubstr("3 drives are those of the profile"));
  run(bin + "palpate doctor --device can:nocan0 --profile " + profile);
  EXPECT_THAT(read(out), HasSubstr("896 of 900 us at 1 kHz"));
  EXPECT_THAT(read(out), HasSubstr("palpate device-test can:nocan0 --profile"));
}

}  // namespace
}  // namespace palpate
