// Device profiles: what is read, what is refused with which words, and what a scene may not ask of a device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "hal/device/device_profile.h"
#include "tests/hal/arm_text.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

using testing::HasSubstr;

// Admits 2 * 2.5 / (1 ms + 2 * 0.5 ms) = 2500 N/m and 2 * 0.001 / 2 ms = 1 N m/rad at 1 kHz.
constexpr char kGood[] = R"(# an arm
[device]
name = "arm"   # of the laboratory
mass_kg = 0.1
inertia_kg_m2 = 1e-4
damping_Ns_per_m = 2.5
damping_Nms_per_rad = 0.001
friction_N = 1
friction_Nm = 5e-1
encoder_step_mm = 0.03
encoder_step_rad = 0.001
delay_ms = 0.5
force_max_N = 8.5
torque_max_Nm = 0.2
)";

std::string refusal(const std::string& text) {
  std::string error;
  return parse_device_profile(text, "arm.toml", error) ? "accepted" : error;
}
std::string with(const std::string& old, const std::string& line) {
  std::string text = kGood;
  const auto at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), line);
}
DeviceProfile good() {
  std::string error;
  const auto profile = parse_device_profile(kGood, "arm.toml", error);
  EXPECT_TRUE(profile) << error;
  return profile.value_or(DeviceProfile{});
}
ModelParams scene() {
  ModelParams params = test::tiny_params();
  params.coupling_N_per_m = 2500;
  params.coupling_Nm_per_rad = 1;
  return params;
}

TEST(DeviceProfile, IsReadInSiUnits) {
  const DeviceProfile profile = good();
  EXPECT_EQ(profile.name, "arm");
  EXPECT_DOUBLE_EQ(profile.encoder_step_m, 3e-5);
  EXPECT_DOUBLE_EQ(profile.delay_s, 5e-4);
  EXPECT_DOUBLE_EQ(profile.friction_Nm, 0.5);
  EXPECT_DOUBLE_EQ(profile.force_max_N, 8.5);
}

TEST(DeviceProfile, IsRefusedWithFileLineKeyRangeAndRemedy) {
  EXPECT_EQ(refusal(with("mass_kg = 0.1", "mass_kg = 0")),
            "arm.toml:4: mass_kg: '0' is not a number in the range 0.001 to 100");
  EXPECT_THAT(refusal(with("mass_kg = 0.1\n", "")), HasSubstr("missing: mass_kg; a profile gives every key"));
  EXPECT_THAT(refusal(""), HasSubstr("missing: name, mass_kg, inertia_kg_m2"));
  EXPECT_THAT(refusal(with("mass_kg", "mass_g")), HasSubstr("arm.toml:4: mass_g: unknown key"));
  EXPECT_THAT(refusal(with("[device]", "")), HasSubstr("begin the file with [device]"));
  EXPECT_THAT(refusal(with("delay_ms = 0.5", "delay_ms = 0.5\ndelay_ms = 1")),
              HasSubstr("arm.toml:13: delay_ms: given twice"));
  EXPECT_THAT(refusal(with("[device]", "[device]\n[device]")), HasSubstr("a second [device]"));
  EXPECT_THAT(refusal(with("[device]", "[body]")), HasSubstr("[body]: begin the file with [device]"));
  EXPECT_THAT(refusal(with("delay_ms = 0.5", "delay")), HasSubstr("write KEY = VALUE"));
  for (const char* bad : {"nan", "inf", "-1", "1e999", "0x10", "", "0.5 ms", "\"0.5\"", "101", "--1", "1e", "."})
    EXPECT_THAT(refusal(with("delay_ms = 0.5", std::string("delay_ms = ") + bad)), HasSubstr("arm.toml:12: delay_ms:"))
        << bad;
  for (const char* bad : {"arm", "\"\"", "\"a\\n\"", "\"\x01\"", "\"arm"})
    EXPECT_THAT(refusal(with("\"arm\"", bad)), HasSubstr("arm.toml:3: name:")) << bad;
  EXPECT_THAT(refusal(with("\"arm\"", '"' + std::string(64, 'x') + '"')), HasSubstr("1 to 63"));
}

// No prefix and no random edit is anything but read or refused.
TEST(DeviceProfile, AnyTextIsReadOrRefused) {
  const std::string whole = kGood;
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "accepted") << length;
  std::mt19937 random(3);
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = whole;
    for (unsigned n = 0; n <= random() % 4; ++n) text[random() % text.size()] = static_cast<char>(random());
    std::string error;
    const auto profile = parse_device_profile(text, "f", error);
    ASSERT_EQ(profile.has_value(), error.empty());
    if (!profile) continue;
    accepted += 1;
    ASSERT_TRUE(profile->force_max_N > 0 && profile->force_max_N <= kWireForceMax_N && profile->delay_s >= 0);
  }
  EXPECT_GT(accepted, 100);
  EXPECT_LT(accepted, 19000);
}

TEST(DeviceProfile, NoOrdinaryFileOfItsSizeIsRefused) {
  std::string error;
  for (const char* file : {"/nonexistent", "/", "/dev/zero", "/dev/null"}) {
    error.clear();
    EXPECT_FALSE(read_device_profile(file, error)) << file;
    EXPECT_THAT(error, HasSubstr(file));
  }
  const auto large = std::filesystem::temp_directory_path() / ("palpate_profile_" + std::to_string(getpid()));
  std::ofstream(large) << kGood << std::string(1 << 16, '\n');
  EXPECT_FALSE(read_device_profile(large, error));
  EXPECT_THAT(error, HasSubstr("no device profile"));
  std::ofstream(large) << kGood;
  EXPECT_TRUE(read_device_profile(large, error)) << error;
  std::filesystem::remove(large);
}

std::string arm_with(const std::string& old, const std::string& line) {
  std::string text = std::string(kGood) + test::kArm;
  const auto at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return refusal(text.replace(at, old.size(), line));
}

TEST(DeviceProfile, AnArmIsReadInSiUnits) {
  std::string error;
  const auto profile = parse_device_profile(std::string(kGood) + test::kArm, "arm.toml", error);
  ASSERT_TRUE(profile && profile->arm) << error;
  const ArmProfile& arm = *profile->arm;
  EXPECT_EQ(arm.linkage.kind, LinkageKind::kSerial3r);
  EXPECT_DOUBLE_EQ(arm.linkage.fore_m, 0.245);
  EXPECT_EQ(arm.protocol, DriveProtocol::kODrive);
  EXPECT_EQ(arm.firmware, "0.6.10");
  EXPECT_DOUBLE_EQ(arm.drives.watchdog_s, 0.02);
  ASSERT_EQ(arm.axes.size(), 3u);
  EXPECT_EQ(arm.axes[1].direction, -1);
  EXPECT_DOUBLE_EQ(arm.axes[1].home_joint, 80 * kPi / 180);
  EXPECT_EQ(arm.axes[2].serial, 61925406831667.0);
  // A quarter turn about z carries the device's x onto the world's y, twice as far.
  DeviceSample sample;
  sample.position_m = {0.01, 0, 0};
  const Vec3 seen = pose_in_world(profile->frame, sample).position_m;
  EXPECT_LT(norm(seen - Vec3{-0.1, 0.02, 0}), 1e-15);
  EXPECT_EQ(profile->clutch_buttons, 2u);
  EXPECT_TRUE(valid(profile->frame));
}

// What was smoothed for another device's friction does not run on one that would go to and fro.
TEST(DeviceProfile, ASmoothedSceneAsksForTheFrictionThatHoldsTheHandle) {
  DeviceProfile profile = good();
  ModelParams asks = scene();
  profile.friction_N = 0.08;     // sqrt(2500 / 0.1) / 153 = 1.0334 times 2500 N/m times 30 um is 0.07751
  profile.friction_Nm = 6.4e-4;  // 0.633 times 1 N m/rad times 1 mrad
  EXPECT_EQ(profile_contradictions(profile, asks), "");  // as told: nothing is asked
  asks.encoder_step_m = 3e-5;
  asks.encoder_step_rad = 1e-3;
  EXPECT_EQ(profile_contradictions(profile, asks), "");
  profile.friction_N = 0.075;
  EXPECT_EQ(profile_contradictions(profile, asks),
            "device.friction_N: the scene smooths the encoder, which asks for 0.0775068 N of friction, the device has "
            "0.075 N; bake the scene with this profile (--with PROFILE), or with device.smooth_encoder = false");
  asks.encoder_law_m = EncoderLaw::kEdges;
  EXPECT_EQ(profile_contradictions(profile, asks), "");
  profile.friction_N = 0.046;  // 0.62 of 75 mN is 46.5
  EXPECT_THAT(profile_contradictions(profile, asks),
              HasSubstr("asks for 0.0465 N of friction, the device has 0.046 N"));
  asks.track_below_N_per_m = 2000;  // and on its track 0.98 of 60 mN
  profile.friction_N = 0.058;
  EXPECT_THAT(profile_contradictions(profile, asks), HasSubstr("asks for 0.0588 N of friction"));
  profile.friction_N = 0.06;
  EXPECT_EQ(profile_contradictions(profile, asks), "");
  profile.friction_Nm = 6e-4;
  asks.encoder_law_rad = EncoderLaw::kEdges;  // 0.62 of 1 mN m, as a stiffer turn's would be less than the motion's
  EXPECT_THAT(profile_contradictions(profile, asks), HasSubstr("asks for 0.00062 N m of friction"));
  asks.encoder_law_rad = EncoderLaw::kMotion;
  asks.local_period_s = 1e-4;  // a device that smooths by itself, but not the angle
  profile.local_Hz = 1e4;
  EXPECT_THAT(profile_contradictions(profile, asks),
              AllOf(Not(HasSubstr("friction_N:")), HasSubstr("device.friction_Nm: the scene smooths")));
}

TEST(DeviceProfile, AnArmThatCannotBeIsRefused) {
  EXPECT_THAT(arm_with("kind = \"serial_3r\"", "kind = \"scara\""),
              HasSubstr("kind: \"scara\": allowed are \"cartesian\""));
  EXPECT_THAT(arm_with("upper_mm = 205\n", ""), HasSubstr("missing in the table above: upper_mm"));
  EXPECT_THAT(arm_with("upper_mm = 205", "upper_mm = 0"), HasSubstr("range 1 to 10000"));
  EXPECT_THAT(arm_with("[[axis]]\nnode = 1", "[axis]\nnode = 1"), HasSubstr("[axis]: a profile holds only"));
  EXPECT_THAT(arm_with("direction = -1", "direction = 0"), HasSubstr("axis 2: direction: 1 or -1"));
  EXPECT_THAT(arm_with("node = 2", "node = 1"), HasSubstr("axis 2: node 1 is that of axis 1"));
  EXPECT_THAT(arm_with("node = 2", "node = 63"), HasSubstr("an ODrive's is 1 to 62"));
  EXPECT_THAT(arm_with("node = 2", "node = 2.5"), HasSubstr("whole numbers"));
  EXPECT_THAT(arm_with("831667", "831666"), HasSubstr("axis 3: serial is that of axis 2"));
  EXPECT_THAT(arm_with("home_deg = 80", "home_deg = 130"), HasSubstr("between lowest and highest"));
  EXPECT_THAT(arm_with("ratio = 16\n", ""), HasSubstr("missing in the table above: ratio"));
  EXPECT_THAT(arm_with("ratio = 16", "ratio = 16\nmm_per_turn = 3"), HasSubstr("only a slide has it"));
  EXPECT_THAT(arm_with("kind = \"serial_3r\"", "kind = \"serial_3r_gimbal\""), HasSubstr("has 6 axes, not 3"));
  EXPECT_THAT(arm_with("firmware = \"0.6.10\"\n", ""), HasSubstr("missing in the table above: firmware"));
  EXPECT_THAT(arm_with("watchdog_ms = 20", "watchdog_ms = 0"), HasSubstr("range 5 to 100"));
  EXPECT_THAT(arm_with("watchdog_ms = 20\n", ""), HasSubstr("missing in the table above: watchdog_ms"));
  EXPECT_THAT(arm_with("calibrate = \"home_pose\"", "calibrate = \"absolute\""), HasSubstr("home_turns"));
  EXPECT_THAT(arm_with("home_deg = -20", "home_deg = -20\nfriction_Nm = 0.1"),
              HasSubstr("axis 3: friction_Nm: must be below torque_max_Nm"));
  EXPECT_THAT(arm_with("home_deg = -20", "home_deg = -20\nfriction_Nm = -1"), HasSubstr("range 0 to 100"));
  EXPECT_THAT(arm_with("calibrate = \"home_pose\"", "calibrate = \"index\""), HasSubstr("home_turns"));
  EXPECT_THAT(arm_with("protocol = \"odrive\"", "protocol = \"cia402\""), HasSubstr("vendor_id"));
  EXPECT_THAT(arm_with("scale = 2", "scale = 2\nscale = 2"), HasSubstr("arm.toml:20: scale: given twice"));
  EXPECT_THAT(arm_with("[linkage]", "[frame]"), HasSubstr("a second [frame]"));
  EXPECT_THAT(refusal(std::string(kGood) + "[linkage]\nkind = \"cartesian\"\ncalibrate = \"absolute\"\n"),
              HasSubstr("[drives]"));
}

// Index marks are asked of the drives that can tell them.
TEST(DeviceProfile, AnIndexIsReadWhereTheDriverReadsIt) {
  std::string text = std::string(kGood) + test::kArm;
  const auto put = [&text](const std::string& old, const std::string& fresh) {
    text.replace(text.find(old), old.size(), fresh);
  };
  put("calibrate = \"home_pose\"", "calibrate = \"index\"");
  for (const char* home : {"home_deg = 0\n", "home_deg = 80\n", "home_deg = -20\n"})
    put(home, std::string(home) + "home_turns = 0\n");
  EXPECT_THAT(refusal(text), HasSubstr("of CiA 402 drives and of a Falcon alone; odrive drives are not asked"));
  put("protocol = \"odrive\"", "protocol = \"moteus\"");
  for (const char* key :
       {"endpoint_enable_watchdog = 182\n", "endpoint_watchdog_timeout = 183\n", "endpoint_direction = 396\n"})
    put(key, "");
  EXPECT_THAT(refusal(text), HasSubstr("moteus drives are not asked"));
}

TEST(DeviceProfile, ASceneAtTheDevicesLimitsFits) { EXPECT_EQ(profile_contradictions(good(), scene()), ""); }

TEST(DeviceProfile, ASceneThatAsksMoreIsRefusedKeyByKey) {
  ModelParams asks = scene();
  asks.force_max_N = 8.6;
  EXPECT_EQ(profile_contradictions(good(), asks), "device.force_max_N: the scene states 8.6 N, the device has 8.5 N");
  asks = scene();
  asks.torque_max_Nm = 0.21;
  EXPECT_THAT(profile_contradictions(good(), asks), HasSubstr("device.torque_max_Nm: the scene states 0.21 N m"));
  asks = scene();
  asks.coupling_N_per_m = 2501;
  EXPECT_THAT(profile_contradictions(good(), asks), HasSubstr("admits, by 2b / (T + 2 tau), 2500 N/m"));
  asks = scene();
  asks.coupling_Nm_per_rad = 1.01;
  EXPECT_THAT(profile_contradictions(good(), asks), HasSubstr("device.coupling_Nm_per_rad: the scene states 1.01"));
  asks.torque_max_Nm = 0;  // nothing turns the handle
  EXPECT_EQ(profile_contradictions(good(), asks), "");
  asks = scene();
  asks.period_s = 2e-3;  // slower: less is admitted
  EXPECT_THAT(profile_contradictions(good(), asks), HasSubstr("1666.67 N/m"));
}

// The hand feels the scene's stiffness times the scale and its turning over it: a coupling of 0.8 of the bound would be
// 1.6 times the bound in a frame of scale 2.
TEST(DeviceProfile, AMagnifiedFrameAdmitsLess) {
  DeviceProfile profile = good();
  profile.frame.scale = 2;
  ModelParams asks = scene();
  asks.coupling_N_per_m = 0.8 * 2500;
  EXPECT_EQ(
      profile_contradictions(profile, asks),
      "device.coupling_N_per_m: the scene states 2000 N/m, the device admits, by 2b / (T + 2 tau) over frame.scale "
      "= 2, 1250 N/m");
  asks.coupling_N_per_m = 0.8 * 1250;
  EXPECT_EQ(profile_contradictions(profile, asks), "");
  asks.coupling_Nm_per_rad = 1.9;  // half as stiff at the handle
  EXPECT_EQ(profile_contradictions(profile, asks), "");
  profile.frame.scale = 0.5;
  EXPECT_THAT(profile_contradictions(profile, asks),
              testing::AllOf(HasSubstr("by 2b / (T + 2 tau) times frame.scale = 0.5, 0.5 N m/rad"),
                             HasSubstr("the device has, times frame.scale = 0.5, 0.1 N m")));
  EXPECT_DOUBLE_EQ(admitted_coupling(profile, 1e-3, HeldPart::kTool).translation.value, 5000);
  EXPECT_DOUBLE_EQ(admitted_coupling(profile, 1e-3, HeldPart::kBoth).translation.value, 2500);  // two handles
}

// What is refused says what to do: --with counts the scale in, as this file does.
TEST(DeviceProfile, AScaleThatASceneWasNotBakedForIsRefused) {
  const auto path = std::filesystem::temp_directory_path() / ("palpate_scaled_" + std::to_string(getpid()));
  std::ofstream(path) << kGood << "[frame]\nscale = 2\n";
  const std::string refused = refuse_profile(false, "loopback", path, scene());
  std::filesystem::remove(path);
  EXPECT_THAT(refused, HasSubstr("1250 N/m"));
  EXPECT_THAT(refused, HasSubstr("--with " + path.string() + " (which counts frame.scale in)"));
}

TEST(DeviceProfile, ARealDeviceNeedsOneAndASimulatedOneDoesNot) {
  EXPECT_EQ(refuse_profile(false, "loopback", "", scene()), "");
  EXPECT_THAT(refuse_profile(true, "can:can0", "", scene()),
              HasSubstr("refused: can:can0 is driven only with a profile"));
  EXPECT_THAT(refuse_profile(true, "can:can0", "", scene()), HasSubstr("--profile FILE"));
  EXPECT_THAT(refuse_profile(false, "loopback", "/nonexistent", scene()), HasSubstr("/nonexistent"));
}

}  // namespace
}  // namespace palpate
