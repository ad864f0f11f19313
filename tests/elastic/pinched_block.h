// The gripper of pinch_block on its block as an elastic body, without friction: what the large-strain reference of
// tests/strain/slow solves.
#pragma once

#include <array>
#include <string>

namespace palpate::test {

inline constexpr double kJawHeight_m = 0.020, kJawRadius_m = 0.010, kJawHalf_m = 0.005, kBlockHalf_m = 0.012;
// How deep either jaw is, and the force on the right one. LongReport.PinchedBlock (2026-11-25).
struct BlockState {
  double closed_m, force_N;
};
inline constexpr std::array<BlockState, 2> kBlockStates = {{{5e-4, 1.07767}, {1e-3, 2.70096}}};

inline std::string pinched_block() {
  const auto jaw = [](const char* side) {
    return std::string("[[tool.piece]]\nshape = \"capsule\"\nradius_mm = 10\nlength_mm = 30\nposition_mm = [") + side +
           "19, 0, 0]\nslide_mm = [" + side + "8, 0, 0]\n" + (*side == '-' ? "part = 1\n" : "");
  };
  return "name = \"pinched_block\"\n[body]\nshape = \"box\"\nsize_mm = [24, 30, 24]\n[body.fem]\nedge_mm = 4\n"
         "[body.elastic]\nsoft_modes = 3\nlinear_modes = 20\n[body.material]\nyoungs_modulus_Pa = 2e5\n"
         "poisson_ratio = 0.45\ndensity_kg_per_m3 = 1100\n[body.fixed]\nbase_height_mm = 0\n[contact]\n"
         "backend = \"elastic\"\nmax_depth_mm = 4\n[friction]\nlaw = \"none\"\n[gripper]\nclosing_s = 1\n"
         "stop_force_N = 1000\n" +
         jaw("") + jaw("-") +
         "[device]\nname = \"sim-6dof\"\n[path]\npoint = [ { time_s = 0, position_mm = [0, 45, 0] } ]\n";
}

}  // namespace palpate::test
