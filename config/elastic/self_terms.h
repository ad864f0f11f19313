// What the body gives under its own contact beyond a half space and beyond its soft modes:
//   c(x) = R - sum over soft modes of (n . phi)^2 / lambda,   R = g . K^-1 g - half space,
// g a Gaussian patch of unit force along the inward normal n. Both parts of R grow alike as the patch shrinks; what is
// left changes with the patch's deviation (on a wall of 10 mm by 10 % at 3.2 mm and 20 % at 4.8), and two patches tell
// how (width_law.h); c is that of no width. The soft part goes off here, at the samples, because on a slender body it
// is most of the compliance: c alone is small and smooth, and may be interpolated. It is the place's own, as the tick
// has it: a patch's mean of the modes is up to a tenth less. c1(x) is the same for the second order: travel = ... + c1
// F^2, with
//   c1 = -1/2 K2(u, u) . u - 3 U3,  U3 = -V3(q1) + 1/2 (n . theta)(q1, q1),  q1 = (n . phi) / lambda,
// u = K^-1 g brought to no width by the cube of R's growth, U3 the soft modes' own complementary energy of third order.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "config/elastic/soft_maps.h"
#include "config/elastic/width_law.h"

namespace palpate::elastic {

// A place's patch and what it meets, whatever modes are chosen.
struct SelfSample {
  int node = 0;
  WidthLaw width;            // R
  double third_mpN2 = 0;     // K2(u, u) . u
  double curvature_1pm = 0;  // at rest: mean of the principal ones; convex positive
};

struct SelfTerms {
  std::vector<int> nodes;                     // where contact may be
  std::vector<double> self_mpN, second_mpN2;  // c and c1, per node of the body; NaN elsewhere
  std::vector<WidthLaw> width;                // R, the same, with nothing taken off
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

// The patches behind the self terms.
struct PatchOptions {
  // The narrower's deviation, in edges of the mesh there. A narrower one is not carried by a mesh graded towards the
  // contact (block under a sphere: 0.8 % of error at 1, 6.9 % at 0.6); a wider one flattens what a body of large
  // elements does under it (arch, elements as long as its wall: 15 to 25 % at 1, 3.3 % at 0.6; measured 2026-11-22).
  double edges = 1;
  // By how much of a half space's give the mesh is too stiff under a patch of one edge.
  double too_stiff = 0;
};

// How the whole body answers a patch at a node, for whoever draws it.
struct PressedPlace {
  int node = 0;
  double sigma_m[2] = {}, give_mpN = 0;  // of the two patches; where the first presses, all of it
  Eigen::VectorXd u_mpN[2];              // under a newton along the place's normal
  // Of the first: what a newton along the surface's own normals adds, and what F^2 adds, which is that of the material,
  // -1/2 K^-1 K2(u, u), and of the normals' turn.
  Eigen::VectorXd bent_mpN, second_mpN2;
};
using PlaceListener = std::function<void(const PressedPlace&)>;

// At the given surface nodes. `probe_m`: largest displacement of the second order's difference. With `listen` each
// place costs two more solves; it hears of one after another, on this thread. On `jobs` threads, to the same bits.
template <int kDim>
std::vector<SelfSample> self_samples(const RestBody<kDim>& body, const std::vector<int>& nodes, double probe_m,
                                     const PatchOptions& patch, const PlaceListener& listen = {}, unsigned jobs = 1);
template <int kDim>
SelfTerms self_terms(const RestBody<kDim>& body, const SurfaceModes& modes, const SoftMaps& maps,
                     const std::vector<SelfSample>& samples);

}  // namespace palpate::elastic
