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

// J = det F with its gradient and its Hessian (which is linear in F).
template <int kDim>
struct VolumeRatio {
  double value = 0;
  Gradient<kDim> slope = Gradient<kDim>::Zero();
  GradientSquare<kDim> curvature = GradientSquare<kDim>::Zero();
};

inline VolumeRatio<2> volume_ratio(const Gradient<2>& f) {
  VolumeRatio<2> v;
  const double in_plane = f[0] * f[3] - f[1] * f[2];
  v.value = f[4] * in_plane;
  v.slope << f[4] * f[3], -f[4] * f[2], -f[4] * f[1], f[4] * f[0], in_plane;
  const auto set = [&](int i, int j, double x) { v.curvature(i, j) = v.curvature(j, i) = x; };
  set(0, 3, f[4]);
  set(1, 2, -f[4]);
  set(0, 4, f[3]);
  set(3, 4, f[0]);
  set(1, 4, -f[2]);
  set(2, 4, -f[1]);
  return v;
}

inline VolumeRatio<3> volume_ratio(const Gradient<3>& f) {
  VolumeRatio<3> v;
  // d2J / dF_iI dF_jJ = e_ijk e_IJK F_kK: for i != j, I != J one term, with the sign of both permutations.
  for (int i = 0; i < 3; ++i)
    for (int step = 1; step <= 2; ++step)
      for (int a = 0; a < 3; ++a)
        for (int turn = 1; turn <= 2; ++turn) {
          const int j = (i + step) % 3, k = 3 - i - j, b = (a + turn) % 3, c = 3 - a - b;
          v.curvature(3 * i + a, 3 * j + b) = (step == turn ? 1 : -1) * f[3 * k + c];
        }
  v.slope = 0.5 * (v.curvature * f);
  v.value = v.slope.dot(f) / 3;
  return v;
}

template <int kDim>
struct DistortionEnergy {
  double value = 0;
  Gradient<kDim> slope;
  GradientSquare<kDim> curvature;
};
template <int kDim>
DistortionEnergy<kDim> distortion_energy(const Gradient<kDim>& f, const VolumeRatio<kDim>& v, double shear_Pa) {
  DistortionEnergy<kDim> w;
  const double j = v.value, root = std::cbrt(j), s = 1 / (root * root), first = f.squaredNorm();
  w.value = 0.5 * shear_Pa * (s * first - 3);
  w.slope = shear_Pa * s * (f - first / (3 * j) * v.slope);
  w.curvature = shear_Pa * s *
                (GradientSquare<kDim>::Identity() - 2 / (3 * j) * (f * v.slope.transpose() + v.slope * f.transpose()) +
                 5 * first / (9 * j * j) * (v.slope * v.slope.transpose()) - first / (3 * j) * v.curvature);
  return w;
}

}  // namespace palpate::fem
