#include "rt_core/skeleton/transfer.h"

#include "rt_core/skeleton/beam_table.h"
#include "rt_core/skeleton/rbf.h"
#include "rt_core/skeleton/skeleton.h"
#include "rt_core/skeleton/temporal_order.h"

namespace palpate {
namespace {

bool in_contact(const State& state, std::int32_t slot) PALPATE_RT {
  return slot >= 0 && slot < kMaxRegions && is_in_contact(state.region[slot]);
}

// The same with baked beams; only the shares are filled in.
bool transfer_beam_table(const Model& model, const State& state, std::int32_t slot, Skeleton& skeleton) PALPATE_RT {
  const Region& from = state.region[slot];
  BeamTableSkeleton table;
  const Vec3 force = from.normal_force_N * from.normal_w + from.friction_force_w;
  if (!solve_beam_table(model, locate_contact(model, state, slot), force, table)) return false;
  skeleton.count = table.count;
  for (std::int32_t a = 0; a < table.count; ++a) skeleton.force_w[a] = table.force_w[a];  // <= kMaxAnchors
  return true;
}

// The skeleton of one region under its own force: linear in it, so loading it with the force on the tool gives the
// shares on the tool's side. False: it carries nothing.
bool transfer_skeleton(const Model& model, const State& state, std::int32_t slot, Skeleton& skeleton) PALPATE_RT {
  const Region& from = state.region[slot];
  if (uses_beam_table(model)) return transfer_beam_table(model, state, slot, skeleton);
  Vec3 offset[kMaxAnchors];
  const std::span<const Vec3> offsets = earlier_displacements(model, state, slot, offset);
  const Vec3 force = from.normal_force_N * from.normal_w + from.friction_force_w;
  return solve_skeleton(model, offsets, from.centre_w, force, skeleton);
}

Vec3 carried_over(const Skeleton& skeleton, const RbfVector& weight) PALPATE_RT {
  Vec3 sum;
  for (std::int32_t a = 0; a < skeleton.count; ++a) sum += weight[a] * skeleton.force_w[a];  // bound: kMaxAnchors
  return sum;
}

}  // namespace

Vec3 transferred_force_w(const Model& model, const State& state, std::int32_t from_slot,
                         std::int32_t to_slot) PALPATE_RT {
  if (from_slot == to_slot || !in_contact(state, from_slot) || !in_contact(state, to_slot)) return {};
  if (!rbf_available(model) || !is_finite(state.region[to_slot].centre_w)) return {};
  Skeleton skeleton;
  if (!transfer_skeleton(model, state, from_slot, skeleton)) return {};
  RbfVector weight{};
  rbf_weights(model, state.region[to_slot].centre_w, weight);
  return carried_over(skeleton, weight);
}

void add_transferred_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                            Real* added_N) PALPATE_RT {
  if (!rbf_available(model)) return;
  RbfVector weight[kMaxRegions];
  for (std::int32_t i = 0; i + 1 < count; ++i) {  // bound: kMaxRegions
    if (is_finite(state.region[slot[i]].centre_w)) rbf_weights(model, state.region[slot[i]].centre_w, weight[i]);
  }
  for (std::int32_t j = 1; j < count; ++j) {  // bound: kMaxRegions^2 / 2
    Skeleton skeleton;
    if (!transfer_skeleton(model, state, slot[j], skeleton)) continue;
    for (std::int32_t i = 0; i < j; ++i) {
      const Region& to = state.region[slot[i]];
      if (!is_finite(to.centre_w)) continue;
      const Vec3 force = carried_over(skeleton, weight[i]);
      if (is_finite(force)) added_N[i] += dot(force, to.normal_w);
    }
  }
}

}  // namespace palpate
