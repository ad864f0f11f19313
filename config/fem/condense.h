// A linear elastic body reduced to its surface: the response of every surface node to a force on any other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/fem/linear_body.h"
#include "config/fem/material.h"
#include "config/fem/tet_mesh.h"
#include "config/scene/progress.h"
#include "rt_core/limits.h"

namespace palpate {

struct CondensedBody {
  SurfaceMesh surface;             // vertex i is surface node i; counter-clockwise from outside
  std::vector<Vec3> normal;        // outward unit normals of the vertices
  std::vector<std::int32_t> node;  // the mesh's node of vertex i
  std::vector<std::uint8_t> held;  // held components of vertex i: bit 0 x, 1 y, 2 z
  // Row-major, (3 n)^2: displacement component a of vertex i by a unit force along b on vertex j, at
  // [(3 i + a) * 3 n + 3 j + b]. m/N. Symmetric to the last bit; rows and columns of held components are zero.
  std::vector<double> compliance_mpN;
  std::size_t degrees_of_freedom = 0;  // of the whole mesh, held components excepted
  std::size_t factor_entries = 0;      // of the sparse Cholesky factor
};

struct CondenseLimits {
  std::size_t surface_nodes = kMaxNodalVertices;
};

// Checks mesh, material, supports and the size of the table, and factors the stiffness. Throws ConfigError naming
// `label`.
LinearBody factor_for_table(const TetMesh& mesh, const FemMaterial& material, const Supports& supports,
                            const std::string& label, const Progress& progress = {}, const CondenseLimits& limits = {});

// Solves for the surface columns; interior nodes carry no force, so this equals the inverse of the Schur complement
// (Duriez, Andriot & Kheddar 2003, section 3.1). `solver` is of the same mesh and supports.
CondensedBody condense(const LinearBody& solver, const TetMesh& mesh, const Supports& supports,
                       const std::string& label, const Progress& progress = {}, const CondenseLimits& limits = {});

// Both at once.
CondensedBody condense(const TetMesh& mesh, const FemMaterial& material, const Supports& supports,
                       const std::string& label, const Progress& progress = {}, const CondenseLimits& limits = {});

// Bytes of the compliance table of n surface nodes, in doubles.
constexpr std::size_t compliance_bytes(std::size_t surface_nodes) {
  return 9 * surface_nodes * surface_nodes * sizeof(double);
}

}  // namespace palpate
