#include "config/bake/elastic_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "config/bake/elastic_mesh.h"
#include "config/bake/element_materials.h"
#include "config/bake/image_rules.h"
#include "config/bake/tick_memory.h"
#include "config/bake/tool_points.h"
#include "config/body/supports.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/large_strain_solver.h"
#include "config/response/corner_normals.h"
#include "config/response/tip_bake.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/tick.h"

namespace palpate {

namespace {

constexpr std::array<double, 5> kDepths = {0.125, 0.25, 0.5, 0.75, 1};  // of the deepest
// Of what the device renders: a press ends there. Deeper, nobody feels it.
constexpr double kForces = 3;
// Of the way from a place to the nearest held node: deeper no law of a layer is made for (config/elastic/width_law.h).
constexpr double kDeepest = 0.45;
constexpr double kReachShare = 1.2;  // how far the fine elements reach, of the contact's radius at the deepest
// A check in per cent: penetration left, of a facet, residual, and steps of several facets. A tube's forces change by
// 0.6 % at most from elements of 0.3 radii, 1e-3, 1e-6 and steps of one facet, in a twentieth of the time (2026-11-22).
constexpr double kGapTolerance = 5e-3, kResidualTolerance = 1e-4, kStepFacets = 3;
// Cosine between a corner's normal and its vertex's: below it they belong to an edge.
constexpr double kSharp = 0.99;
// Force along the surface, of that along the normal: from there on the body goes out from under a frictionless ball,
// and its force depends on the smallest thing.
constexpr double kSlides = 0.5;
// Steps that converge take up to 20 iterations; where the body goes out from under the ball none does, and trying on
// costs more than all the rest of a press (2026-11-22: 40 iterations and 4 cuts, 63 of 83 s on a ring).
constexpr int kMostNewton = 25, kMostCuts = 2;
constexpr double kStep_m = 5e-5;  // of the ball in a tick

fem::Point<3> point(Vec3 p) { return {p.x, p.y, p.z}; }
Vec3 vec(const fem::Point<3>& p) { return {p[0], p[1], p[2]}; }

double contact_radius_m(double radius_m, double depth_m) {
  // A sphere on a half space, a = sqrt(R d), and on anything softer less.
  return square_root(radius_m * std::min(depth_m, radius_m));
}
// On a slender body most of the depth is bending, and the contact is as large as its force makes it (Hertz 1882).
double pressed_radius_m(double modulus_Pa, double radius_m, double force_N) {
  return std::cbrt(0.75 * force_N * radius_m / modulus_Pa);
}
// Of the element nearest to the place.
double contact_modulus_at(const SceneDesc& scene, const ModelParams& params, const TetMesh& mesh, Vec3 place_m) {
  const std::vector<fem::ElementMaterial> of_element = element_materials(scene, mesh);
  fem::ElementMaterial material{params.youngs_modulus_Pa, params.poisson_ratio};
  double least = kHuge;
  for (std::size_t t = 0; t < of_element.size(); ++t) {
    Vec3 middle;
    for (std::size_t k = 0; k < 4; ++k) middle += 0.25 * mesh.node_m[static_cast<std::size_t>(mesh.tet[t].node[k])];
    if (!(norm(middle - place_m) < least)) continue;
    least = norm(middle - place_m);
    material = of_element[t];
  }
  return material.youngs_modulus_Pa / (1 - material.poisson_ratio * material.poisson_ratio);
}
// What the baked body makes of the press, up to what the device can render.
double expected_N(const SceneDesc& scene, const ImageContents& image, const CheckPress& press) {
  const CheckedPress baked = press_baked(with_ball(scene, image, press.radius_m), press);
  return std::min(kForces * scene.device.force_max_N, *std::ranges::max_element(baked.force_N));
}

// A ball comes to the place from outside, along the normal, touching nothing else.
bool is_reachable(const Model& surface, Vec3 place_m, Vec3 normal, double radius_m, double size_m) {
  constexpr int kStations = 24;
  for (int i = 0; i <= kStations; ++i) {
    const double out = radius_m * 1.01 + size_m * i / kStations;
    const SurfacePoint nearest = closest_surface_point(surface, place_m + out * normal, kHuge, -1);
    if (!nearest.found || !(nearest.signed_distance_m > 0.98 * radius_m)) return false;
  }
  return true;
}

// Vertices where the surface has an edge.
std::vector<Vec3> sharp_corners(const SceneDesc& scene, const ImageContents& image) {
  const std::vector<CornerNormals> normals = corner_normals(scene.body, image.vertex_m, image.triangle);
  std::vector<Vec3> corners;
  for (std::size_t t = 0; t < normals.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(image.triangle[t].vertex[k]);
      if (dot(normals[t].normal[k], image.vertex_normal[v]) < kSharp) corners.push_back(image.vertex_m[v]);
    }
  return corners;
}

double nearest_m(const std::vector<Vec3>& places, Vec3 p) {
  double least = kHuge;
  for (const Vec3 q : places) least = std::min(least, norm(p - q));
  return least;
}
std::vector<Vec3> held_nodes(const TetMesh& mesh, const Supports& supports) {
  std::vector<Vec3> held;
  for (std::size_t n = 0; n < mesh.node_m.size(); ++n)
    if (supports[n] != 0) held.push_back(mesh.node_m[n]);
  return held;
}

}  // namespace

std::vector<CheckPress> check_places(const SceneDesc& scene, const ImageContents& image, const TetMesh& mesh,
                                     int count) {
  const Model surface = model_of(image);
  const double depth = scene.contact.max_depth_m;
  double radius = 0;
  for (const ToolPoint& tip : image.tool_point) radius = std::max(radius, tip.margin_m);
  radius = std::max(radius, depth);
  std::vector<Vec3> taken;
  const double apart = 1.2 * contact_radius_m(radius, depth);
  const auto nearest = [&](Vec3 p) { return nearest_m(taken, p); };
  std::vector<std::size_t> open;
  const auto look_beside = [&](const Supports& supports) {
    taken = held_nodes(mesh, supports);
    std::ranges::copy(sharp_corners(scene, image), std::back_inserter(taken));
    for (std::size_t v = 0; v < image.vertex_m.size(); ++v)
      if (nearest(image.vertex_m[v]) > apart &&
          is_reachable(surface, image.vertex_m[v], image.vertex_normal[v], radius, surface.params.surface_size_m))
        open.push_back(v);
  };
  const Supports supports = supports_of(scene, mesh);
  const std::vector<Vec3> held = held_nodes(mesh, supports);
  look_beside(supports_and_beds(supports, beds_of(scene, mesh)));
  if (open.empty()) look_beside(supports);  // a bed all around is no reason not to press
  std::vector<CheckPress> presses;
  while (static_cast<int>(presses.size()) < count && !open.empty()) {
    const std::size_t v = *std::ranges::max_element(
        open, [&](std::size_t a, std::size_t b) { return nearest(image.vertex_m[a]) < nearest(image.vertex_m[b]); });
    if (!presses.empty() && !(nearest(image.vertex_m[v]) > apart)) break;
    if (presses.empty()) taken.clear();
    taken.push_back(image.vertex_m[v]);
    presses.push_back({image.vertex_m[v], image.vertex_normal[v], radius, {}, false, {}});
    const double deepest = std::min(depth, kDeepest * nearest_m(held, image.vertex_m[v]));
    for (const double share : kDepths) presses.back().depth_m.push_back(deepest * share);
  }
  return presses;
}

int affordable_presses(int wanted, double factor_multiplications) {
  constexpr double kSeconds = 600;
  return static_cast<int>(clamp_to(kSeconds / press_seconds(factor_multiplications), 0, wanted));
}

int press_elements(const SceneDesc& scene, const ImageContents& image, const TetMesh& mesh, CheckPress& press,
                   double edge_share, std::vector<elastic::MovedPlace>* surface) {
  const double modulus_Pa = contact_modulus_at(scene, image.params, mesh, press.place_m);
  const double patch = std::min(contact_radius_m(press.radius_m, press.depth_m.back()),
                                pressed_radius_m(modulus_Pa, press.radius_m, expected_N(scene, image, press)));
  const Refinement zone{press.place_m, kReachShare * patch, edge_share * patch};
  const TetMesh fine = refine_elastic_mesh(scene, image, mesh, {&zone, 1});
  const fem::StrainMesh<3> solid = elastic::solid_mesh(fine, scene.source.where("body.shape"));
  const std::vector<bool> fixed = elastic::fixed_components(supports_of(scene, fine));
  std::vector<int> touched;
  for (int n = 0; n < solid.node_count(); ++n)
    if (!fixed[static_cast<std::size_t>(3 * n)] &&
        norm(fine.node_m[static_cast<std::size_t>(n)] - press.place_m) < 2 * zone.radius_m + press.depth_m.back())
      touched.push_back(n);
  fem::RigidTool ball;
  ball.radius_m = press.radius_m;
  fem::StrainOptions options;
  options.gap_tolerance = kGapTolerance;
  options.residual_tolerance = kResidualTolerance;
  options.step_facets = kStepFacets;
  options.stable = true;
  options.max_newton = kMostNewton;
  options.max_cuts = kMostCuts;
  fem::LargeStrainSolver<3> solver(solid, elastic_material(scene, image.params, fine), fixed, touched, {ball}, options);
  solver.place_tools({point(press.place_m + press.radius_m * press.normal)});
  const double most_N = kForces * scene.device.force_max_N;
  std::vector<std::vector<double>> u_m;  // at each depth
  for (const double depth : press.depth_m) {
    auto state = solver.move_tools({point(press.place_m + (press.radius_m - depth) * press.normal)});
    const Vec3 force = vec(state.force_on_tool_N[0]);
    const double along = dot(force, press.normal);
    press.slides = !state.converged || !(norm(force - along * press.normal) <= kSlides * along);
    if (press.slides || (along > most_N && !press.reference_N.empty())) break;
    press.reference_N.push_back(along);
    press.force_w_N.push_back(force);
    u_m.push_back(std::move(state.u_m));
    if (along > most_N) break;
  }
  if (press.slides && !press.reference_N.empty()) press.reference_N.pop_back();
  press.depth_m.resize(press.reference_N.size());
  press.force_w_N.resize(press.reference_N.size());
  if (surface != nullptr && !press.depth_m.empty())
    *surface = elastic::moved_places(solid, u_m[press.depth_m.size() - 1]);
  return solid.node_count();
}

ImageContents with_ball(const SceneDesc& scene, const ImageContents& image, double radius_m) {
  SceneDesc ball = scene;
  ball.articulation = Articulation::kRigid;
  ball.device.holds = HeldPart::kTool;
  ball.piece = {PieceDesc{}};
  ball.piece[0].radius_m = radius_m;
  ball.tip = {};
  ball.pair.clear();
  ImageContents out = image;
  put_tool(make_tool(ball.piece), out);
  out.tip_law.clear();
  out.factor.clear();
  out.joint.clear();
  out.params.articulation = Articulation::kRigid;
  out.params.held_part = HeldPart::kTool;
  out.params.friction_law = FrictionLaw::kNone;
  ResponseReport ignored;
  std::vector<std::string> unheard;
  bake_response(ball, out, ignored, unheard);
  return out;
}

CheckedPress press_baked(const ImageContents& with_ball, const CheckPress& press) {
  return press_model(model_of(with_ball), press);
}

CheckedPlace checked_place(const CheckPress& press, const CheckedPress& checked) {
  return {press.place_m,          press.radius_m,     press.depth_m.back(), press.reference_N.back(),
          checked.force_N.back(), checked.worst_error};
}

CheckedPress press_model(Model model, const CheckPress& press) {
  model.params.relax_share_1 = 0;  // compared before it relaxes
  TickMemory memory(model);
  Output output;
  Input input;
  input.drive = Drive::kTool;
  CheckedPress out;
  double depth = 0;
  for (std::size_t i = 0; i < press.depth_m.size(); ++i) {
    const auto go = [&](double to) {
      input.pose_w = {press.place_m + (press.radius_m - to) * press.normal, {}};
      tick(model, memory.state, memory.scratch, input, output);
    };
    const int steps = static_cast<int>((press.depth_m[i] - depth) / kStep_m) + 1;
    for (int k = 1; k <= steps; ++k) go(depth + (press.depth_m[i] - depth) * k / steps);
    for (int k = 0; k < 5; ++k) go(press.depth_m[i]);
    depth = press.depth_m[i];
    const double force = dot(output.contact_w.force_N, press.normal);
    out.force_N.push_back(force);
    double square = 0;
    for (const double p : memory.state.elastic.soft_rootJ) square += p * p;
    out.reach_rootJ = std::max(out.reach_rootJ, std::sqrt(square));
  }
  for (std::size_t i = 0; i < press.reference_N.size(); ++i) {
    const double error = out.force_N[i] / press.reference_N[i] - 1;
    out.worst_error = std::max(out.worst_error, std::abs(error));
    out.bias += error / static_cast<double>(press.reference_N.size());
  }
  return out;
}

}  // namespace palpate
