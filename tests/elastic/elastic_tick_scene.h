// Elastic bodies in the tick: small scenes with one sphere, pressed by giving the tool its pose.
#pragma once

#include <algorithm>
#include <string>

#include "tests/support/baked_scene.h"

namespace palpate::test {

inline std::string number(double x) { return std::to_string(x); }

// `body`: the keys of [body]; the sphere's centre is the tool's origin.
inline std::string elastic_scene(const std::string& body, double base_mm, double edge_mm, double radius_mm,
                                 int soft_modes, const std::string& friction = "none") {
  return "name = \"elastic\"\n[body]\n" + body +
         "[body.material]\nyoungs_modulus_Pa = 3e6\npoisson_ratio = 0.45\ndensity_kg_per_m3 = 1100\n"
         "[body.fixed]\nbase_height_mm = " +
         number(base_mm) + "\n[body.fem]\nedge_mm = " + number(edge_mm) +
         "\n[body.elastic]\nsoft_modes = " + number(soft_modes).substr(0, number(soft_modes).find('.')) +
         "\n[contact]\nbackend = \"elastic\"\nmax_depth_mm = 6\n[friction]\nlaw = \"" + friction +
         "\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = " + number(radius_mm) +
         "\n[device]\nname = \"sim-6dof\"\n[path]\nhand_stiffness_N_per_m = 800\nhand_damping_Ns_per_m = 8\npoint = [ "
         "{ time_s = 0.0, position_mm = [0, 200, 0] }, { time_s = 1.0, position_mm = [0, 200, 0] } ]\n";
}
// Tube of 35 mm radius, 70 mm long, held up to its axis: an arch under the tip.
inline std::string arch(double wall_mm) {
  return "shape = \"hollow_cylinder\"\nradius_mm = 35\nheight_mm = 70\nwall_mm = " + number(wall_mm) +
         "\naxis = \"z\"\ntriangles = 3024\n";
}

// Moves the tool by at most `step_m` a tick, then holds it for three.
inline const Output& move_to(Bench& bench, Vec3 from, Vec3 to, double step_m = 2e-5) {
  const int steps = static_cast<int>(norm(to - from) / step_m) + 1;
  for (int i = 1; i <= steps; ++i) bench.tick_at({from + (static_cast<double>(i) / steps) * (to - from), {}}, {});
  for (int i = 0; i < 3; ++i) bench.tick_at({to, {}}, {});
  return bench.output;
}
// Largest change of the force from tick to tick while the tool is held for 60 ticks; the first `settling` do not count.
inline double change_while_held_N(Bench& bench, const Pose& at, int settling) {
  double change = 0;
  Vec3 before;
  for (int i = 0; i < 60; ++i) {
    const Vec3 force = bench.tick_at(at, {}).contact_w.force_N;
    if (i > settling) change = std::max(change, norm(force - before));
    before = force;
  }
  return change;
}
// Force upwards on a tip lowered by `depth_m` from `top`.
inline double press_N(const Model& model, Vec3 top, double depth_m) {
  Bench bench(model);
  return move_to(bench, top, top - Vec3{0, depth_m, 0}).contact_w.force_N.y;
}

}  // namespace palpate::test
