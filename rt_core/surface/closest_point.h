// Signed distance of a point from the rest surface: the query every contact force is made from.
#pragma once

#include <cstdint>

#include "rt_core/model.h"
#include "rt_core/surface/triangle.h"

namespace palpate {

// Hierarchy nodes one query may open. Points within a few centimetres of a surface need 10 to 40 (measured on bodies of
// 3 thousand to 1 million triangles, 2026-11-21); only points near the medial axis, where much of the surface is
// equally far, need more. Past the cap the nearest point so far is returned, marked truncated:
// Status::kTraversalTruncated.
// Triangles besides, likewise: a fan of slivers puts thousands into boxes that all hold its centre; on the axis of a
// cylinder of 600 thousand triangles a query took 240,128 instructions (2026-11-22).
inline constexpr std::int32_t kMaxSearched = 512;
// Triangles a walk over neighbours may look at before it gives up: from the last tick's triangle, which is near or else
// of no use, and from a leaf straight down the hierarchy. With 256 for both, a tool thrown about took 62,737
// instructions on the ring instead of 54,500 (2026-11-23).
inline constexpr std::int32_t kMaxWarmWork = 24;
inline constexpr std::int32_t kMaxLandedWork = 48;
// Boxes and triangles one query looks at in all: two walks and the fan or ring in which each gives up (3 kMaxFan), in
// each a turn about a fan's middle (kMaxTurn / kSpokesPerLook and kMaxWarmWork) and what meets at it (kMaxNearCorner),
// the way down to a leaf, and the search with its last node's 16 triangles:
// 64 + 128 + 2 * 72 + 2 * (32 + 24 + 128) + 68 + 512 + 512 + 16.
inline constexpr std::int32_t kMaxQueryWork = 2048;
// Triangles that may meet in one vertex: no query could look at more. Those about the poles of a body of four million
// triangles are 2,000. Refused when the body is read and when its image is loaded.
inline constexpr std::int32_t kMaxVertexTriangles = kMaxQueryWork;
// Distance below which p - closest is too short to have a direction: the pseudo-normal is used instead.
inline constexpr double kDirectionFloor_m = 1e-9;

// A closest point whose smallest barycentric weight exceeds this is safely inside its face or edge: rounding cannot put
// it on a neighbour. The scene compiler checks it against each triangle before it sets Triangle::ring_convex.
inline constexpr double kSafeInset = 1e-3;

// What a tick of a scene may look at.
inline std::int32_t surface_work_share(const ModelParams& params) PALPATE_RT {
  return params.surface_work_max > 0 ? params.surface_work_max : kMaxSurfaceWork;
}

struct SurfacePoint {
  Vec3 closest_w;  // on the rest surface
  Vec3 normal_w;   // unit, outward: along p - closest outside, its opposite inside, pseudo-normal at contact
  double signed_distance_m = 0;  // < 0 inside the body
  double lower_bound_m = 0;      // no surface point is nearer to p than this
  std::int32_t triangle = -1;    // the lowest index among equally near triangles
  Feature feature = Feature::kFace;
  std::int32_t nodes = 0;             // hierarchy nodes searched; 0 when the neighbourhood gave the proof
  std::int32_t looked = 0;            // boxes and triangles looked at, at most kMaxQueryWork
  std::int32_t stack_high_water = 0;  // traversal stack entries used
  bool found = false;                 // a surface point lies within search_radius_m
  bool truncated = false;             // stopped by a cap: a closer point may have been missed
};

// Closest rest-surface point within search_radius_m (any value; larger than 1e9 means unlimited) of p (world, m).
// `warm_triangle` (or -1) only saves work: unless truncated, the answer is a function of p alone, because equally near
// triangles are decided by index and no box or cone that could hold one is skipped. Sign by angle-weighted
// pseudo-normals (Baerentzen & Aanaes 2005). A p that is not finite is not found. `most_searched`:
// nodes the hierarchy's search may open, and triangles it may look at. Bound: kMaxQueryWork.
SurfacePoint closest_surface_point(const Model& model, Vec3 p, double search_radius_m, std::int32_t warm_triangle,
                                   std::int32_t most_searched = kMaxSearched) PALPATE_RT;

// The same where a bound is known that is nearly the answer, or below which none is asked for: no walk, and no first
// leaf that would find one; the hierarchy's boxes beyond it are not opened.
SurfacePoint nearer_surface_point(const Model& model, Vec3 p, double than_m, std::int32_t most_searched) PALPATE_RT;

// Outward pseudo-normal (not unit) of a feature of a triangle: face normal, sum of both unit face normals on an edge,
// Model::vertex_normal at a vertex.
Vec3 pseudo_normal(const Model& model, std::int32_t triangle, Feature feature) PALPATE_RT;

}  // namespace palpate
