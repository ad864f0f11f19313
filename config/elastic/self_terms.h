// What the body gives under its own contact beyond a half space and beyond its soft modes:
//   c(x) = g . K^-1 g - half space - sum over soft modes of (g . phi)^2 / lambda,
// g a Gaussian patch of unit force along the inward normal. The first two grow alike as the patch shrinks. The soft
// part goes off here, at the samples, because on a slender body it is most of the compliance: c alone is small and
// smooth, and may be interpolated. c1(x) is the same for the second order: travel = ... + c1 F^2, with
//   c1 = -1/2 K2(u, u) . u - 3 U3,  U3 = -V3(q1) + 1/2 (g . theta)(q1, q1),  q1 = (g . phi) / lambda,
// u = K^-1 g, U3 the soft modes' own complementary energy of third order.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "config/elastic/soft_maps.h"

namespace palpate::elastic {

// A place's patch and what it meets, whatever modes are chosen.
struct SelfSample {
  int node = 0;
  Eigen::SparseVector<double> load_N;  // g
  double give_mpN = 0;                 // g . K^-1 g less the half space's
  double third_mpN2 = 0;               // K2(u, u) . u
  double curvature_1pm = 0;            // at rest: mean of the principal ones; convex positive
};

struct SelfTerms {
  std::vector<int> nodes;                     // where contact may be
  std::vector<double> self_mpN, second_mpN2;  // c and c1, per node of the body; NaN elsewhere
  std::vector<double> curvature_1pm;  // per node of the body, at rest: mean of the principal ones; convex positive
  double length_m = 0;                // of the plane's logarithm: LocalLaw::length_m
  bool known(int node) const {
    return self_mpN[static_cast<std::size_t>(node)] == self_mpN[static_cast<std::size_t>(node)];
  }
};

// Unit force along -normal, spread over facets that face the same way, as nodal loads.
template <int kDim>
Eigen::VectorXd gaussian_patch(const RestBody<kDim>& body, const Vector<kDim>& at_m, const Vector<kDim>& normal,
                               double sigma_m);

// Mean normal of the facets at a surface node.
template <int kDim>
Vector<kDim> node_normal(const Surface<kDim>& surface, int node);

// At the given surface nodes. `probe_m`: largest displacement of the second order's difference. `patch_edges`: the
// patch's deviation in edges of the mesh there.
template <int kDim>
std::vector<SelfSample> self_samples(const RestBody<kDim>& body, const std::vector<int>& nodes, double probe_m,
                                     double patch_edges);
template <int kDim>
SelfTerms self_terms(const RestBody<kDim>& body, const SurfaceModes& modes, const SoftMaps& maps,
                     const std::vector<SelfSample>& samples);

}  // namespace palpate::elastic
