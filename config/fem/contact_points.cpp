#include "config/fem/contact_points.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace palpate::fem {

namespace {

using Facet = std::vector<int>;

std::vector<Facet> element_facets(StrainElement element) {
  switch (element) {
    case StrainElement::kQ9:
      return {{0, 1, 2}, {2, 5, 8}, {8, 7, 6}, {6, 3, 0}};
    case StrainElement::kT10:
      return {{0, 1, 2, 4, 5, 6}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {2, 0, 3, 6, 7, 9}};
    case StrainElement::kH27:
      break;
  }
  std::vector<Facet> faces;
  constexpr int kStride[3] = {1, 3, 9};
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 2}) {
      Facet face;
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          face.push_back(side * kStride[axis] + i * kStride[(axis + 1) % 3] + j * kStride[(axis + 2) % 3]);
      faces.push_back(face);
    }
  return faces;
}

std::vector<double> parabolas(double x) { return {0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)}; }

std::vector<ContactPoint> points_of(const Facet& facet) {
  std::vector<ContactPoint> points;
  const double g = 1 / std::sqrt(3.0);
  if (facet.size() == 3) {
    for (const double x : {-g, g}) points.push_back({facet, parabolas(x), 0.5});
  } else if (facet.size() == 9) {
    for (const double y : {-g, g})
      for (const double x : {-g, g}) {
        ContactPoint point = {facet, {}, 0.25};
        for (const double b : parabolas(y))
          for (const double a : parabolas(x)) point.shape.push_back(a * b);
        points.push_back(point);
      }
  } else {
    for (int k = 0; k < 3; ++k) {
      double l[3] = {1.0 / 6, 1.0 / 6, 1.0 / 6};
      l[k] = 2.0 / 3;
      points.push_back({facet,
                        {l[0] * (2 * l[0] - 1), l[1] * (2 * l[1] - 1), l[2] * (2 * l[2] - 1), 4 * l[0] * l[1],
                         4 * l[1] * l[2], 4 * l[2] * l[0]},
                        1.0 / 3});
    }
  }
  return points;
}

}  // namespace

template <int kDim>
std::vector<BoundaryFacet> boundary_facets(const StrainMesh<kDim>& mesh) {
  const std::vector<Facet> local = element_facets(mesh.element);
  const int size = nodes_per_element(mesh.element);
  std::map<Facet, std::pair<int, BoundaryFacet>> seen;
  for (int e = 0; e < mesh.element_count(); ++e)
    for (const Facet& f : local) {
      Facet nodes;
      for (const int i : f) nodes.push_back(mesh.connectivity[static_cast<std::size_t>(e * size + i)]);
      Facet key = nodes;
      std::sort(key.begin(), key.end());
      if (std::unique(key.begin(), key.end()) != key.end()) continue;
      auto& entry = seen[key];
      ++entry.first;
      entry.second = {nodes, e};
    }
  std::vector<BoundaryFacet> boundary;
  for (const auto& [key, entry] : seen)
    if (entry.first == 1) boundary.push_back(entry.second);
  return boundary;
}
template std::vector<BoundaryFacet> boundary_facets<2>(const StrainMesh<2>&);
template std::vector<BoundaryFacet> boundary_facets<3>(const StrainMesh<3>&);

template <int kDim>
std::vector<ContactPoint> contact_points(const StrainMesh<kDim>& mesh, const std::vector<int>& contact_nodes) {
  std::vector<bool> wanted(mesh.nodes_m.size());
  for (const int node : contact_nodes) wanted[static_cast<std::size_t>(node)] = true;
  std::vector<ContactPoint> points;
  for (const BoundaryFacet& facet : boundary_facets(mesh))
    if (std::all_of(facet.nodes.begin(), facet.nodes.end(), [&](int n) { return wanted[static_cast<std::size_t>(n)]; }))
      for (ContactPoint& p : points_of(facet.nodes)) points.push_back(std::move(p));
  return points;
}
template std::vector<ContactPoint> contact_points<2>(const StrainMesh<2>&, const std::vector<int>&);
template std::vector<ContactPoint> contact_points<3>(const StrainMesh<3>&, const std::vector<int>&);

}  // namespace palpate::fem
