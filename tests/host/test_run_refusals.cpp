// What is refused before a device is driven: no profile of it, a scene that asks more than it can do, real-time rights
// that were not given. (A tool that starts inside: Safety.DoesNotArmAToolThatStartsInside.)
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "sim_host/exit_codes.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

using testing::HasSubstr;

class Refusal : public BallRun {
 protected:
  Refusal() : profile_(file("sim-6dof.toml")) {}

  static std::string file(const char* name) { return std::string(PALPATE_SOURCE_DIR) + "/config/devices/" + name; }
  // Exit code; what was printed is in text_.
  int operator()(const std::string& arguments) {
    const std::string output = (folder_ / "out.txt").string();
    const int status = std::system((options_.program_folder + "/" + arguments + " > " + output + " 2>&1").c_str());
    std::ifstream stream(output);
    text_ = {std::istreambuf_iterator<char>(stream), {}};
    return WEXITSTATUS(status);
  }
  std::string image() {
    const std::string image = (folder_ / "ball.pal").string();
    EXPECT_EQ((*this)("palpate bake " + options_.scene + " -o " + image), kExitOk) << text_;
    return image;
  }
  // The same device, but for one line.
  std::string profile_with(const std::string& key, const std::string& value) {
    std::ifstream stream(profile_);
    const std::string changed = (folder_ / "changed.toml").string();
    std::ofstream out(changed);
    for (std::string line; std::getline(stream, line);)
      out << (line.starts_with(key + " ") ? key + " = " + value : line) << "\n";
    return changed;
  }

  std::string profile_, text_;
};

// The interface does not exist: what passes the profile's check ends there, with another code and text.
TEST_F(Refusal, TheControllerDrivesNoDeviceOnABusWithoutAProfile) {
  const std::string image_path = image();
  for (const char* device : {"can:nocan0", "usb:/dev/hidraw99"}) {
    const std::string start = "palpate-rt --image " + image_path + " --device " + device;
    EXPECT_EQ((*this)(start), kExitUsage) << text_;
    EXPECT_THAT(text_, HasSubstr(std::string("refused: ") + device + " is driven only with a profile"));
    EXPECT_EQ((*this)(start + " --allow-no-rt"), kExitUsage) << text_;
    EXPECT_EQ((*this)(start + " --profile " + (folder_ / "none.toml").string()), kExitUsage) << text_;
    EXPECT_EQ((*this)(start + " --profile " + profile_with("delay_ms", "2")), kExitUsage) << text_;
    EXPECT_THAT(text_, HasSubstr("device.coupling_N_per_m: the scene states"));
    EXPECT_THAT(text_, HasSubstr("palpate bake SCENE --with"));
    EXPECT_EQ((*this)(start + " --profile " + profile_with("force_max_N", "8")), kExitUsage) << text_;
    EXPECT_THAT(text_, HasSubstr("device.force_max_N: the scene states 8.5 N, the device has 8 N"));
    EXPECT_EQ((*this)(start + " --profile " + profile_), kExitUnavailable) << text_;
    EXPECT_THAT(text_, HasSubstr("profile sim-6dof: the scene asks 8.5 of 8.5 N"));
  }
}

TEST_F(Refusal, TheHostSaysItBeforeItBakes) {
  const std::string baked = (folder_ / "baked.pal").string();
  const std::string start =
      "palpate run " + options_.scene + " --quiet --no-record --device can:nocan0 --image " + baked;
  EXPECT_EQ((*this)(start), kExitUsage) << text_;
  EXPECT_THAT(text_, HasSubstr("refused: can:nocan0 is driven only with a profile"));
  EXPECT_FALSE(std::filesystem::exists(baked));
  EXPECT_EQ((*this)(start + " --profile " + profile_with("torque_max_Nm", "0.1")), kExitUsage) << text_;
  EXPECT_THAT(text_, HasSubstr("device.torque_max_Nm"));
  EXPECT_EQ((*this)(start + " --profile " + profile_), kExitUnavailable) << text_;
}

// Baked for it, every shipped example runs: on the simulated device, which then is the one of the profile.
TEST_F(Refusal, ASceneBakedForADeviceIsAccepted) {
  const std::string weak = file("example-can.toml"), baked = (folder_ / "weak.pal").string();
  EXPECT_EQ((*this)("palpate run " + options_.scene + " --virtual-time --quiet --no-record --profile " + weak),
            kExitUsage);
  EXPECT_THAT(text_, HasSubstr("device.force_max_N: the scene states 8.5 N, the device has 3 N"));
  EXPECT_EQ((*this)("palpate bake " + options_.scene + " --with " + weak + " -o " + baked), kExitOk) << text_;
  EXPECT_EQ((*this)("palpate explain " + baked + " --profile " + weak), kExitOk) << text_;
  EXPECT_THAT(text_, HasSubstr("device  example-can: the scene asks 3 of 3 N"));
  EXPECT_EQ((*this)("palpate explain " + options_.scene + " --profile " + weak), kExitFailed) << text_;
  options_.profile = profile_;
  options_.time = RunTime::kVirtual;
  options_.duration_s = 0.5;
  EXPECT_EQ(run_session(options_).controller_exit, kExitOk);
}

TEST_F(Refusal, TheDoctorMissesTheProfile) {
  (*this)("palpate doctor --device can:nocan0");
  EXPECT_THAT(text_, HasSubstr("FAIL    device profile"));
  (*this)("palpate doctor --device can:nocan0 --profile " + profile_);
  EXPECT_THAT(text_, HasSubstr("pass    device profile"));
  EXPECT_THAT(text_, HasSubstr("sim-6dof: 8.5 N, 0.188 N m, admits 2500 N/m at 1 kHz"));
  (*this)("palpate doctor --device can:nocan0 --profile " + options_.scene);
  EXPECT_THAT(text_, HasSubstr("FAIL    device profile"));
}

// NaN is not below the least nor above the most.
TEST_F(Refusal, NumbersThatAreNoneAreNoDurations) {
  for (const char* command : {"run %s --virtual-time --no-record --duration nan", "latency --duration nan",
                              "press %s --path demo --hand nan", "run %s --virtual-time --no-record --duration -inf"}) {
    std::string text = command;
    if (const auto at = text.find("%s"); at != std::string::npos) text.replace(at, 2, options_.scene);
    EXPECT_EQ((*this)("palpate " + text), kExitUsage) << text_;
    EXPECT_THAT(text_, ::testing::ContainsRegex("is not a (number|duration) from")) << command;
  }
}

// The simulated device refuses such a path, and was gone: the run then said that the controller was killed.
TEST_F(Refusal, AMotionThatIsNoneIsSaidByTheHost) {
  const std::string path = (folder_ / "hand.csv").string();
  for (const char* rows : {"0,nan,0,0", "0,0,0", "0,0,0,0\n0,0,0,0", ""}) {
    std::ofstream(path) << "time_s,x_mm,y_mm,z_mm\n" << rows << "\n";
    EXPECT_EQ((*this)("palpate run " + options_.scene + " --virtual-time --no-record --quiet --path " + path),
              kExitUsage);
    EXPECT_THAT(text_, HasSubstr("hand.csv")) << rows;
  }
  EXPECT_EQ((*this)("palpate run " + options_.scene + " --virtual-time --no-record --quiet --path /dev/zero"),
            kExitUsage);
  EXPECT_THAT(text_, HasSubstr("is no ordinary file"));
}

// Root's `palpate bake -o /dev/null` replaced the device by a file, for it was written elsewhere and renamed.
TEST_F(Refusal, WhatIsNoFileIsNotReplaced) {
  const std::string pipe = (folder_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ((*this)("palpate bake " + options_.scene + " -o " + pipe), kExitUsage) << text_;
  EXPECT_THAT(text_, HasSubstr("is no ordinary file and is not replaced"));
  EXPECT_EQ((*this)("palpate run " + options_.scene + " --virtual-time --quiet --overwrite --record " + pipe),
            kExitUsage);
  EXPECT_THAT(text_, HasSubstr("is no ordinary file and is not replaced"));
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

// A limit on the size of files ended the program by a signal, without a word.
TEST_F(Refusal, ALimitOnFilesIsSaid) {
  const std::string image_path = image(), path = (folder_ / "hand.csv").string();
  std::ofstream(path) << "time_s,x_mm,y_mm,z_mm\n0,0,200,0\n60,0,200,0\n";
  const std::string output = (folder_ / "limited.txt").string();
  const int status =
      std::system(("ulimit -f 64; " + options_.program_folder + "/palpate run " + image_path + " --path " + path +
                   " --virtual-time --quiet --no-record --duration 0.5 > " + output + " 2>&1")
                      .c_str());
  std::ifstream stream(output);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_TRUE(WIFEXITED(status)) << text;
  EXPECT_EQ(WEXITSTATUS(status), kExitUnavailable) << text;
  EXPECT_THAT(text, HasSubstr("File too large"));
}

// What a device on a bus asks by itself; here asked for on the loopback, which has no bus.
TEST_F(Refusal, WithoutRealTimeRightsNothingIsDriven) {
  const std::string device = "loopback:palpate-rights-" + std::to_string(getpid());
  const std::string path = (folder_ / "hand.csv").string();
  std::ofstream(path) << "time_s,x_mm,y_mm,z_mm\n0,0,200,0\n60,0,200,0\n";
  const std::string both = "palpate-device --device " + device + " --path " + path + " > /dev/null 2>&1 & " +
                           options_.program_folder + "/palpate-rt --image " + image() + " --device " + device +
                           " --priority 0 --duration 0.2 ";
  EXPECT_EQ((*this)(both + "--require-rt"), kExitUnavailable) << text_;
  EXPECT_THAT(text_, HasSubstr("refused: scheduler (--priority 0)"));
  EXPECT_THAT(text_, HasSubstr("--allow-no-rt"));
  EXPECT_EQ((*this)(both + "--require-rt --allow-no-rt"), kExitOk) << text_;
}

}  // namespace
}  // namespace palpate
