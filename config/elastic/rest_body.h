// A supported body at rest: its stiffness factored once, its exact nodal forces at any displacement, its surface.
// Vectors are [node * kDim + component]; fixed components are zero.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "config/elastic/surface.h"
#include "config/fem/large_strain_assembly.h"
#include "config/fem/supernodal_factor.h"

namespace palpate::elastic {

template <int kDim>
class RestBody {
 public:
  // Plane strain, plane stress or solid; `fixed[node * kDim + component]` must hold every rigid motion. Throws
  // ConfigError otherwise, and for a bad material.
  RestBody(const fem::StrainMesh<kDim>& mesh, const fem::StrainBody& body, const std::vector<bool>& fixed);

  const fem::StrainBody& material() const { return material_; }
  const Surface<kDim>& surface() const { return surface_; }
  Eigen::Index size() const { return size_; }
  // What a contact patch meets: E / (1 - nu^2), in plane stress E; in the plane times the width (N/m).
  double contact_modulus() const;
  // The same of the elements at a node, their mean.
  double contact_modulus(int node) const;

  // SupernodalFactor::multiplications of the stiffness.
  double factor_multiplications() const { return factor_.multiplications(); }

  // K^-1 f at rest.
  Eigen::VectorXd solve(const Eigen::VectorXd& force_N) const { return solve_all(force_N); }
  // The same for every column, to the same bits.
  Eigen::MatrixXd solve_all(const Eigen::MatrixXd& force_N) const;
  // Nodal forces that hold `u_m`. Throws ConfigError when an element is turned inside out.
  Eigen::VectorXd internal_force(const Eigen::VectorXd& u_m) const;
  // Sets fixed components to zero.
  void release_fixed(Eigen::VectorXd& v) const;

 private:
  double contact_modulus_of(const fem::ElementMaterial& material) const;
  void find_node_moduli(const fem::StrainMesh<kDim>& mesh);
  fem::StrainBody material_;
  Eigen::Index size_;
  std::vector<double> node_modulus_;  // of bodies of several materials
  Surface<kDim> surface_;
  fem::LargeStrainAssembly<kDim> assembly_;
  fem::SupernodalFactor factor_;
};

}  // namespace palpate::elastic
