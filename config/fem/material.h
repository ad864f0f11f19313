// Isotropic elastic material, and what holds a body.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/fem/tet_mesh.h"

namespace palpate {

// Above this Poisson's ratio quadratic elements use the mean dilatation, and linear ones are refused: they lock (a
// cantilever of 959 nodes is 40 % too stiff at 0.49 and 93 % at 0.4999).
inline constexpr double kMeanDilatationAbove = 0.49;

struct FemMaterial {
  double young_Pa = 1e6;
  double poisson = 0.3;
};
// Throws ConfigError unless E > 0 and -1 < nu < 0.5.
void check_material(const FemMaterial& material, const std::string& label);

// Which displacement components of a node are held at zero: bit 0 x, bit 1 y, bit 2 z.
inline constexpr std::uint8_t kHoldAll = 7;
// One entry per node of the mesh.
using Supports = std::vector<std::uint8_t>;

// Holds all components of the nodes that `held` accepts.
Supports hold_where(const TetMesh& mesh, const std::function<bool(Vec3)>& held);

// Throws ConfigError, saying which rigid motions are free, unless the supports hold the body.
void check_supports(const TetMesh& mesh, const Supports& supports, const std::string& label);

}  // namespace palpate
