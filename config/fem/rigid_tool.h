// Rigid analytic tools of the large-strain solver: signed distance with its first and second derivatives.
#pragma once

#include <cstdint>

#include "config/fem/large_strain_mesh.h"

namespace palpate::fem {

// The distance is measured from the tool's origin, which the solver moves. In the plane y is the pressing axis and the
// tool lies above its tip: kPunch and kCone have their tip (the flat face, the rounded end) at the origin.
enum class RigidShape : std::uint8_t {
  kBall,      // circle, cylinder across the plane, or sphere: `radius_m` around the origin
  kPlane,     // half space behind the plane through the origin; `axis` points to the free side
  kPunch,     // plane only: flat face |x| <= radius_m, edge rounded by fillet_m
  kCone,      // plane only: cone about y with half_apex_rad from the axis, tip rounded by fillet_m
  kCylinder,  // space only: cylinder of radius_m about `axis`, infinite or with round ends (half_length_m)
};

struct RigidTool {
  RigidShape shape = RigidShape::kBall;
  double radius_m = 0;
  double fillet_m = 0;
  double half_apex_rad = 0;
  double half_length_m = 1e30;               // of a cylinder's axis, to the middles of its round ends
  std::array<double, 3> axis = {0, 1, 0};    // unit
  std::array<double, 3> press = {0, -1, 0};  // unit, from the tool into the body: how the linear law measures its gap
};

// Gap of a point from the tool (negative inside), unit gradient (out of the tool, into the body), curvature of the gap.
template <int kDim>
struct Gap {
  double value_m = 0;
  Point<kDim> normal{};
  std::array<Point<kDim>, static_cast<std::size_t>(kDim)> curvature_per_m{};
};
template <int kDim>
Gap<kDim> gap_of(const RigidTool& tool, const Point<kDim>& from_origin_m);

// The gap along `press`, which is its normal: classical small-strain contact (Hertz, Signorini). Beside the tool's
// shadow it is kNoGap. Not for kPlane tools whose axis is not `press`.
inline constexpr double kNoGap = 1e30;
template <int kDim>
Gap<kDim> gap_along_press(const RigidTool& tool, const Point<kDim>& from_origin_m);

}  // namespace palpate::fem
