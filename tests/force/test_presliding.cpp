// Pre-sliding friction in two dimensions: exact under sub-division, free of drift, passive, bounded.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "rt_core/contact/friction.h"

namespace palpate {
namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
const Vec3 kUp{0, 0, 1};

Vec3 walk(const std::vector<Vec3>& path, Real slip, int parts) {
  Vec3 stretch;
  for (const Vec3& step : path)
    for (int i = 0; i < parts; ++i) stretch = preslide(stretch, (1.0 / parts) * step, slip).stretch_w;
  return stretch;
}

// Worked values, computed independently with 1e5 radial returns per step.
TEST(Presliding, TractrixIsIndependentOfTheStep) {
  const std::vector<Vec3> path{{0.5, 0, 0}, {0, 0.3, 0}, {-0.1, 0.05, 0}};
  for (const int parts : {1, 2, 3, 17, 1000}) {
    const Vec3 z = walk(path, 0.2, parts);
    EXPECT_NEAR(z.x, -0.01785466, 1e-8) << parts;
    EXPECT_NEAR(z.y, 0.19920143, 1e-8) << parts;
  }
  const Presliding one = preslide({0.1, 0.1, 0}, {0.3, 0, 0}, 0.2);
  EXPECT_NEAR(one.stretch_w.x, 0.19704885, 1e-8);
  EXPECT_NEAR(one.stretch_w.y, 0.03423083, 1e-8);
  EXPECT_TRUE(one.sliding);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<Real> step(-0.4, 0.4);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Vec3> wander;
    for (int i = 0; i < 30; ++i) wander.push_back({step(random), step(random), 0});
    EXPECT_LT(norm(walk(wander, 0.2, 1) - walk(wander, 0.2, 37)), 1e-12);
  }
}

TEST(Presliding, FollowsTheMotionAndNeverLeavesTheCircle) {
  std::mt19937_64 random(8);
  std::normal_distribution<Real> size(-3, 3);
  std::uniform_real_distribution<Real> angle(0, 2 * M_PI);
  Vec3 stretch;
  for (int i = 0; i < 20000; ++i) {
    const Real length = std::pow(10, size(random)), a = angle(random);
    const Vec3 step{length * std::cos(a), length * std::sin(a), 0};
    const Presliding moved = preslide(stretch, step, 0.2);
    ASSERT_LE(norm(moved.stretch_w), 0.2 * (1 + 1e-12));
    // Sliding pulls the stretch towards the motion.
    if (moved.sliding) {
      ASSERT_GE(dot(moved.stretch_w, step), -1e-12 * length);
    }
    stretch = moved.stretch_w;
  }
  // Straight against the stretch: through the middle, no division by the vanishing side.
  const Presliding back = preslide({-0.2, 0, 0}, {1, 0, 0}, 0.2);
  EXPECT_DOUBLE_EQ(back.stretch_w.x, 0.2);
  EXPECT_EQ(norm(preslide({0.1, 0, 0}, {0, 0, 0}, 0.2).stretch_w - Vec3{0.1, 0, 0}), 0);
  EXPECT_EQ(norm(preslide({0.1, 0, 0}, {0.3, 0, 0}, 0).stretch_w), 0);
  EXPECT_TRUE(is_finite(preslide({0.1, 0, 0}, {1e11, 1, 0}, 0.2).stretch_w));
}

FrictionParameters parameters_of(FrictionLaw law, Real mu = 0.5) {
  FrictionParameters p;
  p.law = law;
  p.k_N = mu;
  p.beta = 1;
  p.mu_dynamic = mu;
  p.slip_m = 0.2e-3;
  p.mindlin_ratio = 0.71;
  return p;
}
FrictionLoad load_of(Real force_N, Vec3 step) {
  FrictionLoad load;
  load.normal_w = kUp;
  load.force_N = force_N;
  // Hertz: stiffness grows like the cube root of the force; 10 kN/m at 10 N.
  load.tangent_N_per_m = 1e4 * std::cbrt(max_of(force_N, 0.0) / 10);
  load.step_w = step;
  return load;
}

// Encoder dither of 30 um at a held force does not move the adhesion point at all; Dahl's law creeps under it.
TEST(Presliding, DoesNotDriftUnderDither) {
  const FrictionParameters p = parameters_of(FrictionLaw::kPresliding);
  FrictionMemory memory;
  friction_step(p, load_of(10, {}), memory);
  friction_step(p, load_of(10, {0.3e-3, 0.1e-3, 0}), memory);
  const Vec3 start = memory.stretch_w;
  const Real d = 0x1p-15;  // 30.5 um, a power of two: the sums of the steps are exact
  Vec3 place = start;
  std::mt19937_64 random(1);
  for (int i = 0; i < 200000; ++i) {
    const Vec3 target = start + Vec3{random() % 2 ? d : 0.0, random() % 2 ? d : 0.0, 0};
    friction_step(p, load_of(10, target - place), memory);
    place = target;
  }
  friction_step(p, load_of(10, start - place), memory);
  // 2e5 roundings of 3e-4 m in a random walk: 450 of 5e-20 m.
  EXPECT_LT(norm(memory.stretch_w - start), 1e-16);
}

// Sliding force is mu F_n along the motion, whatever the direction; friction vanishes with the load.
TEST(Presliding, LimitIsCoulomb) {
  for (const FrictionLaw law : {FrictionLaw::kPresliding, FrictionLaw::kPreslidingPaper}) {
    const FrictionParameters p = parameters_of(law);
    FrictionMemory memory;
    friction_step(p, load_of(14, {}), memory);
    FrictionForce f;
    for (int i = 0; i < 500; ++i) f = friction_step(p, load_of(14, {6e-5, -8e-5, 0}), memory);
    EXPECT_NEAR(f.force_w.x, -0.6 * 7, 1e-9);  // 7 N at 14 N: Mahvash & Hayward 2002, figure 8
    EXPECT_NEAR(f.force_w.y, 0.8 * 7, 1e-9);
    EXPECT_EQ(memory.mode, FrictionMode::kSlip);
    EXPECT_EQ(f.along_N_per_m, 0);
    const FrictionForce none = friction_step(p, load_of(0, {1e-4, 0, 0}), memory);
    EXPECT_EQ(norm(none.force_w), 0);
  }
}

struct Loop {
  Real work_J = 0, moved_J = 0;
};
// Work done on the tool's user against friction over a random closed path while the normal force varies.
Loop random_loop(const FrictionParameters& p, std::mt19937_64& random, int steps, Real reach) {
  std::uniform_real_distribution<Real> symmetric(-1, 1);
  std::array<Real, 9> a{};
  for (Real& x : a) x = symmetric(random);
  const auto place = [&](Real t) {
    const Real w = 2 * M_PI;
    return Vec3{reach * (a[0] * std::sin(w * t) + a[1] * std::sin(2 * w * t) + a[2] * std::sin(3 * w * t)),
                reach * (a[3] * std::sin(w * t) + a[4] * std::sin(2 * w * t) + a[5] * std::sin(3 * w * t)), 0};
  };
  const auto force = [&](Real t) {
    return 5.5 + 4.5 * std::sin(2 * M_PI * t * (1 + static_cast<int>(3 * std::abs(a[6]))) + 6 * a[7]);
  };
  FrictionMemory memory;
  Vec3 last_place = place(0), last_force;
  Loop loop;
  // Round the path thrice: what matters is what a cycle returns.
  for (int i = 0; i <= 3 * steps; ++i) {
    const Real t = static_cast<Real>(i) / steps;
    const FrictionForce f = friction_step(p, load_of(force(t), place(t) - last_place), memory);
    const Real done = -0.5 * dot(f.force_w + last_force, place(t) - last_place);
    if (i > 2 * steps) loop.work_J += done;
    if (i > 2 * steps) loop.moved_J += std::abs(done);
    last_place = place(t);
    last_force = f.force_w;
  }
  return loop;
}

TEST(Presliding, PassiveWhenTheNormalForceChanges) {
  std::mt19937_64 random(21);
  for (const Real reach : {2e-5, 2e-4, 2e-3}) {
    for (int i = 0; i < 100; ++i) {
      const Loop loop = random_loop(parameters_of(FrictionLaw::kPresliding), random, 2000, reach);
      // The trapezoidal rule over 2000 steps of a path of a few periods errs by less than 1e-4 of what moved.
      EXPECT_GE(loop.work_J, -1e-4 * loop.moved_J);
    }
  }
}

// The published form returns mu (F_2 - F_1) z^2/(2 z_max) of every loop {shift at F_1, press to F_2, shift back}:
// 0.2531 mJ for mu = 0.5, z_max = 0.2 mm, z = 0.15 mm, 1 to 10 N. Ours returns nothing.
TEST(Presliding, PublishedFormReturnsEnergy) {
  for (const FrictionLaw law : {FrictionLaw::kPreslidingPaper, FrictionLaw::kPresliding}) {
    FrictionParameters p = parameters_of(law);
    FrictionMemory memory;
    friction_step(p, load_of(1, {}), memory);
    Real work = 0;
    Vec3 last;
    const auto shift = [&](Real from, Real to, Real force) {
      for (int i = 0; i < 1000; ++i) {
        const Vec3 step{(to - from) / 1000, 0, 0};
        const Vec3 f = friction_step(p, load_of(force, step), memory).force_w;
        work += 0.5 * dot(f + last, step);  // by the tool on its user
        last = f;
      }
    };
    shift(0, 0.15e-3, 1);
    for (int i = 1; i <= 900; ++i) last = friction_step(p, load_of(1 + 0.01 * i, {}), memory).force_w;
    shift(0.15e-3, 0, 10);
    if (law == FrictionLaw::kPreslidingPaper) {
      EXPECT_NEAR(work, 0.253125e-3, 1e-9);
    } else {
      EXPECT_LT(work, 0);
    }
  }
}

TEST(Presliding, StiffnessIsTheDerivativeOfTheForce) {
  const FrictionParameters p = parameters_of(FrictionLaw::kPresliding);
  FrictionMemory base{{1e-4, 0.4e-4, 0}, 0.71e4, FrictionMode::kStick};
  const FrictionForce f = friction_step(p, load_of(10, {}), base);
  ASSERT_EQ(base.mode, FrictionMode::kStick);
  FrictionMemory along = base, across = base;
  const Real h = 1e-8;
  const Vec3 e = f.direction_w, c = cross(kUp, e);
  const Vec3 df = friction_step(p, load_of(10, h * e), along).force_w - f.force_w;
  const Vec3 dg = friction_step(p, load_of(10, h * c), across).force_w - f.force_w;
  EXPECT_NEAR(-dot(df, e) / h, f.along_N_per_m, 1e-4 * f.along_N_per_m);
  EXPECT_NEAR(-dot(dg, c) / h, f.across_N_per_m, 1e-4 * f.across_N_per_m);
}

TEST(Presliding, BadInputIsHarmless) {
  for (const FrictionLaw law : {FrictionLaw::kPresliding, FrictionLaw::kPreslidingPaper}) {
    for (const Real force : {kNan, -1.0, 0.0, 5.0, 1e300}) {
      for (const Real step : {kNan, 1e300, 1e-300, 1e-4}) {
        for (const Real slip : {0.0, 1e-4, kNan}) {
          FrictionParameters p = parameters_of(law);
          p.slip_m = slip;
          FrictionMemory memory{{1e-4, 0, 0}, 1e3, FrictionMode::kStick};
          const FrictionForce f = friction_step(p, load_of(force, {step, 0, 0}), memory);
          EXPECT_TRUE(is_finite(f.force_w) && is_finite(memory.stretch_w) && is_finite(f.energy_J));
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate
