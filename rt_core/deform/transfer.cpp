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

// Forces on one region's beams under its own force: linear in it, so loading them with the force on the tool gives the
// shares on the tool's side.
struct BeamShares {
  std::int32_t count = 0;
  Vec3 force_w[kMaxAnchors];
};

template <class Solved>
void keep_shares(const Solved& skeleton, BeamShares& shares) PALPATE_RT {
  shares.count = skeleton.count;
  for (std::int32_t a = 0; a < shares.count; ++a) shares.force_w[a] = skeleton.force_w[a];  // bound: kMaxAnchors
}

// False: the region carries nothing.
bool share_force(const Model& model, const State& state, std::int32_t slot, BeamShares& shares) PALPATE_RT {
  const Region& from = state.region[slot];
  const Vec3 force = from.normal_force_N * from.normal_w + from.friction_force_w;
  if (uses_beam_table(model)) {
    BeamTableSkeleton skeleton;
    if (!solve_beam_table(model, locate_contact(model, state, slot), force, skeleton)) return false;
    keep_shares(skeleton, shares);
    return true;
  }
  Vec3 offset[kMaxAnchors];
  const std::span<const Vec3> offsets = earlier_displacements(model, state, slot, offset);
  Skeleton skeleton;
  if (!solve_skeleton(model, offsets, from.centre_w, force, skeleton)) return false;
  keep_shares(skeleton, shares);
  return true;
}

Vec3 carried_over(const BeamShares& shares, const RbfVector& weight) PALPATE_RT {
  Vec3 sum;
  for (std::int32_t a = 0; a < shares.count; ++a) sum += weight[a] * shares.force_w[a];  // bound: kMaxAnchors
  return sum;
}

}  // namespace

Vec3 transferred_force_w(const Model& model, const State& state, std::int32_t from_slot,
                         std::int32_t to_slot) PALPATE_RT {
  if (from_slot == to_slot || !in_contact(state, from_slot) || !in_contact(state, to_slot)) return {};
  if (!rbf_available(model) || !is_finite(state.region[to_slot].centre_w)) return {};
  BeamShares shares;
  if (!share_force(model, state, from_slot, shares)) return {};
  RbfVector weight{};
  rbf_weights(model, state.region[to_slot].centre_w, weight);
  return carried_over(shares, weight);
}

void add_transferred_forces(const Model& model, const State& state, const std::int32_t* slot, std::int32_t count,
                            Real* added_N) PALPATE_RT {
  if (!rbf_available(model)) return;
  RbfVector weight[kMaxRegions];
  for (std::int32_t i = 0; i + 1 < count; ++i) {  // bound: kMaxRegions
    if (is_finite(state.region[slot[i]].centre_w)) rbf_weights(model, state.region[slot[i]].centre_w, weight[i]);
  }
  for (std::int32_t j = 1; j < count; ++j) {  // bound: kMaxRegions^2 / 2
    BeamShares shares;
    if (!share_force(model, state, slot[j], shares)) continue;
    for (std::int32_t i = 0; i < j; ++i) {
      const Region& to = state.region[slot[i]];
      if (!is_finite(to.centre_w)) continue;
      const Vec3 force = carried_over(shares, weight[i]);
      if (is_finite(force)) added_N[i] += dot(force, to.normal_w);
    }
  }
}

}  // namespace palpate
