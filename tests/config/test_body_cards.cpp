// Every shape of body keeps what its card promises: mesh, anchors, normals and keys agree. Run over the whole table: a
// new shape is tested by being in it.
#include <gtest/gtest.h>

#include <set>

#include "config/body/body.h"
#include "config/body/body_card.h"
#include "config/scene/config_error.h"
#include "tests/support/baked_scene.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

using test::BakedScene;
using test::Bench;

// One value for every key of [body] that is a number; shapes of files have none of these.
std::string value_of(const std::string& key) {
  if (key == "half_axes_mm") return "[40, 30, 25]";
  if (key == "size_mm") return "[60, 40, 50]";
  if (key == "radius_mm") return "30";
  if (key == "height_mm") return "50";
  if (key == "width_mm") return "80";
  if (key == "wall_mm") return "8";
  if (key == "axis") return "\"y\"";
  if (key == "pattern") return "\"rings\"";
  if (key == "profile_mm") return "[[0, 0], [20, 5], [25, 25], [0, 40]]";
  if (key == "triangles") return "800";
  if (key == "fix_orientation") return "true";
  return "1.5";
}

bool from_file(BodyShape shape) { return shape == BodyShape::kMesh || shape == BodyShape::kTets; }

std::string example_toml(BodyShape shape) {
  std::string text = "name = \"s\"\n[body]\nshape = \"" + std::string(word_of(shape)) + "\"\n";
  for (const CardKey& key : card_of(shape).keys) {
    const std::string name = key.key;
    text += name + " = " + (name == "mesh" ? "\"body.obj\"" : value_of(name)) + "\n";
  }
  return text;
}
const char* const kTool = "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n";

std::string refusal(const std::string& text) {
  return test::refusal_by([&] { parse_scene(text, "s.toml"); });
}

class BodyCards : public testing::TestWithParam<BodyShape> {};

TEST_P(BodyCards, TakesItsKeysAndNoOther) {
  const std::string whole = example_toml(GetParam());
  EXPECT_EQ(refusal(whole + kTool), "accepted");
  std::set<std::string> own, all;
  for (const CardKey& key : card_of(GetParam()).keys) own.insert(key.key);
  for (std::int32_t i = 0; i < ChoiceOf<BodyShape>::kCount; ++i)
    for (const CardKey& key : card_of(static_cast<BodyShape>(i)).keys) all.insert(key.key);
  for (const std::string& key : all) {
    if (own.count(key) != 0) continue;
    const std::string error = refusal(whole + key + " = " + (key == "mesh" ? "\"x\"" : value_of(key)) + "\n" + kTool);
    EXPECT_NE(error.find("body." + key + ": has no effect"), std::string::npos) << error;
  }
}

// check_mesh has seen that the surface is closed, oriented and of one piece.
TEST_P(BodyCards, MeshStandsOnTheGroundAndIsItsOwnVolume) {
  if (from_file(GetParam())) return;
  std::vector<std::string> warnings;
  const SurfaceMesh mesh = make_body(parse_scene(example_toml(GetParam()) + kTool, "s.toml"), warnings);
  EXPECT_GT(signed_volume_m3(mesh), 0);
  if (GetParam() != BodyShape::kClip) {
    EXPECT_NEAR(bounds_of(mesh).lower_m.y, 0, 1e-6);
  }
}

// 800 triangles: a facet of a 40 mm body stands off its surface by about 0.5 mm at most.
TEST_P(BodyCards, ExactAnchorsAndNormalsLieOnTheMesh) {
  const BodyCard& card = card_of(GetParam());
  if (from_file(GetParam())) return;
  std::vector<std::string> warnings;
  const SceneDesc scene = parse_scene(example_toml(GetParam()) + kTool, "s.toml");
  const SurfaceMesh mesh = make_body(scene, warnings);
  const std::vector<Vec3> vertex_normal = vertex_normals(mesh);
  const double size = bounds_of(mesh).largest_m();
  if (card.anchors != nullptr) {
    for (const AnchorPoint& anchor : card.anchors(scene.body)) {
      EXPECT_NEAR(norm(anchor.normal), 1, 1e-12);
      double nearest = kHuge;
      for (const Vec3& v : mesh.vertex_m) nearest = std::min(nearest, norm(v - anchor.position_m));
      EXPECT_LT(nearest, 0.12 * size);
    }
  }
  if (card.normal == nullptr) return;
  for (const Corners& t : mesh.triangle) {
    const auto at = [&](std::size_t k) { return mesh.vertex_m[static_cast<std::size_t>(t[k])]; };
    const Vec3 face = unit_or(cross(at(1) - at(0), at(2) - at(0)), {0, 1, 0});
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 normal = card.normal(scene.body, at(k), face, bounds_of(mesh).upper_m.y);
      ASSERT_NEAR(norm(normal), 1, 1e-12);
      EXPECT_GT(dot(normal, face), 0.6);
    }
  }
}

// A ball pressed into the top of the body for 1000 ticks: everything stays finite, and the body pushes back.
TEST_P(BodyCards, BakesAndTicks) {
  if (from_file(GetParam())) return;
  const SceneDesc desc = parse_scene(example_toml(GetParam()) + kTool, "s.toml");
  const BakedScene scene(desc);
  Vec3 top{0, -kHuge, 0};
  for (const Vec3& v : scene.model().vertex_m)
    if (v.y > top.y) top = v;
  Bench bench(scene.model());
  double largest_N = 0;
  for (int i = 0; i < 1000; ++i) {
    const double depth = 0.003 * std::min(1.0, i / 600.0);
    const Output& out = bench.tick_at({{top.x, top.y + 0.008 - depth, top.z}, {}}, {});
    ASSERT_TRUE(is_finite(out.contact_w.force_N) && is_finite(out.device_w.force_N)) << "tick " << i;
    largest_N = std::max(largest_N, norm(out.contact_w.force_N));
  }
  EXPECT_GT(bench.output.contacts, 0);
  EXPECT_GT(largest_N, 0.01);
}

std::vector<BodyShape> all_shapes() {
  std::vector<BodyShape> shapes;
  for (std::int32_t i = 0; i < ChoiceOf<BodyShape>::kCount; ++i) shapes.push_back(static_cast<BodyShape>(i));
  return shapes;
}
INSTANTIATE_TEST_SUITE_P(Shapes, BodyCards, testing::ValuesIn(all_shapes()),
                         [](const auto& shape) { return std::string(word_of(shape.param)); });

}  // namespace
}  // namespace palpate
