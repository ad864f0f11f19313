// Quadrature points of the surface that may touch a tool. Contact at nodes alone lets a rounded edge cut through
// between them and the surface fold there (seen 2026-11-21 under a punch: 10 to 16 % of the force).
#pragma once

#include <vector>

#include "config/fem/large_strain_mesh.h"

namespace palpate::fem {

struct ContactPoint {
  std::vector<int> nodes;     // of one facet
  std::vector<double> shape;  // their weights at the point
  double share = 0;           // of the facet's area
};
// A facet that belongs to one element only; nodes in the order of the element's facet, which may be either way round.
struct BoundaryFacet {
  std::vector<int> nodes;  // 3 (edge), 6 (triangle: corners, then edges 01 12 20) or 9 (tensor product, first fastest)
  int element = 0;
};
// In the order of their sorted nodes. Facets collapsed to a line or a point are none.
template <int kDim>
std::vector<BoundaryFacet> boundary_facets(const StrainMesh<kDim>& mesh);

// Points on the boundary facets all of whose nodes are in `contact_nodes`. As many per facet as keep the pressure modes
// independent: Gauss 2 on an edge, 2 x 2 on a face of nine nodes, 3 on a face of six.
template <int kDim>
std::vector<ContactPoint> contact_points(const StrainMesh<kDim>& mesh, const std::vector<int>& contact_nodes);

}  // namespace palpate::fem
