#include "tests/elastic/elastic_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/elastic/solid_mesh.h"
#include "config/fem/tet_procedural.h"

namespace palpate::elastic {

namespace {

constexpr double kDegree = std::numbers::pi / 180, kRound = 1e-9;
constexpr double kInner_m = 0.020, kOuter_m = 0.030, kFingerRadius_m = 0.008;
constexpr double kFingerAngle_rad[2] = {90 * kDegree, 20 * kDegree};

fem::Point<2> polar(double r, double a) { return {r * std::cos(a), r * std::sin(a)}; }
double radius_of(const fem::Point<2>& p) { return std::hypot(p[0], p[1]); }
double angle_of(const fem::Point<2>& p) { return std::atan2(p[1], p[0]); }

fem::StrainBody rubber(fem::Kinematics kinematics) {
  fem::StrainBody body;
  body.youngs_modulus_Pa = 3e6;
  body.poisson_ratio = 0.45;
  body.kinematics = kinematics;
  body.thickness_m = 0.01;
  return body;
}

}  // namespace

ElasticScene<2> clip_scene(double element_m) {
  fem::ClipMesh clip = fem::clip_mesh(element_m);
  return {std::move(clip.mesh), fem::clip_material(), std::move(clip.fixed), std::move(clip.contact_nodes)};
}

ElasticScene<2> plates_scene(int elements_around) {
  ElasticScene<2> scene;
  scene.mesh = fem::make_plane_mesh({{fem::uniform_steps(kInner_m, kOuter_m, std::max(3, elements_around / 16)),
                                      fem::uniform_steps(0, 2 * std::numbers::pi, elements_around), polar}},
                                    1e-8);
  scene.material = rubber(fem::Kinematics::kPlaneStress);
  for (const fem::Point<2>& p : scene.mesh.nodes_m)
    for (const double x : p) scene.fixed.push_back(std::abs(x) < kRound);
  scene.contact_nodes = fem::nodes_where<2>(
      scene.mesh, [](const fem::Point<2>& p) { return radius_of(p) > kOuter_m - kRound && std::abs(p[1]) > 0.01; });
  return scene;
}

ElasticScene<2> fingers_scene(double contact_element_m, double inner_m) {
  ElasticScene<2> scene;
  scene.mesh = fem::RingUnderFingers(contact_element_m, fem::StrainLaw::kNeoHookean).mesh;
  for (fem::Point<2>& p : scene.mesh.nodes_m) {  // another wall: the radii stretched, the outer one kept
    const double r = kOuter_m - (kOuter_m - radius_of(p)) * (kOuter_m - inner_m) / (kOuter_m - kInner_m);
    p = polar(r, angle_of(p));
  }
  scene.material = rubber(fem::Kinematics::kPlaneStrain);
  for (const fem::Point<2>& p : scene.mesh.nodes_m) {
    const bool held = radius_of(p) > kOuter_m - kRound && std::abs(angle_of(p) + 90 * kDegree) < (25 + 1e-6) * kDegree;
    scene.fixed.push_back(held);
    scene.fixed.push_back(held);
  }
  scene.contact_nodes = fem::nodes_where<2>(scene.mesh, [](const fem::Point<2>& p) {
    return radius_of(p) > kOuter_m - kRound && (std::abs(angle_of(p) - kFingerAngle_rad[0]) < 16 * kDegree ||
                                                std::abs(angle_of(p) - kFingerAngle_rad[1]) < 16 * kDegree);
  });
  return scene;
}

fem::Point<2> finger_origin(int finger, double depth_m) {
  return polar(kOuter_m + kFingerRadius_m - depth_m, kFingerAngle_rad[finger]);
}

double finger_force_N(int finger, const StaticState<2>& state) {
  const fem::Point<2> out = polar(1, kFingerAngle_rad[finger]),
                      f = state.force_on_tool_N[static_cast<std::size_t>(finger)];
  return out[0] * f[0] + out[1] * f[1];
}

ElasticScene<3> block_scene() {
  const fem::PressBody block = fem::rubber_block();
  constexpr int kSectors = 12;
  const std::vector<double> radii = {0.002, 0.004, 0.0065, 0.0105, 0.018, 0.032, block.outer_radius_m};
  PlaneMesh plane;
  plane.node_m.push_back({});
  for (const double r : radii)
    for (int s = 0; s < kSectors; ++s)
      plane.node_m.push_back(
          {r * std::cos(2 * std::numbers::pi * s / kSectors), r * std::sin(2 * std::numbers::pi * s / kSectors), 0});
  const auto node = [&](int ring, int s) { return 1 + ring * kSectors + s % kSectors; };
  for (int s = 0; s < kSectors; ++s) {
    plane.triangle.push_back({0, node(0, s), node(0, s + 1)});
    for (int ring = 0; ring + 1 < static_cast<int>(radii.size()); ++ring) {
      plane.triangle.push_back({node(ring, s), node(ring + 1, s), node(ring + 1, s + 1)});
      plane.triangle.push_back({node(ring, s), node(ring + 1, s + 1), node(ring, s + 1)});
    }
  }
  std::vector<double> height = {-block.height_m, -0.032, -0.018, -0.0105, -0.0065, -0.004, -0.002, 0};
  TetMesh tets = extrude(plane, height);
  add_middle_nodes(tets);
  ElasticScene<3> scene;
  scene.mesh = solid_mesh(tets, "block");
  scene.material.youngs_modulus_Pa = block.youngs_modulus_Pa;
  scene.material.poisson_ratio = block.poisson_ratio;
  scene.material.kinematics = fem::Kinematics::kSolid;
  scene.fixed = fixed_components(hold_where(tets, [&](Vec3 p) { return p.z < -block.height_m + kRound; }));
  scene.contact_nodes = fem::nodes_where<3>(
      scene.mesh, [](const fem::Point<3>& p) { return p[2] > -kRound && std::hypot(p[0], p[1]) < 0.0021; });
  return scene;
}

ElasticScene<3> tongue_scene(double thickness_m) {
  ElasticScene<3> scene;
  scene.mesh = fem::sweep(
      fem::make_plane_mesh({{fem::uniform_steps(0, kTongueLength_m, 12), fem::uniform_steps(0, thickness_m, 2),
                             [](double s, double t) {
                               return fem::Point<2>{s, t};
                             }}},
                           1e-8),
      fem::uniform_steps(-0.005, 0.005, 2));
  scene.material = rubber(fem::Kinematics::kSolid);
  for (const fem::Point<3>& p : scene.mesh.nodes_m) scene.fixed.insert(scene.fixed.end(), 3, p[0] < kRound);
  scene.contact_nodes = fem::nodes_where<3>(scene.mesh, [&](const fem::Point<3>& p) {
    return p[1] > thickness_m - kRound && p[0] > 0.02 && std::abs(p[2]) < 0.0051;
  });
  return scene;
}

}  // namespace palpate::elastic
