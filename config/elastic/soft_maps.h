// The nonlinear part of the soft modes: u = phi q + 1/2 theta(q, q) with the energy V(q), from differences of exact
// nodal forces at rest; no nonlinear system is solved.
//
// F(u) = K u + 1/2 K2(u, u) + 1/6 K3(u, u, u) + ... . A soft motion phi q meets K2(phi q, phi q), which the stiff rest
// of the body follows by theta = -(K^-1 - sum_c phi_c phi_c' / lambda_c) K2: statically, K-orthogonal to every soft
// mode. Put into the energy:
//   V = 1/2 lambda q q + 1/6 (K2 . phi) q q q + 1/24 (K3 . phi) q q q q + 1/8 (K2 . theta) q q q q.
// The last term is negative, what following saves: without it bending walls are far too stiff.
#pragma once

#include <vector>

#include "config/elastic/rest_body.h"
#include "config/elastic/soft_potential.h"
#include "config/elastic/surface_modes.h"

namespace palpate::elastic {

struct SoftMaps {
  std::vector<Eigen::VectorXd> theta_1pm3;  // of the pairs a <= b, in the order of pair_place
  SoftPotential potential;
  double quartic_residual = 0;  // of the fit of K3, share of its right-hand side
  int residuals = 0;            // nodal forces computed
};

inline std::size_t pair_place(int a, int b, int count) {
  if (a > b) std::swap(a, b);
  return static_cast<std::size_t>(a * count - a * (a - 1) / 2 + b - a);
}

// The soft displacement of all nodes, or of the rows given by the maps.
Eigen::VectorXd soft_displacement(const SurfaceModes& modes, const SoftMaps& maps, const Eigen::VectorXd& q);

// Of the lowest `soft` modes. Probing displacements are `probe_m` in the softest mode; the others get what holds equal
// energy, or fifth-order terms of stiff modes would swamp the quartic of soft ones. On `jobs` threads
// (config/parallel.h), to the same bits.
template <int kDim>
SoftMaps soft_maps(const RestBody<kDim>& body, const SurfaceModes& modes, int soft, double probe_m, unsigned jobs = 1);

}  // namespace palpate::elastic
