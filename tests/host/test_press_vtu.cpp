// ParaView files: well-formed, complete, and the numbers are those of the model.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "sim_host/bake/scene_model.h"
#include "sim_host/tick_memory.h"
#include "sim_host/view/vtu.h"
#include "tests/host/xml_check.h"

namespace palpate {
namespace {

std::string encode(const std::string& text) {
  return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(Base64, MatchesTheStandardsExamples) {  // RFC 4648, section 10
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foo"), "Zm9v");
  EXPECT_EQ(encode("foob"), "Zm9vYg==");
  EXPECT_EQ(encode("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

std::vector<std::uint8_t> decode(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    group = group << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((bits += 6) >= 8) bytes.push_back(static_cast<std::uint8_t>(group >> (bits -= 8)));
  }
  return bytes;
}

// Payload of the named array, its length prefix checked and removed.
template <typename T>
std::vector<T> array_of(const std::string& vtu, const std::string& name) {
  const std::size_t tag = vtu.find("Name=\"" + name + "\"");
  if (tag == std::string::npos) return {};
  const std::size_t begin = vtu.find('>', tag) + 1;
  const std::vector<std::uint8_t> bytes = decode(vtu.substr(begin, vtu.find('<', begin) - begin));
  std::uint32_t length = 0;
  if (bytes.size() < sizeof length) return {};
  std::memcpy(&length, bytes.data(), sizeof length);
  EXPECT_EQ(length + sizeof length, bytes.size());
  std::vector<T> values(length / sizeof(T));
  std::memcpy(values.data(), bytes.data() + sizeof length, length);
  return values;
}

class Vtu : public ::testing::Test {
 protected:
  const SceneModel scene_{std::string(PALPATE_SOURCE_DIR) + "/config/scenes/ellipsoid_mallet_springs.toml"};
  const Model& model_ = scene_.model();
};

TEST_F(Vtu, SurfaceHoldsPointsTrianglesAndDisplacement) {
  std::vector<Vec3> displacement(model_.vertex_m.size());
  displacement[7] = {3e-3, -4e-3, 0};
  const std::string text = surface_vtu(model_, deformed_surface(model_, displacement));
  EXPECT_EQ(test::xml_error(text), "");
  const auto points = array_of<float>(text, "Points");
  ASSERT_EQ(points.size(), 3 * model_.vertex_m.size());
  EXPECT_FLOAT_EQ(points[3 * 7 + 1], static_cast<float>(model_.vertex_m[7].y));
  EXPECT_FLOAT_EQ(array_of<float>(text, "displacement_m")[3 * 7 + 1], -4e-3f);
  EXPECT_FLOAT_EQ(array_of<float>(text, "displacement_magnitude_mm")[7], 5.0f);
  EXPECT_EQ(array_of<float>(text, "normal").size(), points.size());
  const auto connectivity = array_of<std::int32_t>(text, "connectivity");
  ASSERT_EQ(connectivity.size(), 3 * model_.triangle.size());
  EXPECT_EQ(connectivity[5], model_.triangle[1].vertex[2]);
  EXPECT_EQ(array_of<std::int32_t>(text, "offsets").back(), static_cast<std::int32_t>(connectivity.size()));
  EXPECT_EQ(array_of<std::uint8_t>(text, "types"), std::vector<std::uint8_t>(model_.triangle.size(), 5));
}

TEST_F(Vtu, AnchorsHoldDisplacementAndStress) {
  AnchorField field;
  field.anchor[2].displacement_w = {0, 1e-3, 0};
  field.anchor[2].stress_Pa = 1234;
  const std::string text = anchors_vtu(model_, field);
  EXPECT_EQ(test::xml_error(text), "");
  EXPECT_EQ(array_of<std::uint8_t>(text, "fixed").size(), model_.anchor.size());
  EXPECT_FLOAT_EQ(array_of<float>(text, "stress_Pa")[2], 1234);
  EXPECT_FLOAT_EQ(array_of<float>(text, "displacement_m")[3 * 2 + 1], 1e-3f);
}

TEST(VtuRegions, AreTheRecordsNumbersToTheBit) {
  std::vector<RegionRecord> regions(2);
  regions[1].id = 7;
  regions[1].centre_w = {1e-3, 1.0 / 3, -0.1};
  regions[1].force_w = {0.1, -2.0 / 7, 1e-12};
  regions[1].normal_w = {0, 0.6, 0.8};
  regions[1].depth_equivalent_m = 1e-3 / 3;
  regions[1].friction = 2;
  const std::string text = regions_vtu(regions);
  EXPECT_EQ(test::xml_error(text), "");
  const auto of = [&](const char* name) { return array_of<double>(text, name); };
  EXPECT_EQ(of("Points")[4], 1.0 / 3);
  EXPECT_EQ(of("force_N")[4], -2.0 / 7);
  EXPECT_EQ(of("normal")[5], 0.8);
  EXPECT_EQ(of("depth_equivalent_m")[1], 1e-3 / 3);
  EXPECT_EQ(array_of<std::uint32_t>(text, "id")[1], 7u);
  EXPECT_EQ(array_of<std::int32_t>(text, "friction")[1], 2);
  EXPECT_EQ(array_of<std::uint8_t>(text, "types"), std::vector<std::uint8_t>(2, 1));
  EXPECT_EQ(test::xml_error(regions_vtu({})), "") << "a tick without contact has a file, too";
}

TEST_F(Vtu, SeriesHasAnIndexWithTimes) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("palpate_vtu_" + std::to_string(getpid()));
  const auto state = make_state(model_);
  reset(*state);
  {
    VtuSeries series(folder.string());
    series.add(model_, *state, {}, 0);
    series.add(model_, *state, {}, 0.25);
    series.finish();
  }
  std::ifstream file(folder / "surface.pvd");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(test::xml_error(text.str()), "");
  EXPECT_NE(text.str().find("timestep=\"0.25\" part=\"0\" file=\"surface_000001.vtu\""), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder / "surface_000001.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder / "anchors_000001.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder / "anchors.pvd"));
  std::filesystem::remove_all(folder);
  EXPECT_THROW(VtuSeries("/proc/nonexistent/vtu"), std::runtime_error);
}

}  // namespace
}  // namespace palpate
