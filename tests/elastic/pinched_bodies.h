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
// References: LongReport.PinchedBodies, one mesh each (2026-11-25).
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
     {{{{4.93754, 2.38186, -0.01764}, {-4.94372, 2.39395, 0.01601}},
       {{18.40635, 9.03601, 0.02342}, {-18.42743, 9.01469, 0.04338}},
       {{15.95719, 7.51532, 0.02477}, {-20.86020, 10.81569, 0.06068}}}}},
    {"tube",
     "shape = \"hollow_cylinder\"\nradius_mm = 28\nheight_mm = 40\nwall_mm = 10\ntriangles = 4032\n",
     5e5,
     0.45,
     5e-3,
     5e-3,
     28e-3,
     32e-3,
     2.7e-3,
     {{{{1.02755, 0.10955, 0.00046}, {-1.03089, 0.11246, 0.00084}},
       {{3.72518, 0.37419, -0.00059}, {-3.73189, 0.37806, -0.00019}},
       {{3.28182, 0.27010, -0.00230}, {-4.20817, 0.50439, 0.00298}}}}},
    {"tube_of_half_the_wall",
     "shape = \"hollow_cylinder\"\nradius_mm = 28\nheight_mm = 40\nwall_mm = 5\ntriangles = 4032\n",
     5e5,
     0.45,
     5e-3,
     2.5e-3,
     28e-3,
     32e-3,
     1.7e-3,
     {{{{0.21086, 0.02208, -0.00008}, {-0.21094, 0.02191, 0.00000}},
       {{0.62695, 0.06208, -0.00037}, {-0.62765, 0.06215, -0.00016}},
       {{0.56387, 0.04231, -0.00006}, {-0.69535, 0.08747, 0.00001}}}}},
}};

}  // namespace palpate::test
