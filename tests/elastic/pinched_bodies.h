// Bodies between two fingers: the cases of test_coupled_ticks.cpp and of their large-strain references.
#pragma once

#include <array>
#include <cmath>
#include <ostream>
#include <string>

#include "rt_core/tick.h"
#include "tests/elastic/two_balls_on_an_arch.h"

namespace palpate::test {

// A jaw's ball, described where its surface is kPinchDeepest_m inside the body; an open gripper has it kPinchWay_m
// away.
inline constexpr double kPinchBall_m = 8e-3, kPinchDeepest_m = 4e-3, kPinchWay_m = 8e-3;

struct PinchState {
  double closed_m, aside_m;  // how deep either ball is along x; how far both are moved towards +x
};
inline constexpr std::array<PinchState, 3> kPinchStates = {{{1e-3, 0}, {3e-3, 0}, {3e-3, 1e-3}}};

// A round body about the z axis, pinched along x at a height.
struct PinchedBody {
  const char* name;
  const char* body;  // keys of [body]
  double youngs_modulus_Pa, poisson_ratio, base_m, edge_m;
  double outer_m, height_m;  // radius about the axis; of the balls' centres above the body's lowest point
  double fine_m;             // elements of the reference under the balls
  std::array<PairForces, kPinchStates.size()> reference;

  // A ball's centre, from the body's axis, where it touches from the right.
  double touches_m() const {
    const double off = outer_m + kPinchBall_m, above = height_m - outer_m;
    return std::sqrt(off * off - above * above);
  }
  // Where that ball touches.
  Vec3 place_m(double side) const {
    const double share = outer_m / (outer_m + kPinchBall_m);
    return {side * share * touches_m(), outer_m + share * (height_m - outer_m), 0};
  }
  Vec3 ball_m(const PinchState& state, double side) const {
    return {state.aside_m + side * (touches_m() - state.closed_m), height_m, 0};
  }
  std::string scene() const {
    const auto mm = [](double x_m) { return std::to_string(1e3 * x_m); };
    const auto jaw = [&](double side) {
      return "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = " + mm(kPinchBall_m) + "\nposition_mm = [" +
             mm(side * (touches_m() - kPinchDeepest_m)) + ", 0, 0]\nslide_mm = [" + mm(side * kPinchWay_m) +
             ", 0, 0]\n" + (side < 0 ? "part = 1\n" : "");
    };
    return "name = \"pinched\"\n[body]\n" + std::string(body) +
           "axis = \"z\"\n[body.material]\nyoungs_modulus_Pa = " + std::to_string(youngs_modulus_Pa) +
           "\npoisson_ratio = " + std::to_string(poisson_ratio) +
           "\ndensity_kg_per_m3 = 1100\n[body.fixed]\nbase_height_mm = " + mm(base_m) +
           "\n[body.fem]\nedge_mm = " + mm(edge_m) +
           "\n[body.elastic]\nsoft_modes = 4\nlinear_modes = 20\n[contact]\nbackend = \"elastic\"\nmax_depth_mm = 6\n"
           "[friction]\nlaw = \"none\"\n[gripper]\nclosing_s = 0.2\nstop_force_N = 1000\n" +
           jaw(1) + jaw(-1) +
           "[device]\nname = \"sim-6dof\"\n[path]\npoint = [ { time_s = 0, position_mm = [0, 200, 0] } ]\n";
  }
};

inline void PrintTo(const PinchedBody& body, std::ostream* out) { *out << body.name; }

// A thick ring that stands in a clamp, above its axis; a tube that lies on a strip, at its sides; its wall halved.
// References: LongReport/LongPinch, one mesh each, of 7,103, 7,651 and 22,654 nodes (2026-11-29). The meshes of
// 2026-11-25, before the sizing changed, gave forces within 0.5 % of these.
inline const std::array<PinchedBody, 3> kPinchedBodies = {{
    {"ring",
     "shape = \"ring\"\nradius_mm = 50\nwall_mm = 20\ntriangles = 4608\n",
     3e6,
     0.47,
     35e-3,
     5e-3,
     50e-3,
     75e-3,
     2.7e-3,
     {{{{4.94209, 2.39075, -0.00026}, {-4.94671, 2.39512, 0.01724}},
       {{18.44389, 9.06006, -0.00317}, {-18.45934, 9.03160, 0.03738}},
       {{15.98118, 7.52940, 0.08310}, {-20.90235, 10.83931, 0.12702}}}}},
    {"tube",
     "shape = \"hollow_cylinder\"\nradius_mm = 28\nheight_mm = 40\nwall_mm = 10\ntriangles = 4032\n",
     5e5,
     0.45,
     5e-3,
     5e-3,
     28e-3,
     32e-3,
     2.7e-3,
     {{{{1.02783, 0.10958, 0.00047}, {-1.03022, 0.11234, 0.00083}},
       {{3.72615, 0.37447, -0.00057}, {-3.72863, 0.37709, -0.00033}},
       {{3.28194, 0.27011, -0.00229}, {-4.20368, 0.50273, 0.00269}}}}},
    {"tube_of_half_the_wall",
     "shape = \"hollow_cylinder\"\nradius_mm = 28\nheight_mm = 40\nwall_mm = 5\ntriangles = 4032\n",
     5e5,
     0.45,
     5e-3,
     2.5e-3,
     28e-3,
     32e-3,
     1.7e-3,
     {{{{0.21096, 0.02231, -0.00006}, {-0.21080, 0.02210, 0.00001}},
       {{0.62734, 0.06262, -0.00032}, {-0.62734, 0.06268, 0.00006}},
       {{0.56400, 0.04230, -0.00004}, {-0.69458, 0.08735, 0.00030}}}}},
}};

}  // namespace palpate::test
