// A body of revolution pressed along its axis by a rigid tool: force over depth by the linear and by the large-strain
// law.
#pragma once

#include <vector>

#include "config/fem/large_strain_solver.h"

namespace palpate::fem {

struct PressBody {
  enum class Kind : std::uint8_t {
    kBlock,      // cylinder of outer_radius_m and height_m, bottom bonded, side free: a thick block or a thin layer
    kEllipsoid,  // of revolution, semi-axes outer_radius_m (across) and height_m (along the axis, half its height),
                 // all of it lower than fixed_below_m (height above the centre) fixed, its inside too
  };
  Kind kind = Kind::kBlock;
  double outer_radius_m = 0;
  double height_m = 0;
  double fixed_below_m = 0;
  bool slip_base = false;  // of a block: free to slide on its base
  double youngs_modulus_Pa = 0;
  double poisson_ratio = 0;
};

struct PressPoint {
  double depth_m = 0;
  double force_N = 0;
  double energy_J = 0;
  double contact_radius_m = 0;
  int newton_steps = 0;
  std::vector<double> u_m;  // [node][r, z]
};

struct PressCurve {
  StrainMesh<2> mesh;
  std::vector<PressPoint> points;
};

// Mesh step under the tool. A contact radius holds about a_max / step elements; three or more are needed, ten are good.
struct PressMeshing {
  double fine_extent_m =
      0;                 // radius and depth of the evenly meshed zone: a little more than the largest contact radius
  int fine_count = 20;   // elements over it
  double growth = 1.25;  // of the elements outside it
};
// Something sensible for a tool pressed to `depth_m`.
PressMeshing default_meshing(const PressBody& body, const RigidTool& tool, double depth_m, int fine_count);

// Tool: kBall, kPunch or kCone; its tip starts on the body's top. Depths rise from above 0. Throws ConfigError when a
// depth finds no equilibrium, naming the last one that did.
PressCurve press_axisymmetric(const PressBody& body, const RigidTool& tool, StrainLaw law,
                              const std::vector<double>& depths_m, const PressMeshing& meshing);
// The same, but the curve ends before the first depth without equilibrium.
PressCurve press_as_far_as_possible(const PressBody& body, const RigidTool& tool, StrainLaw law,
                                    const std::vector<double>& depths_m, const PressMeshing& meshing);

}  // namespace palpate::fem
