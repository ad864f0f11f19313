// Energy, nodal forces and tangent stiffness of a neo-Hookean body, element by element (total Lagrange). The volumetric
// energy K/2 (J - 1)^2 takes J projected on the element's pressure modes: for nu up to 0.4999 nothing locks.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "config/fem/large_strain_elements.h"
#include "config/fem/large_strain_solver.h"
#include "config/fem/neo_hookean.h"

namespace palpate::fem {

struct ElementModuli {
  double shear_Pa = 0, bulk_Pa = 0;
  double point_bulk_Pa = 0;  // of the bulk modulus, what acts point by point, not projected
};

template <int kDim>
class LargeStrainAssembly {
 public:
  LargeStrainAssembly(const StrainMesh<kDim>& mesh, const StrainBody& body, std::vector<int> equation_of_dof);

  // The elastic energy of `u`, infinite where an element is turned inside out. `force` (all degrees of freedom) and
  // `tangent` (lower triangle, free ones; pattern() gives the structure) are added to when not null.
  double evaluate(const Eigen::VectorXd& u, Eigen::VectorXd* force, Eigen::SparseMatrix<double>* tangent) const;
  Eigen::SparseMatrix<double> pattern() const { return pattern_; }
  // No element is folded at a node. Between quadrature points the energy alone would not notice, least of all on the
  // axis of a ring, where a node carries no weight (seen 2026-11-21: 4 % of stray energy).
  bool unfolded(const Eigen::VectorXd& u) const;
  // Adds weights_a weights_b block to the tangent's entries of every pair of nodes, which share an element.
  void add_nodes_block(const std::vector<int>& nodes, const std::vector<double>& weights,
                       const Eigen::Matrix<double, kDim, kDim>& block, Eigen::SparseMatrix<double>& tangent) const;
  // Forces of the body's springs on what holds their other ends.
  Eigen::VectorXd spring_force(const Eigen::VectorXd& u) const;
  int free_count() const { return free_count_; }
  int equation(int dof) const { return equation_[static_cast<std::size_t>(dof)]; }

 private:
  struct ElementSums;
  void place_points(const StrainMesh<kDim>& mesh);
  void place_nodes(const StrainMesh<kDim>& mesh);
  void find_pattern();
  bool evaluate_element(int e, const Eigen::VectorXd& u, bool tangent, ElementSums& out) const;
  void add_force(int e, int g, const Gradient<kDim>& stress, ElementSums& out) const;
  void add_stiffness(int e, int g, const GradientSquare<kDim>& stiffness, ElementSums& out) const;
  Gradient<kDim> gradient_at(int e, int g, const Eigen::VectorXd& u) const;
  int* element_nodes(int e) { return &connectivity_[static_cast<std::size_t>(e * tables_.nodes)]; }
  const int* element_nodes(int e) const { return &connectivity_[static_cast<std::size_t>(e * tables_.nodes)]; }
  const ElementModuli& moduli(int e) const { return moduli_[moduli_.size() == 1 ? 0 : static_cast<std::size_t>(e)]; }
  double add_springs(const Eigen::VectorXd& u, Eigen::VectorXd* force, Eigen::SparseMatrix<double>* tangent) const;
  std::size_t point_index(int e, int g) const { return static_cast<std::size_t>(e * tables_.points + g); }

  ElementTables<kDim> tables_;
  StrainBody body_;
  std::vector<ElementModuli> moduli_;  // of each element, or of all
  std::vector<int> connectivity_;
  std::vector<int> equation_;  // per degree of freedom, -1 when fixed
  int free_count_ = 0;
  std::vector<Point<kDim>> gradient_;          // [element][point][node], in rest coordinates
  std::vector<Point<kDim>> node_gradient_;     // [element][node][node], zero where an edge is collapsed
  std::vector<double> hoop_;                   // [element][point][node], N / R of rings, else empty
  std::vector<double> weight_;                 // [element][point], volume
  std::vector<Eigen::MatrixXd> inverse_mass_;  // [element], of the pressure modes
  std::vector<int> value_index_;   // [element][lower triangle], place in the tangent's values, -1 when fixed
  std::vector<int> spring_index_;  // [spring], the same
  Eigen::SparseMatrix<double> pattern_;
};

}  // namespace palpate::fem
