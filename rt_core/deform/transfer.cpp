#include "rt_core/deform/transfer.h"

#include "rt_core/deform/beam_table.h"
#include "rt_core/deform/rbf.h"
#include "rt_core/deform/skeleton.h"
#include "rt_core/deform/temporal_order.h"

namespace palpate {
namespace {

bool in_contact(const State& state, std::int32_t slot) PALPATE_RT {
  return slot >= 0 && slot < kMaxRegions && is_in_contact(state.region[slot]);
}

Vec3 weighted_sum(const RbfVector& weight, const Vec3 (&force)[kMaxAnchors], std::int32_t count) PALPATE_RT {
  Vec3 sum;
  for (std::int32_t a = 0; a < count; ++a) sum += weight[a] * force[a];  // <= kMaxAnchors
  return sum;
}

}  // namespace

Vec3 transferred_force_w(const Model& model, const State& state, std::int32_t from_slot,
                         std::int32_t to_slot) PALPATE_RT {
  if (from_slot == to_slot || !in_contact(state, from_slot) || !in_contact(state, to_slot)) return {};
  if (!rbf_available(model) || !is_finite(state.region[to_slot].centre_w)) return {};
  const Region& from = state.region[from_slot];
  // The skeleton is linear in the force: loading it with the force on the tool gives the shares on the tool's side.
  const Vec3 force = from.normal_force_N * from.normal_w + from.friction_force_w;
  RbfVector weight{};
  if (uses_beam_table(model)) {
    BeamTableSkeleton skeleton;
    if (!solve_beam_table(model, locate_contact(model, state, from_slot), force, skeleton)) return {};
    rbf_weights(model, state.region[to_slot].centre_w, weight);
    return weighted_sum(weight, skeleton.force_w, skeleton.count);
  }
  Vec3 offset[kMaxAnchors];
  const std::span<const Vec3> offsets = earlier_displacements(model, state, from_slot, offset);
  Skeleton skeleton;
  if (!solve_skeleton(model, offsets, from.centre_w, force, skeleton)) return {};
  rbf_weights(model, state.region[to_slot].centre_w, weight);
  return weighted_sum(weight, skeleton.force_w, skeleton.count);
}

}  // namespace palpate
