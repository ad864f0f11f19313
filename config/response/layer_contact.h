// Frictionless axisymmetric contact with an elastic layer on a rigid base, exact: offline, for the factor tables.
#pragma once

#include <vector>

#include "rt_core/choice.h"
#include "rt_core/vec.h"

namespace palpate {

#define PALPATE_LAYER_BASES(X) X(kBonded, bonded) X(kSlip, slip)
PALPATE_CHOICE(LayerBase, PALPATE_LAYER_BASES);

// thickness_m <= 0: a half space.
struct ElasticLayer {
  double thickness_m = 0;
  double poisson_ratio = 0.5;
  LayerBase base = LayerBase::kBonded;
};

// Depth of a rigid profile's surface below its tip as Abel's transform sees it, g(x) = depth - profile(x): parabola
// x^2/R, sphere (x/2) ln((R + x)/(R - x)), cone (pi/2) x cot alpha; a flat punch is 0.
enum class TipProfile : std::int32_t { kFlat = 0, kParabola = 1, kSphere = 2, kCone = 3 };
struct Indenter {
  TipProfile profile = TipProfile::kParabola;
  double radius_m = 0;        // parabola, sphere
  double tan_half_angle = 0;  // cone: tangent of the angle from its axis
};

// One equilibrium, forces and stiffnesses over E* = E/(1 - nu^2).
struct LayerState {
  double depth_m = 0;
  double force_m2 = 0;
  double stiffness_m = 0;
};

// The dual integral equations of the layer (Lebedev & Ufliand 1958; Hayes et al. 1972) as a Fredholm equation,
//   phi(x) - 1/pi int_0^a [k(x - t) + k(x + t)] phi(t) dt = E*/pi g(x),   F = 2 pi int_0^a phi dx,
//   k(s) = int_0^inf (1 - L(omega h)) cos(omega s) d omega,
// by 64-point Gauss quadrature. L bonded: (2 K sinh 2w - 4w)/(2 K cosh 2w + K^2 + 1 + 4 w^2), K = 3 - 4 nu; slipping:
// 2 sinh^2 w/(sinh 2w + 2w), whatever nu. Relative error below 1e-9 up to contact radii of 4 thicknesses.
class LayerContact {
 public:
  // For contact radii up to largest_radius_m.
  LayerContact(const ElasticLayer& layer, double largest_radius_m);
  // Contact of radius a > 0; for a flat punch (a = its radius) per metre of depth: depth_m = 1.
  LayerState at_radius(const Indenter& indenter, double radius_m) const;
  // Contact at a depth > 0 of a curved indenter. Depths beyond largest_radius_m's are not allowed.
  LayerState at_depth(const Indenter& indenter, double depth_m) const;
  // k(0): to first order the layer stiffens a contact as if the depth were larger by k(0) F/(pi E*).
  double kernel_at_zero_per_m() const;

 private:
  double kernel(double distance_over_thickness) const;
  ElasticLayer layer_;
  double step_ = 0;
  std::vector<double> value_, slope_;  // of the kernel, over distance / thickness
};

// Radius of the sphere whose Hertz law F = 4/3 E* sqrt(R) d^1.5 is that of the elliptic contact with relative
// curvatures 2A <= 2B, 1/m each (Johnson 1985, section 4.2). curvature_a, curvature_b > 0.
double elliptic_radius_m(double curvature_a_per_m, double curvature_b_per_m);

}  // namespace palpate
