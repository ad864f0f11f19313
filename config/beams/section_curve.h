// Plane sections of the body's surface: the curve a circular beam has to follow.
#pragma once

#include <vector>

#include "rt_core/model.h"

namespace palpate {

// The closed curve in which a plane through a surface vertex cuts the surface there.
struct SectionLoop {
  std::vector<Vec3> point;  // in order; the last joins the first
  std::size_t start = 0;    // nearest to the vertex
};
// The loop through vertex `vertex` in the plane with unit normal `normal`; empty where the plane only touches.
// `first_triangle[v]` is any triangle with vertex v.
SectionLoop trace_section(const Model& surface, const std::vector<std::int32_t>& first_triangle, std::int32_t vertex,
                          Vec3 normal);

// The stretch of a loop from its start to the point `to`, one way round or the other.
struct SectionCurve {
  double length_m = 0;
  double least_curvature_per_m = 0;  // over the stretch; positive where it bends towards `inside`
  double start_curvature_per_m = 0, end_curvature_per_m = 0;
  Vec3 middle_m;
};
struct SectionCurves {
  bool reaches = false;  // `to` lies on this loop
  SectionCurve way[2];
};
// Curvature from circles through points `spacing_m` apart, or a twelfth of the stretch where that is more: facets are
// flat and their edges sharp, and only over several of them is there a curvature. Positive: the surface is convex
// there, `outward` being its normal at the start.
SectionCurves curves_between(const SectionLoop& loop, Vec3 to, double spacing_m, double tolerance_m, Vec3 normal,
                             Vec3 outward);

}  // namespace palpate
