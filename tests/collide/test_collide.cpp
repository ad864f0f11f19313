// Stage collide on whole tools: contacts against brute force, skipping, overflow, bad poses.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>

#include "rt_core/contact/regions.h"
#include "rt_core/surface/closest_point.h"
#include "tests/collide/pieces.h"
#include "tests/support/roomy.h"

namespace palpate::test {
namespace {

// A cloud of `count` points of one spherical piece, spread over a disc of the given radius in the tool's xy plane.
void give_tool(Body& body, int count, double radius, double margin) {
  body.piece = {piece_of(PieceShape::kHull, radius, radius, 0, margin)};
  body.piece[0].point_count = count;
  body.tool_point.clear();
  for (int i = 0; i < count; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / count), a = 2.399963229728653 * i;  // sunflower
    body.tool_point.push_back({{r * std::cos(a), r * std::sin(a), 0}, margin, 1e-5, 0.5 + i, 0, 0});
  }
  body.bind();
}

struct Rig {
  Body body;
  StatePtr state = test::roomy_state();
  ScratchPtr scratch = test::roomy_scratch();
  void step(const Pose& tool) {
    state->tool_previous_w = state->tick == 0 ? tool : state->tool_w;
    state->tool_w = tool;
    scratch->status = 0;
    collide(body.model, *state, *scratch);
    state->tick += 1;
  }
  double exact_gap(int i) const {
    const ToolPoint& p = body.tool_point[static_cast<std::size_t>(i)];
    const Vec3 w = transform(state->tool_w, p.position_tool_m);
    return closest_surface_point(body.model, w, kHuge, -1).signed_distance_m - p.margin_m;
  }
};

TEST(Collide, SkippingNeverChangesAnAnswer) {
  // A wandering tool, from far off into contact and back: every tick's contacts equal those of fresh queries, and a
  // skipped point's bound never exceeds its true gap.
  Rig rig{make_body(ellipsoid({0.05, 0.035, 0.03}, 14))};
  give_tool(rig.body, 24, 0.012, 4e-3);
  std::mt19937_64 rng(12);
  int contacts = 0, skipped = 0;
  for (int t = 0; t < 3000; ++t) {
    const double s = 6.28 * t / 1000;
    const Pose tool{{0.02 * std::sin(s), 0.01 * std::cos(1.7 * s), 0.055 - 0.03 * std::sin(0.5 * s)},
                    small_rotation({0.3 * std::sin(s), 0.2 * std::sin(2 * s), 0.1})};
    rig.step(tool);
    int expected = 0;
    for (int i = 0; i < 24; ++i) {
      const double gap = rig.exact_gap(i);
      const PointState& point = rig.state->point[i];
      expected += gap < 0 ? 1 : 0;
      ASSERT_LE(point.gap_bound_m, gap + 1e-12);
      skipped += point.gap_m > 1e-3 && gap - point.gap_m > 1e-12 ? 1 : 0;
      if (gap < 0.5e-3) {
        ASSERT_NEAR(point.gap_m, gap, 1e-15);  // the stage rotates by matrix, the oracle by quaternion
      }
    }
    ASSERT_EQ(rig.scratch->contact_count, expected);
    ASSERT_EQ(rig.scratch->status, 0u);
    contacts += expected;
  }
  EXPECT_GT(contacts, 3000);
  EXPECT_GT(skipped, 20000);
}

TEST(Collide, ContactHoldsDepthPlaceAndNormal) {
  Rig rig{make_body(box({0.03, 0.02, 0.01}))};
  give_tool(rig.body, 1, 0, 5e-3);
  rig.step({{0.002, 0.001, 0.0135}, {}});
  ASSERT_EQ(rig.scratch->contact_count, 1);
  const Contact& c = rig.scratch->contact[0];
  EXPECT_NEAR(c.depth_m, 1.5e-3, 1e-15);
  EXPECT_NEAR(norm(c.position_w - Vec3{0.002, 0.001, 0.01}), 0, 1e-15);
  EXPECT_NEAR(norm(c.normal_w - Vec3{0, 0, 1}), 0, 1e-12);
  EXPECT_EQ(c.weight, 0.5);
  // Core point inside: the depth keeps growing and the normal still points out.
  rig.step({{0.002, 0.001, 0.008}, {}});
  EXPECT_NEAR(rig.scratch->contact[0].depth_m, 7e-3, 1e-15);
  EXPECT_NEAR(norm(rig.scratch->contact[0].normal_w - Vec3{0, 0, 1}), 0, 1e-12);
  // Exactly touching is not in contact.
  rig.step({{0.002, 0.001, 0.5}, {}});
  EXPECT_EQ(rig.scratch->contact_count, 0);
}

TEST(Collide, OverflowKeepsTheDeepestInOrder) {
  Rig rig{make_body(box({0.03, 0.02, 0.01}))};
  give_tool(rig.body, 100, 0.01, 5e-3);
  const Pose tilted{{0, 0, 0.0135}, small_rotation({0.05, 0.03, 0})};
  rig.step(tilted);
  ASSERT_EQ(rig.scratch->contact_count, kMaxContacts);
  EXPECT_TRUE(rig.scratch->status & Status::kContactsDropped);
  EXPECT_EQ(rig.state->high_water.contacts, kMaxContacts);
  double shallowest = 1;
  std::vector<bool> kept(100);
  for (int i = 0; i < kMaxContacts; ++i) {
    const Contact& c = rig.scratch->contact[i];
    if (i > 0) {
      EXPECT_GT(c.point, rig.scratch->contact[i - 1].point);
    }
    shallowest = std::min(shallowest, c.depth_m);
    kept[static_cast<std::size_t>(c.point)] = true;
  }
  for (int i = 0; i < 100; ++i) {
    if (!kept[static_cast<std::size_t>(i)]) {
      EXPECT_LE(-rig.exact_gap(i), shallowest);
    }
  }
}

TEST(Collide, OverflowTiesKeepTheLowestIndices) {
  Rig rig{make_body(box({0.03, 0.02, 0.01}))};
  give_tool(rig.body, 100, 0.0, 5e-3);  // all points in one place: equal depths
  rig.step({{0, 0, 0.0135}, {}});
  ASSERT_EQ(rig.scratch->contact_count, kMaxContacts);
  for (int i = 0; i < kMaxContacts; ++i) EXPECT_EQ(rig.scratch->contact[i].point, i);
}

TEST(Collide, BadPosesGiveNoContactAndRecover) {
  Rig rig{make_body(box({0.03, 0.02, 0.01}))};
  give_tool(rig.body, 16, 0.005, 5e-3);
  const Pose good{{0, 0, 0.0135}, {}};
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Pose bad[] = {{{nan, 0, 0}, {}}, {{0, 0, inf}, {}}, {{0, 0, 0}, {nan, 0, 0, 0}}, {{1e300, 0, 0}, {}}};
  for (const Pose& pose : bad) {
    rig.step(good);
    ASSERT_EQ(rig.scratch->contact_count, 16);
    rig.step(pose);
    EXPECT_EQ(rig.scratch->contact_count, 0);
    rig.step(good);
    EXPECT_EQ(rig.scratch->contact_count, 16);
  }
}

TEST(Collide, TruncatedSearchKeepsTheSideAndSaysSo) {
  Rig rig{make_body(ellipsoid({0.03, 0.03, 0.03}, 60))};
  give_tool(rig.body, 1, 0, 1e-3);
  rig.step({{0, 0, 1e-3}, {}});
  rig.step({{0, 0, 0}, {}});  // the centre: all 28,800 triangles equally far
  EXPECT_TRUE(rig.scratch->status & Status::kTraversalTruncated);
  ASSERT_EQ(rig.scratch->contact_count, 1);
  EXPECT_NEAR(rig.scratch->contact[0].depth_m, 0.031, 1e-4);
}

TEST(Collide, SameInputsSameBitsWhateverTheScratchHeld) {
  const auto run = [](int poison) {
    Rig rig{make_body(torus(0.04, 0.012, 48, 24))};
    give_tool(rig.body, 24, 0.012, 4e-3);
    test::poison(*rig.scratch, test::roomiest_model(), poison);
    for (int t = 0; t < 200; ++t) rig.step({{0.04, 0, 0.02 - 5e-5 * t}, {}});
    std::vector<double> out;
    for (int i = 0; i < rig.scratch->contact_count; ++i) {
      const Contact& c = rig.scratch->contact[i];
      out.insert(out.end(), {double(c.point), c.depth_m, c.position_w.x, c.position_w.y, c.position_w.z});
    }
    return out;
  };
  const std::vector<double> a = run(0), b = run(0xA5);
  EXPECT_GT(a.size(), 0u);
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace palpate::test
