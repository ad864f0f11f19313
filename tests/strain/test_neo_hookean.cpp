// Slopes and curvatures of the neo-Hookean energy against differences of what they are derivatives of.
#include "config/fem/neo_hookean.h"

#include <gtest/gtest.h>

#include <random>

namespace palpate::fem {
namespace {

constexpr double kShear_Pa = 2, kBulk_Pa = 7;

template <int kDim>
Gradient<kDim> slope_at(const Gradient<kDim>& f) {
  const VolumeRatio<kDim> v = volume_ratio(f);
  return distortion_energy<kDim>(f, v, kShear_Pa).slope + kBulk_Pa * (v.value - 1) * v.slope;
}
template <int kDim>
double energy_at(const Gradient<kDim>& f) {
  const VolumeRatio<kDim> v = volume_ratio(f);
  return distortion_energy<kDim>(f, v, kShear_Pa).value + 0.5 * kBulk_Pa * (v.value - 1) * (v.value - 1);
}

template <int kDim>
class NeoHookean : public ::testing::Test {
 protected:
  // Near the identity, with J > 0.
  Gradient<kDim> any_gradient() {
    std::uniform_real_distribution<double> value(-0.25, 0.25);
    Gradient<kDim> f = Gradient<kDim>::Zero();
    for (int d = 0; d < kDim; ++d) f[d * kDim + d] = 1;
    if (kDim == 2) f[4] = 1;
    for (double& x : f) x += value(random_);
    return f;
  }
  std::mt19937 random_{3};
};

// Central differences of step h err by h^2 of a third derivative, here below 1e3, and by rounding over h.
constexpr double kStep = 1e-5, kTolerance = 1e3 * kStep * kStep + 1e-14 / kStep;

template <int kDim>
void expect_derivatives(const Gradient<kDim>& f) {
  const VolumeRatio<kDim> v = volume_ratio(f);
  ASSERT_GT(v.value, 0);
  const GradientSquare<kDim> curvature =
      energy_curvature(f, v, distortion_energy<kDim>(f, v, kShear_Pa), kBulk_Pa * (v.value - 1), kBulk_Pa);
  for (int i = 0; i < kGradientSize<kDim>; ++i) {
    const Gradient<kDim> step = kStep * Gradient<kDim>::Unit(i);
    EXPECT_NEAR(
        (volume_ratio(Gradient<kDim>(f + step)).value - volume_ratio(Gradient<kDim>(f - step)).value) / (2 * kStep),
        v.slope[i], kTolerance);
    EXPECT_NEAR((energy_at<kDim>(f + step) - energy_at<kDim>(f - step)) / (2 * kStep), slope_at<kDim>(f)[i],
                kTolerance);
    const Gradient<kDim> column = (slope_at<kDim>(f + step) - slope_at<kDim>(f - step)) / (2 * kStep);
    EXPECT_LT((column - curvature.col(i)).cwiseAbs().maxCoeff(), kTolerance) << i;
  }
}

using NeoHookeanInSpace = NeoHookean<3>;
using NeoHookeanInThePlane = NeoHookean<2>;
TEST_F(NeoHookeanInSpace, HasTheDerivativesOfItsEnergy) {
  for (int i = 0; i < 50; ++i) expect_derivatives<3>(any_gradient());
}
TEST_F(NeoHookeanInThePlane, HasTheDerivativesOfItsEnergy) {
  for (int i = 0; i < 50; ++i) expect_derivatives<2>(any_gradient());
}

}  // namespace
}  // namespace palpate::fem
