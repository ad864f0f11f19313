// The surface drawn under a hand: regions take the shape of what touches, joints included, and the palm flattens.
#include <gtest/gtest.h>

#include <cmath>

#include "config/hand/hand_model.h"
#include "sim_host/press/grasp_run.h"
#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/imprint.h"
#include "sim_host/view/surface_shape.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

SceneDesc scene_named(const std::string& name) {
  return load_scene(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml");
}

// A grasp held, and its surface on a fine mesh with and without what the hand presses into it.
struct Held {
  explicit Held(const SceneDesc& scene, Vec3 shift = {}) : baked(scene), bench(baked.model()) {
    Pose pose = baked.model().grasp_w[0];
    pose.position_m += shift;
    for (int i = 0; i < 1500; ++i) bench.tick_at(pose, closing_all(1));
    surface = refined_surface(baked.model(), *bench.state, 60'000);
    ShapeField field;
    prepare_shape(baked.model(), *bench.state, field);
    for (const Vec3 p : surface.rest_m) smooth_m.push_back(p + displacement_at(baked.model(), field, p, -1));
  }
  BakedScene baked;
  Bench bench;
  DeformedSurface surface;
  std::vector<Vec3> smooth_m;  // by the shape models alone
};

// Height of a point over the palm's face, out of the palm.
double over_palm_m(const Held& held, Vec3 point_w) {
  const ToolPiece& palm = held.baked.model().piece.back();
  const Vec3 local = inverse_transform(held.bench.state->tool_w * palm.pose_tool, point_w);
  return -local.z - (palm.half_extent_m[2] + palm.margin_m);
}

double deepest_inside_m(const std::vector<FingerShape>& shapes, const std::vector<Vec3>& points, bool joints) {
  double deepest = 0;
  for (const FingerShape& shape : shapes)
    for (const Vec3& p : points)
      if (shape.joint == joints) deepest = std::max(deepest, -distance_m(shape, p));
  return deepest;
}

TEST(Imprint, AContactRegionTakesTheShapeOfItsPart) {
  const Held held(scene_named("grasp_cylinder_5"));
  const std::vector<FingerShape> shapes = finger_shapes(held.baked.model(), *held.bench.state);
  ASSERT_EQ(shapes.size(), 15u);                                      // every part, no joint: all regions are their own
  EXPECT_GT(deepest_inside_m(shapes, held.smooth_m, false), 0.5e-3);  // the dents alone leave fingers in the body
  EXPECT_LE(deepest_inside_m(shapes, held.surface.position_m, false), 1e-9);
  // What moved lies on a finger now, or on the palm, which touches along a line; nothing else moved.
  std::size_t moved = 0;
  for (std::size_t i = 0; i < held.smooth_m.size(); ++i) {
    const Vec3 step = held.surface.position_m[i] - held.smooth_m[i];
    if (norm(step) < 1e-12) continue;
    ++moved;
    double nearest = std::abs(over_palm_m(held, held.surface.position_m[i]));
    for (const FingerShape& shape : shapes)
      nearest = std::min(nearest, std::abs(distance_m(shape, held.surface.position_m[i])));
    EXPECT_LE(nearest, 1e-9);
  }
  EXPECT_GT(moved, 100u);
}

TEST(Imprint, MergedPartsShareTheSurfaceOfTheirJoint) {
  SceneDesc merging = scene_named("grasp_cylinder_5");
  merging.contact.cluster_distance_m = 0.016;
  const Held held(merging);
  ASSERT_LT(held.bench.output.regions, 15);
  const std::vector<FingerShape> shapes = finger_shapes(held.baked.model(), *held.bench.state);
  const auto joints = std::count_if(shapes.begin(), shapes.end(), [](const FingerShape& s) { return s.joint; });
  EXPECT_EQ(joints, 15 - held.bench.output.regions);  // every merge has its joint
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!shapes[i].joint) continue;
    EXPECT_EQ(shapes[i].root_w, shapes[i - 1].tip_w);
    EXPECT_EQ(shapes[i].tip_w, shapes[i + 1].root_w);
    EXPECT_EQ(shapes[i].tip_radius_m, shapes[i + 1].root_radius_m);
  }
  EXPECT_GT(deepest_inside_m(shapes, held.smooth_m, true), 0.2e-3);
  EXPECT_LE(deepest_inside_m(shapes, held.surface.position_m, true), 1e-9);
}

// The palm 4 mm into the body: everything within its breadth ends at its face, and no force comes of it.
TEST(Imprint, ThePalmFlattensWhatLiesAgainstItAndPressesNothing) {
  SceneDesc scene = scene_named("grasp_cylinder_5");
  const Held before(scene), held(scene, {4e-3, 0, 0});
  const Model& model = held.baked.model();
  const ToolPiece& palm = model.piece.back();
  ASSERT_EQ(palm.part, kPalmPart);
  const Pose pose = held.bench.state->tool_w * palm.pose_tool;
  std::size_t flat = 0;
  for (std::size_t i = 0; i < held.smooth_m.size(); ++i) {
    const Vec3 at = inverse_transform(pose, held.surface.position_m[i]);
    const bool within = std::abs(at.x) < palm.half_extent_m[0] && std::abs(at.y) < palm.half_extent_m[1];
    if (!within) continue;
    EXPECT_GE(over_palm_m(held, held.surface.position_m[i]), -1e-12);
    flat += over_palm_m(held, held.surface.position_m[i]) < 1e-12 ? 1U : 0U;
  }
  EXPECT_GT(flat, 100u);
  EXPECT_EQ(norm(held.bench.state->articulation.piece_force_tool_N.data()[model.piece.size() - 1]), 0);
  for (std::int32_t i = 0; i < held.bench.scratch->contact_count; ++i)
    EXPECT_NE(held.bench.scratch->contact[i].piece, static_cast<std::int32_t>(model.piece.size()) - 1);
}

TEST(Imprint, DentsReachAsFarAsTheTableSaysForEachPart) {
  const Held held(scene_named("grasp_cylinder_5"));
  const Model& model = held.baked.model();
  ShapeField field;
  prepare_shape(model, *held.bench.state, field);
  ASSERT_EQ(field.count, 15);
  for (std::int32_t k = 0; k < field.count; ++k) {
    for (std::size_t p = 0; p < model.piece.size(); ++p) {
      const ToolPiece& piece = model.piece[p];
      if (piece.point_count == 0 || held.bench.state->point[piece.first_point].region != field.region[k].slot) continue;
      EXPECT_EQ(field.region[k].local.reach_m,
                hand_parts()[static_cast<std::size_t>(piece.part - 1)].neighbourhood_radius_m);
    }
  }
  // A scene that states a radius means it for all parts.
  SceneDesc stated = parse_scene(
      "name = \"h\"\n[body]\nshape = \"cylinder\"\nradius_mm = 22\nheight_mm = 120\ntriangles = "
      "800\n[body.material]\npoisson_ratio = 0.47\n[shape]\nradius_mm = 11\n[hand]\n"
      "grasp_mm = [-30, 68, -28]\ngrasp_deg = [0, -90, 0]\n",
      "test.toml");
  const BakedScene baked(stated);
  for (const ToolPiece& piece : baked.model().piece) EXPECT_EQ(piece.neighbourhood_m, 0);
  EXPECT_EQ(baked.model().params.neighbourhood_radius_m, 0.011);
}

}  // namespace
}  // namespace palpate::test
