// Quasi-static large strain with frictionless contact against rigid tools: the reference for force laws, and the solver
// behind the series law's coefficients. Deterministic: no clock, no random number, one thread.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "config/fem/large_strain_mesh.h"
#include "config/fem/rigid_tool.h"

namespace palpate::fem {

enum class Kinematics : std::uint8_t {
  kPlaneStrain,
  kPlaneStress,
  kAxisymmetric,  // x = radius, y = axis; energies and forces are those of the whole ring
  kSolid,         // three dimensions
};

enum class StrainLaw : std::uint8_t {
  kNeoHookean,  // W = G/2 (J^-2/3 I1 - 3) + K/2 (J - 1)^2
  // Small strain about the rest shape, contact gaps and normals taken at the rest position: turning the normal with the
  // linear displacement costs 17 to 44 % of the force (measured 2026-11-21 on an ellipsoid and a punch).
  kLinear,
};

// Between two degrees of freedom, node * dimension + component, or of one alone: energy k u_row u_column, half of it on
// the diagonal. `row` >= `column`, of nodes that share an element.
struct NodeSpring {
  int row = 0, column = 0;
  double stiffness_N_per_m = 0;
};
struct ElementMaterial {
  double youngs_modulus_Pa = 0, poisson_ratio = 0;
};

struct StrainBody {
  double youngs_modulus_Pa = 0;
  double poisson_ratio = 0;  // in (-1, 0.4999]: 0.5 has no finite bulk modulus
  Kinematics kinematics = Kinematics::kAxisymmetric;
  double thickness_m = 1;  // of plane bodies
  StrainLaw law = StrainLaw::kNeoHookean;
  // Of the shear modulus: the bulk modulus that acts point by point, the rest acts through an element's pressure modes.
  // T10 with its one mode alone is too soft where elements are as large as a wall.
  double point_bulk = 0;
  std::vector<ElementMaterial> element;  // of each element; empty: all have that of above
  std::vector<NodeSpring> spring;        // an elastic bed's, linear
};

struct StrainOptions {
  double gap_tolerance = 2e-5;       // largest penetration left, share of the shortest contact facet
  double residual_tolerance = 1e-9;  // share of the largest nodal force
  int max_newton = 40;
  int max_augmentations = 12;
  double step_facets = 1;  // longest step, in shortest facets
  // Off saddles: a slender body goes aside as it does, not on in the symmetric shape that a symmetric press allows.
  bool stable = false;
  int max_cuts = 7;  // a step that does not converge is halved at most so often
};

template <int kDim>
struct PressState {
  bool converged = false;
  double energy_J = 0;                       // elastic
  std::vector<Point<kDim>> force_on_tool_N;  // per tool
  Point<kDim> support_reaction_N{};          // on the body, from its fixed nodes and its springs
  std::vector<double> u_m;                   // [node][component]
  double penetration_m = 0;                  // largest left
  int active_contacts = 0;
  double contact_radius_m = 0;  // largest |x[0]|, deformed, of a node that carries force
  int newton_steps = 0;
};

template <int kDim>
class LargeStrainSolver {
 public:
  // `fixed[node * kDim + component]`; `contact_nodes` may touch the tools. Throws ConfigError for a bad material or
  // mesh.
  LargeStrainSolver(const StrainMesh<kDim>& mesh, const StrainBody& body, const std::vector<bool>& fixed,
                    std::vector<int> contact_nodes, std::vector<RigidTool> tools, const StrainOptions& options = {});
  ~LargeStrainSolver();
  LargeStrainSolver(LargeStrainSolver&&) noexcept;

  // Equilibrium with the tools' origins at `origin_m`, from the last equilibrium along a straight path, cut into
  // shorter steps where one does not converge. When none does, the result says so and the state stays where it was.
  PressState<kDim> move_tools(const std::vector<Point<kDim>>& origin_m);
  // The same for dead loads at nodes and for displacements of fixed nodes (both [node][component], empty = zero).
  PressState<kDim> load(const std::vector<double>& force_N, const std::vector<double>& displacement_m);
  // Where the tools start from: no contact there, no solve.
  void place_tools(const std::vector<Point<kDim>>& origin_m);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::fem
