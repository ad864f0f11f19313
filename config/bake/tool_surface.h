// Dense samples of a tool piece's outer surface: what its tool points have to stand for.
#pragma once

#include <vector>

#include "config/scene/scene.h"

namespace palpate {

// A piece as the core stores it: core half extents (see ToolPiece::half_extent_m) and margin, metres.
struct PieceCore {
  PieceShape shape;
  TouchingEnd touches;
  double half_extent_m[3];
  double margin_m;
  std::vector<Vec3> vertices_m;  // kHull
};
// Outer dimensions of the scene to core and margin; resolves an "auto" margin.
PieceCore piece_core(const PieceDesc& piece);

struct SurfaceSample {
  Vec3 position_m;  // piece frame
  double area_m2;
};
// Samples of the part of the outer surface that may touch. Their areas sum to its exact area, except for hulls, where
// the rounding of edges is left out: facets of the core plus one sphere of the margin.
std::vector<SurfaceSample> surface_samples(const PieceCore& core);

// Triangles of the convex hull of at most 64 points, outward; empty when they lie in a plane. Exactly coplanar facets
// are split by a vanishing, index-dependent shift, so that the triangles do not overlap.
std::vector<Corners> convex_hull(const std::vector<Vec3>& point);

}  // namespace palpate
