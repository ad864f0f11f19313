// Friction of one region: worked table, passivity over random closed paths, the paper's rule against the right one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "rt_core/contact/friction.h"
#include "rt_core/contact/friction_lanes.h"

namespace palpate {
namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
const Vec3 kUp{0, 0, 1};

// Static limit 4 N and sliding force 2.5 N under 5 N.
FrictionParameters worked_parameters(FrictionLaw law = FrictionLaw::kReturnMap) {
  FrictionParameters p;
  p.law = law;
  p.k_N = 0.8 * std::pow(5.0, 0.25);
  p.beta = 0.75;
  p.mu_dynamic = 0.5;
  p.mindlin_ratio = 2 * (1 - 0.47) / (2 - 0.47);
  p.contact = {40, 3e8, kHuge};
  return p;
}

FrictionLoad load_of(const FrictionParameters& p, Real depth, Vec3 step) {
  FrictionLoad load;
  load.normal_w = kUp;
  load.step_w = step;
  load.depth_m = depth;
  load.force_N = law_force_N(p.contact, depth);
  load.tangent_N_per_m = law_tangent_N_per_m(p.contact, depth);
  return load;
}

FrictionLoad constant_load(const FrictionParameters& p, Vec3 step) {
  FrictionLoad load = load_of(p, law_depth_m(p.contact, 5.0), step);
  load.force_N = 5;
  return load;
}

// Of a way that ends at the limit all of it; of one three times as long a third, which is what it meets on the whole;
// of what slips already nothing.
TEST(Friction, TheShareBeforeSlipIsTheSecant) {
  const FrictionParameters p = worked_parameters();
  FrictionForce friction;
  friction.force_w = {1, 0, 0};
  friction.along_N_per_m = 1000;  // 3 N are left: 3 mm
  EXPECT_EQ(share_before_slip(p, friction, 5, 0), 1);
  EXPECT_NEAR(share_before_slip(p, friction, 5, 3e-3), 1, 1e-12);
  EXPECT_NEAR(share_before_slip(p, friction, 5, 9e-3), 1.0 / 3, 1e-12);
  friction.force_w = {4.5, 0, 0};
  EXPECT_EQ(share_before_slip(p, friction, 5, 1e-6), 0);
}

TEST(Friction, Limits) {
  const FrictionParameters p = worked_parameters();
  EXPECT_NEAR(p.k_N, 1.1962790250, 1e-9);
  EXPECT_NEAR(static_limit_N(p, 5), 4, 1e-14);
  EXPECT_NEAR(sliding_limit_N(p, 5), 2.5, 1e-14);
  EXPECT_NEAR(law_depth_m(p.contact, 4), 2.352519648e-3, 1e-12);
  EXPECT_NEAR(law_depth_m(p.contact, 2.5), 2.005479644e-3, 1e-12);
  // The limits cross at (K/mu)^(1/(1-beta)); above it sliding uses the static limit.
  const Real crossing = std::pow(p.k_N / 0.5, 4);
  EXPECT_LT(sliding_limit_N(p, 2 * crossing), 0.5 * 2 * crossing);
  EXPECT_EQ(sliding_limit_N(p, 2 * crossing), static_limit_N(p, 2 * crossing));
  // The roots used for beta = 3/4 agree with the general power.
  FrictionParameters near = p;
  near.beta = std::nextafter(0.75, 1.0);
  for (const Real force : {1e-6, 0.3, 5.0, 40.0}) {
    EXPECT_NEAR(static_limit_N(near, force), static_limit_N(p, force), 1e-14 * static_limit_N(p, force));
  }
  near.beta = 1;
  EXPECT_DOUBLE_EQ(static_limit_N(near, 3), 3 * near.k_N);
}

TEST(Friction, WorkedTable) {
  const FrictionParameters p = worked_parameters();
  FrictionMemory memory;
  friction_step(p, constant_load(p, {}), memory);
  EXPECT_EQ(memory.mode, FrictionMode::kStick);
  const struct {
    Real x_mm;
    FrictionMode mode;
    Real force_N, origin_mm;
  } rows[] = {{1.0, FrictionMode::kStick, -0.34, 0},
              {2.0, FrictionMode::kStick, -2.48, 0},
              {2.3, FrictionMode::kStick, -3.7421, 0},
              {2.4, FrictionMode::kSlip, -2.5, 0.394520},
              {3.0, FrictionMode::kSlip, -2.5, 0.994520},
              {4.0, FrictionMode::kSlip, -2.5, 1.994520},
              {3.5, FrictionMode::kStick, -1.083856, 1.994520},
              {3.0, FrictionMode::kStick, -0.345178, 1.994520},
              {1.0, FrictionMode::kStick, 0.334876, 1.994520},
              {0.0, FrictionMode::kStick, 2.460108, 1.994520}};
  Real x = 0;
  for (const auto& row : rows) {
    const FrictionForce f = friction_step(p, constant_load(p, {1e-3 * (row.x_mm - x), 0, 0}), memory);
    x = row.x_mm;
    EXPECT_EQ(memory.mode, row.mode) << x;
    EXPECT_NEAR(f.force_w.x, row.force_N, 1e-6) << x;  // the table has six decimals
    EXPECT_NEAR(1e3 * (1e-3 * x - memory.stretch_w.x), row.origin_mm, 1e-6) << x;
    EXPECT_EQ(f.force_w.y, 0);
    EXPECT_EQ(f.along_N_per_m == 0, row.mode == FrictionMode::kSlip);
  }
  // Between the table's digits: slip leaves exactly the stretch that carries the sliding force.
  FrictionMemory fresh{{2.4e-3, 0, 0}, 0, FrictionMode::kSlip};
  friction_step(p, constant_load(p, {}), fresh);
  EXPECT_NEAR(fresh.stretch_w.x, 2.005479644e-3, 1e-12);
}

TEST(Friction, RadialLawSplitsASkewedForce) {
  // 4 mm at 30 degrees: separable (12.609, 2.48) N, radial (16.766, 9.68) N.
  FrictionParameters p = worked_parameters();
  p.k_N = 100;  // no slip
  const Real depth = 4e-3 * std::cos(M_PI / 6), stretch = 4e-3 * std::sin(M_PI / 6);
  for (const TangentialLaw law : {TangentialLaw::kSeparable, TangentialLaw::kRadial}) {
    p.tangential = law;
    FrictionMemory memory{{}, 0, FrictionMode::kStick};
    const FrictionLoad load = load_of(p, depth, {stretch, 0, 0});
    const FrictionForce f = friction_step(p, load, memory);
    const Real normal = load.force_N + f.normal_gain_N;
    EXPECT_NEAR(normal, law == TangentialLaw::kRadial ? 16.766 : 12.609, 5e-4);
    EXPECT_NEAR(-f.force_w.x, law == TangentialLaw::kRadial ? 9.68 : 2.48, 1e-12 + 1e-12);
  }
  // Along -D, with the magnitude of the whole displacement.
  FrictionMemory memory{{}, 0, FrictionMode::kStick};
  const FrictionLoad load = load_of(p, depth, {stretch, 0, 0});
  const FrictionForce f = friction_step(p, load, memory);
  EXPECT_NEAR(std::hypot(load.force_N + f.normal_gain_N, f.force_w.x), 19.36, 1e-12);
}

TEST(Friction, RadialSlipFindsTheStretchOfTheLimitInsideAndBeyondTheRange) {
  for (const Real max_depth : {kHuge, 3e-3}) {
    FrictionParameters p = worked_parameters();
    p.tangential = TangentialLaw::kRadial;
    p.contact.max_depth_m = max_depth;
    for (const Real depth : {1e-3, 2.9e-3, 6e-3}) {
      FrictionMemory memory{{}, 0, FrictionMode::kStick};
      const FrictionForce slip = friction_step(p, load_of(p, depth, {0.02, 0.01, 0}), memory);
      ASSERT_EQ(memory.mode, FrictionMode::kSlip);
      const Real limit = norm(slip.force_w);
      const FrictionLoad under = load_of(p, depth, {});
      // Exact where sliding is mu F; where the power law is lower the normal force settles over the next ticks.
      EXPECT_NEAR(limit, sliding_limit_N(p, under.force_N + slip.normal_gain_N), (depth > 5e-3 ? 0.06 : 1e-9) * limit);
      // The stretch kept carries just that force: holding still is then sticking, with the same force.
      FrictionParameters held = p;
      held.k_N = 1e6;
      memory.mode = FrictionMode::kStick;
      const FrictionForce still = friction_step(held, under, memory);
      EXPECT_NEAR(norm(still.force_w), limit, 1e-12 * limit);
    }
  }
}

// A random smooth closed path: sums of sines that start and end at the same point.
struct ClosedPath {
  std::array<Real, 18> a;
  explicit ClosedPath(std::mt19937_64& random) {
    std::uniform_real_distribution<Real> amplitude(-1, 1);
    for (Real& value : a) value = amplitude(random);
  }
  Vec3 at(Real t) const {
    Vec3 p{0, 0, 2.5e-3};  // z is the depth
    for (int h = 0; h < 3; ++h) {
      const Real s = std::sin(2 * M_PI * (h + 1) * t), c = std::cos(2 * M_PI * (h + 1) * t) - 1;
      const std::size_t k = static_cast<std::size_t>(6 * h);
      p += Vec3{3e-3 * (a[k] * s + a[k + 1] * c), 3e-3 * (a[k + 2] * s + a[k + 3] * c),
                0.7e-3 * (a[k + 4] * s + a[k + 5] * c)};
    }
    return p;
  }
};

struct LoopResult {
  Real dissipated_J;  // work of the user minus change of stored energy
  Real moved_J;       // sum of |work|: scale of the sampling error
  bool slipped;
};

// Walks the path twice; depth z may leave contact (then friction forgets).
LoopResult walk(const FrictionParameters& p, const ClosedPath& path, int steps) {
  FrictionMemory memory;
  Vec3 force{}, position = path.at(0);
  LoopResult result{0, 0, false};
  Real first_energy = 0, energy = 0;
  for (int i = 0; i <= 2 * steps; ++i) {
    const Vec3 next = path.at(static_cast<Real>(i) / steps);
    const Vec3 move = next - position;
    Vec3 next_force{};
    energy = 0;
    if (next.z > 0) {
      const FrictionForce f = friction_step(p, load_of(p, next.z, {move.x, move.y, 0}), memory);
      // z counts inward, so the normal force works against +z.
      next_force = f.force_w + Vec3{0, 0, -(law_force_N(p.contact, next.z) + f.normal_gain_N)};
      energy = law_energy_J(p.contact, next.z) + f.energy_J;
      result.slipped = result.slipped || memory.mode == FrictionMode::kSlip;
    } else {
      memory = {};
    }
    if (i == 0) {
      first_energy = energy;
    } else {
      const Real work = -0.5 * dot(force + next_force, move);
      result.dissipated_J += work;
      result.moved_J += std::abs(work);
    }
    force = next_force;
    position = next;
  }
  result.dissipated_J -= energy - first_energy;
  return result;
}

TEST(Friction, NeverGivesEnergyBackOnRandomClosedPaths) {
  const struct {
    FrictionLaw law;
    TangentialLaw tangential;
  } promised[] = {{FrictionLaw::kReturnMap, TangentialLaw::kSeparable},
                  {FrictionLaw::kReturnMap, TangentialLaw::kRadial},
                  {FrictionLaw::kMindlin, TangentialLaw::kSeparable}};
  for (const auto& which : promised) {
    std::mt19937_64 random(7);
    int slipped = 0;
    Real least = 1;
    for (int loop = 0; loop < 300; ++loop) {
      FrictionParameters p = worked_parameters(which.law);
      p.tangential = which.tangential;
      const LoopResult result = walk(p, ClosedPath(random), 2000);
      slipped += result.slipped;
      least = std::min(least, result.dissipated_J);
      EXPECT_GE(result.dissipated_J, -1e-4 * result.moved_J) << loop;  // trapezoidal work at 2000 steps
    }
    EXPECT_GT(slipped, 250);
    RecordProperty("least_dissipation_J", std::to_string(least));
    EXPECT_GT(least, 0) << "law " << static_cast<int>(which.law);
  }
}

TEST(Friction, ConservativeWhileStuck) {
  for (const TangentialLaw tangential : {TangentialLaw::kSeparable, TangentialLaw::kRadial}) {
    std::mt19937_64 random(8);
    for (int loop = 0; loop < 50; ++loop) {
      FrictionParameters p = worked_parameters();
      p.tangential = tangential;
      p.k_N = 1e5;  // never slips
      p.contact.max_depth_m = 3e-3;
      ClosedPath path(random);
      const LoopResult coarse = walk(p, path, 1000), fine = walk(p, path, 4000);
      if (path.at(0.37).z < 0.2e-3 || path.at(0.71).z < 0.2e-3) continue;
      bool leaves = false;
      for (int i = 0; i < 1000; ++i) leaves = leaves || path.at(i * 1e-3).z <= 0;
      if (leaves) continue;  // losing contact drops the stretch and its energy
      // Trapezoidal error falls with the square of the step: 16 times for 4 times the steps.
      EXPECT_LT(std::abs(fine.dissipated_J), 1e-5 * fine.moved_J);
      EXPECT_LT(std::abs(fine.dissipated_J), 0.2 * std::abs(coarse.dissipated_J) + 1e-9 * fine.moved_J);
    }
  }
}

TEST(Friction, PlainMindlinSpringWouldBeActiveAndTheRuleIsNot) {
  // Shift 0.3 mm under 1 mm of depth, press to 3 mm, shift back, release to 1 mm.
  FrictionParameters p = worked_parameters(FrictionLaw::kMindlin);
  p.k_N = 1e3;
  p.mu_dynamic = 1e3;
  const Real shift = 0.3e-3;
  const Real low = p.mindlin_ratio * law_tangent_N_per_m(p.contact, 1e-3);
  const Real high = p.mindlin_ratio * law_tangent_N_per_m(p.contact, 3e-3);
  EXPECT_NEAR(0.5 * (high - low) * shift * shift, 2.24e-4, 1e-6);  // what k_t(D) s would give away
  FrictionMemory memory;
  friction_step(p, load_of(p, 1e-3, {}), memory);
  Real work = 0;
  const int steps = 1000;
  FrictionForce f = friction_step(p, load_of(p, 1e-3, {}), memory);
  const auto shift_by = [&](Real depth, Real distance) {
    for (int i = 0; i < steps; ++i) {
      const FrictionForce next = friction_step(p, load_of(p, depth, {distance / steps, 0, 0}), memory);
      work -= 0.5 * (f.force_w.x + next.force_w.x) * distance / steps;
      f = next;
    }
  };
  shift_by(1e-3, shift);
  const Vec3 before = f.force_w;
  f = friction_step(p, load_of(p, 3e-3, {}), memory);
  EXPECT_NEAR(f.force_w.x, before.x, 1e-15);  // pressing keeps the force
  shift_by(3e-3, -shift);
  f = friction_step(p, load_of(p, 1e-3, {}), memory);
  EXPECT_GT(work - f.energy_J, 0);  // dissipated, with what the spring still holds taken off
}

// Slide once round a circle of 10 mm under 5 N after breaking away; work done against friction.
Real circle_work(FrictionLaw law) {
  const FrictionParameters p = worked_parameters(law);
  FrictionMemory memory;
  friction_step(p, constant_load(p, {}), memory);
  const int steps = 20000;
  const Real radius = 0.01;
  Vec3 previous{radius, 0, 0}, force{};
  Real work = 0;
  for (int i = 1; i <= 2 * steps; ++i) {  // the first lap breaks away, the second is counted
    const Real angle = 2 * M_PI * i / steps;
    const Vec3 next{radius * std::cos(angle), radius * std::sin(angle), 0};
    const FrictionForce f = friction_step(p, constant_load(p, next - previous), memory);
    if (i > steps) work -= 0.5 * dot(f.force_w + force, next - previous);
    force = f.force_w;
    previous = next;
  }
  return work;
}

TEST(Friction, PapersShiftRuleDoesNoWorkOnACircleTheReturnMapDoes) {
  const Real coulomb = 2.5 * 2 * M_PI * 0.01;  // 0.157 J
  EXPECT_LT(std::abs(circle_work(FrictionLaw::kPaper)), 1e-3 * coulomb);
  // The body's stretch (2 mm) makes the origin run on a slightly smaller circle: sqrt(10^2 - 2.005^2) mm.
  EXPECT_NEAR(circle_work(FrictionLaw::kReturnMap), coulomb * std::sqrt(1 - 0.2005479644 * 0.2005479644), 1e-5);
  EXPECT_NEAR(circle_work(FrictionLaw::kReturnMap), 0.1539, 1e-4);
}

TEST(Friction, NoiseAfterASlideShakesThePapersForceNotTheReturnMaps) {
  for (const FrictionLaw law : {FrictionLaw::kPaper, FrictionLaw::kReturnMap}) {
    const FrictionParameters p = worked_parameters(law);
    FrictionMemory memory;
    friction_step(p, constant_load(p, {}), memory);
    for (int i = 0; i < 400; ++i) friction_step(p, constant_load(p, {1e-5, 0, 0}), memory);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<Real> noise(-1e-5, 1e-5);
    Real lowest = 1e9, highest = 0, at = 0;
    for (int i = 0; i < 2000; ++i) {
      const Real next = noise(random);
      const Real f = norm(friction_step(p, constant_load(p, {next - at, 0, 0}), memory).force_w);
      at = next;
      lowest = std::min(lowest, f);
      highest = std::max(highest, f);
    }
    if (law == FrictionLaw::kPaper) {
      EXPECT_GT(highest - lowest, 1.2);  // jumps between sliding and static limits, 2.5 and 4 N
    } else {
      EXPECT_LT(highest - lowest, 0.15);  // 20 um at the tangent stiffness of 3.6 kN/m is 0.07 N
    }
  }
}

// Four regions pushed about at random: those told to stick are as friction_step() has them, and nobody else sticks.
TEST(Friction, FourThatStickAreTheSameToTheBit) {
  std::mt19937_64 random(5);
  std::normal_distribution<Real> normal;
  std::uniform_real_distribution<Real> pressed(0, 5);
  FrictionParameters p = worked_parameters();
  p.contact.max_depth_m = 1e-3;  // so that some stretches are beyond the range
  int stuck = 0, slipped = 0;
  for (const Real beta : {0.75, 1.0, 0.8}) {
    p.beta = beta;
    ASSERT_TRUE(sticks_by_fours(p));
    FrictionMemory memory[4];
    for (int tick = 0; tick < 2000; ++tick) {
      FrictionLoad load[4];
      FrictionLoad4 four{};
      Vec3x4 stretch{};
      std::uint32_t touched = 0, slipping = 0;
      for (std::uint32_t k = 0; k < 4; ++k) {
        const Vec3 up = unit_or({normal(random), normal(random), normal(random)}, kUp);
        const Real scale = tick % 50 == 0 ? 0.0 : 1e-3;
        load[k] = load_of(p, 1e-3, scale * Vec3{normal(random), normal(random), normal(random)});
        load[k].normal_w = up;
        load[k].force_N = pressed(random);
        four.step_w.set(k, load[k].step_w);
        four.normal_w.set(k, up);
        four.force_N[k] = load[k].force_N;
        stretch.set(k, memory[k].stretch_w);
        touched |= memory[k].mode != FrictionMode::kFree ? 1u << k : 0u;
        slipping |= memory[k].mode == FrictionMode::kSlip ? 1u << k : 0u;
      }
      const Sticking4 told = stick_four(p, four, stretch, touched, slipping);
      for (std::uint32_t k = 0; k < 4; ++k) {
        const bool touched_before = memory[k].mode != FrictionMode::kFree;
        const FrictionForce one = friction_step(p, load[k], memory[k]);
        if ((told.which >> k & 1) == 0) {
          slipped += touched_before ? 1 : 0;
          EXPECT_TRUE(!touched_before || memory[k].mode == FrictionMode::kSlip);
          continue;
        }
        stuck += 1;
        ASSERT_EQ(told.force_w[k], one.force_w);
        ASSERT_EQ(told.direction_w[k], one.direction_w);
        ASSERT_EQ(told.stretch_w[k], memory[k].stretch_w);
        ASSERT_EQ((told.slip >> k & 1) != 0, memory[k].mode == FrictionMode::kSlip);
        ASSERT_EQ(told.energy_J[k], one.energy_J);
        ASSERT_EQ(told.along_N_per_m[k], one.along_N_per_m);
        ASSERT_EQ(told.across_N_per_m[k], one.across_N_per_m);
        ASSERT_EQ(one.normal_gain_N, 0);
        ASSERT_EQ(one.reversal_N_per_m, 0);
      }
    }
  }
  EXPECT_GT(stuck, 5000);
  EXPECT_GT(slipped, 2000);
}

TEST(Friction, TurnsWithTheFrame) {
  const FrictionParameters p = worked_parameters();
  const Quat turn = normalised({0.3, -0.5, 0.7, 0.2});
  FrictionMemory memory, turned;
  std::mt19937_64 random(12);
  std::uniform_real_distribution<Real> step(-1e-3, 1e-3);
  for (int i = 0; i < 200; ++i) {
    FrictionLoad load = constant_load(p, {step(random), step(random), 0});
    const FrictionForce f = friction_step(p, load, memory);
    load.step_w = rotate(turn, load.step_w);
    load.normal_w = rotate(turn, load.normal_w);
    const FrictionForce g = friction_step(p, load, turned);
    EXPECT_LT(norm(g.force_w - rotate(turn, f.force_w)), 1e-10);
    EXPECT_EQ(memory.mode, turned.mode);
  }
}

TEST(Friction, StiffnessIsTheDerivativeOfTheForce) {
  for (const TangentialLaw tangential : {TangentialLaw::kSeparable, TangentialLaw::kRadial}) {
    FrictionParameters p = worked_parameters();
    p.tangential = tangential;
    FrictionMemory base{{1e-3, 0.4e-3, 0}, 0, FrictionMode::kStick};
    const FrictionForce f = friction_step(p, constant_load(p, {}), base);
    ASSERT_EQ(base.mode, FrictionMode::kStick);
    const Real h = 1e-8;
    const Vec3 e = f.direction_w, c = cross(kUp, e);
    FrictionMemory along = base, across = base;
    const Vec3 df = friction_step(p, constant_load(p, h * e), along).force_w - f.force_w;
    const Vec3 dg = friction_step(p, constant_load(p, h * c), across).force_w - f.force_w;
    EXPECT_NEAR(-dot(df, e) / h, f.along_N_per_m, 1e-4 * f.along_N_per_m);
    EXPECT_NEAR(-dot(dg, c) / h, f.across_N_per_m, 1e-4 * f.across_N_per_m);
  }
}

TEST(Friction, BadInputIsHarmless) {
  for (const FrictionLaw law :
       {FrictionLaw::kNone, FrictionLaw::kReturnMap, FrictionLaw::kPaper, FrictionLaw::kMindlin}) {
    FrictionParameters p = worked_parameters(law);
    const auto check = [&](FrictionLoad load, FrictionMemory memory) {
      const FrictionForce f = friction_step(p, load, memory);
      EXPECT_TRUE(is_finite(f.force_w) && is_finite(f.energy_J) && is_finite(memory.stretch_w));
      EXPECT_TRUE(is_finite(f.along_N_per_m) && is_finite(f.across_N_per_m));
    };
    const FrictionMemory stuck{{1e-3, 0, 0}, 100, FrictionMode::kStick};
    check(constant_load(p, {kNan, 0, 0}), stuck);
    check(constant_load(p, {1e300, 0, 0}), stuck);
    check(constant_load(p, {}), {{kNan, 0, 0}, 0, FrictionMode::kSlip});
    FrictionLoad load = constant_load(p, {1e-3, 0, 0});
    for (const Real force : {0.0, -1.0, kNan}) {
      load.force_N = force;
      load.depth_m = 0;
      load.tangent_N_per_m = 0;
      check(load, stuck);
      FrictionMemory memory = stuck;
      EXPECT_EQ(norm(friction_step(p, load, memory).force_w), 0) << "no load, no friction";
    }
    p.k_N = kNan;
    p.mu_dynamic = kNan;
    check(constant_load(p, {1e-3, 0, 0}), stuck);
  }
  FrictionMemory memory{{1e-3, 0, 0}, 5, FrictionMode::kStick};
  const FrictionParameters none = worked_parameters(FrictionLaw::kNone);
  EXPECT_EQ(norm(friction_step(none, constant_load(none, {1e-3, 0, 0}), memory).force_w), 0);
  EXPECT_EQ(memory.mode, FrictionMode::kFree);
}

}  // namespace
}  // namespace palpate
