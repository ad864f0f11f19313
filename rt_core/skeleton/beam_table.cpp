#include "rt_core/skeleton/beam_table.h"

#include "rt_core/cholesky.h"
#include "rt_core/skeleton/skeleton.h"

namespace palpate {
namespace {

// Element of the beam from one vertex to anchor `index`.
std::size_t beam_at(const Model& model, const SurfaceSpot& spot, int corner, std::int32_t index) PALPATE_RT {
  return static_cast<std::size_t>(spot.vertex[corner]) * static_cast<std::size_t>(model.sizes.n_anchor) +
         static_cast<std::size_t>(index);
}

Vec3 point_of(const Model& model, const SurfaceSpot& spot) PALPATE_RT {
  Vec3 sum;
  for (int corner = 0; corner < 3; ++corner)
    sum += spot.weight[corner] * model.vertex_m[static_cast<std::size_t>(spot.vertex[corner])];
  return sum;
}

// What sees an anchor at rest as `spot` sees it moved.
SurfaceSpot seen_from(const Model& model, const SurfaceSpot& spot, Vec3 moved_w) PALPATE_RT {
  if (!(squared_norm(moved_w) > 0)) return spot;
  const SurfaceSpot there = locate_from(model, point_of(model, spot) - moved_w, spot.triangle);
  return there.found ? there : spot;
}

void clear(const Model& model, const SurfaceSpot& spot, std::span<const Vec3> moved_w,
           BeamTableSkeleton& skeleton) PALPATE_RT {
  const std::int64_t n = model.sizes.n_anchor;
  skeleton.count = n < kMaxAnchors ? static_cast<std::int32_t>(n) : kMaxAnchors;
  skeleton.degenerate = false;
  skeleton.minimum_norm = false;
  skeleton.alpha = skeleton.beta = 0;
  skeleton.displacement_w = {};
  for (std::int32_t i = 0; i < skeleton.count; ++i) {
    skeleton.spot[i] =
        spot.found && !moved_w.empty() ? seen_from(model, spot, moved_w[static_cast<std::size_t>(i)]) : spot;
    skeleton.force_w[i] = {};
  }
}

// Six entries of the interpolated stiffness of every beam, and their sum.
using Stiffness6 = Real[6];

bool share_by_stiffness(const Model& model, Vec3 force, BeamTableSkeleton& skeleton) PALPATE_RT {
  Stiffness6 beam[kMaxAnchors] = {};
  for (int corner = 0; corner < 3; ++corner) {
    for (std::int32_t i = 0; i < skeleton.count; ++i) {  // <= kMaxAnchors
      const BeamStiffness& row = model.beam_stiffness[beam_at(model, skeleton.spot[i], corner, i)];
      for (int k = 0; k < 6; ++k) beam[i][k] += skeleton.spot[i].weight[corner] * row.k_N_per_m[k];
    }
  }
  Real sum[6] = {};
  for (std::int32_t i = 0; i < skeleton.count; ++i)  // <= kMaxAnchors
    for (int k = 0; k < 6; ++k) sum[k] += beam[i][k];
  Real factor[9] = {sum[0], 0, 0, sum[1], sum[3], 0, sum[2], sum[4], sum[5]};
  skeleton.degenerate = !cholesky_factor(factor, 3);
  if (skeleton.degenerate) return false;
  Real d[3] = {force.x, force.y, force.z};
  cholesky_solve(factor, d, 3);
  skeleton.displacement_w = {d[0], d[1], d[2]};
  for (std::int32_t i = 0; i < skeleton.count; ++i) {
    const Stiffness6& k = beam[i];
    skeleton.force_w[i] = {k[0] * d[0] + k[1] * d[1] + k[2] * d[2], k[1] * d[0] + k[3] * d[1] + k[4] * d[2],
                           k[2] * d[0] + k[4] * d[1] + k[5] * d[2]};
  }
  return true;
}

bool share_by_ratios(const Model& model, Vec3 force, BeamTableSkeleton& skeleton) PALPATE_RT {
  const Vec3 direction = unit_or(force, {});
  Vec3 first[kMaxAnchors], second[kMaxAnchors], u, v;
  for (int corner = 0; corner < 3; ++corner) {
    for (std::int32_t i = 0; i < skeleton.count; ++i) {  // <= kMaxAnchors
      const Real weight = skeleton.spot[i].weight[corner];
      const BeamRatio& row = model.beam_ratio[beam_at(model, skeleton.spot[i], corner, i)];
      first[i] += (weight * dot(row.f1_gain_N_per_m, direction)) * row.f1_axis;
      second[i] += (weight * dot(row.f2_gain_N_per_m, direction)) * row.f2_axis;
    }
  }
  for (std::int32_t i = 0; i < skeleton.count; ++i) {
    u += first[i];
    v += second[i];
  }
  const RatioScales scales = solve_ratio_scales(u, v, force);
  skeleton.alpha = scales.alpha;
  skeleton.beta = scales.beta;
  skeleton.minimum_norm = scales.minimum_norm;
  skeleton.degenerate = !scales.solvable;
  if (skeleton.degenerate) return false;
  for (std::int32_t i = 0; i < skeleton.count; ++i) {
    skeleton.force_w[i] = scales.alpha * first[i] + scales.beta * second[i];
  }
  return true;
}

// Barycentric weights, not normalised, of the projection of p onto the triangle's plane.
void barycentric(const Model& model, Vec3 p, std::int32_t triangle, Real (&weight)[3]) PALPATE_RT {
  const Triangle& t = model.triangle[static_cast<std::size_t>(triangle)];
  Vec3 arm[3];
  for (int k = 0; k < 3; ++k) arm[k] = model.vertex_m[static_cast<std::size_t>(t.vertex[k])] - p;
  const Vec3 normal = cross(arm[1] - arm[0], arm[2] - arm[0]);
  for (int k = 0; k < 3; ++k) weight[k] = dot(cross(arm[(k + 1) % 3], arm[(k + 2) % 3]), normal);
}

SurfaceSpot spot_of(const Model& model, std::int32_t triangle, const Real (&weight)[3]) PALPATE_RT {
  SurfaceSpot spot;
  spot.triangle = triangle;
  Real sum = 0;
  for (int k = 0; k < 3; ++k) {
    spot.vertex[k] = model.triangle[static_cast<std::size_t>(triangle)].vertex[k];
    spot.weight[k] = max_of(weight[k], 0.0);
    sum += spot.weight[k];
  }
  spot.found = sum > 0;
  for (Real& w : spot.weight) w = spot.found ? w / sum : 0.0;
  return spot;
}

}  // namespace

SurfaceSpot locate_from(const Model& model, Vec3 point_w, std::int32_t triangle) PALPATE_RT {
  const auto triangles = static_cast<std::int64_t>(model.triangle.size());
  if (triangle < 0 || triangle >= triangles || !is_finite(point_w)) return {};
  Real weight[3];
  std::int32_t before = -1;
  for (std::int32_t step = 0; step < kLocateSteps; ++step) {
    barycentric(model, point_w, triangle, weight);
    int least = weight[1] < weight[0] ? 1 : 0;
    if (weight[2] < weight[least]) least = 2;
    if (weight[least] >= 0) break;
    // Across the edge opposite to that corner; back again means between the two.
    const std::int32_t next = model.triangle[static_cast<std::size_t>(triangle)].adjacent[(least + 1) % 3];
    if (next < 0 || next >= triangles || next == before) break;
    before = triangle;
    triangle = next;
  }
  barycentric(model, point_w, triangle, weight);
  return spot_of(model, triangle, weight);
}

SurfaceSpot locate_contact(const Model& model, const State& state, std::int32_t slot) PALPATE_RT {
  const Vec3 centre = state.region[slot].centre_w;
  const auto points = static_cast<std::int32_t>(model.sizes.n_tool_point);
  std::int32_t warm = -1;
  Real nearest = kHuge;
  for (std::int32_t i = 0; i < points && i < kMaxToolPoints; ++i) {
    if (state.point[i].region != slot) continue;
    const Real distance2 = squared_norm(state.point[i].closest_w - centre);
    if (!(distance2 < nearest)) continue;
    nearest = distance2;
    warm = state.point[i].triangle;
  }
  return locate_from(model, centre, warm);
}

bool solve_beam_table(const Model& model, const SurfaceSpot& spot, Vec3 force_on_body_w, BeamTableSkeleton& skeleton,
                      std::span<const Vec3> moved_w) PALPATE_RT {
  clear(model, spot, moved_w, skeleton);
  skeleton.degenerate = !(spot.found && is_finite(force_on_body_w) && skeleton.count > 0);
  if (skeleton.degenerate) return false;
  return model.params.skeleton_law == SkeletonLaw::kCircularPaper
             ? share_by_ratios(model, force_on_body_w, skeleton)
             : share_by_stiffness(model, force_on_body_w, skeleton);
}

Vec3 beam_table_displacement(const Model& model, const BeamTableSkeleton& skeleton, std::int32_t index) PALPATE_RT {
  const auto anchor = static_cast<std::size_t>(index);
  Vec3 moved;
  if (model.anchor[anchor].fixed != 0) return moved;
  for (int corner = 0; corner < 3; ++corner) {  // bound: 3
    const Vec3 f = skeleton.spot[index].weight[corner] * skeleton.force_w[index];
    const BeamResponse& row = model.beam_response[beam_at(model, skeleton.spot[index], corner, index)];
    moved += {dot(row.release_m_per_N[0], f), dot(row.release_m_per_N[1], f), dot(row.release_m_per_N[2], f)};
  }
  return moved;
}

}  // namespace palpate
