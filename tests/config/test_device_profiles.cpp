// The shipped device profiles: each scene's device has one that says the same and admits it, and a profile can be laid
// over a scene.
#include <gtest/gtest.h>

#include <filesystem>

#include "config/bake/compile.h"
#include "hal/device/device_profile.h"

namespace palpate {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(PALPATE_SOURCE_DIR) / "config";

std::string profile_file(const std::string& name) { return (kConfig / "devices" / (name + ".toml")).string(); }

TEST(DeviceProfiles, OfEveryShippedScenesDeviceSaysWhatTheSceneSays) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const DeviceDesc device = load_scene(entry.path().string()).device;
    std::string error;
    const auto profile = read_device_profile(profile_file(device.name), error);
    ASSERT_TRUE(profile) << entry.path() << ": " << error;
    EXPECT_EQ(profile->name, device.name);
#define PALPATE_KEY(member, key, value, lowest, highest, scale, meaning) \
  EXPECT_DOUBLE_EQ(profile->member, device.member) << entry.path() << ": " << key;
    PALPATE_PROFILE_KEYS(PALPATE_KEY)
#undef PALPATE_KEY
    scenes += 1;
  }
  EXPECT_GE(scenes, 16);
}

// What the controller reads is what a scene's reader reads: the same keys, units and ranges, one table.
TEST(DeviceProfiles, LieOverAScene) {
  int profiles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig / "devices")) {
    std::string error;
    const auto profile = read_device_profile(entry.path().string(), error);
    ASSERT_TRUE(profile) << error;
    SceneDesc scene = load_scene((kConfig / "scenes/ellipsoid_mallet.toml").string(), {{entry.path().string()}, {}});
    EXPECT_EQ(scene.device.name, profile->name);
#define PALPATE_KEY(member, key, value, lowest, highest, scale, meaning) \
  EXPECT_DOUBLE_EQ(scene.device.member, profile->member) << entry.path() << ": " << key;
    PALPATE_PROFILE_KEYS(PALPATE_KEY)
#undef PALPATE_KEY
    profiles += 1;
  }
  EXPECT_GE(profiles, 3);
}

}  // namespace
}  // namespace palpate
