// Shape functions and stiffness of one tetrahedron, linear, quadratic or transition, with straight or curved edges.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "config/fem/material.h"
#include "config/fem/tet_mesh.h"

namespace palpate {

// Barycentric coordinates and weight; weights sum to 1 (times the volume 1/6 of the parent element in use).
struct TetPoint {
  std::array<double, 4> lambda;
  double weight;
};
// Four points, exact for polynomials of degree 2 (Hammer, Marlowe & Stroud 1956): exact stiffness of straight elements.
const std::vector<TetPoint>& tet_rule_4();
// Fourteen points, degree 5 (Walkington 2000): for curved edges, where the integrand is rational.
const std::vector<TetPoint>& tet_rule_14();

// Values and parent-space derivatives (along the parent's x, y, z, i.e. lambda 1, 2, 3) of the ten functions at a
// point; those of absent middle nodes are zero and their share stays with the corners, so the edge remains straight.
using TetValues = Eigen::Matrix<double, 10, 1>;
using TetGradients = Eigen::Matrix<double, 10, 3>;
TetValues tet_shape(const Tet& tet, const std::array<double, 4>& lambda);
TetGradients tet_shape_gradients(const Tet& tet, const std::array<double, 4>& lambda);

// Gradients in space, and the Jacobian's determinant (6 x volume of a straight element), at a point.
struct TetMapping {
  TetGradients gradient_1pm;
  double determinant_m3 = 0;
};
TetMapping map_tet(const TetMesh& mesh, const Tet& tet, const std::array<double, 4>& lambda);

// True when a middle node lies off the middle of its chord by more than rounding.
bool is_curved(const TetMesh& mesh, const Tet& tet);
// Smallest Jacobian determinant over integration points and corners, as a share of the corners' (1: straight).
double least_jacobian_ratio(const TetMesh& mesh, const Tet& tet);

// 30 x 30, rows 3 * local node + axis; rows of absent nodes are zero. N/m. Above kMeanDilatationAbove the volumetric
// part is taken at the element's mean dilatation (Nagtegaal, Parks & Rice 1974): K = sum w B' D_dev B + K V b b'.
using TetStiffness = Eigen::Matrix<double, 30, 30>;
TetStiffness tet_stiffness(const TetMesh& mesh, const Tet& tet, const FemMaterial& material);

}  // namespace palpate
