#include "config/fem/rigid_tool.h"

#include <algorithm>
#include <cmath>

namespace palpate::fem {

namespace {

template <int kDim>
Gap<kDim> flat_gap(const Point<kDim>& normal, double value_m) {
  Gap<kDim> gap;
  gap.value_m = value_m;
  gap.normal = normal;
  return gap;
}

// Distance to the foot of `across` (the vector from foot to point), less an offset. `axis` is a direction along which
// the distance does not change, or zero.
template <int kDim>
Gap<kDim> round_gap(const Point<kDim>& across, const Point<kDim>& axis, double offset_m) {
  Gap<kDim> gap;
  double square = 0;
  for (const double c : across) square += c * c;
  const double length = std::sqrt(square);
  if (!(length > 0)) {  // on the centre every direction is as good as another
    gap.value_m = -offset_m;
    gap.normal[1] = -1;
    return gap;
  }
  gap.value_m = length - offset_m;
  for (std::size_t i = 0; i < across.size(); ++i) gap.normal[i] = across[i] / length;
  for (std::size_t i = 0; i < across.size(); ++i)
    for (std::size_t j = 0; j < across.size(); ++j)
      gap.curvature_per_m[i][j] = ((i == j ? 1.0 : 0.0) - axis[i] * axis[j] - gap.normal[i] * gap.normal[j]) / length;
  return gap;
}

// The punch is its core, |x| <= R - f above y = f, blown up by the fillet radius f.
Gap<2> punch_gap(const RigidTool& tool, const Point<2>& p) {
  const double side = p[0] < 0 ? -1 : 1, x = std::abs(p[0]) - (tool.radius_m - tool.fillet_m), y = tool.fillet_m - p[1];
  if (x > 0 && y > 0) return round_gap<2>({side * x, -y}, {0, 0}, tool.fillet_m);
  // Inside the core the face is the way out, however deep a first guess lies.
  if (x > 0) return flat_gap<2>({side, 0}, x - tool.fillet_m);
  return flat_gap<2>({0, -1}, y - tool.fillet_m);
}

// The cone is a sharp cone with its apex at y = f, blown up by f.
Gap<2> cone_gap(const RigidTool& tool, const Point<2>& p) {
  const double side = p[0] < 0 ? -1 : 1, s = std::sin(tool.half_apex_rad), c = std::cos(tool.half_apex_rad);
  const double x = std::abs(p[0]), y = p[1] - tool.fillet_m;
  if (x * s + y * c <= 0) return round_gap<2>({side * x, y}, {0, 0}, tool.fillet_m);
  return flat_gap<2>({side * c, -s}, x * c - y * s - tool.fillet_m);
}

}  // namespace

template <>
Gap<2> gap_of<2>(const RigidTool& tool, const Point<2>& p) {
  switch (tool.shape) {
    case RigidShape::kPunch:
      return punch_gap(tool, p);
    case RigidShape::kCone:
      return cone_gap(tool, p);
    case RigidShape::kPlane:
      return flat_gap<2>({tool.axis[0], tool.axis[1]}, tool.axis[0] * p[0] + tool.axis[1] * p[1]);
    default:
      return round_gap<2>(p, {0, 0}, tool.radius_m);
  }
}

template <>
Gap<3> gap_of<3>(const RigidTool& tool, const Point<3>& p) {
  const double along = tool.axis[0] * p[0] + tool.axis[1] * p[1] + tool.axis[2] * p[2];
  if (tool.shape == RigidShape::kPlane) return flat_gap<3>(tool.axis, along);
  if (tool.shape != RigidShape::kCylinder) return round_gap<3>(p, {0, 0, 0}, tool.radius_m);
  const double on_axis = std::clamp(along, -tool.half_length_m, tool.half_length_m);
  Point<3> across = p;
  for (std::size_t i = 0; i < 3; ++i) across[i] -= on_axis * tool.axis[i];
  return round_gap<3>(across, on_axis == along ? tool.axis : Point<3>{}, tool.radius_m);
}

namespace {

// Height of the tool's surface above its origin's plane, against `press`, at distance `rho` from the press axis.
double profile(const RigidTool& tool, double rho) {
  const auto arc = [](double r, double x) { return x < r ? -std::sqrt(r * r - x * x) : kNoGap; };
  switch (tool.shape) {
    case RigidShape::kPlane:
      return 0;
    case RigidShape::kPunch:
      return rho <= tool.radius_m - tool.fillet_m
                 ? 0
                 : tool.fillet_m + arc(tool.fillet_m, rho - tool.radius_m + tool.fillet_m);
    case RigidShape::kCone: {
      const double c = std::cos(tool.half_apex_rad), s = std::sin(tool.half_apex_rad);
      return rho < tool.fillet_m * c ? tool.fillet_m + arc(tool.fillet_m, rho)
                                     : tool.fillet_m * (1 - 1 / s) + rho * c / s;
    }
    default:
      return arc(tool.radius_m, rho);
  }
}

}  // namespace

template <int kDim>
Gap<kDim> gap_along_press(const RigidTool& tool, const Point<kDim>& p) {
  double along = 0, square = 0;
  for (std::size_t i = 0; i < p.size(); ++i) along += p[i] * tool.press[i];
  Gap<kDim> gap;
  for (std::size_t i = 0; i < p.size(); ++i) {
    double across = p[i] - along * tool.press[i];
    if (tool.shape == RigidShape::kCylinder)
      for (std::size_t j = 0; j < p.size(); ++j) across -= p[j] * tool.axis[j] * tool.axis[i];
    square += across * across;
    gap.normal[i] = tool.press[i];
  }
  const double height = profile(tool, std::sqrt(square));
  gap.value_m = height < kNoGap ? along + height : kNoGap;
  return gap;
}
template Gap<2> gap_along_press<2>(const RigidTool&, const Point<2>&);
template Gap<3> gap_along_press<3>(const RigidTool&, const Point<3>&);

}  // namespace palpate::fem
