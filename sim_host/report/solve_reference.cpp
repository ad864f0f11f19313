#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>

#include "config/bake/elastic_check.h"
#include "config/bake/elastic_mesh.h"
#include "config/bake/image_rules.h"
#include "config/body/body_card.h"
#include "config/body/supports.h"
#include "config/response/press_shape.h"
#include "config/scene/config_error.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/report/reference_curve.h"

namespace palpate {

namespace {

// Of the deepest: closer where a contact begins, because its force grows with a power of the depth; less deep it would
// be smaller than three elements.
constexpr double kDepths[] = {0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
// Edges under the ball, of the contact's radius, and elements over the axisymmetric one's finely meshed zone.
constexpr double kFineShare = 0.34, kCoarseShare = 0.5;
constexpr int kFineElements = 28, kCoarseElements = 18;
constexpr double kExtents[] = {1, 1.1, 1.25, 1.5};  // of the finely meshed zone's default
// Elements of the body away from the ball, of the scene's own.
constexpr double kFineBody = 0.75;

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

// Under the ball a fourth of its radius times kThinned apart.
void keep_surface(ReferenceCurve& curve, const std::vector<elastic::MovedPlace>& places) {
  constexpr double kFine = 0.25 * elastic::kThinned;
  curve.surface.depth_m = curve.depth_m.back();
  curve.surface.place = elastic::thinned(places, curve.press.place_m, kFine * curve.press.radius_m);
}

ReferenceCurve begun(const PressPlace& press) {
  ReferenceCurve curve;
  curve.press = press;
  for (const double share : kDepths) curve.depth_m.push_back(share * press.depth_m);
  curve.made = today();
  return curve;
}

// A body of revolution under a press along its axis.
bool is_axisymmetric(const SceneDesc& scene, const PressPlace& press, fem::PressBody& body) {
  try {
    body = pressed_body(scene, "body.shape");
  } catch (const ConfigError&) {
    return false;
  }
  const bool box = scene.body.shape == BodyShape::kBox;
  return !box && press.normal.y > 1 - 1e-9 && std::hypot(press.place_m.x, press.place_m.z) < 1e-9;
}

ReferenceCurve solve_revolved(const fem::PressBody& body, const PressPlace& press) {
  ReferenceCurve curve = begun(press);
  fem::RigidTool ball;
  ball.radius_m = press.radius_m;
  // Whether a press of a stiff block finds its first equilibrium depends on where the element edges happen to lie
  // (2026-11-22): the first of some meshes that comes to the end.
  const auto pressed = [&](int elements) {
    fem::PressCurve best;
    for (const double share : kExtents) {
      fem::PressMeshing meshing = fem::default_meshing(body, ball, press.depth_m, elements);
      meshing.fine_extent_m *= share;
      fem::PressCurve made =
          fem::press_as_far_as_possible(body, ball, fem::StrainLaw::kNeoHookean, curve.depth_m, meshing);
      if (best.points.empty() || made.points.size() > best.points.size()) best = std::move(made);
      if (best.points.size() == curve.depth_m.size()) break;
    }
    return best;
  };
  const fem::PressCurve fine = pressed(kFineElements), coarse = pressed(kCoarseElements);
  curve.depth_m.resize(fine.points.size());
  for (std::size_t i = 0; i < fine.points.size(); ++i) {
    curve.force_N.push_back(fine.points[i].force_N * press.normal);
    curve.coarse_N.push_back(i < coarse.points.size() ? coarse.points[i].force_N
                                                      : std::numeric_limits<double>::quiet_NaN());
  }
  if (!fine.points.empty())
    keep_surface(curve, elastic::moved_places(fine.mesh, fine.points.back().u_m, press.place_m));
  curve.solver = "axisymmetric Q9, neo-Hookean, frictionless";
  curve.mesh = fmt::format("{} nodes, {} elements under the ball; coarse: {} nodes, {} elements",
                           fine.mesh.node_count(), kFineElements, coarse.mesh.node_count(), kCoarseElements);
  return curve;
}

// One mesh in space. `nodes`: how many it has.
CheckPress solve_solid(const SceneDesc& elastic, const ReferenceCurve& curve, double edge_share, int& nodes,
                       std::vector<elastic::MovedPlace>* surface = nullptr) {
  const SceneModel baked(elastic);
  ImageContents image = contents_of(baked.model());
  std::vector<std::string> unheard;
  const TetMesh mesh = make_elastic_mesh(elastic, image, unheard);
  CheckPress press{curve.press.place_m, curve.press.normal, curve.press.radius_m, curve.depth_m, false, {}, {}};
  SceneDesc strong = elastic;
  strong.device.force_max_N = 1e6;  // the curve ends where the caller says, not at what a device renders
  nodes = press_elements(strong, image, mesh, press, edge_share, surface);
  return press;
}

ReferenceCurve solve_tets(const SceneDesc& scene, const PressPlace& press, const Progress& progress) {
  ReferenceCurve curve = begun(press);
  SceneDesc elastic = scene_of(*find_variant("elastic"), scene, press);
  int nodes = 0, coarse_nodes = 0;
  if (progress) progress("coarse elements", 0);
  const CheckPress coarse = solve_solid(elastic, curve, kCoarseShare, coarse_nodes);
  if (progress) progress("fine elements", 0);
  if (!is_auto(elastic.fem.edge_m)) elastic.fem.edge_m *= kFineBody;
  std::vector<elastic::MovedPlace> surface;
  const CheckPress fine = solve_solid(elastic, curve, kFineShare, nodes, &surface);
  if (progress) progress("fine elements", 1);
  curve.depth_m = fine.depth_m;
  curve.force_N = fine.force_w_N;
  if (!surface.empty()) keep_surface(curve, surface);
  for (std::size_t i = 0; i < fine.depth_m.size(); ++i)
    curve.coarse_N.push_back(i < coarse.reference_N.size() ? coarse.reference_N[i]
                                                           : std::numeric_limits<double>::quiet_NaN());
  curve.solver = "T10, neo-Hookean, frictionless";
  curve.mesh = fmt::format("{} nodes, {:.3g} of the contact's radius under the ball; coarse: {} nodes, {:.3g}", nodes,
                           kFineShare, coarse_nodes, kCoarseShare);
  return curve;
}

}  // namespace

ReferenceCurve solve_reference(const SceneDesc& scene, const PressPlace& press, const Progress& progress) {
  fem::PressBody body;
  ReferenceCurve curve =
      is_axisymmetric(scene, press, body) ? solve_revolved(body, press) : solve_tets(scene, press, progress);
  if (curve.depth_m.size() < 3)
    throw std::runtime_error(
        fmt::format("{}: the elements came {} of {} depths far: press elsewhere, less deep, or hold more of the body",
                    scene.name, curve.depth_m.size(), std::size(kDepths)));
  curve.press.depth_m = curve.depth_m.back();
  return curve;
}

}  // namespace palpate
