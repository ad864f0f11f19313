// The exact layer and curvature solutions against published and independently computed values.
#include <gtest/gtest.h>

#include <cmath>

#include "config/response/layer_contact.h"

namespace palpate {
namespace {

// F / (2 a E* d) of a flat punch at a/h, from an independent solution of the same integral equations with 200 points.
TEST(Layer, FlatPunchFactors) {
  const struct {
    double nu;
    LayerBase base;
    double ratio[4], factor[4];
  } rows[] = {{0.3, LayerBase::kBonded, {0.05, 0.2, 1, 2}, {1.04576, 1.20656, 2.48352, 4.35324}},
              {0.45, LayerBase::kBonded, {0.05, 0.2, 1, 2}, {1.05447, 1.25234, 3.09141, 6.42059}},
              {0.49, LayerBase::kBonded, {0.05, 0.2, 1, 2}, {1.05843, 1.27412, 3.48398, 8.33700}},
              {0.5, LayerBase::kBonded, {0.05, 0.2, 1, 2}, {1.05960, 1.28064, 3.61874, 9.14945}},
              {0.3, LayerBase::kSlip, {0.05, 0.2, 1, 2}, {1.03855, 1.17103, 2.19862, 3.72761}}};
  for (const auto& row : rows) {
    const LayerContact contact({1.0, row.nu, row.base}, 2.0);
    for (int k = 0; k < 4; ++k) {
      const LayerState state = contact.at_radius({TipProfile::kFlat, row.ratio[k], 0}, row.ratio[k]);
      EXPECT_NEAR(state.force_m2 / (2 * row.ratio[k]), row.factor[k], 6e-6) << row.nu << " " << row.ratio[k];
    }
  }
}

TEST(Layer, SphereFactors) {
  const struct {
    double nu;
    LayerBase base;
    double chi[5], factor[5];
  } rows[] = {
      {0.3, LayerBase::kBonded, {0.02, 0.1, 0.5, 1, 1.5}, {1.01789, 1.09719, 1.71698, 2.91970, 4.29274}},
      {0.45, LayerBase::kBonded, {0.02, 0.1, 0.5, 1, 1.5}, {1.02120, 1.11709, 1.96710, 3.97408, 6.66935}},
      {0.5, LayerBase::kBonded, {0.02, 0.1, 0.5, 1, 1.5}, {1.02314, 1.12908, 2.15622, 5.11537, 10.30451}},
      {0.5, LayerBase::kSlip, {0.02, 0.1, 0.5, 1, 1.5}, {1.01513, 1.08111, 1.56684, 2.50450, 3.60524}},
  };
  for (const auto& row : rows) {
    const LayerContact contact({1.0, row.nu, row.base}, 3.0);
    for (int k = 0; k < 5; ++k) {
      const double radius = 2.0, depth = row.chi[k] * row.chi[k] / radius;
      const LayerState state = contact.at_depth({TipProfile::kParabola, radius, 0}, depth);
      const double hertz = 4.0 / 3 * std::sqrt(radius) * std::pow(depth, 1.5);
      EXPECT_NEAR(state.force_m2 / hertz, row.factor[k], 1e-5) << row.nu << " " << row.chi[k];
    }
  }
}

TEST(Layer, ConeFactors) {
  const double eta[] = {0.07651, 0.28298, 0.61945, 1.09044}, factor[] = {1.05375, 1.23919, 1.72102, 2.85717};
  const LayerContact contact({1.0, 0.45, LayerBase::kBonded}, 2.0);
  for (int k = 0; k < 4; ++k) {
    const double tangent = 1.7, depth = eta[k] / tangent;
    const LayerState state = contact.at_depth({TipProfile::kCone, 0, tangent}, depth);
    // eta is given to five digits, and the factor's slope is up to 2.2.
    EXPECT_NEAR(state.force_m2 / (2 / M_PI * tangent * depth * depth), factor[k], 3e-5);
  }
}

// Without a layer the same solver must give the closed forms; the exact sphere's are F = E* [(a^2 + R^2)/2 ln((R + a)/
// (R - a)) - a R] at d = (a/2) ln((R + a)/(R - a)) (Segedin 1957).
TEST(Layer, HalfSpaceIsExact) {
  const LayerContact contact({}, 1.0);
  for (const double q : {1e-3, 0.1, 0.5, 0.8}) {
    const double radius = 3.0, a = q * radius, l = 2 * std::atanh(q);
    const double depth = 0.5 * a * l;
    const LayerState state = contact.at_depth({TipProfile::kSphere, radius, 0}, depth);
    const double force = 0.5 * (a * a + radius * radius) * l - a * radius;
    // At small q the closed form itself loses q^-2 digits.
    EXPECT_NEAR(state.force_m2, force, (1e-12 + 3e-16 / q / q) * force);
    EXPECT_NEAR(state.stiffness_m, 2 * a, 1e-11 * a);
  }
  EXPECT_NEAR(contact.at_depth({TipProfile::kParabola, 2, 0}, 0.3).force_m2,
              4.0 / 3 * std::sqrt(2.0) * std::pow(0.3, 1.5), 1e-13);
  EXPECT_NEAR(contact.at_depth({TipProfile::kCone, 0, 2}, 0.3).force_m2, 2 / M_PI * 2 * 0.09, 1e-13);
}

// Thick layers approach the half space by k(0) F/(pi E*), thin bonded incompressible ones stiffen without bound, and
// nothing breaks at nu = 0.5, where the compressible limit's leading term vanishes.
TEST(Layer, Limits) {
  for (const double nu : {0.0, 0.3, 0.4999, 0.5}) {
    const LayerContact thick({1000.0, nu, LayerBase::kBonded}, 1.0);
    const LayerState state = thick.at_radius({TipProfile::kFlat, 1.0, 0}, 1.0);
    EXPECT_NEAR(state.force_m2 / 2 - 1, 2 / M_PI * thick.kernel_at_zero_per_m(), 2e-6);
  }
  const auto factor = [](double nu, double h) {
    return LayerContact({h, nu, LayerBase::kBonded}, 1.0).at_radius({TipProfile::kFlat, 1.0, 0}, 1.0).force_m2 / 2;
  };
  EXPECT_NEAR(factor(0.4999, 1.0), factor(0.5, 1.0), 1e-2 * factor(0.5, 1.0));
  // Thin and compressible: an elastic foundation of modulus M = E (1-nu)/((1+nu)(1-2 nu)), F = pi a^2 M d/h, plus its
  // edge. Between h/a = 0.25 and 0.125 the factor must double but for the edge term, which is of order h.
  const double thin = factor(0.3, 0.125), thinner = factor(0.3, 0.0625);
  const double foundation = M_PI / 2 * (1 - 0.09) * 0.7 / (1.3 * 0.4);
  EXPECT_NEAR((thinner - thin) * 0.125, foundation, 0.02 * foundation);
}

TEST(Layer, EllipticContactIsHertz) {
  // Errors of the geometric mean 1/sqrt(AB) against the exact elliptic contact, computed independently.
  const struct { double ratio, error_percent; } rows[] = {{1.27, -0.1}, {2, -1.0}, {3, -2.4}, {5, -5.1}, {10, -9.8}};
  for (const auto& row : rows) {
    const double mean = 1 / std::sqrt(row.ratio);
    const double error = 100 * (std::sqrt(mean / elliptic_radius_m(1, row.ratio)) - 1);
    EXPECT_NEAR(error, row.error_percent, 0.06) << row.ratio;
  }
  EXPECT_DOUBLE_EQ(elliptic_radius_m(4, 4), 0.25);
  // No step where the circle's formula takes over, and symmetric.
  EXPECT_NEAR(elliptic_radius_m(1, 1 + 1.1e-6), elliptic_radius_m(1, 1 + 0.9e-6), 3e-7);
  EXPECT_DOUBLE_EQ(elliptic_radius_m(1, 7), elliptic_radius_m(7, 1));
}

}  // namespace
}  // namespace palpate
