// Small-displacement elasticity of a tetrahedral mesh: assembled, factored once, solved for many loads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/fem/material.h"
#include "config/fem/tet_mesh.h"
#include "config/scene/progress.h"

namespace palpate {

class LinearBody {
 public:
  // Does not check the mesh (check_tet_mesh); throws ConfigError for the material and for supports that leave a rigid
  // motion free.
  LinearBody(const TetMesh& mesh, const FemMaterial& material, const Supports& supports, const std::string& label,
             const Progress& progress = {});
  ~LinearBody();
  LinearBody(LinearBody&&) noexcept;
  LinearBody& operator=(LinearBody&&) noexcept;

  // Displacement of every node by the forces on the nodes; forces on held components go to the support.
  std::vector<Vec3> solve_m(const std::vector<Vec3>& force_N) const;
  // The same where held components move by `held_m` instead of staying at zero.
  std::vector<Vec3> solve_m(const std::vector<Vec3>& force_N, const std::vector<Vec3>& held_m) const;
  // Many loads at once: 16 cost little more than one.
  std::vector<std::vector<Vec3>> solve_all_m(const std::vector<std::vector<Vec3>>& forces_N) const;
  // K u: the forces that hold the nodes where they are, supports' reactions included.
  std::vector<Vec3> forces_N(const std::vector<Vec3>& displacement_m) const;
  double energy_J(const std::vector<Vec3>& displacement_m) const;

  // Compliance between the given nodes, row-major (3 n)^2, as CondensedBody::compliance_mpN.
  std::vector<double> compliance_mpN(const std::vector<std::int32_t>& nodes, const Progress& progress = {}) const;

  std::size_t degrees_of_freedom() const;
  std::size_t factor_entries() const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace palpate
