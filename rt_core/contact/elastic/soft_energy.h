// The stored energy of an elastic body's soft modes, V(p) = p.p/2 + cubic + quartic (contact/elastic/elastic_layout.h).
// Outside the ball |p| = elastic_radius_rootJ the cubic and quartic parts go on along their tangents on every ray:
// energy and forces stay continuous, and far out the linear body remains.
#pragma once

#include "rt_core/contact/elastic/elastic_layout.h"

namespace palpate {

struct SoftEnergy {
  Real energy_J;
  Real slope[kMaxSoftModes];
  Real curvature[kMaxSoftModes * kMaxSoftModes];  // row-major soft x soft
  bool is_outside;                                // of the ball
};

// Products y of the amplitudes: p, then the pairs'. Writes terms(soft) numbers.
void soft_products(std::int32_t soft, const Real* p, Real* y) PALPATE_RT;
// `y` from soft_products. Bound: pairs^2 multiply-adds.
void soft_energy(const Model& model, const Real* p, const Real* y, SoftEnergy& out) PALPATE_RT;
// V' alone, into slope[soft]; returns V. As dear as half of soft_energy.
Real soft_slope(const Model& model, const Real* p, const Real* y, Real* slope) PALPATE_RT;

}  // namespace palpate
