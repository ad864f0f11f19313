#include "config/bake/fem_body.h"
#include "config/body/body.h"
#include "config/body/body_card.h"
#include "config/body/body_pose.h"
#include "config/body/supports.h"

#include <algorithm>
#include <cmath>

#include "config/bake/compile.h"
#include "config/fem/compliance_precision.h"
#include "config/fem/strain_gauges.h"
#include "config/fem/tet_io.h"
#include "config/fem/tet_procedural.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Flags of the elements that the scene's zone keeps quadratic.
std::vector<char> zone_elements(const SceneDesc& scene, const TetMesh& mesh, std::vector<std::string>& warnings) {
  const Vec3 from = scene.fem.zone_from_m, to = scene.fem.zone_to_m;
  const auto inside = [&](Vec3 x) {
    return x.x >= from.x && x.x <= to.x && x.y >= from.y && x.y <= to.y && x.z >= from.z && x.z <= to.z;
  };
  const std::vector<char> quadratic = elements_near(mesh, inside, scene.fem.zone_layers);
  const auto count = std::count(quadratic.begin(), quadratic.end(), 1);
  const std::string where = scene.source.where("body.fem.zone_from_mm") + ": ";
  if (count == 0) {
    const Bounds body = bounds_of(surface_of(mesh).mesh);
    throw ConfigError(where + "no corner of a tetrahedron lies in the zone; the body reaches from " +
                      position_text(body.lower_m) + " to " + position_text(body.upper_m) +
                      ": move the zone there, or make it larger than an element");
  }
  if (count == static_cast<std::ptrdiff_t>(quadratic.size()))
    warnings.push_back(where + "the zone makes all elements quadratic; order = \"quadratic\" says so");
  return quadratic;
}

void add_gauges(const SceneDesc& scene, const LinearBody& solver, FemBody& body, const Progress& progress) {
  if (scene.fem.strain_gauges == 0) return;
  const StrainGauges gauges = place_strain_gauges(solver, body.mesh, body.condensed,
                                                  static_cast<std::size_t>(scene.fem.strain_gauges), progress);
  for (const double e : gauges.strain_1pN) body.strain_gauge.push_back(static_cast<float>(e));
  body.gauges = static_cast<std::int32_t>(gauges.tet.size());
}

}  // namespace

double tet_edge_m(const SceneDesc& scene, Vec3 size_m) {
  return is_auto(scene.fem.edge_m) ? std::max({size_m.x, size_m.y, size_m.z}) / 8 : scene.fem.edge_m;
}

TetMesh make_tet_mesh(const SceneDesc& scene, std::vector<std::string>& warnings) {
  TetMesh mesh;
  if (const auto tets = card_of(scene.body.shape).tets; tets != nullptr) {
    mesh = tets(scene, warnings);
    place(scene.body, mesh.node_m);
  } else {
    const SurfaceMesh surface = make_body(scene, warnings);
    mesh = tetrahedralise(surface, tet_edge_m(scene, bounds_of(surface).size_m()), scene.source.where("body.shape"));
  }
  add_middle_nodes(mesh);
  if (scene.fem.order == FemOrder::kLinear) keep_middle_nodes(mesh, std::vector<char>(mesh.tet.size(), 0));
  if (scene.fem.order == FemOrder::kMixed) keep_middle_nodes(mesh, zone_elements(scene, mesh, warnings));
  return mesh;
}

FemBody make_fem_body(const SceneDesc& scene, std::vector<std::string>& warnings, const Progress& progress) {
  const std::string label = scene.source.where("body.shape");
  FemBody body;
  body.mesh = make_tet_mesh(scene, warnings);
  const FemMaterial material{scene.material.youngs_modulus_Pa, scene.material.poisson_ratio};
  const Supports supports = supports_of(scene, body.mesh);
  const LinearBody solver = factor_for_table(body.mesh, material, supports, label, progress);
  body.condensed = condense(solver, body.mesh, supports, label, progress);
  const PrecisionReport report = single_precision_error(body.condensed);
  body.precision_error = report.total_error;
  const bool single = scene.fem.precision == FemPrecision::kSingle ||
                      (scene.fem.precision == FemPrecision::kByError && single_precision_suffices(report));
  body.precision = single ? CompliancePrecision::kSingle : CompliancePrecision::kDouble;
  if (scene.fem.precision == FemPrecision::kSingle && !single_precision_suffices(report))
    warnings.push_back(scene.source.where("body.fem.precision") +
                       ": single precision changes forces by more than 1e-4; use \"auto\"");
  add_gauges(scene, solver, body, progress);
  return body;
}

}  // namespace palpate
