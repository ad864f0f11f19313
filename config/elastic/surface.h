// The boundary of a finite-element mesh as curved facets: shape functions, quadrature, mass. What the elastic body
// measures displacements, loads and contact places on.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "config/fem/contact_points.h"
#include "config/fem/large_strain_mesh.h"
#include "rt_core/vec.h"

namespace palpate::elastic {

template <int kDim>
using Vector = Eigen::Matrix<double, kDim, 1>;
inline Vec3 vec(const Vector<3>& v) { return {v[0], v[1], v[2]}; }

inline constexpr std::size_t kMaxFacetNodes = 9;

// Parameters of an edge: first in [-1, 1]; of a triangle: shares of corners 1 and 2; of a square: both in [-1, 1].
using FacetPlace = Eigen::Vector2d;

struct FacetShape {
  std::array<double, kMaxFacetNodes> value{};
  std::array<Eigen::Vector2d, kMaxFacetNodes> slope{};      // d / d parameter
  std::array<Eigen::Matrix2d, kMaxFacetNodes> curvature{};  // d2 / d parameter2
};
// `nodes`: 3, 6 or 9, as BoundaryFacet has them.
FacetShape facet_shape(std::size_t nodes, const FacetPlace& at);
// The nearest place that lies on the facet.
FacetPlace clamp_to_facet(std::size_t nodes, const FacetPlace& at);
FacetPlace facet_centre(std::size_t nodes);

struct FacetPoint {
  FacetPlace at;
  double weight = 0;  // in parameters
};
// Exact for the product of two shape functions on a straight facet.
const std::vector<FacetPoint>& facet_rule(std::size_t nodes);

template <int kDim>
class Surface {
 public:
  struct Facet {
    std::vector<int> nodes;
    double side = 1;  // -1: the parameters' normal points into the body
  };
  struct Point {  // of a facet, in rest coordinates
    int facet = 0;
    FacetShape shape;
    Vector<kDim> x_m, normal;  // normal unit, out of the body
    double area_m2 = 0;        // share of the surface; thickness included in the plane
  };

  // `thickness_m` of plane bodies; 1 in space.
  Surface(const fem::StrainMesh<kDim>& mesh, double thickness_m);

  const std::vector<Facet>& facets() const { return facets_; }
  const std::vector<Point>& points() const { return points_; }
  // Facets at a node, empty inside the body.
  const std::vector<int>& facets_at(int node) const { return at_node_[static_cast<std::size_t>(node)]; }
  Vector<kDim> rest(int node) const;
  Vector<kDim> normal(const Facet& facet, const FacetShape& shape) const;
  // How the unit normal at a point turns with [node * kDim + component], to first order.
  Vector<kDim> turn(const Point& point, const Eigen::VectorXd& u) const;
  // int N N dA on [node * kDim + component].
  Eigen::VectorXd mass_times(const Eigen::VectorXd& u) const;
  // Largest distance between two corners of the bounding box.
  double extent_m() const { return extent_m_; }
  // Mean distance between neighbouring corners of the facets at a node.
  double edge_m(int node) const;

 private:
  // Quadrature points of a facet, and its part of the mass.
  void add_points(int facet, double thickness_m, std::vector<Eigen::Triplet<double>>& mass);

  std::vector<fem::Point<kDim>> nodes_m_;
  std::vector<Facet> facets_;
  std::vector<Point> points_;
  std::vector<std::vector<int>> at_node_;
  Eigen::SparseMatrix<double> mass_;  // per component
  double extent_m_ = 0;
};

}  // namespace palpate::elastic
