#include "rt_core/contact/points/point_laws.h"
#include "rt_core/skeleton/beam_table.h"
#include "rt_core/skeleton/mutual_skeleton.h"
#include "rt_core/skeleton/rbf.h"
#include "rt_core/skeleton/skeleton.h"

namespace palpate {
namespace {

// With baked beams.
bool share_table_beams(const Model& model, const State& state, std::int32_t slot, Vec3 force_w,
                       Vec3 (&moved_w)[kMaxAnchors], Skeleton& skeleton) PALPATE_RT {
  BeamTableSkeleton table;
  if (!solve_beam_table(model, locate_contact(model, state, slot), force_w, table, moved_w)) return false;
  skeleton.count = table.count;
  for (std::int32_t a = 0; a < table.count; ++a) {  // bound: kMaxAnchors
    skeleton.force_w[a] = table.force_w[a];
    moved_w[a] += -beam_table_displacement(model, table, a);
  }
  return true;
}

// Shares of a force of one region on the tool, as they act on the tool's side, and what it adds to the displacements of
// the anchors. The skeleton is odd in its force, so loading it with the force on the tool turns the sign of both.
bool share_force(const Model& model, const State& state, std::int32_t slot, Vec3 force_w, Vec3 (&moved_w)[kMaxAnchors],
                 Skeleton& skeleton) PALPATE_RT {
  if (uses_beam_table(model)) return share_table_beams(model, state, slot, force_w, moved_w, skeleton);
  if (!solve_skeleton(model, moved_w, state.region[slot].centre_w, force_w, skeleton)) return false;
  for (std::int32_t a = 0; a < skeleton.count; ++a)  // bound: kMaxAnchors
    moved_w[a] += -anchor_displacement(skeleton, model.anchor[static_cast<std::size_t>(a)], a);
  return true;
}

Vec3 carried_over(const Skeleton& skeleton, const RbfVector& weight) PALPATE_RT {
  Vec3 sum;
  for (std::int32_t a = 0; a < skeleton.count; ++a) sum += weight[a] * skeleton.force_w[a];  // bound: kMaxAnchors
  return sum;
}

Vec3 force_on_tool(const Region& region) PALPATE_RT {
  return region.normal_force_N * region.normal_w + region.friction_force_w;
}

}  // namespace

bool add_transferred_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                            Real* added_N) PALPATE_RT {
  if (!rbf_available(model) || count < 2) return true;
  RbfVector weight[kMaxRegions];
  for (std::int32_t i = 0; i + 1 < count; ++i) {  // bound: kMaxRegions
    if (is_finite(state.region[slot[i]].centre_w)) rbf_weights(model, state.region[slot[i]].centre_w, weight[i]);
  }
  Vec3 moved_w[kMaxAnchors];
  bool all_carried = true;
  for (std::int32_t j = 0; j < count; ++j) {  // bound: kMaxRegions^2 / 2
    Skeleton skeleton;
    const Region& from = state.region[slot[j]];
    if (!share_force(model, state, slot[j], force_on_tool(from), moved_w, skeleton)) {
      all_carried = false;
      continue;
    }
    for (std::int32_t i = 0; i < j; ++i) {
      const Region& to = state.region[slot[i]];
      if (!is_finite(to.centre_w)) continue;
      const Vec3 force_w = carried_over(skeleton, weight[i]);
      if (is_finite(force_w)) added_N[i] += abs_of(dot(force_w, to.normal_w));
    }
  }
  return all_carried;
}

bool add_mutual_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                       Real* added_N) PALPATE_RT {
  const std::span<const std::int32_t> all(slot, static_cast<std::size_t>(count));
  bool all_carried = true;
  for (std::int32_t j = 0; count > 1 && j < count; ++j) {  // bound: kMaxRegions^2
    Skeleton skeleton;
    if (!solve_mutual_skeleton(model, state, all, j, force_on_tool(state.region[slot[j]]), skeleton)) {
      all_carried = false;
      continue;
    }
    for (std::int32_t i = 0; i < count; ++i) {
      if (i == j) continue;
      const Real along_N = dot(skeleton.force_w[mutual_beam(model, j, i)], state.region[slot[i]].normal_w);
      if (is_finite(along_N)) added_N[i] += abs_of(along_N);
    }
  }
  return all_carried;
}

void shift_in_order(const Model& model, State& state, Scratch& scratch, const PointLaws& laws) PALPATE_RT {
  const RowsByRegion& rows = scratch.rows;
  if (!rbf_available(model) || rows.regions < 2) return;
  Vec3 moved_w[kMaxAnchors];
  const auto anchors = static_cast<std::int32_t>(model.anchor.size());
  for (std::int32_t r = 0; r < rows.regions; ++r) {  // bound: kMaxRegions skeletons
    const RegionRows& touching = laws.region[r];
    for (std::int32_t k = 0; k < touching.count; ++k)
      touching[k].force_N = touching[k].weight * law_force_N(laws.law, touching[k].depth_m);
    Region& region = state.region[rows.slot[r]];
    const RegionCentre centre = centre_of(region, touching);
    region.centre_w = centre.position_w;
    if (r > 0) {
      RbfVector weight;
      rbf_weights(model, centre.position_w, weight);
      Vec3 moved;
      for (std::int32_t a = 0; a < anchors; ++a) moved += weight[a] * moved_w[a];  // bound: kMaxAnchors
      // Contact is looked for on the rest surface: what bulges out comes in with the depth there, or it would jump in.
      const Real inward_m = -dot(moved, centre.normal_w), most_m = laws.law.max_depth_m;
      const Real bulge_m = min_of(deepest_of(touching).depth_m, most_m);
      scratch.system.shift_m[r] = is_finite(inward_m) ? clamp_to(inward_m, -bulge_m, most_m) : 0.0;
    }
    if (r + 1 == rows.regions) break;
    const Vec3 force_w = laws.load(r, scratch.system.shift_m[r]).force_N * centre.normal_w;
    Skeleton skeleton;
    scratch.work.standing += anchors;
    if (!share_force(model, state, rows.slot[r], force_w, moved_w, skeleton))
      scratch.status |= Status::kSkeletonDegenerate;
  }
}

}  // namespace palpate
