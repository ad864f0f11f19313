// Stage regions: clustering, identity and memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "rt_core/contact/regions.h"
#include "tests/collide/pieces.h"
#include "tests/support/roomy.h"

namespace palpate::test {
namespace {

struct Touch {
  int point;
  Vec3 at;
  double depth_m = 1e-3;
};

constexpr double kNear = 5e-3;     // cluster distance of every rig here
constexpr int kMemory_ticks = 50;  // what a lost region is kept for, at its period of 1 ms

// Feeds contacts straight into the stage and, as the force stage would, moves each region's centre to its contacts.
struct Rig {
  Rig() {
    body.piece = {all_pieces()[4]};
    body.piece[0].point_count = kMaxToolPoints;
    body.tool_point.assign(kMaxToolPoints, {{}, 1e-3, 2e-6, 1, 0, 0});
    body.bind();
    body.model.params.cluster_distance_m = kNear;
    body.model.params.period_s = 1e-3;
    state->tool_w.position_m = {1, 1, 1};  // far off: the overlap test says miss unless a test moves the tool
  }
  void step(const std::vector<Touch>& touches) {
    scratch->status = 0;
    scratch->contact_count = scratch->support_calls = 0;
    for (std::size_t i = 0; i < touches.size(); ++i) {
      Contact& c = place_in_order(*scratch, touches[i].point);
      c = Contact{};
      c.row = c.point = touches[i].point;
      c.previous = state->point[touches[i].point].region;
      c.position_w = touches[i].at;
      c.depth_m = touches[i].depth_m;
      c.area_m2 = body.model.tool_point[static_cast<std::size_t>(touches[i].point)].area_m2;
      PointState& p = state->point[touches[i].point];
      p.closest_w = touches[i].at;
      p.triangle = 0;
    }
    group_points(body.model, *state, *scratch, still_touching);
    for (int s = 0; s < kMaxRegions; ++s) {
      Vec3 sum{};
      int n = 0;
      for (int i = 0; i < scratch->contact_count; ++i) {
        if (scratch->contact[i].region != s) continue;
        sum += scratch->contact[i].position_w;
        ++n;
      }
      if (n > 0) state->region[s].centre_w = (1.0 / n) * sum;
    }
    state->tick += 1;
  }
  // Identity of the region a tool point is in, or 0.
  std::uint32_t id_at(int point) const {
    const int slot = state->point[point].region;
    return slot < 0 ? 0 : state->region[slot].id;
  }
  const Region& region_at(int point) const { return state->region[state->point[point].region]; }
  int live() const {
    return static_cast<int>(std::count_if(std::begin(state->region), std::end(state->region),
                                          [](const Region& r) { return r.id != 0 && r.lost_ticks == 0; }));
  }
  int used() const {
    return static_cast<int>(
        std::count_if(std::begin(state->region), std::end(state->region), [](const Region& r) { return r.id != 0; }));
  }
  Body body = make_body(box({0.03, 0.02, 0.01}));
  StatePtr state = test::roomy_state();
  ScratchPtr scratch = test::roomy_scratch();
};

// Connected components by repeated relabelling.
std::vector<int> naive_clusters(const std::vector<Touch>& touches) {
  std::vector<int> label(touches.size());
  for (std::size_t i = 0; i < label.size(); ++i) label[i] = static_cast<int>(i);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < label.size(); ++i)
      for (std::size_t j = 0; j < label.size(); ++j)
        if (norm(touches[i].at - touches[j].at) < kNear && label[j] < label[i]) label[i] = label[j], changed = true;
  }
  return label;
}

std::vector<Touch> random_touches(std::mt19937_64& rng, int count, double half) {
  std::vector<int> points(kMaxToolPoints);
  for (int i = 0; i < kMaxToolPoints; ++i) points[static_cast<std::size_t>(i)] = i;
  std::shuffle(points.begin(), points.end(), rng);
  std::uniform_real_distribution<double> depth(1e-4, 4e-3);
  std::vector<Touch> touches;
  for (int i = 0; i < count; ++i)
    touches.push_back({points[static_cast<std::size_t>(i)], random_vec(rng, half), depth(rng)});
  return touches;
}

TEST(Regions, ClusteringMatchesTheNaiveOracle) {
  std::mt19937_64 rng(20);
  for (int trial = 0; trial < 300; ++trial) {
    Rig rig;
    const std::vector<Touch> touches = random_touches(rng, 1 + trial % 24, 0.012);
    const std::vector<int> label = naive_clusters(touches);
    const std::size_t clusters = std::set<int>(label.begin(), label.end()).size();
    if (clusters > kMaxRegions) continue;
    rig.step(touches);
    ASSERT_EQ(rig.live(), static_cast<int>(clusters));
    double area = 0;
    for (std::size_t i = 0; i < touches.size(); ++i) {
      const Contact& contact = rig.scratch->contact.data()[i];
      ASSERT_EQ(contact.region, rig.state->point[contact.point].region);
      ASSERT_GE(rig.region_at(touches[i].point).depth_max_m, touches[i].depth_m);
      for (std::size_t j = 0; j < touches.size(); ++j)
        ASSERT_EQ(rig.id_at(touches[i].point) == rig.id_at(touches[j].point), label[i] == label[j]);
    }
    for (const Region& r : rig.state->region) area += r.area_m2;
    ASSERT_NEAR(area, 2e-6 * static_cast<double>(touches.size()), 1e-18);
  }
}

TEST(Regions, TheOrderContactsComeInDoesNotMatter) {
  std::mt19937_64 rng(21);
  Rig a, b;
  for (int tick = 0; tick < 400; ++tick) {
    std::vector<Touch> touches = random_touches(rng, 20 + tick % 45, 0.02);  // overflows some ticks
    a.step(touches);
    std::shuffle(touches.begin(), touches.end(), rng);
    b.step(touches);
    ASSERT_EQ(a.scratch->status, b.scratch->status);
    ASSERT_EQ(a.state->next_region_id, b.state->next_region_id);
    for (int p = 0; p < kMaxToolPoints; ++p) ASSERT_EQ(a.state->point[p].region, b.state->point[p].region);
    for (int s = 0; s < kMaxRegions; ++s) {
      Region& r = a.state->region[s];
      Region& q = b.state->region[s];
      ASSERT_EQ(r.id, q.id);
      ASSERT_EQ(r.born_tick, q.born_tick);
      ASSERT_EQ(r.lost_ticks, q.lost_ticks);
      ASSERT_EQ(r.area_m2, q.area_m2);
      ASSERT_EQ(r.depth_max_m, q.depth_max_m);
      q.centre_w = r.centre_w;  // the rig's own mean depends on order; the stage's results must not
    }
  }
}

TEST(Regions, SlidingKeepsTheIdentityWhileToolPointsRollOver) {
  Rig rig;
  rig.step({{0, {0, 0, 0}}, {1, {1e-3, 0, 0}}});
  const std::uint32_t id = rig.id_at(0);
  EXPECT_EQ(id, 1u);
  for (int t = 1; t < 60; ++t) {  // point t leaves as point t + 2 enters, 1 mm further on
    rig.step({{t, {1e-3 * t, 0, 0}}, {t + 1, {1e-3 * (t + 1), 0, 0}}});
    ASSERT_EQ(rig.id_at(t), id);
    ASSERT_EQ(rig.region_at(t).born_tick, 0u);
  }
  // All points exchanged at once, within the memory distance: still the same contact.
  rig.step({{100, {60e-3, 0, 0}}});
  EXPECT_EQ(rig.id_at(100), id);
  EXPECT_EQ(rig.used(), 1);
}

TEST(Regions, MergeKeepsTheOlderIdentity) {
  Rig rig;
  rig.step({{5, {0.02, 0, 0}}});
  const std::uint32_t older = rig.id_at(5);
  rig.step({{5, {0.02, 0, 0}}, {1, {0, 0, 0}}, {2, {1e-3, 0, 0}}, {3, {2e-3, 0, 0}}});
  ASSERT_EQ(rig.live(), 2);
  const int slot = rig.state->point[5].region;
  rig.step({{5, {5e-3, 0, 0}}, {1, {0, 0, 0}}, {2, {1e-3, 0, 0}}, {3, {2e-3, 0, 0}}});  // the older one is smaller
  EXPECT_EQ(rig.live(), 1);
  EXPECT_EQ(rig.used(), 1);  // the other identity ended, it is not remembered
  EXPECT_EQ(rig.id_at(1), older);
  EXPECT_EQ(rig.state->point[1].region, slot);
  EXPECT_EQ(rig.region_at(1).point_count, 4);
}

TEST(Regions, SplitLeavesTheIdentityToTheLargerPart) {
  Rig rig;
  rig.step({{0, {0, 0, 0}}, {1, {4e-3, 0, 0}}, {2, {5e-3, 0, 0}}});
  const std::uint32_t id = rig.id_at(0);
  rig.step({{0, {0, 0, 0}}, {1, {20e-3, 0, 0}}, {2, {21e-3, 0, 0}}});
  EXPECT_EQ(rig.live(), 2);
  EXPECT_EQ(rig.id_at(1), id);
  EXPECT_EQ(rig.id_at(0), id + 1);
  EXPECT_EQ(rig.region_at(0).born_tick, 1u);
}

TEST(Regions, NewSlotsStartFromZero) {
  Rig rig;
  rig.step({{0, {0, 0, 0}}});
  Region& region = rig.state->region[rig.state->point[0].region];
  region.stretch_w = {1, 2, 3};
  region.friction = FrictionMode::kSlip;
  for (int t = 0; t < kMemory_ticks + 2; ++t) rig.step({});
  EXPECT_EQ(rig.used(), 0);
  rig.step({{0, {0, 0, 0}}});
  EXPECT_EQ(rig.id_at(0), 2u);
  EXPECT_EQ(rig.region_at(0).stretch_w, Vec3{});
  EXPECT_EQ(rig.region_at(0).friction, FrictionMode::kFree);
}

TEST(Regions, AreKeptForATimeNotForTicks) {
  for (const double period_s : {1e-4, 2e-3, 0.1}) {
    Rig rig;
    rig.body.model.params.period_s = period_s;
    const int kept = std::max(1, static_cast<int>(std::lround(kRegionMemory_s / period_s)));
    rig.step({{0, {0, 0, 0}}});
    for (int t = 0; t < kept; ++t) rig.step({});
    EXPECT_EQ(rig.used(), 1) << period_s;
    rig.step({});
    EXPECT_EQ(rig.used(), 0) << period_s;
  }
}

TEST(Regions, MergeAndSplitHaveHysteresis) {
  Rig rig;
  const auto at_gap = [&](double factor) {
    rig.step({{0, {0, 0, 0}}, {1, {factor * kNear, 0, 0}}});
    return rig.live();
  };
  EXPECT_EQ(at_gap(2.0), 2);
  EXPECT_EQ(at_gap(1.01), 2);  // not yet near enough to merge
  EXPECT_EQ(at_gap(0.99), 1);
  EXPECT_EQ(at_gap(1.01), 1);  // merged: stays so
  EXPECT_EQ(at_gap(1.49), 1);
  EXPECT_EQ(at_gap(1.51), 2);
  EXPECT_EQ(at_gap(1.49), 2);
  int changes = 0;
  for (int t = 0, last = 2; t < 100; ++t) {  // chatter around the threshold changes nothing
    const int now = at_gap(1.0 + (t % 2 == 0 ? 0.2 : 0.001));
    changes += now != last ? 1 : 0;
    last = now;
  }
  EXPECT_EQ(changes, 0);
}

TEST(Regions, ABounceKeepsItsHistoryForAWhile) {
  for (const int gap_ticks : {1, 10, kMemory_ticks, kMemory_ticks + 1}) {
    Rig rig;
    rig.step({{0, {0, 0, 0}}});
    rig.state->region[rig.state->point[0].region].stretch_w = {1e-4, 0, 0};
    for (int t = 0; t < gap_ticks; ++t) {
      rig.step({});
      EXPECT_EQ(rig.live(), 0);
      EXPECT_EQ(rig.state->point[0].region, -1);
    }
    rig.step({{7, {1.9e-3, 0, 0}}});
    const bool remembered = gap_ticks <= kMemory_ticks;
    EXPECT_EQ(rig.id_at(7), remembered ? 1u : 2u) << gap_ticks;
    EXPECT_EQ(rig.region_at(7).stretch_w, (remembered ? Vec3{1e-4, 0, 0} : Vec3{}));
    EXPECT_EQ(rig.region_at(7).lost_ticks, 0);
  }
}

TEST(Regions, AContactElsewhereIsANewOne) {
  Rig rig;
  rig.step({{0, {0, 0, 0}}});
  rig.step({});
  rig.step({{0, {2.1e-3, 0, 0}}});
  EXPECT_EQ(rig.id_at(0), 2u);
  EXPECT_EQ(rig.used(), 2);  // the lost one is still remembered
}

TEST(Regions, TheNearestLostRegionReturns) {
  Rig rig;
  rig.step({{0, {0, 0, 0}}, {1, {8e-3, 0, 0}}});
  rig.step({});
  rig.step({{9, {7e-3, 0, 0}}});
  EXPECT_EQ(rig.id_at(9), 2u);
}

TEST(Regions, APieceThatStillOverlapsHoldsTheMemoryAndSaysSo) {
  // The box piece (half height 3 mm, margin 1 mm) still dips into the surface between its tool points.
  Rig rig;
  const Vec3 on_top = rig.body.model.vertex_m[static_cast<std::size_t>(rig.body.model.triangle[0].vertex[0])];
  rig.step({{0, on_top}});
  rig.state->tool_w = {on_top, {}};
  for (int t = 0; t < 3 * kMemory_ticks; ++t) {
    rig.step({});
    ASSERT_EQ(rig.used(), 1);
    ASSERT_EQ(rig.state->region[0].lost_ticks, 1);
    ASSERT_EQ(rig.state->region[0].point_count, 0);
    ASSERT_EQ(rig.scratch->status, t == 0 ? 0u : Status::kTouchesBetween) << "asked from the second tick on";
  }
  EXPECT_GT(rig.state->high_water.gjk_support_calls, 0);
  EXPECT_LE(rig.state->high_water.gjk_support_calls, kGjkSupportBudget);
  rig.state->tool_w.position_m = {1, 1, 1};
  for (int t = 0; t < kMemory_ticks; ++t) {
    rig.step({});
    ASSERT_EQ(rig.scratch->status, 0u);
  }
  EXPECT_EQ(rig.used(), 0);
}

TEST(Regions, AnInconclusiveOverlapHoldsTheMemoryAndSaysSo) {
  Rig rig;
  rig.step({{0, {0, 0, 0}}});
  rig.step({});
  rig.state->tool_w.position_m = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  for (int t = 0; t < 2 * kMemory_ticks; ++t) {
    rig.step({});
    ASSERT_TRUE(rig.scratch->status & Status::kOverlapInconclusive);
    ASSERT_EQ(rig.used(), 1);
  }
}

TEST(Regions, OverlapTestsOfATickShareTheirBudget) {
  Rig rig;
  const Vec3 on_top = rig.body.model.vertex_m[static_cast<std::size_t>(rig.body.model.triangle[0].vertex[0])];
  std::vector<Touch> touches;
  for (int i = 0; i < kMaxRegions; ++i) touches.push_back({i, on_top + Vec3{0.02 * i, 0, 0}});
  rig.step(touches);
  rig.state->tool_w = {on_top, {}};  // dips into the triangle that all of them touched last
  rig.step({});
  rig.step({});
  EXPECT_GT(rig.scratch->support_calls, kGjkSupportBudget - 2 * kLeastSupports);
  EXPECT_LE(rig.scratch->support_calls, kGjkSupportBudget + kMostSupportsBeyond);
  EXPECT_TRUE(rig.scratch->status & Status::kOverlapInconclusive);
  EXPECT_EQ(rig.used(), kMaxRegions) << "what could not be decided is kept";
}

TEST(Regions, OverflowKeepsTheDeepest) {
  Rig rig;
  std::vector<Touch> touches;
  for (int i = 0; i < 24; ++i) touches.push_back({i, {0.02 * i, 0, 0}, 1e-3 + 1e-5 * ((i * 7) % 24)});
  rig.step(touches);
  EXPECT_TRUE(rig.scratch->status & Status::kRegionsDropped);
  EXPECT_EQ(rig.live(), kMaxRegions);
  EXPECT_EQ(rig.scratch->contact_count, kMaxRegions);
  EXPECT_EQ(rig.state->high_water.regions, kMaxRegions);
  for (int i = 0; i < rig.scratch->contact_count; ++i) {
    EXPECT_GE(rig.scratch->contact[i].region, 0);
    EXPECT_GE(rig.scratch->contact[i].depth_m, 1e-3 + 1e-5 * (24 - kMaxRegions) - 1e-12);
  }
  const std::uint32_t next = rig.state->next_region_id;
  rig.step(touches);  // the same sixteen: nothing is born or lost
  EXPECT_EQ(rig.state->next_region_id, next);
  EXPECT_EQ(rig.live(), kMaxRegions);
}

TEST(Regions, ANewContactTakesTheSlotLostLongest) {
  Rig rig;
  std::vector<Touch> touches;
  for (int i = 0; i < kMaxRegions; ++i) touches.push_back({i, {0.02 * i, 0, 0}});
  rig.step(touches);
  const std::uint32_t first_lost = rig.id_at(3);
  const int slot = rig.state->point[3].region;
  touches.erase(touches.begin() + 3);
  rig.step(touches);
  touches.pop_back();
  rig.step(touches);  // two lost now, point 3's longer
  touches.push_back({60, {1.0, 0, 0}});
  rig.step(touches);
  EXPECT_EQ(rig.state->point[60].region, slot);
  EXPECT_NE(rig.id_at(60), first_lost);
  EXPECT_EQ(rig.scratch->status, 0u);
}

TEST(Regions, IdsNeverBecomeZero) {
  Rig rig;
  rig.state->next_region_id = 0xFFFFFFFFu;
  rig.step({{0, {0, 0, 0}}, {1, {0.1, 0, 0}}, {2, {0.2, 0, 0}}});
  EXPECT_EQ(rig.id_at(0), 0xFFFFFFFFu);
  EXPECT_EQ(rig.id_at(1), 1u);
  EXPECT_EQ(rig.id_at(2), 2u);
}

TEST(Regions, InvariantsHoldOverALongRandomRun) {
  std::mt19937_64 rng(22);
  Rig rig;
  for (int tick = 0; tick < 2000; ++tick) {
    const std::vector<Touch> touches = random_touches(rng, tick % 7 == 0 ? 0 : tick % 65, 0.03);
    rig.step(touches);
    std::set<std::uint32_t> ids;
    int points = 0;
    for (const Region& r : rig.state->region) {
      if (r.id == 0) continue;
      ASSERT_TRUE(ids.insert(r.id).second);
      ASSERT_EQ(r.lost_ticks == 0, r.point_count > 0);
      ASSERT_LE(r.lost_ticks, kMemory_ticks);
      points += r.point_count;
    }
    ASSERT_EQ(points, rig.scratch->contact_count);
    for (int i = 0; i < rig.scratch->contact_count; ++i)
      ASSERT_EQ(rig.state->region[rig.scratch->contact[i].region].lost_ticks, 0);
  }
}

}  // namespace
}  // namespace palpate::test
