#include "config/fem/condense.h"

#include <cmath>
#include <cstdio>

#include "config/config_error.h"
#include "config/fem/linear_body.h"

namespace palpate {

namespace {

void check_size(std::size_t surface_nodes, const CondenseLimits& limits, const std::string& label) {
  if (compliance_bytes(surface_nodes) <= limits.compliance_B) return;
  const auto most = static_cast<std::size_t>(std::sqrt(static_cast<double>(limits.compliance_B) / 72.0));
  char text[320];
  std::snprintf(text, sizeof text,
                ": the mesh has %zu surface nodes, whose compliance takes %.1f GiB; the limit is %.2f GiB, %zu nodes. "
                "Coarsen the mesh, make it linear away from the contact zone, or raise the limit",
                surface_nodes, static_cast<double>(compliance_bytes(surface_nodes)) / 1073741824.0,
                static_cast<double>(limits.compliance_B) / 1073741824.0, most);
  throw ConfigError(label + text);
}

}  // namespace

CondensedBody condense(const TetMesh& mesh, const FemMaterial& material, const Supports& supports,
                       const std::string& label, const Progress& progress, const CondenseLimits& limits) {
  check_material(material, label);
  check_tet_mesh(mesh, label);
  TetSurface surface = surface_of(mesh);
  check_size(surface.node.size(), limits, label);
  const LinearBody body(mesh, material, supports, label, progress);
  CondensedBody out;
  for (const std::int32_t i : surface.node) out.held.push_back(supports[static_cast<std::size_t>(i)]);
  out.compliance_mpN = body.compliance_mpN(surface.node, progress);
  out.surface = std::move(surface.mesh);
  out.normal = vertex_normals(out.surface);
  out.node = std::move(surface.node);
  out.degrees_of_freedom = body.degrees_of_freedom();
  out.factor_entries = body.factor_entries();
  return out;
}

}  // namespace palpate
