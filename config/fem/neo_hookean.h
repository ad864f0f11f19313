// Neo-Hookean solid, W = G/2 (J^-2/3 I1 - 3) + K/2 (J - 1)^2, first and second derivatives in the deformation gradient.
// In the plane F = (F11, F12, F21, F22, F33); in space the nine entries row by row.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace palpate::fem {

template <int kDim>
inline constexpr int kGradientSize = kDim == 2 ? 5 : 9;
template <int kDim>
using Gradient = Eigen::Matrix<double, kGradientSize<kDim>, 1>;
template <int kDim>
using GradientSquare = Eigen::Matrix<double, kGradientSize<kDim>, kGradientSize<kDim>>;

// J = det F with its gradient, the cofactors of F.
template <int kDim>
struct VolumeRatio {
  double value = 0;
  Gradient<kDim> slope = Gradient<kDim>::Zero();
};

inline VolumeRatio<2> volume_ratio(const Gradient<2>& f) {
  VolumeRatio<2> v;
  const double in_plane = f[0] * f[3] - f[1] * f[2];
  v.value = f[4] * in_plane;
  v.slope << f[4] * f[3], -f[4] * f[2], -f[4] * f[1], f[4] * f[0], in_plane;
  return v;
}

inline VolumeRatio<3> volume_ratio(const Gradient<3>& f) {
  VolumeRatio<3> v;
  v.slope << f[4] * f[8] - f[5] * f[7], f[5] * f[6] - f[3] * f[8], f[3] * f[7] - f[4] * f[6],  //
      f[7] * f[2] - f[8] * f[1], f[8] * f[0] - f[6] * f[2], f[6] * f[1] - f[7] * f[0],         //
      f[1] * f[5] - f[2] * f[4], f[2] * f[3] - f[0] * f[5], f[0] * f[4] - f[1] * f[3];
  v.value = f[0] * v.slope[0] + f[1] * v.slope[1] + f[2] * v.slope[2];
  return v;
}

// J's Hessian, which is linear in F.
inline GradientSquare<2> volume_curvature(const Gradient<2>& f) {
  GradientSquare<2> curvature = GradientSquare<2>::Zero();
  const auto set = [&](int i, int j, double x) { curvature(i, j) = curvature(j, i) = x; };
  set(0, 3, f[4]);
  set(1, 2, -f[4]);
  set(0, 4, f[3]);
  set(3, 4, f[0]);
  set(1, 4, -f[2]);
  set(2, 4, -f[1]);
  return curvature;
}

inline GradientSquare<3> volume_curvature(const Gradient<3>& f) {
  GradientSquare<3> curvature = GradientSquare<3>::Zero();
  // d2J / dF_iI dF_jJ = e_ijk e_IJK F_kK: for i != j, I != J one term, with the sign of both permutations.
  for (int i = 0; i < 3; ++i)
    for (int step = 1; step <= 2; ++step)
      for (int a = 0; a < 3; ++a)
        for (int turn = 1; turn <= 2; ++turn) {
          const int j = (i + step) % 3, k = 3 - i - j, b = (a + turn) % 3, c = 3 - a - b;
          curvature(3 * i + a, 3 * j + b) = (step == turn ? 1 : -1) * f[3 * k + c];
        }
  return curvature;
}

template <int kDim>
struct DistortionEnergy {
  double value = 0;
  double scale = 0;  // G J^-2/3
  double first = 0;  // I1
  Gradient<kDim> slope;
};
template <int kDim>
DistortionEnergy<kDim> distortion_energy(const Gradient<kDim>& f, const VolumeRatio<kDim>& v, double shear_Pa) {
  DistortionEnergy<kDim> w;
  const double root = std::cbrt(v.value), s = 1 / (root * root);
  w.first = f.squaredNorm();
  w.scale = shear_Pa * s;
  w.value = 0.5 * shear_Pa * (s * w.first - 3);
  w.slope = w.scale * (f - w.first / (3 * v.value) * v.slope);
  return w;
}

// The Hessian of W where its volumetric part has the slope `pressure_Pa` in J and the curvature `bulk_Pa`.
template <int kDim>
GradientSquare<kDim> energy_curvature(const Gradient<kDim>& f, const VolumeRatio<kDim>& v,
                                      const DistortionEnergy<kDim>& w, double pressure_Pa, double bulk_Pa) {
  const double mixed = 2 * w.scale / (3 * v.value);
  const double own = 5 * w.scale * w.first / (9 * v.value * v.value) + bulk_Pa;
  GradientSquare<kDim> curvature = (pressure_Pa - w.scale * w.first / (3 * v.value)) * volume_curvature(f);
  for (int b = 0; b < kGradientSize<kDim>; ++b)
    for (int a = 0; a < kGradientSize<kDim>; ++a)
      curvature(a, b) += own * (v.slope[a] * v.slope[b]) - mixed * (f[a] * v.slope[b] + v.slope[a] * f[b]);
  curvature.diagonal().array() += w.scale;
  return curvature;
}

}  // namespace palpate::fem
