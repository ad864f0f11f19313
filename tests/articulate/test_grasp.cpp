// Whole grasps, from approach to release: regions, stability, order of contact, palm, stresses and hostile commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "config/hand/hand_model.h"
#include "config/scene/config_error.h"
#include "rt_core/tool/articulate.h"
#include "tests/articulate/grasp_scenes.h"
#include "tests/support/baked_scene.h"
#include "tests/support/roomy.h"
#include "tests/support/state_difference.h"

namespace palpate::test {
namespace {

TEST(Grasp, FiveFingersHoldTheCylinderByFifteenRegions) {
  const GraspRun& run = played("grasp_cylinder_5");
  EXPECT_EQ(run.regions, kHandParts);
  for (std::size_t part = 1; part <= kHandParts; ++part) EXPECT_GT(run.part_force_N[part], 0) << part;
  EXPECT_EQ(played("grasp_cylinder_2").regions, 6);
  EXPECT_EQ(played("grasp_cylinder_3").regions, 9);
}

TEST(Grasp, OnlyTheFingersThatTakePartTouch) {
  const GraspRun& run = played("grasp_cylinder_2");
  for (std::size_t part = 1; part <= kHandParts; ++part) {
    const bool index_or_thumb = part <= 3 || part >= 13;
    EXPECT_EQ(run.part_force_N[part] > 0, index_or_thumb) << part;
  }
}

// The bound is the issue's: under 1 % of the force per tick. A held hand does not move at all, so the truth is
// rounding.
TEST(Grasp, AHandThatIsStillDoesNotChatter) {
  for (const char* name : kScenes) EXPECT_LT(played(name).chatter, 1e-9) << name;
}

// The same on an arm of 2 kN/m that is held still, as a device's is: the wrist finds its balance through the virtual
// coupling while the fingers close, and must stay in it. Rounding moves it by 1e-14 per tick (measured 2026-11-21).
TEST(Grasp, AHandOnACompliantWristDoesNotChatterAndLetsGoExactly) {
  GraspOptions options;
  options.hand_N_per_m = 2000;
  for (const char* name : kScenes) {
    const GraspRun run = run_grasp(scene_named(name).model(), *scene_named(name).scene(), options);
    ASSERT_GT(run.regions, 5) << name;
    EXPECT_LT(run.chatter, 1e-9) << name;
    EXPECT_TRUE(run.back_at_rest) << name;
  }
}

TEST(Grasp, OpeningTheHandReturnsTheBodyToRestExactly) {
  for (const char* name : kScenes) EXPECT_TRUE(played(name).back_at_rest) << name;
}

TEST(Grasp, ThePalmWouldPushAndBalancesFingersAndWeight) {
  for (const char* name : {"grasp_cylinder_2", "grasp_cylinder_3", "grasp_cylinder_5"}) {
    const SceneModel& scene = scene_named(name);
    const GraspRun& run = played(name);
    const Vec3 weight{0, -9.80665 * scene.model().params.body_mass_kg, 0};
    // On the body: palm, fingers (the opposite of what they feel) and weight.
    EXPECT_LE(norm(run.palm_w.force_N - run.contact_w.force_N + weight), 1e-12) << name;
    const Vec3 out_of_palm = rotate(run.held->tool_w.orientation, {0, 0, -1});
    EXPECT_GT(dot(run.palm_w.force_N, out_of_palm), 0) << name;
  }
}

TEST(Grasp, StressesGrowWithTheNumberOfFingers) {
  const auto total = [](const GraspRun& run) {
    double sum = 0;
    for (const double stress : run.held_stress_Pa) sum += stress;
    return sum;
  };
  const double two = total(played("grasp_cylinder_2")), three = total(played("grasp_cylinder_3")),
               five = total(played("grasp_cylinder_5"));
  EXPECT_GT(three, two);
  EXPECT_GT(five, three);
}

// From zero before the first touch up to the hold, at every anchor (Cui & Xiao 2008, Fig. 8).
TEST(Grasp, StressesStartAtZeroAndAreLargestWhileHeld) {
  const GraspRun& run = played("grasp_cylinder_5");
  for (std::size_t a = 0; a < run.stress_Pa.size(); ++a) {
    EXPECT_EQ(run.stress_Pa[a].front(), 0);
    EXPECT_EQ(run.stress_Pa[a].back(), 0);
    EXPECT_GT(run.held_stress_Pa[a], 0);
  }
}

// Friction remembers how contact came about, and the stop force where it was reached; without them the end of a grasp
// is a function of where the hand is, whatever came first. The far field is fixed to the body at each region's first
// touch, and first touches differ between orders: hence not to rounding. See docs/models_grasp.md for the figures.
GraspRun played_in_order(const std::string& name, CouplingLaw law, const std::vector<double>& delay_s) {
  const SceneModel& scene = scene_named(name);
  Model model = scene.model();
  model.params.coupling_law = law;
  model.params.friction_law = FrictionLaw::kNone;
  model.params.stop_force_N = 1e6;
  GraspOptions options;
  options.every = 1'000'000;  // no history
  for (std::size_t f = 0; f < delay_s.size(); ++f) options.delay_s[f] = delay_s[f];
  return run_grasp(model, *scene.scene(), options);
}

// Fingers in the order in which they first touched, as digits: 201 is the middle finger, the thumb, the index.
std::string touched(const Model& model, const State& state, std::int32_t fingers) {
  std::vector<std::pair<std::uint32_t, std::int32_t>> born;
  for (std::int32_t f = 0; f < fingers; ++f) {
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t i = 0; i < model.tool_point.size(); ++i) {
      const ToolPiece& piece = model.piece[static_cast<std::size_t>(model.tool_point[i].piece)];
      if (piece.group == f && state.point.data()[i].region >= 0)
        first = std::min(first, state.region[state.point.data()[i].region].born_tick);
    }
    born.emplace_back(first, f);
  }
  std::sort(born.begin(), born.end());
  std::string order;
  for (const auto& [tick, finger] : born) order += static_cast<char>('0' + finger);
  return order;
}

struct OrderDependence {
  std::set<std::string> orders;
  double coupled = 0, temporal = 0;  // largest difference of a part's force from the first order's, of the largest
};

// Every finger starts to close `step_s` after the one before it in the order.
OrderDependence played_in_orders(const std::string& name, const std::vector<std::vector<std::size_t>>& orders,
                                 double step_s) {
  OrderDependence all;
  std::vector<GraspRun> coupled, temporal;
  for (const std::vector<std::size_t>& order : orders) {
    std::vector<double> delay_s(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) delay_s[order[k]] = step_s * static_cast<double>(k);
    coupled.push_back(played_in_order(name, CouplingLaw::kCoupled, delay_s));
    temporal.push_back(played_in_order(name, CouplingLaw::kTemporalPaper, delay_s));
    all.orders.insert(
        touched(scene_named(name).model(), *coupled.back().held, static_cast<std::int32_t>(order.size())));
    all.coupled = std::max(all.coupled, force_difference(coupled[0], coupled.back()));
    all.temporal = std::max(all.temporal, force_difference(temporal[0], temporal.back()));
  }
  return all;
}

void expect_order_matters_to_the_paper_only(const OrderDependence& all, std::size_t orders) {
  EXPECT_EQ(all.orders.size(), orders);  // they did touch in that many different orders
  EXPECT_LT(all.coupled, 1e-4);          // measured 2026-11-21: 1.7e-6 of three fingers, 5.0e-6 of five
  EXPECT_GT(all.temporal, 0.1);          // 0.74 and 0.69
}

TEST(Grasp, AllOrdersOfThreeFingersEndInTheSameForces) {
  std::vector<std::vector<std::size_t>> orders;
  std::vector<std::size_t> order{0, 1, 2};
  do orders.push_back(order);
  while (std::next_permutation(order.begin(), order.end()));
  expect_order_matters_to_the_paper_only(played_in_orders("grasp_cylinder_3", orders, 0.3), orders.size());
}

TEST(Grasp, SeveralOrdersOfFiveFingersEndInTheSameForces) {
  const std::vector<std::vector<std::size_t>> orders = {{0, 1, 2, 3, 4}, {4, 3, 2, 1, 0}, {1, 2, 3, 4, 0},
                                                        {2, 0, 4, 1, 3}, {3, 1, 4, 0, 2}, {2, 4, 1, 3, 0}};
  expect_order_matters_to_the_paper_only(played_in_orders("grasp_cylinder_5", orders, 0.17), orders.size());
}

// The fingers close, the wrist goes aside, the fingers open there, the wrist comes back: what the hand put in it got
// back, to the error of the sum over ticks. The far field of an articulated tool is fixed to the body for this.
TEST(Grasp, LoopsOfFingersAndWristReturnNoEnergy) {
  Model model = scene_named("grasp_cylinder_5").model();
  model.params.friction_law = FrictionLaw::kNone;
  model.params.stop_force_N = 1e6;
  Bench bench(model);
  struct Push {
    std::int32_t piece;
    Vec3 at_w, force_w;
  };
  std::vector<Push> before, now;
  Pose carrier_before[kMaxPieces];
  double work_J = 0, most_J = 0, at_hold_J = 0, stored_at_hold_J = 0;
  constexpr int kPhase = 2500;
  for (int n = 0; n <= 4 * kPhase; ++n) {
    const double u = static_cast<double>(n % kPhase) / kPhase;
    const int phase = n / kPhase;
    const double closing = phase == 0 ? u : phase == 1 ? 1 : phase == 2 ? 1 - u : 0;
    const double aside = phase == 0 ? 0 : phase == 1 ? u : phase == 2 ? 1 : phase == 3 ? 1 - u : 0;
    Pose pose = model.grasp_w[0];
    pose.position_m += aside * Vec3{-1.2e-3, 1.5e-3, 1e-3};
    bench.tick_at(pose, closing_all(closing));
    now.clear();
    for (std::int32_t i = 0; i < bench.scratch->contact_count; ++i) {
      const Contact& c = bench.scratch->contact[i];
      now.push_back({c.piece, c.position_w, c.force_N * c.normal_w});
    }
    Pose carrier[kMaxPieces];
    for (std::size_t p = 0; p < model.piece.size(); ++p)
      carrier[p] = carrier_w(model, *bench.state, static_cast<std::int32_t>(p));
    // The hand's work against the body's force on it: half with the forces before the step, half with those after.
    if (n > 0) {
      for (const Push& push : before) {
        const Vec3 to = transform(carrier[push.piece], inverse_transform(carrier_before[push.piece], push.at_w));
        work_J -= 0.5 * dot(push.force_w, to - push.at_w);
      }
      for (const Push& push : now) {
        const Vec3 from = transform(carrier_before[push.piece], inverse_transform(carrier[push.piece], push.at_w));
        work_J -= 0.5 * dot(push.force_w, push.at_w - from);
      }
    }
    before = now;
    std::copy_n(carrier, kMaxPieces, carrier_before);
    most_J = std::max(most_J, bench.output.energy_J);
    if (n == kPhase - 1) {
      at_hold_J = work_J;
      stored_at_hold_J = bench.output.energy_J;
      EXPECT_EQ(bench.output.regions, kHandParts);
    }
  }
  EXPECT_EQ(bench.output.regions, 0);
  EXPECT_GT(most_J, 1e-3);
  // The bound is 1e-3; measured 2026-11-21: 4.8e-6 at the hold, 2.4e-7 after the loop.
  EXPECT_NEAR(at_hold_J, stored_at_hold_J, 1e-4 * most_J);
  EXPECT_NEAR(work_J, 0, 1e-5 * most_J);
}

TEST(Grasp, TheCoupledSolveConvergesThroughTheWholeGrasp) {
  for (const char* name : kScenes) EXPECT_LT(played(name).residual_max_m, 1e-9) << name;
}

// Any command at all, for five seconds: joints keep their limits and their speeds, and the output stays a number.
TEST(Grasp, JointsKeepLimitsAndSpeedsWhateverIsCommanded) {
  const Model& model = scene_named("grasp_cylinder_5").model();
  Bench bench(model);
  std::mt19937 random(20261121);
  std::uniform_real_distribution<float> wild(-4, 4);
  const float garbage[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30f};
  bench.tick_at(model.grasp_w[0], {});
  JointCommand joints;
  for (int i = 0; i < 5000; ++i) {
    if (i % 50 == 0) {
      for (float& closing : joints.closing) closing = wild(random);
      for (float& target : joints.target) target = wild(random);
      joints.direct = static_cast<std::uint32_t>(random());
      joints.closing[random() % kMaxFingers] = garbage[random() % 3];
      joints.target[random() % kMaxJoints] = garbage[random() % 3];
    }
    double before[kMaxJoints];
    for (std::size_t j = 0; j < kMaxJoints; ++j) before[j] = bench.state->articulation.joint.data()[j];
    bench.tick_at(model.grasp_w[0], joints);
    for (std::size_t j = 0; j < kMaxJoints; ++j) {
      const double now = bench.state->articulation.joint.data()[j];
      ASSERT_TRUE(now >= model.joint[j].lowest && now <= model.joint[j].highest) << "joint " << j << " tick " << i;
      ASSERT_LE(std::abs(now - before[j]), model.joint[j].speed_max * model.params.period_s * (1 + 1e-12));
    }
    ASSERT_TRUE(is_finite(bench.output.contact_w.force_N) && is_finite(bench.output.palm_w.torque_Nm));
    ASSERT_EQ(bench.output.fault, 0u);
  }
}

TEST(Grasp, APoseThatIsNoNumberIsRejectedAndTheHandHolds) {
  const Model& model = scene_named("grasp_cylinder_5").model();
  Bench bench(model);
  for (int i = 0; i < 1500; ++i) bench.tick_at(model.grasp_w[0], closing_all(1));
  ASSERT_EQ(bench.output.regions, kHandParts);
  Pose broken = model.grasp_w[0];
  broken.position_m.y = std::numeric_limits<double>::quiet_NaN();
  bench.tick_at(broken, closing_all(1));
  EXPECT_TRUE((bench.output.status & Status::kInputRejected) != 0);
  EXPECT_EQ(bench.output.regions, kHandParts);
  EXPECT_TRUE(is_finite(bench.output.contact_w.force_N));
}

// The whole state is a copy: a grasp goes on from a copy with the same bits, and stale memory has no influence.
TEST(Grasp, ACopyOfTheStateGoesOnWithTheSameBits) {
  const Model& model = scene_named("grasp_cylinder_5").model();
  Bench a(model), b(model);
  test::poison(*b.scratch, model, 0x5A);
  for (int i = 0; i < 900; ++i) a.tick_at(model.grasp_w[0], closing_all(1));
  copy_state(*a.state, *b.state);
  for (int i = 0; i < 300; ++i) {
    a.tick_at(model.grasp_w[0], closing_all(0.5));
    b.tick_at(model.grasp_w[0], closing_all(0.5));
    ASSERT_EQ(hash_state(*a.state), hash_state(*b.state)) << first_state_difference(*a.state, *b.state);
  }
}

// Twenty jaws of a hundred points each press a block: 2000 points, 20 regions. Each jaw is described `step_mm` higher
// than the one before and tilted, so that its points differ in depth.
std::string crowd(double step_mm, double tilt_deg) {
  std::string text = R"(
name = "crowd"
[body]
shape = "box"
size_mm = [300, 40, 300]
triangles = 3000
[body.material]
poisson_ratio = 0.47
[contact]
law = "cubic"
reference_area_mm2 = 100
cluster_distance_mm = 3
[contact.cubic]
k1_N_per_m = 100
[gripper]
closing_s = 0.1
stop_force_N = 100
)";
  for (int k = 0; k < 20; ++k) {
    const int x = 50 * (k % 5) - 100, z = 60 * (k / 5) - 90;
    text += "[[tool.piece]]\nshape = \"capsule\"\nposition_mm = [" + std::to_string(x) + ", " +
            std::to_string(step_mm * k) + ", " + std::to_string(z) + "]\nrotation_deg = [" + std::to_string(tilt_deg) +
            ", 0, 0]\nradius_mm = 6\nlength_mm = 32\npoints = 100\nslide_mm = [" + std::to_string(0.01 * k + 0.01) +
            ", 20, 0]\n";
  }
  return text;
}

// Both pools overflow in one tick: far more points touch than contacts are kept, and those that are kept belong to
// more jaws than there are regions. Two runs, one on dirty scratch memory, agree in every bit of every tick.
TEST(GraspOverflow, ThousandsOfPointsAndTooManyRegionsDegradeDeterministically) {
  EXPECT_THROW(BakedScene{crowd(0.002, 10) + "[device]\nperiod_ms = 0.5\n"}, ConfigError)
      << "the worst tick of so many does not fit a period of 0.5 ms: 2,530,655 instructions (2026-11-28)";
  const BakedScene scene(crowd(0.002, 10) + "[device]\nperiod_ms = 4\n");
  const Model& model = scene.model();
  ASSERT_EQ(model.sizes.n_tool_point, 2000);
  Bench a(model), b(model);
  test::poison(*b.scratch, model, 0xC3);
  int together = 0;
  for (int i = 0; i < 150; ++i) {
    const Pose pose{{0, 0.0445, 0}, {}};
    a.tick_at(pose, closing_all(1));
    b.tick_at(pose, closing_all(1));
    ASSERT_EQ(hash_state(*a.state), hash_state(*b.state)) << first_state_difference(*a.state, *b.state);
    ASSERT_EQ(a.output.contact_w, b.output.contact_w);
    ASSERT_EQ(a.output.status, b.output.status);
    ASSERT_LE(a.output.contacts, kMaxContacts);
    ASSERT_LE(a.output.regions, kMaxRegions);
    ASSERT_EQ(a.output.fault, 0u);
    ASSERT_TRUE(is_finite(a.output.contact_w.force_N));
    constexpr std::uint32_t kBoth = Status::kContactsDropped | Status::kRegionsDropped;
    together += (a.output.status & kBoth) == kBoth ? 1 : 0;
  }
  EXPECT_GT(together, 20);  // ticks
  EXPECT_EQ(a.output.regions, kMaxRegions);
  EXPECT_GT(a.output.contact_w.force_N.y, 0);
}

// The same with one point per jaw: twenty regions, of which the sixteen deepest are kept.
TEST(GraspOverflow, TwentyRegionsKeepTheSixteenDeepest) {
  std::string text = crowd(0.02, 0);
  for (std::size_t at; (at = text.find("points = 100")) != std::string::npos;) text.replace(at, 12, "points = 1");
  const BakedScene scene(text);
  Bench bench(scene.model());
  for (int i = 0; i < 150; ++i) bench.tick_at({{0, 0.0445, 0}, {}}, closing_all(1));
  EXPECT_TRUE((bench.output.status & Status::kRegionsDropped) != 0);
  EXPECT_EQ(bench.output.regions, kMaxRegions);
  for (std::int32_t k = 0; k < 20; ++k)  // jaw k is described 0.02 k mm higher: the last four are the shallowest
    EXPECT_EQ(norm(bench.state->articulation.piece_force_tool_N[k]) > 0, k < kMaxRegions) << k;
}

}  // namespace
}  // namespace palpate::test
