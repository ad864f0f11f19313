// What a tick looks at is bounded on any mesh and for any number of tool points: fans of slivers, flat tops, points
// that are all cold at once. What is left over waits for its turn and is measured then.
#include <gtest/gtest.h>

#include "rt_core/contact/regions.h"
#include "rt_core/image_check.h"
#include "rt_core/surface/closest_point.h"
#include "tests/collide/pieces.h"
#include "tests/support/roomy.h"

namespace palpate::test {
namespace {

// A standing cylinder whose ends are fans about the axis: the mesh that cost 240,128 instructions a query at 600
// thousand triangles, four a step around.
Mesh fan_cylinder(double radius, double half_height, int around) {
  Mesh mesh;
  mesh.vertex = {{0, 0, -half_height}, {0, 0, half_height}};
  for (int i = 0; i < around; ++i) {
    const double a = 6.283185307179586 * i / around;
    for (const double z : {-half_height, half_height})
      mesh.vertex.push_back({radius * std::cos(a), radius * std::sin(a), z});
  }
  for (int i = 0; i < around; ++i) {
    const int low = 2 + 2 * i, next = 2 + 2 * ((i + 1) % around);
    for (const Triangle& t : {Triangle{{0, next, low}, {}}, Triangle{{1, low + 1, next + 1}, {}},
                              Triangle{{low, next, next + 1}, {}}, Triangle{{low, next + 1, low + 1}, {}}})
      mesh.triangle.push_back(t);
  }
  return mesh;
}

TEST(SurfaceWork, AQueryOverAFanIsBoundedAndNearlyRight) {
  for (const int around : {100, 1000, 10000}) {
    const Body body = make_body(fan_cylinder(0.02, 0.03, around));
    std::mt19937_64 rng(41);
    int truncated = 0;
    double worst_m = 0;
    for (int i = 0; i < 2000; ++i) {
      // About the axis, above and below the top, cold.
      const double off = i % 2 == 0 ? 1e-3 : 1e-4;
      const Vec3 p = Vec3{0, 0, 0.03} + random_vec(rng, off) + Vec3{0, 0, random_vec(rng, 2e-3).x};

      const SurfacePoint s = closest_surface_point(body.model, p, 1e12, -1);
      ASSERT_TRUE(s.found);
      ASSERT_LE(s.looked, kMaxQueryWork);
      truncated += s.truncated ? 1 : 0;
      const double exact = std::abs(p.z - 0.03);  // nothing else is so near
      ASSERT_LE(s.lower_bound_m, exact + 1e-12);
      worst_m = std::max(worst_m, std::abs(s.signed_distance_m) - exact);
      if (!s.truncated) {
        ASSERT_NEAR(std::abs(s.signed_distance_m), exact, 1e-12);
      }
    }
    RecordProperty("truncated_" + std::to_string(around), truncated);
    RecordProperty("worst_um_" + std::to_string(around), std::to_string(1e6 * worst_m));
    // Even a search that was cut short ends within the fan: not farther off than the place is from the axis.
    EXPECT_LT(worst_m, 1e-3) << around;
  }
}

// Beyond what a query may look at, the image is refused; see also CheckMesh.AFanLargerThanAQueryIsRefused.
TEST(SurfaceWork, AnImageWithAFanLargerThanAQueryIsRefused) {
  for (const int around : {kMaxVertexTriangles - 1, kMaxVertexTriangles, kMaxVertexTriangles + 1}) {
    const ImageResult result = check_arrays(make_body(fan_cylinder(0.02, 0.03, around)).model);
    EXPECT_EQ(std::string(result.field) == "triangle.fan", around > kMaxVertexTriangles) << around << result.field;
  }
}

// 400 points over the fan, all cold at once.
struct Crowd {
  Crowd(int points, std::int32_t share) : body(make_body(fan_cylinder(0.02, 0.03, 1000))) {
    body.piece = {piece_of(PieceShape::kHull, 0.01, 0.01, 0, 4e-3)};
    body.piece[0].bounding_radius_m = 1;
    body.piece[0].point_count = points;
    for (int i = 0; i < points; ++i) {
      const double r = 0.012 * std::sqrt((i + 0.5) / points), a = 2.399963229728653 * i;
      body.tool_point.push_back({{r * std::cos(a), r * std::sin(a), 0}, 4e-3, 1e-6, 1, 0, 0});
    }
    body.bind();
    body.model.sizes.n_tool_point = points;
    body.model.params.surface_work_max = share;
  }
  void step(const Pose& tool) {
    state->tool_previous_w = state->tick == 0 ? tool : state->tool_w;
    state->tool_w = tool;
    scratch->status = 0;
    collide(body.model, *state, *scratch);
    state->tick += 1;
    for (int i = 1; i < scratch->contact_count; ++i)
      ASSERT_LT(scratch->contact[i - 1].point, scratch->contact[i].point);
  }
  Body body;
  StatePtr state = roomy_state();
  ScratchPtr scratch = roomy_scratch();
};

// Of one query, before its search and in the fan's turn: kMaxQueryWork has twice 512 for the search.
constexpr std::int32_t kWalks = kMaxQueryWork - 2 * kMaxSearched;

TEST(SurfaceWork, ATickKeepsToItsShareAndNobodyWaitsForEver) {
  constexpr std::int32_t kShare = 128;
  Crowd crowd(50, kShare);
  const Pose pressed{{3e-3, 1e-3, 0.0325}, small_rotation({0.02, 0.01, 0})};
  int held_ticks = 0;
  for (int t = 0; t < 200; ++t) {
    crowd.step(pressed);
    ASSERT_LE(crowd.scratch->surface_work, kShare + kWalks);
    held_ticks += (crowd.scratch->status & Status::kPointsHeld) != 0 ? 1 : 0;
  }
  EXPECT_GT(held_ticks, 0) << "this share is meant to be too small for the first ticks";
  // At rest the last ticks hold what an unlimited tick finds: everyone has had a turn.
  Crowd free(50, 0);
  for (int t = 0; t < 3; ++t) free.step(pressed);
  ASSERT_EQ(crowd.scratch->contact_count, free.scratch->contact_count);
  for (int i = 0; i < free.scratch->contact_count; ++i) {
    EXPECT_EQ(crowd.scratch->contact[i].point, free.scratch->contact[i].point);
    EXPECT_NEAR(crowd.scratch->contact[i].depth_m, free.scratch->contact[i].depth_m, 1e-12);
  }
}

// Teleports and turns of any size: the bound holds, whatever the crowd meets.
TEST(SurfaceWork, AdversarialPosesOfManyPointsStayWithinTheBound) {
  Crowd crowd(400, 4096);
  std::mt19937_64 rng(42);
  std::int32_t most = 0;
  for (int t = 0; t < 2000; ++t) {
    crowd.step({random_vec(rng, 0.04), random_rotation(rng)});
    most = std::max(most, crowd.scratch->surface_work);
    ASSERT_LE(crowd.scratch->surface_work, 4096 + kWalks);
  }
  EXPECT_GT(most, 4096) << "never spent its share: this proves nothing";
}

// On the axis of a cylinder everything is as near. A search for which the rest of the share does not suffice waits, and
// the next tick begins there with all of it.
TEST(SurfaceWork, ASearchThatTheRestDoesNotSufficeForIsTheNextTicksFirst) {
  constexpr std::int32_t kShare = 64;
  Crowd crowd(2, kShare);
  crowd.body.tool_point[0].position_tool_m = {0.012, 0, 0};  // near the side
  crowd.body.tool_point[1].position_tool_m = {0, 0, -0.015};
  std::int32_t second_first = 0;
  for (int t = 0; t < 40; ++t) {
    crowd.step({{1e-4 * t, 2e-5 * t, 0.031}, small_rotation({0.01 * t, 0, 0})});
    ASSERT_LE(crowd.scratch->surface_work, kShare + kWalks);
    second_first += crowd.state->first_point == 1 ? 1 : 0;
  }
  EXPECT_GT(second_first, 0) << "this share is meant to be too small for both";
}

// A point that was in contact stays on its plane while it waits: its depth follows the tool.
TEST(SurfaceWork, AHeldContactFollowsItsPlane) {
  Crowd crowd(1, 0);
  crowd.step({{3e-3, 1e-3, 0.0335}, {}});
  ASSERT_EQ(crowd.scratch->contact_count, 1);
  crowd.step({{3e-3, 1e-3, 0.0332}, {}});
  const double depth_m = crowd.scratch->contact[0].depth_m;
  Crowd held(2, 1);  // the first query spends the share
  held.body.tool_point[0].position_tool_m = held.body.tool_point[1].position_tool_m =
      crowd.body.tool_point[0].position_tool_m;
  held.step({{3e-3, 1e-3, 0.0335}, {}});
  held.step({{3e-3, 1e-3, 0.0335}, {}});
  held.step({{3e-3, 1e-3, 0.0332}, {}});
  ASSERT_EQ(held.scratch->contact_count, 2);
  EXPECT_TRUE(held.scratch->status & Status::kPointsHeld);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(held.scratch->contact[i].depth_m, depth_m, 1e-12);
}

}  // namespace
}  // namespace palpate::test
