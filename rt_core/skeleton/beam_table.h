// The skeleton of baked beams: circular cantilever beams (and what replaces them where they do not fit) from every
// surface vertex to every anchor, looked up at the contact point and made to share the contact force.
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/limits.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline bool uses_beam_table(const Model& model) PALPATE_RT {
  return model.params.skeleton_law == SkeletonLaw::kCircular ||
         model.params.skeleton_law == SkeletonLaw::kCircularPaper;
}

// A point of the rest surface: the triangle it lies on, as vertices and barycentric weights (>= 0, sum 1).
struct SurfaceSpot {
  std::int32_t vertex[3] = {0, 0, 0};
  Real weight[3] = {0, 0, 0};
  bool found = false;
  std::int32_t triangle = -1;
};
// Where `point_w`, which lies on the surface or close to it, is seen from `triangle`: walks over edges towards it.
// Where it ends between two triangles, or after kLocateSteps, the last triangle's nearest weights. Bound: kLocateSteps.
inline constexpr std::int32_t kLocateSteps = 24;  // a region's centre lies within a few triangles of its contacts
SurfaceSpot locate_from(const Model& model, Vec3 point_w, std::int32_t triangle) PALPATE_RT;
// The same for the equivalent contact point of region `slot`, starting from its tool point nearest to it.
// Bound: n_tool_point and kLocateSteps.
SurfaceSpot locate_contact(const Model& model, const State& state, std::int32_t slot) PALPATE_RT;

struct BeamTableSkeleton {
  std::int32_t count = 0;         // beams, = anchors
  bool degenerate = false;        // no usable stiffness: all forces are zero
  bool minimum_norm = false;      // paper law only, as in Skeleton
  Real alpha = 0, beta = 0;       // paper law only: scales of F1 and F2
  SurfaceSpot spot[kMaxAnchors];  // where each beam is looked up: the contact, or what sees its anchor as it does
  Vec3 displacement_w;            // of the contact point, K^-1 F (not with the paper's law)
  Vec3 force_w[kMaxAnchors];      // on each beam's tip
};

// Looks the beams up at `spot` and shares the force among them. Anchors displaced by `moved_w` (empty: at rest): the
// beam from P to A + d is that from P - d to A, moved by d, so it is looked up there, on the surface; what d has along
// the normal is left out, and what turns the beam's cross-section to the surface elsewhere comes in.
// kCircular: K = sum K_i, d = K^-1 F, F_i = K_i d: exact, and sum F_i = F. K_i are interpolated over the triangle,
// which keeps them symmetric and positive definite. kCircularPaper: the ratios of the circular-beam paper (2009,
// section III.D) with their two free scales, in the least-squares sense, as distribute_by_ratios does for straight
// beams. Returns false (and sets degenerate) when there is no stiffness or the force is not finite. Bound: 3 n_anchor
// beams, and kLocateSteps for each moved anchor.
bool solve_beam_table(const Model& model, const SurfaceSpot& spot, Vec3 force_on_body_w, BeamTableSkeleton& skeleton,
                      std::span<const Vec3> moved_w = {}) PALPATE_RT;

// Displacement of anchor `index` (< count) under its beam's share of the force, released; zero for a fixed anchor.
Vec3 beam_table_displacement(const Model& model, const BeamTableSkeleton& skeleton, std::int32_t index) PALPATE_RT;

}  // namespace palpate
