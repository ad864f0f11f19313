// The force stage as a whole, on hand-placed contacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <utility>

#include "config/bake/rbf_system.h"
#include "force_scene.h"
#include "rt_core/contact/cubic_law.h"
#include "rt_core/contact/points/point_laws.h"
#include "rt_core/skeleton/rbf.h"
#include "rt_core/skeleton/skeleton.h"

namespace palpate {
namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
const Vec3 kUp{0, 0, 1};
const CubicLaw kLaw{40, 3e8, 0.02};

Vec3 sum_of_regions(const State& state) {
  Vec3 sum;
  for (const Region& region : state.region) sum += region.wrench_w.force_N;
  return sum;
}

TEST(ComputeForce, OnePointIsTheContactLaw) {
  ForceScene s;
  s.open_region(3, 7);
  s.state->tool_w.position_m = {0.1, 0, 0};
  s.state->tool_previous_w = s.state->tool_w;
  s.add_contact(3, {0.1, 0.02, 0}, kUp, 2e-3);
  s.run();
  const Region& region = s.state->region[3];
  EXPECT_NEAR(s.force().z, 2.48, 1e-14);
  EXPECT_NEAR(s.torque().x, 0.02 * 2.48, 1e-15);
  EXPECT_NEAR(s.scratch->contact[0].force_N, 2.48, 1e-14);
  EXPECT_NEAR(region.depth_equivalent_m, 2e-3, 1e-17);
  EXPECT_NEAR(region.tangent_N_per_m, law_tangent_N_per_m(kLaw, 2e-3), 1e-9);
  EXPECT_NEAR(s.scratch->energy_J, law_energy_J(kLaw, 2e-3), 1e-17);
  EXPECT_EQ(region.friction, FrictionMode::kStick);
  EXPECT_EQ(region.centre_w, (Vec3{0.1, 0.02, 0}));
  EXPECT_EQ(s.scratch->system.shift_m[0], 0);
  EXPECT_EQ(s.scratch->status, 0u);
  EXPECT_EQ(s.scratch->residual_m, 0);
}

// Regions of random contacts on a sphere, with the tool turning and sliding.
void fill_random(ForceScene& s, std::mt19937_64& random, int regions, int points) {
  std::uniform_real_distribution<Real> u(-1, 1);
  for (int r = 0; r < regions; ++r) {
    const Vec3 axis = unit_or({u(random), u(random), u(random)}, kUp);
    for (int i = 0; i < points; ++i) {
      const Vec3 n = unit_or(axis + 0.2 * Vec3{u(random), u(random), u(random)}, kUp);
      s.add_contact(r, 0.03 * n, n, 2e-3 + 1e-3 * u(random), 0.5 + 0.4 * u(random));
    }
  }
}

TEST(ComputeForce, ForcesAndMomentsBalance) {
  std::mt19937_64 random(1);
  for (const CouplingLaw coupling : {CouplingLaw::kNone, CouplingLaw::kCoupled}) {
    for (const TangentialLaw tangential : {TangentialLaw::kSeparable, TangentialLaw::kRadial}) {
      ForceScene s;
      s.set_coupling(coupling);
      s.model.params.tangential_law = tangential;
      for (int r = 0; r < 5; ++r) s.open_region(r, static_cast<std::uint32_t>(r + 1));
      for (int tick = 0; tick < 20; ++tick) {
        s.clear_contacts();
        s.move_tool({{1e-4 * tick, -2e-4 * tick, 0.05}, small_rotation({1e-3 * tick, 0, 2e-3 * tick})});
        fill_random(s, random, 5, 4);
        s.run();
        Vec3 force, torque, normal_sum[5];
        for (int i = 0; i < s.scratch->contact_count; ++i) {
          const Contact& c = s.scratch->contact[i];
          const Vec3 f = c.force_N * c.normal_w;
          EXPECT_GE(c.force_N, 0);
          force += f;
          torque += cross(c.position_w - s.state->tool_w.position_m, f);
          normal_sum[c.region] += f;
        }
        for (int r = 0; r < 5; ++r) {
          const Region& region = s.state->region[r];
          // The radial law adds along the normal at the centre.
          const Vec3 gain = (region.normal_force_N - dot(normal_sum[r], region.normal_w)) * region.normal_w;
          const Vec3 at_centre = region.friction_force_w + gain;
          EXPECT_NEAR(dot(region.friction_force_w, region.normal_w), 0, 1e-12);
          force += at_centre;
          torque += cross(region.centre_w - s.state->tool_w.position_m, at_centre);
        }
        EXPECT_LT(norm(force - s.force()), 1e-12);
        EXPECT_LT(norm(torque - s.torque()), 1e-12);
        EXPECT_LT(norm(sum_of_regions(*s.state) - s.force()), 1e-12);
        EXPECT_EQ(s.scratch->status, 0u);
      }
    }
  }
}

TEST(ComputeForce, SlidesByTheWorkedTable) {
  ForceScene s;
  s.open_region(0, 1);
  const Real depth = law_depth_m(kLaw, 5);
  const std::pair<Real, Real> rows[] = {{0, 0},         {1, -0.34},    {2, -2.48},   {2.3, -3.7421},
                                        {2.4, -2.5},    {3, -2.5},     {4, -2.5},    {3.5, -1.083856},
                                        {3, -0.345178}, {1, 0.334876}, {0, 2.460108}};
  for (const auto& [x_mm, force] : rows) {
    s.clear_contacts();
    s.move_tool({{1e-3 * x_mm, 0, 0}, {}});
    s.add_contact(0, {1e-3 * x_mm, 0, 0}, kUp, depth);
    s.run();
    EXPECT_NEAR(s.force().x, force, 1e-6) << x_mm;
    EXPECT_NEAR(s.force().z, 5, 1e-14);
  }
  EXPECT_NEAR(s.state->region[0].centre_w.x - s.state->region[0].stretch_w.x, 1.994520e-3, 1e-9);
}

TEST(ComputeForce, StretchFollowsTheToolMaterialAtTheCentre) {
  // Pure spin of the tool about its origin moves the material at the contact by the arc.
  ForceScene s;
  s.model.params.friction_k_N = 1e4;
  s.open_region(0, 1);
  s.add_contact(0, {0.02, 0, 0}, kUp, 3e-3);
  s.run();
  s.move_tool({{}, small_rotation({0, 0, 0.01})});
  s.clear_contacts();
  s.add_contact(0, {0.02, 0, 0}, kUp, 3e-3);
  s.run();
  const Region& region = s.state->region[0];
  EXPECT_NEAR(region.stretch_w.y, 0.02 * std::sin(0.01), 1e-9);
  EXPECT_NEAR(region.stretch_w.x, 0.02 * (std::cos(0.01) - 1) * -1, 3e-6);
  EXPECT_LT(region.friction_force_w.y, 0);  // against the motion
  EXPECT_NEAR(s.torque().z, 0.02 * region.friction_force_w.y, 1e-15);
}

TEST(ComputeForce, RollingAndTiltingKeepTheStretch) {
  ForceScene s;
  s.model.params.friction_k_N = 1e4;
  s.open_region(0, 1);
  s.add_contact(0, {}, kUp, 3e-3);
  s.run();
  s.move_tool({{1e-3, 0, 0}, {}});
  s.clear_contacts();
  s.add_contact(0, {1e-3, 0, 0}, kUp, 3e-3);
  s.run();
  const Real length = norm(s.state->region[0].stretch_w);
  EXPECT_NEAR(length, 1e-3, 1e-17);
  s.move_tool(s.state->tool_w);
  for (const Real angle : {0.1, 0.5, 1.0}) {  // the contact wanders and its normal turns; the material does not move
    s.clear_contacts();
    s.add_contact(0, {0.02 * angle, 0.01, 0}, {std::sin(angle), 0, std::cos(angle)}, 3e-3);
    s.run();
    const Vec3 stretch = s.state->region[0].stretch_w;
    EXPECT_NEAR(norm(stretch), length, 1e-17);
    EXPECT_NEAR(stretch.x, length * std::cos(angle), 1e-16);
    EXPECT_NEAR(stretch.z, -length * std::sin(angle), 1e-16);
  }
}

TEST(ComputeForce, SymmetricPinchGivesSymmetricForces) {
  for (const CouplingLaw coupling : {CouplingLaw::kNone, CouplingLaw::kCoupled}) {
    ForceScene s;
    s.set_coupling(coupling);
    s.open_region(0, 1);
    s.open_region(1, 2);
    s.add_contact(0, {0.03, 0, 0}, {1, 0, 0}, 3e-3);
    s.add_contact(1, {-0.03, 0, 0}, {-1, 0, 0}, 3e-3);
    s.run();
    EXPECT_EQ(s.state->region[0].wrench_w.force_N.x, -s.state->region[1].wrench_w.force_N.x);
    EXPECT_EQ(norm(s.force()), 0);
    EXPECT_EQ(norm(s.torque()), 0);
  }
}

TEST(ComputeForce, CoupledRegionsMatchTheSolverAndOrderDoesNotMatter) {
  ForceScene s;
  s.set_coupling(CouplingLaw::kCoupled);
  s.open_region(0, 1);
  s.open_region(5, 2, 9);
  s.add_contact(0, {0, 0, 0}, kUp, 3e-3);
  s.add_contact(5, {0.012, 0, 0}, kUp, 2e-3);
  s.run();
  const Real scale = far_field_scale_m2_per_N(3e6, 0.47);
  const Real self = scale / 0.01, mutual = scale / std::hypot(0.012, 0.01);
  const Real f0 = s.state->region[0].normal_force_N, f5 = s.state->region[5].normal_force_N;
  // One step from a start within 5 um may leave 1e-11 m (coupled_points.cpp), here 1.7e-12: 13 nN on 7.7 kN/m.
  EXPECT_NEAR(s.scratch->system.shift_m[0], self * f0 + mutual * f5, 1e-11);
  EXPECT_NEAR(f0, law_force_N(kLaw, 3e-3 - self * f0 - mutual * f5), 1e-7);
  EXPECT_NEAR(f5, law_force_N(kLaw, 2e-3 - mutual * f0 - self * f5), 1e-7);
  EXPECT_LE(s.scratch->residual_m, 1e-11);
  EXPECT_NEAR(s.scratch->energy_J,
              law_energy_J(kLaw, 3e-3 - s.scratch->system.shift_m[0]) +
                  law_energy_J(kLaw, 2e-3 - s.scratch->system.shift_m[1]) +
                  0.5 * (self * f0 * f0 + 2 * mutual * f0 * f5 + self * f5 * f5),
              1e-11 * (f0 + f5));
  s.reset_state();
  s.open_region(0, 1, 9);
  s.open_region(5, 2);
  s.run();
  EXPECT_NEAR(s.state->region[0].normal_force_N, f0, 1e-7);
  EXPECT_NEAR(s.state->region[5].normal_force_N, f5, 1e-7);
}

TEST(ComputeForce, PressLoopOfTwoCoupledRegionsReturnsNoEnergy) {
  ForceScene s;
  s.set_coupling(CouplingLaw::kCoupled);
  s.set_friction(FrictionLaw::kNone);
  s.open_region(0, 1);
  s.open_region(1, 2);
  Real work = 0, moved = 0, force[2] = {}, depth[2] = {}, first_energy = 0;
  const int steps = 2000;
  for (int i = 0; i <= steps; ++i) {
    const Real angle = 2 * M_PI * i / steps;
    const Real next[2] = {3.25e-3 + 0.25e-3 * std::cos(angle), 2.75e-3 + 0.25e-3 * std::sin(angle)};
    s.clear_contacts();
    s.add_contact(0, {0, 0, 0}, kUp, next[0]);
    s.add_contact(1, {0.02, 0, 0}, unit_or({0.3, 0, 1}, kUp), next[1]);
    s.run();
    for (int r = 0; r < 2; ++r) {
      const Real f = s.state->region[r].normal_force_N;
      if (i > 0) work += 0.5 * (f + force[r]) * (next[r] - depth[r]);
      if (i > 0) moved += std::abs(0.5 * (f + force[r]) * (next[r] - depth[r]));
      force[r] = f;
      depth[r] = next[r];
    }
    if (i == 0) first_energy = s.scratch->energy_J;
  }
  EXPECT_LT(std::abs(work), 1e-11 * moved);
  EXPECT_NEAR(s.scratch->energy_J, first_energy, 1e-11 * first_energy / 1e-3);  // 1e-11 of a depth of a millimetre
}

TEST(ComputeForce, StiffnessIsPositiveSemiDefiniteAndLosesTheSlipDirection) {
  ForceScene s;
  s.open_region(0, 1);
  Real along_stuck = 0;
  for (int i = 0; i <= 40; ++i) {
    s.clear_contacts();
    s.move_tool({{1e-4 * i, 0, 0}, {}});
    s.add_contact(0, {1e-4 * i, 0.01, 0}, kUp, 3e-3);
    s.run();
    const double* k = s.state->contact_stiffness;
    for (int a = 0; a < 6; ++a) {
      EXPECT_GE(k[7 * a], 0);
      for (int b = 0; b < 6; ++b) {
        EXPECT_EQ(k[6 * a + b], k[6 * b + a]);
        EXPECT_LE(k[6 * a + b] * k[6 * a + b], k[7 * a] * k[7 * b] * (1 + 1e-12) + 1e-12);
      }
    }
    EXPECT_NEAR(k[14], law_tangent_N_per_m(kLaw, 3e-3), 1e-9);
    if (s.state->region[0].friction == FrictionMode::kStick) along_stuck = k[0];
  }
  EXPECT_GT(along_stuck, 1000);
  EXPECT_EQ(s.state->region[0].friction, FrictionMode::kSlip);
  EXPECT_EQ(s.state->contact_stiffness[0], 0);
  EXPECT_GT(s.state->contact_stiffness[7], 0);
}

TEST(ComputeForce, LostRegionsAreSilentAndRemember) {
  ForceScene s;
  s.open_region(0, 1);
  for (const Real x : {0.0, 1e-3}) {
    s.clear_contacts();
    s.move_tool({{x, 0, 0}, {}});
    s.add_contact(0, {x, 0, 0}, kUp, 3e-3);
    s.run();
  }
  Region& region = s.state->region[0];
  const Vec3 stretch = region.stretch_w;
  EXPECT_GT(norm(stretch), 0.9e-3);
  region.lost_ticks = 1;
  s.clear_contacts();
  s.run();
  EXPECT_EQ(norm(s.force()), 0);
  EXPECT_EQ(norm(region.wrench_w.force_N), 0);
  EXPECT_EQ(region.normal_force_N, 0);
  EXPECT_EQ(s.scratch->energy_J, 0);
  for (const double entry : s.state->contact_stiffness) EXPECT_EQ(entry, 0);
  EXPECT_EQ(region.stretch_w, stretch);
}

TEST(ComputeForce, SameBitsWhateverScratchHeld) {
  ForceScene a, b;
  test::poison(*b.scratch, test::roomiest_model(), 0);
  for (ForceScene* s : {&a, &b}) {
    std::mt19937_64 random(2);
    s->set_coupling(CouplingLaw::kCoupled);
    s->clear_contacts();
    for (int r = 0; r < 6; ++r) s->open_region(r, static_cast<std::uint32_t>(6 - r));
    s->move_tool({{1e-4, 0, 0}, {}});
    fill_random(*s, random, 6, 5);
    s->run();
  }
  EXPECT_EQ(a.force(), b.force());
  EXPECT_EQ(a.torque(), b.torque());
  EXPECT_EQ(a.scratch->residual_m, b.scratch->residual_m);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(a.state->contact_stiffness[i], b.state->contact_stiffness[i]);
}

TEST(ComputeForce, BadContactsExertNothing) {
  ForceScene s;
  s.set_coupling(CouplingLaw::kCoupled);
  s.open_region(0, 1);
  s.open_region(1, 2).lost_ticks = 3;
  s.add_contact(0, {}, kUp, 2e-3);
  s.run();
  const Vec3 clean = s.force();
  s.add_contact(0, {kNan, 0, 0}, kUp, 2e-3);
  s.add_contact(0, {}, {0, kNan, 0}, 2e-3);
  s.add_contact(0, {}, kUp, kNan);
  s.add_contact(0, {}, kUp, std::numeric_limits<Real>::infinity());
  s.add_contact(0, {}, kUp, -1e-3);
  s.add_contact(0, {}, kUp, 0);
  s.add_contact(0, {}, kUp, 2e-3, kNan);
  s.add_contact(0, {}, kUp, 2e-3, -1);
  s.add_contact(-1, {}, kUp, 2e-3);
  s.add_contact(kMaxRegions, {}, kUp, 2e-3);
  s.add_contact(1, {}, kUp, 2e-3);  // region not in contact
  s.add_contact(2, {}, kUp, 2e-3);  // empty slot
  s.state->region[0].friction = FrictionMode::kFree;
  s.run();
  EXPECT_EQ(s.force(), clean);
  for (int i = 1; i < s.scratch->contact_count; ++i) EXPECT_EQ(s.scratch->contact[i].force_N, 0) << i;
  s.scratch->contact_count = 1000000;  // more than there can be
  s.run();
  EXPECT_TRUE(is_finite(s.force()));
  s.scratch->contact_count = 1;
  s.state->tool_w.position_m.x = kNan;
  s.run();
  EXPECT_EQ(norm(s.force()), 0);
  s.state->tool_w.position_m.x = 0;
  s.state->tool_previous_w.position_m.x = kNan;
  s.run();
  EXPECT_TRUE(is_finite(s.force()));
}

TEST(ComputeForce, StatusBits) {
  ForceScene s;
  s.open_region(0, 1);
  s.add_contact(0, {}, kUp, 0.021);
  s.run();
  EXPECT_EQ(s.scratch->status, Status::kDepthBeyondRange);
  EXPECT_LT(s.force().z, law_force_N({40, 3e8, kHuge}, 0.021));
  // Many regions under stiff points on a soft body: the fixed iterations cannot follow, and say so.
  s.reset_state();
  s.clear_contacts();
  for (std::int32_t r = 0; r < kMaxRegions; ++r) s.open_region(r, static_cast<std::uint32_t>(r + 1));
  std::mt19937_64 random(12);
  fill_random(s, random, kMaxRegions, 4);
  s.set_coupling(CouplingLaw::kCoupled);
  s.model.params.youngs_modulus_Pa = 1e3;
  s.model.params.k3_N_per_m3 = 1e12;
  s.run();
  EXPECT_NE(s.scratch->status & Status::kNotConverged, 0u);
  EXPECT_GT(s.scratch->residual_m, PointLaws::kTolerance_m);
  EXPECT_TRUE(is_finite(s.force()));
}

TEST(ComputeForce, NothingInContactIsNothing) {
  ForceScene s;
  s.set_coupling(CouplingLaw::kCoupled);
  s.run();
  EXPECT_EQ(norm(s.force()), 0);
  EXPECT_EQ(s.scratch->energy_J, 0);
  EXPECT_EQ(s.scratch->residual_m, 0);
}

// Six anchors round the origin, so that the skeleton can carry forces from region to region.
struct TemporalScene : ForceScene {
  std::array<Anchor, 6> anchors{};
  std::array<double, 49> inverse{};

  TemporalScene() {
    const Vec3 at[6] = {{0.04, 0, 0}, {-0.04, 0, 0}, {0, 0.04, 0}, {0, -0.04, 0}, {0, 0, 0.01}, {0, 0, -0.04}};
    for (std::size_t i = 0; i < 6; ++i) {
      anchors[i].position_m = at[i];
      anchors[i].normal = unit_or(at[i], kUp);
      anchors[i].section_radius_m = 4e-3;
      anchors[i].section_area_m2 = M_PI * 16e-6;
      anchors[i].section_inertia_m4 = M_PI * 256e-12 / 4;
      anchors[i].release_length_m = 5e-3;
    }
    EXPECT_TRUE(
        invert_rbf_system(std::array<Vec3, 6>{at[0], at[1], at[2], at[3], at[4], at[5]}, RbfTail::kConstant, inverse));
    model.anchor = anchors;
    model.rbf_inverse = inverse;
    model.sizes.n_anchor = 6;
    model.sizes.n_rbf = 7;
    model.sizes.n_rbf2 = 49;
    model.params.rbf_tail = RbfTail::kConstant;
    model.params.skeleton_law = SkeletonLaw::kStiffness;
    set_coupling(CouplingLaw::kTemporalPaper);
    add_contact(0, {0, 0, 0.02}, kUp, 3e-3);
    add_contact(1, {0.015, 0, 0.02}, unit_or({0.2, 0, 1}, kUp), 2e-3);
  }
};

// How far `first` moves the surface inward under `later`: anchors through its skeleton, the surface by interpolation.
Real shift_by(TemporalScene& s, const Region& first, const Region& later) {
  Skeleton skeleton;
  EXPECT_TRUE(solve_skeleton(s.model, {}, first.centre_w, -first.normal_force_N * first.normal_w, skeleton));
  RbfVector weight;
  rbf_weights(s.model, later.centre_w, weight);
  Vec3 moved;
  for (std::int32_t a = 0; a < skeleton.count; ++a)
    moved += weight[a] * anchor_displacement(skeleton, s.anchors[static_cast<std::size_t>(a)], a);
  return -dot(moved, later.normal_w);
}

TEST(ComputeForce, TemporalCouplingAddsWhatLaterRegionsTransfer) {
  for (const bool second_is_later : {true, false}) {
    TemporalScene s;
    s.open_region(0, 1, second_is_later ? 1 : 8);
    s.open_region(1, 2, 5);
    s.set_coupling(CouplingLaw::kNone);
    s.run();
    Real own[2] = {s.state->region[0].normal_force_N, s.state->region[1].normal_force_N};
    const int first = second_is_later ? 0 : 1, later = 1 - first;
    const std::int32_t order[2] = {first, later};
    Real sum[2] = {};
    // The later one meets the surface as the first has moved it.
    const Real shift_m = shift_by(s, s.state->region[first], s.state->region[later]);
    EXPECT_GT(std::abs(shift_m), 1e-5);
    const Contact& touch = s.scratch->contact[later];
    own[later] = touch.weight * law_force_N(contact_law(s.model.params), touch.depth_m - shift_m);
    s.state->region[later].normal_force_N = own[later];
    EXPECT_TRUE(add_transferred_forces(s.model, *s.state, order, 2, sum));
    const Real added = sum[0];
    EXPECT_GT(std::abs(added), 1e-3);  // the scene does couple
    s.set_coupling(CouplingLaw::kTemporalPaper);
    s.run();
    EXPECT_NEAR(s.state->region[first].normal_force_N, own[first] + added, 1e-9);
    EXPECT_NEAR(s.state->region[later].normal_force_N, own[later], 1e-12);
    EXPECT_NEAR(s.scratch->contact[first].force_N, s.state->region[first].normal_force_N, 1e-12);
    EXPECT_LT(norm(sum_of_regions(*s.state) - s.force()), 1e-12);
  }
}

// Luo & Xiao 2006, section VI: every region adds what the others' beams bring it, whoever came first.
TEST(ComputeForce, MutualCouplingAddsWhatAllOthersTransfer) {
  TemporalScene s;
  s.open_region(0, 1, 1);
  s.open_region(1, 2, 8);
  s.set_coupling(CouplingLaw::kNone);
  s.run();
  const Real own[2] = {s.state->region[0].normal_force_N, s.state->region[1].normal_force_N};
  const std::int32_t order[2] = {0, 1};
  Real sum[2] = {};
  s.set_coupling(CouplingLaw::kMutualPaper);
  EXPECT_TRUE(add_mutual_forces(s.model, *s.state, order, 2, sum));
  s.run();
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(sum[i], 1e-3);  // the scene does couple
    EXPECT_NEAR(s.state->region[i].normal_force_N, own[i] + sum[i], 1e-9);
    EXPECT_NEAR(s.scratch->contact[i].force_N, s.state->region[i].normal_force_N, 1e-12);
  }
  EXPECT_LT(norm(sum_of_regions(*s.state) - s.force()), 1e-12);
}

// A strong press from the other side presses a light one harder, through the body: it neither pulls nor unloads it.
TEST(ComputeForce, TemporalCouplingNeverPulls) {
  TemporalScene s;
  s.clear_contacts();
  s.open_region(0, 1, 1);
  s.open_region(1, 2, 2);
  s.add_contact(0, {0, 0, 0.02}, kUp, 1e-4);
  s.add_contact(1, {0, 0, -0.02}, {0, 0, -1}, 6e-3);  // strong, opposed
  s.run();
  const Real own = s.scratch->contact[0].weight * law_force_N(contact_law(s.model.params), 1e-4);
  EXPECT_GT(s.state->region[0].normal_force_N, 1.1 * own);
  EXPECT_LT(s.state->region[0].normal_force_N, s.state->region[1].normal_force_N);
  EXPECT_GT(s.scratch->contact[0].force_N, own);
}

}  // namespace
}  // namespace palpate
