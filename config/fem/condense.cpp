#include "config/fem/condense.h"

#include <cstdio>

#include "config/scene/config_error.h"

namespace palpate {

namespace {

double mebibytes(std::size_t surface_nodes) { return static_cast<double>(compliance_bytes(surface_nodes)) / 1048576.0; }

void check_size(std::size_t surface_nodes, const CondenseLimits& limits, const std::string& label) {
  if (surface_nodes <= limits.surface_nodes) return;
  char text[320];
  std::snprintf(text, sizeof text,
                ": the mesh has %zu surface nodes, whose compliance table takes %.3g MiB (%.3g MiB in single "
                "precision); allowed %zu nodes, %.3g MiB. Coarsen the mesh, or make it quadratic only near the contact",
                surface_nodes, mebibytes(surface_nodes), 0.5 * mebibytes(surface_nodes), limits.surface_nodes,
                mebibytes(limits.surface_nodes));
  throw ConfigError(label + text);
}

}  // namespace

LinearBody factor_for_table(const TetMesh& mesh, const FemMaterial& material, const Supports& supports,
                            const std::string& label, const Progress& progress, const CondenseLimits& limits) {
  check_material(material, label);
  check_tet_mesh(mesh, label);
  check_size(surface_of(mesh).node.size(), limits, label);  // before the minutes of a mesh that is too large
  return LinearBody(mesh, material, supports, label, progress);
}

CondensedBody condense(const TetMesh& mesh, const FemMaterial& material, const Supports& supports,
                       const std::string& label, const Progress& progress, const CondenseLimits& limits) {
  return condense(factor_for_table(mesh, material, supports, label, progress, limits), mesh, supports, label, progress,
                  limits);
}

CondensedBody condense(const LinearBody& solver, const TetMesh& mesh, const Supports& supports,
                       const std::string& label, const Progress& progress, const CondenseLimits& limits) {
  TetSurface surface = surface_of(mesh);
  check_size(surface.node.size(), limits, label);
  CondensedBody out;
  for (const std::int32_t i : surface.node) out.held.push_back(supports[static_cast<std::size_t>(i)]);
  out.compliance_mpN = solver.compliance_mpN(surface.node, progress);
  out.surface = std::move(surface.mesh);
  out.normal = vertex_normals(out.surface);
  out.node = std::move(surface.node);
  out.degrees_of_freedom = solver.degrees_of_freedom();
  out.factor_entries = solver.factor_entries();
  return out;
}

}  // namespace palpate
