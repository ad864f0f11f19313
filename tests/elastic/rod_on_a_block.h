// A rod that lies on a block, as an elastic body and as the large-strain reference of tests/strain/slow has it: without
// friction, level or leaning along its axis.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "rt_core/vec.h"

namespace palpate::test {

inline constexpr double kRodRadius_m = 6e-3, kRodHalf_m = 8e-3, kRodBlockTop_m = 24e-3;
// How deep the middle of its axis is, and its lean; the force upwards by LongReport.RodOnABlock (2026-11-26).
struct RodState {
  double depth_m, lean_rad, force_N;
};
inline constexpr std::array<RodState, 1> kRodStates = {{{3e-4, 0, 0.63841}}};

inline Vec3 rod_middle_m(const RodState& state) { return {0, kRodBlockTop_m + kRodRadius_m - state.depth_m, 0}; }
// Its +z end down.
inline Vec3 rod_axis(const RodState& state) { return {0, -std::sin(state.lean_rad), std::cos(state.lean_rad)}; }

inline std::string rod_on_a_block(const std::string& edge_mm = "4") {
  return "name = \"rod_on_a_block\"\n[body]\nshape = \"box\"\nsize_mm = [40, 24, 40]\n[body.fem]\nedge_mm = " +
         edge_mm +
         "\n[body.elastic]\nsoft_modes = 4\nlinear_modes = 20\n[body.material]\nyoungs_modulus_Pa = 2e5\n"
         "poisson_ratio = 0.45\ndensity_kg_per_m3 = 1100\n[body.fixed]\nbase_height_mm = 0\n[contact]\n"
         "backend = \"elastic\"\nmax_depth_mm = 3\n[friction]\nlaw = \"none\"\n[[tool.piece]]\nshape = \"capsule\"\n"
         "radius_mm = 6\nlength_mm = 28\npoints = 1\n[device]\nname = \"sim-6dof\"\n[path]\npoint = [ { time_s = 0, "
         "position_mm = [0, 60, 0] } ]\n";
}

}  // namespace palpate::test
