// Laws of single tips: forces, tangents and energies against closed forms and independently computed values.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "config/response/tip_bake.h"
#include "config/scene/config_error.h"
#include "rt_core/contact/region_solve.h"
#include "rt_core/contact/tips/travel.h"

namespace palpate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRubber_Pa = 3.45e6;  // E* of Mahvash & Hayward 2002

struct BakedTip {
  std::vector<FactorKnot> factor;
  TipLaw law;
  explicit BakedTip(const TipDesc& desc) : law(make_tip_law(desc, factor)) {}
  LocalLaw local() const { return {&law, law.first_factor < 0 ? nullptr : &factor[0]}; }
  Tip tip(double depth_m) const { return {local(), {}, TipKind::kPower, depth_m}; }
  TipRegion region(const Tip& tip) const { return {&tip, 1, {law.c0_m_per_N, law.c1_m_per_N2, law.force_max_N}}; }
  double force(double depth_m) const { return local_at(local(), depth_m).force_N; }
};

TipDesc tip_of(Indenter indenter, double depth_max_m = 0.005) {
  TipDesc desc;
  desc.indenter = indenter;
  desc.modulus_Pa = kRubber_Pa;
  desc.depth_max_m = depth_max_m;
  return desc;
}

const double kTan30 = std::tan(M_PI / 6), kTan60 = std::tan(M_PI / 3);

// The rubber and the tools of Mahvash & Hayward 2002, section 4.
TEST(TipLaw, HalfSpaceForces) {
  const BakedTip flat(tip_of({TipProfile::kFlat, 1.6e-3, 0}));
  const BakedTip large(tip_of({TipProfile::kParabola, 6.35e-3, 0})), small(tip_of({TipProfile::kParabola, 1.6e-3, 0}));
  EXPECT_NEAR(flat.force(0.5e-3), 5.52, 1e-9 * 5.52);
  EXPECT_NEAR(large.force(1e-3), 4.0 / 3 * std::sqrt(6.35e-3) * kRubber_Pa * std::pow(1e-3, 1.5), 1e-9 * 11.6);
  EXPECT_NEAR(large.force(1e-3), 11.591635, 1e-6);
  EXPECT_NEAR(small.force(1e-3), 5.818591, 1e-6);
  EXPECT_NEAR(small.force(1.8e-3), 14.051626, 1e-6);  // "around 14 N", their figure 8
  const double cone[] = {1.268056, 2.196338, 3.804169}, tangent[] = {kTan30, 1.0, kTan60};
  for (int k = 0; k < 3; ++k) {
    const BakedTip tip(tip_of({TipProfile::kCone, 0, tangent[k]}));
    EXPECT_NEAR(tip.force(1e-3), cone[k], 1e-6);
    EXPECT_NEAR(tip.force(1e-3), 2 / M_PI * tangent[k] * 3.45, 1e-9);
  }
}

// A true sphere, from its table, against the closed form over contact radius (Segedin 1957) to 1e-9 over the range.
TEST(TipLaw, ExactSphereToNanoPart) {
  const double radius = 6.35e-3;
  const BakedTip tip(tip_of({TipProfile::kSphere, radius, 0}, radius));
  ASSERT_EQ(tip.law.first_factor, 0);
  double worst = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double q = 0.83 * i / 2000, l = 2 * std::atanh(q);
    const double depth = 0.5 * radius * q * l;
    if (depth > tip.law.depth_max_m) break;
    // (q^2 + 1) atanh q - q, by its series where it cancels.
    double shape = (1 + q * q) * std::atanh(q) - q;
    if (q < 0.3) {
      shape = 0;
      for (int k = 30; k >= 1; --k) shape += 4.0 * k / (4.0 * k * k - 1) * std::pow(q, 2 * k + 1);
    }
    const double force = kRubber_Pa * radius * radius * shape;
    worst = std::max(worst, std::abs(tip.force(depth) / force - 1));
  }
  std::printf("  exact sphere: largest relative error of the table %.2g\n", worst);
  EXPECT_LT(worst, 1e-9);
  EXPECT_NEAR(tip.force(1e-3), 11.40878, 5e-6);
  EXPECT_NEAR(tip.force(2e-3), 31.75040, 5e-6);
  EXPECT_NEAR(tip.force(3e-3), 57.37556, 5e-6);
}

// Between the table's knots the layer's factor is that of the integral equations, and forces never fall or jump.
TEST(TipLaw, LayerTablesFollowTheIntegralEquations) {
  for (const Indenter& indenter : {Indenter{TipProfile::kParabola, 6.35e-3, 0},
                                   Indenter{TipProfile::kSphere, 6.35e-3, 0}, Indenter{TipProfile::kCone, 0, 1.0}}) {
    for (const double nu : {0.3, 0.49, 0.5}) {
      TipDesc desc = tip_of(indenter);
      desc.layer = {10e-3, nu, LayerBase::kBonded};
      const BakedTip tip(desc);
      const LayerContact exact(desc.layer, 0.02);
      for (int i = 1; i < 60; ++i) {
        const double depth = desc.depth_max_m * i * (i + 0.37) / 3600;
        const LayerState state = exact.at_depth(indenter, depth);
        const LawPoint point = local_at(tip.local(), depth);
        EXPECT_NEAR(point.force_N, kRubber_Pa * state.force_m2, 1e-9 * point.force_N) << depth;
        EXPECT_NEAR(point.tangent_N_per_m, kRubber_Pa * state.stiffness_m, 1e-6 * point.tangent_N_per_m) << depth;
      }
    }
  }
  TipDesc flat = tip_of({TipProfile::kFlat, 1.6e-3, 0});
  flat.modulus_Pa = 1e6 / (1 - 0.45 * 0.45);
  flat.layer = {3.2e-3, 0.45, LayerBase::kBonded};
  EXPECT_NEAR(BakedTip(flat).force(1e-3), 7.24769, 1e-5);  // a/h = 0.5, E = 1 MPa
}

// Tangent and energy are derivative and integral of the force for every kind of law, at depth and beyond the range.
TEST(TipLaw, TangentAndEnergyBelongToTheForce) {
  std::vector<TipDesc> descs = {tip_of({TipProfile::kFlat, 1.6e-3, 0}), tip_of({TipProfile::kParabola, 6.35e-3, 0}),
                                tip_of({TipProfile::kSphere, 6.35e-3, 0}), tip_of({TipProfile::kCone, 0, kTan60})};
  for (std::size_t i = 0; i < 4; ++i) {
    descs.push_back(descs[i]);
    descs.back().layer = {10e-3, 0.49, LayerBase::kBonded};
  }
  for (const TipDesc& desc : descs) {
    const BakedTip tip(desc);
    for (const double depth : {1e-5, 1.2345e-3, 4.99e-3, 7e-3}) {
      const double h = 1e-4 * depth;
      const LawPoint point = local_at(tip.local(), depth);
      const double slope = (tip.force(depth + h) - tip.force(depth - h)) / (2 * h);
      const double work = (local_energy_J(tip.local(), depth + h) - local_energy_J(tip.local(), depth - h)) / (2 * h);
      EXPECT_NEAR(slope, point.tangent_N_per_m, 1e-6 * point.tangent_N_per_m);
      EXPECT_NEAR(work, point.force_N, 1e-6 * point.force_N);
    }
    // No gap where the law is continued.
    const double edge = desc.depth_max_m;
    EXPECT_NEAR(tip.force(edge * (1 - 1e-12)), tip.force(edge * (1 + 1e-12)), 1e-10 * tip.force(edge));
  }
  const BakedTip flat(descs[0]), sphere(descs[1]), cone(descs[3]);
  EXPECT_NEAR(local_energy_J(flat.local(), 1e-3), 1.6e-3 * kRubber_Pa * 1e-6, 1e-15);
  EXPECT_NEAR(local_energy_J(sphere.local(), 1e-3), 8.0 / 15 * std::sqrt(6.35e-3) * kRubber_Pa * std::pow(1e-3, 2.5),
              1e-15);
  EXPECT_NEAR(local_energy_J(cone.local(), 1e-3), 2 / (3 * M_PI) * kTan60 * kRubber_Pa * 1e-9, 1e-15);
}

// Beyond its range a layer stiffens towards its plate: force and tangent go on where the range ends, the energy belongs
// to them, and near the plate no device's force goes through.
TEST(TipLaw, ALayerStiffensToItsPlate) {
  TipDesc desc = tip_of({TipProfile::kParabola, 6.35e-3, 0}, 0.006);
  desc.modulus_Pa = 2e4 / (1 - 0.49 * 0.49);
  desc.layer = {0.010, 0.49, LayerBase::kBonded};
  const BakedTip layer(desc);
  EXPECT_EQ(layer.law.limit_m, 0.010);
  const LocalLaw law = layer.local();
  const LawPoint inside = local_at(law, 0.006), beyond = local_at(law, 0.006 + 1e-9);
  EXPECT_NEAR(beyond.force_N, inside.force_N, 1e-5);
  EXPECT_NEAR(beyond.tangent_N_per_m, inside.tangent_N_per_m, 1e-3);
  for (double e = 0.0061; e < 0.013; e += 1e-4) {  // past the last twentieth too
    const double h = 1e-8;
    EXPECT_NEAR((local_at(law, e + h).force_N - local_at(law, e - h).force_N) / (2 * h),
                local_at(law, e).tangent_N_per_m, 2e-3 * local_at(law, e).tangent_N_per_m);
    EXPECT_NEAR((local_energy_J(law, e + h) - local_energy_J(law, e - h)) / (2 * h), local_at(law, e).force_N,
                1e-4 * local_at(law, e).force_N);
  }
  EXPECT_GT(layer.force(0.0098), 32.767);  // what a command can carry
  EXPECT_EQ(BakedTip(tip_of({TipProfile::kParabola, 6.35e-3, 0})).law.limit_m, 0);
}

TEST(TipLaw, NothingPullsAndNothingBreaks) {
  const BakedTip tip(tip_of({TipProfile::kSphere, 6.35e-3, 0}));
  for (const double depth : {0.0, -1e-3, -1e300, kNan}) {
    EXPECT_EQ(tip.force(depth), 0);
    EXPECT_EQ(local_energy_J(tip.local(), depth), 0);
  }
  EXPECT_GT(tip.force(1e-300), 0.0 - 1e-300);
  EXPECT_TRUE(is_finite(tip.force(1e-300)) && is_finite(local_at(tip.local(), 1e-200).tangent_N_per_m));
  EXPECT_TRUE(std::isfinite(tip.force(1e300)));
}

// Solved with c0 and c1 as published for a hollow cylinder and an ellipsoid; the values were computed independently.
TEST(Series, WorkedForces) {
  TipDesc cylinder = tip_of({TipProfile::kParabola, 7.1082e-3, 0}, 0.02);
  cylinder.modulus_Pa = 3.76176e6;
  cylinder.c0_m_per_N = 0.080256e-3;
  cylinder.c1_m_per_N2 = 5.266e-7;
  TipDesc ellipsoid = tip_of({TipProfile::kParabola, 8.4211e-3, 0}, 0.02);
  ellipsoid.modulus_Pa = 3e6 / (1 - 0.45 * 0.45);
  ellipsoid.c0_m_per_N = 1.105e-6;
  ellipsoid.c1_m_per_N2 = 2.702e-9;
  const struct {
    const TipDesc& desc;
    double depth_mm, force_N, stiffness_N_per_mm;
  } rows[] = {{cylinder, 2, 12.21270, 6.92028},
              {cylinder, 4, 25.99709, 6.77594},
              {cylinder, 8, 51.57922, 6.01076},
              {ellipsoid, 2, 39.69126, 29.32212},
              {ellipsoid, 8, 295.26542, 51.29541}};
  for (const auto& row : rows) {
    const BakedTip baked(row.desc);
    const Tip tip = baked.tip(1e-3 * row.depth_mm);
    const TipRegion region = baked.region(tip);
    const TravelResult result = solve_travel(region);
    const LawPoint load = region_at(region, result.shift_m);
    EXPECT_NEAR(load.force_N, row.force_N, 2e-5 * row.force_N) << row.depth_mm;  // R_e and c1 are given to 5 digits
    const double k = load.tangent_N_per_m / (1 + far_slope_m_per_N(region.far, load.force_N) * load.tangent_N_per_m);
    EXPECT_NEAR(1e-3 * k, row.stiffness_N_per_mm, 5e-5 * row.stiffness_N_per_mm) << row.depth_mm;
    EXPECT_LT(result.residual_m, 1e-16);
  }
}

// The whole law is a potential: stiffness and energy follow from the force, also where c0 or c1 is negative (a body
// stiffer than the half space, or one that stiffens), beyond the range, and down to no depth at all.
TEST(Series, ConservativeForBothSignsOfTheFarField) {
  const struct { double c0, c1; } fields[] = {{8e-5, 5e-7}, {-7.54e-7, 4.22e-8}, {2e-5, -3e-8}, {-1e-6, -1e-9}};
  for (const auto& field : fields) {
    TipDesc desc = tip_of({TipProfile::kSphere, 6.35e-3, 0});
    desc.c0_m_per_N = field.c0;
    desc.c1_m_per_N2 = field.c1;
    const BakedTip baked(desc);
    double last = 0;
    const auto energy_at = [&](double depth, double& force) {
      const Tip tip = baked.tip(depth);
      const TipRegion region = baked.region(tip);
      const TravelResult result = solve_travel(region);
      force = region_at(region, result.shift_m).force_N;
      EXPECT_LT(result.residual_m, 1e-14);
      return tip_energy_J(tip, depth - result.shift_m) + far_energy_J(region.far, force);
    };
    for (int i = 1; i <= 400; ++i) {
      const double depth = 2.5e-5 * i, step = 1e-4 * depth;  // to twice the range
      double force = 0, unused = 0;
      energy_at(depth, force);
      const double slope = (energy_at(depth + step, unused) - energy_at(depth - step, unused)) / (2 * step);
      EXPECT_NEAR(slope, force, 1e-6 * force);
      EXPECT_GT(force, last);
      last = force;
    }
    double force = 0;
    for (const double depth : {0.0, 1e-12, 1e-9, 1e-7}) {
      energy_at(depth, force);
      EXPECT_GE(force, 0);
      EXPECT_LE(force, 1.2 * baked.force(depth) + 1e-300);
    }
  }
}

TEST(Series, UnstableFarFieldIsRefused) {
  TipDesc desc = tip_of({TipProfile::kParabola, 6.35e-3, 0});
  desc.c1_m_per_N2 = -1e-5;
  std::vector<FactorKnot> factor;
  EXPECT_THROW(make_tip_law(desc, factor), ConfigError);
  desc.c1_m_per_N2 = 0;
  desc.c0_m_per_N = -1e-3;
  EXPECT_THROW(make_tip_law(desc, factor), ConfigError);
}

// Two linear springs of 2 N/mm leaning on one another to second order: F = (3.7123698, 0.49494483) N at 2 and 1 mm.
TEST(Coupling, SecondOrderPair) {
  TipDesc desc = tip_of({TipProfile::kFlat, 1e-3, 0}, 0.01);
  desc.modulus_Pa = 1e6;
  const BakedTip baked(desc);
  ASSERT_NEAR(baked.law.coefficient, 2000, 1e-9);
  const Tip tip[2] = {baked.tip(2e-3), baked.tip(1e-3)};
  const TipRegion region[2] = {baked.region(tip[0]), baked.region(tip[1])};
  const Real c[4] = {0, 1e-4, 1e-4, 0}, h[4] = {0, 5e-5, 2e-5, 0};
  RegionSystem solve;
  const RegionSolution result = solve_regions(TipLaws{region, {c, h}, 2}, 2, solve);
  EXPECT_FALSE(result.singular);
  EXPECT_LT(result.residual_m, 1e-14);
  EXPECT_NEAR(solve.force_N[0], 3.7123698, 1e-7);
  EXPECT_NEAR(solve.force_N[1], 0.49494483, 1e-8);
}

// Any closed path of the two depths returns what it took: the forces are the gradient of the energy.
TEST(Coupling, EnergyIsThePotentialOfTheForces) {
  TipDesc desc = tip_of({TipProfile::kSphere, 6.35e-3, 0});
  desc.c0_m_per_N = 2e-5;
  desc.c1_m_per_N2 = 1e-8;
  const BakedTip baked(desc);
  const Real c[9] = {0, 1e-5, 4e-6, 1e-5, 0, 6e-6, 4e-6, 6e-6, 0};
  const Real h[9] = {0, 1e-7, 2e-8, 5e-8, 0, 3e-8, 1e-8, 4e-8, 0};
  const auto energy_at = [&](const double(&depth)[3], double(&force)[3]) {
    Tip tip[3];
    TipRegion region[3];
    for (int i = 0; i < 3; ++i) {
      tip[i] = baked.tip(depth[i]);
      region[i] = baked.region(tip[i]);
    }
    RegionSystem solve;
    EXPECT_LT(solve_regions(TipLaws{region, {c, h}, 3}, 3, solve).residual_m, 1e-13);
    double energy = coupling_energy_J(3, {c, h}, solve.force_N);
    for (int i = 0; i < 3; ++i) {
      force[i] = solve.force_N[i];
      energy += tip_energy_J(tip[i], depth[i] - solve.shift_m[i]) + far_energy_J(region[i].far, force[i]);
    }
    return energy;
  };
  const double base[][3] = {{3e-3, 1e-3, 2e-3}, {3e-3, 1e-5, 0}, {4e-3, 4e-3, 4e-3}, {3e-3, -1e-3, 2e-3}};
  for (const auto& depth : base) {
    double force[3], unused[3];
    energy_at(depth, force);
    for (int i = 0; i < 3; ++i) {
      const double step = 1e-8;
      double up[3] = {depth[0], depth[1], depth[2]}, down[3] = {depth[0], depth[1], depth[2]};
      up[i] += step;
      down[i] -= step;
      const double slope = (energy_at(up, unused) - energy_at(down, unused)) / (2 * step);
      EXPECT_NEAR(slope, force[i], 1e-6 * force[i] + 1e-6);
      EXPECT_GE(force[i], 0);
    }
  }
}

}  // namespace
}  // namespace palpate
