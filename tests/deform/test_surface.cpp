#include <gtest/gtest.h>

#include <limits>

#include "sim_host/view/anchors.h"
#include "sim_host/view/surface_shape.h"
#include "tests/deform/deform_scene.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

using deform_test::ellipsoid_point;
using deform_test::make_region;
using deform_test::Scene;

constexpr NeighbourhoodLaw kLaws[] = {NeighbourhoodLaw::kNone, NeighbourhoodLaw::kLogPaper, NeighbourhoodLaw::kLogC1,
                                      NeighbourhoodLaw::kPunch};

// Vertices on a latitude-longitude grid, each in a patch spanned by the three anchors of its octant.
void add_vertices(Scene& scene) {
  for (int i = 1; i < 12; ++i) {
    for (int j = 0; j < 24; ++j) {
      const Vec3 p = ellipsoid_point(palpate::kPi * i / 12, 2 * palpate::kPi * (j + 0.5) / 24);
      PatchWeight patch{};
      const double q[3] = {p.x * p.x / 1.6e-3, p.y * p.y / 0.9e-3, p.z * p.z / 0.625e-3};  // sums to 1
      for (int k = 0; k < 3; ++k) {
        patch.anchor[k] = 2 * k + (deform_test::component(p, k) < 0 ? 1 : 0);
        patch.weight[k] = q[k];
      }
      scene.vertices.push_back(p);
      scene.normals.push_back(unit_or({p.x / 1.6e-3, p.y / 0.9e-3, p.z / 0.625e-3}, {0, 0, 1}));
      scene.patches.push_back(patch);
    }
  }
  scene.bind();
}

class Surface : public ::testing::Test {
 protected:
  void SetUp() override {
    deform_test::make_ellipsoid(scene_);
    add_vertices(scene_);
  }
  Model& model() { return scene_.model; }
  void set(NeighbourhoodLaw law, ShapeLaw shape = ShapeLaw::kRbf) {
    model().params.neighbourhood_law = law;
    model().params.shape_law = shape;
  }
  // Puts a region in contact.
  Region& press(std::int32_t slot, Vec3 point, double force_N = 5) {
    const Vec3 normal = unit_or({point.x / 1.6e-3, point.y / 0.9e-3, point.z / 0.625e-3}, {0, 0, 1});
    const auto id = static_cast<std::uint32_t>(slot) + 1;
    state_.region[slot] = make_region(id, id, point, normal, force_N);
    return state_.region[slot];
  }
  Vec3 at(Vec3 x, std::int32_t vertex = -1) {
    prepare_shape(model(), state_, field_);
    return displacement_at(model(), field_, x, vertex);
  }
  Scene scene_;
  const StatePtr memory_ = test::roomy_state();
  State& state_ = *memory_;
  ShapeField field_;
};

TEST_F(Surface, StandsStillWithoutContact) {
  EXPECT_EQ(at({0.01, 0.02, 0.01}), Vec3{});
  press(0, ellipsoid_point(0.5, 0.3));
  state_.region[0].lost_ticks = 1;  // remembered, but not in contact
  EXPECT_EQ(at({0.01, 0.02, 0.01}), Vec3{});
}

TEST_F(Surface, ContactPointMovesByTheDent) {
  for (const ShapeLaw shape : {ShapeLaw::kRbf, ShapeLaw::kDisplacementAnglePaper}) {
    for (const NeighbourhoodLaw law : kLaws) {
      for (const int tail : {0, 1}) {
        set(law, shape);
        model().params.rbf_tail = static_cast<RbfTail>(tail);
        ASSERT_TRUE(scene_.bind());
        const std::int32_t vertex = 24 * 3 + 2;
        const Vec3 point = scene_.vertices[static_cast<std::size_t>(vertex)];
        Region& region = press(0, point);
        region.friction_force_w = tangential_part({1, 2, 0}, region.normal_w);
        const Vec3 force = 5.0 * region.normal_w + region.friction_force_w;
        const Vec3 dent = (-2e-3 / norm(force)) * force;
        EXPECT_LT(norm(at(point, vertex) - dent), 1e-14);
        EXPECT_LT(norm(at(point) - dent), 1e-14);
        EXPECT_LT(dot(dent, region.normal_w), 0);  // into the body
      }
    }
  }
}

TEST_F(Surface, FixedAnchorsKeepStillAndOthersMoveAsTheSkeletonSays) {
  const Vec3 point = ellipsoid_point(0.6, 0.7);  // more than 10 mm from every anchor
  for (const NeighbourhoodLaw law : kLaws) {
    set(law);
    press(0, point);
    EXPECT_LT(norm(at({0, 0, -25e-3})), 1e-15);
    for (std::size_t a = 0; a < 6; ++a) {
      const Vec3 expected = anchors_of(model(), state_).anchor[a].displacement_w;
      EXPECT_LT(norm(at(scene_.anchors[a].position_m) - expected), 1e-14);
      EXPECT_EQ(norm(expected) > 0, a != 5);
    }
  }
}

TEST_F(Surface, DentFadesWithDistance) {
  const Vec3 point = ellipsoid_point(0.6, 0.7);
  for (const NeighbourhoodLaw law : kLaws) {
    set(law);
    press(0, point);
    const double near = norm(at(point)), middle = norm(at(ellipsoid_point(0.75, 0.9))),
                 away = norm(at(ellipsoid_point(2.4, 3.9)));
    EXPECT_GT(near, middle);
    EXPECT_GT(middle, away);
    EXPECT_LT(away, 0.3 * near);
  }
}

// A sixteenth of the step, a sixteenth of the largest change: no jumps anywhere on a path through the contact.
TEST_F(Surface, ContinuousAlongAPathThroughTheContact) {
  for (const NeighbourhoodLaw law : kLaws) {
    set(law);
    press(0, ellipsoid_point(0.6, 0.7));
    prepare_shape(model(), state_, field_);
    double largest[2] = {0, 0};
    for (int level = 0; level < 2; ++level) {
      const int steps = 5000 << (4 * level);
      Vec3 last = displacement_at(model(), field_, ellipsoid_point(0.1, 0.7), -1);
      for (int i = 1; i <= steps; ++i) {
        const Vec3 u = displacement_at(model(), field_, ellipsoid_point(0.1 + 2.5 * i / steps, 0.7), -1);
        largest[level] = std::max(largest[level], norm(u - last));
        last = u;
      }
    }
    // The punch's profile falls like a square root at its edge: a factor 1/4 there, give or take where the steps lie.
    EXPECT_LT(largest[1], (law == NeighbourhoodLaw::kPunch ? 0.4 : 0.1) * largest[0]);
  }
}

// Regions superpose: each one's field alone, added. The displacement-angle law is applied per region, so it adds too.
TEST_F(Surface, RegionsSuperpose) {
  const Vec3 points[2] = {ellipsoid_point(0.6, 0.7), ellipsoid_point(0.8, 3.5)};
  for (const ShapeLaw shape : {ShapeLaw::kRbf, ShapeLaw::kDisplacementAnglePaper}) {
    for (const NeighbourhoodLaw law : kLaws) {
      set(law, shape);
      for (const std::int32_t vertex : {-1, 40, 100}) {
        const Vec3 x = scene_.vertices[static_cast<std::size_t>(vertex < 0 ? 77 : vertex)];
        reset(state_);
        press(0, points[0]);
        const Vec3 first = at(x, vertex);
        reset(state_);
        press(1, points[1]);
        const Vec3 second = at(x, vertex);
        press(0, points[0]);
        EXPECT_LT(norm(at(x, vertex) - (first + second)), 1e-16);
      }
    }
  }
}

TEST_F(Surface, DisplacementAngleLawNeedsAPatchAndElseInterpolates) {
  set(NeighbourhoodLaw::kLogC1, ShapeLaw::kDisplacementAnglePaper);
  press(0, ellipsoid_point(0.6, 0.7));
  const Vec3 x = scene_.vertices[200];
  const Vec3 by_angle = at(x, 200), without = at(x, -1);
  EXPECT_GT(norm(by_angle - without), 1e-8);
  EXPECT_EQ(at(x, 1 << 20), without);
  set(NeighbourhoodLaw::kLogC1, ShapeLaw::kRbf);
  EXPECT_EQ(at(x, 200), without);
}

TEST_F(Surface, ContactOnAnAnchor) {
  const Vec3 top{0, 0, 25e-3};
  for (const ShapeLaw shape : {ShapeLaw::kRbf, ShapeLaw::kDisplacementAnglePaper}) {
    for (const NeighbourhoodLaw law : kLaws) {
      set(law, shape);
      press(0, top);
      EXPECT_LT(norm(at(top) - Vec3{0, 0, -2e-3}), 1e-14);
      EXPECT_TRUE(is_finite(at(ellipsoid_point(1.0, 1.0))));
      EXPECT_TRUE(is_finite(at(scene_.vertices[50], 50)));
    }
  }
}

TEST_F(Surface, WithoutAnchorsOnlyTheLocalDentIsLeft) {
  Scene bare;
  bare.model.params = model().params;
  bare.bind();
  state_.region[0] = make_region(1, 1, {0, 0, 25e-3}, {0, 0, 1}, 5);
  prepare_shape(bare.model, state_, field_);
  EXPECT_LT(norm(displacement_at(bare.model, field_, {0, 0, 25e-3}, -1) - Vec3{0, 0, -2e-3}), 1e-17);
  EXPECT_EQ(displacement_at(bare.model, field_, {0, 0, 0}, 3), Vec3{});
}

TEST_F(Surface, LargeRegionsAreDrawnShallower) {
  ToolPoint point{};
  point.area_m2 = 2e-6;
  point.weight = 0.5;  // reference area 4 mm^2
  scene_.tool_points.push_back(point);
  scene_.bind();
  Region& region = press(0, ellipsoid_point(0.6, 0.7));
  region.area_m2 = 64e-6;
  EXPECT_NEAR(norm(at(region.centre_w)), 2e-3 / 4, 1e-15);
  region.area_m2 = 1e-6;
  EXPECT_NEAR(norm(at(region.centre_w)), 2e-3, 1e-15);
}

TEST_F(Surface, GarbageForcesGiveNoDent) {
  Region& region = press(0, ellipsoid_point(0.6, 0.7));
  region.depth_equivalent_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_finite(at(region.centre_w)));
  const Vec3 centre = region.centre_w;
  region.centre_w.x = region.depth_equivalent_m;
  EXPECT_EQ(at(centre), Vec3{});
  region.centre_w = centre;
  region.depth_equivalent_m = 2e-3;
  region.normal_force_N = 0;  // no force to give a direction: along the normal
  EXPECT_LT(norm(at(region.centre_w) + 2e-3 * region.normal_w), 1e-14);
}

}  // namespace
}  // namespace palpate
