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
// Points on the boundary facets all of whose nodes are in `contact_nodes`. As many per facet as keep the pressure modes
// independent: Gauss 2 on an edge, 2 x 2 on a face of nine nodes, 3 on a face of six.
template <int kDim>
std::vector<ContactPoint> contact_points(const StrainMesh<kDim>& mesh, const std::vector<int>& contact_nodes);

}  // namespace palpate::fem
