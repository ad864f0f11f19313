#include "rt_core/contact/points/point_laws.h"
#include "rt_core/skeleton/beam_table.h"
#include "rt_core/skeleton/rbf.h"
#include "rt_core/skeleton/skeleton.h"

namespace palpate {
namespace {

// The same with baked beams, which stand on the anchors at rest: they move none.
bool share_table_beams(const Model& model, const State& state, std::int32_t slot, Vec3 force_w,
                       Skeleton& skeleton) PALPATE_RT {
  BeamTableSkeleton table;
  if (!solve_beam_table(model, locate_contact(model, state, slot), force_w, table)) return false;
  skeleton.count = table.count;
  for (std::int32_t a = 0; a < table.count; ++a) skeleton.force_w[a] = table.force_w[a];  // bound: kMaxAnchors
  return true;
}

// Shares of one region's force, as they act on the tool's side, and what the region adds to the displacements of the
// anchors. The skeleton is odd in its force, so loading it with the force on the tool turns the sign of both.
bool share_force(const Model& model, const State& state, std::int32_t slot, Vec3 (&moved_w)[kMaxAnchors],
                 Skeleton& skeleton) PALPATE_RT {
  const Region& from = state.region[slot];
  const Vec3 force_w = from.normal_force_N * from.normal_w + from.friction_force_w;
  if (uses_beam_table(model)) return share_table_beams(model, state, slot, force_w, skeleton);
  if (!solve_skeleton(model, moved_w, from.centre_w, force_w, skeleton)) return false;
  for (std::int32_t a = 0; a < skeleton.count; ++a)  // bound: kMaxAnchors
    moved_w[a] += -anchor_displacement(skeleton, model.anchor[static_cast<std::size_t>(a)], a);
  return true;
}

Vec3 carried_over(const Skeleton& skeleton, const RbfVector& weight) PALPATE_RT {
  Vec3 sum;
  for (std::int32_t a = 0; a < skeleton.count; ++a) sum += weight[a] * skeleton.force_w[a];  // bound: kMaxAnchors
  return sum;
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
    if (!share_force(model, state, slot[j], moved_w, skeleton)) {
      all_carried = false;
      continue;
    }
    for (std::int32_t i = 0; i < j; ++i) {
      const Region& to = state.region[slot[i]];
      if (!is_finite(to.centre_w)) continue;
      const Vec3 force_w = carried_over(skeleton, weight[i]);
      if (is_finite(force_w)) added_N[i] += dot(force_w, to.normal_w);
    }
  }
  return all_carried;
}

}  // namespace palpate
