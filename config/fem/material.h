// Isotropic elastic material, and what holds a body.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/fem/tet_mesh.h"

namespace palpate {

// Above this Poisson's ratio quadratic elements use the mean dilatation, and linear ones are refused: they lock (a
// cantilever 6 x 1 x 1 of 1813 nodes bends 46 % too little at 0.49; measured 2026-11-21).
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
