#include "rt_core/skeleton/mutual_skeleton.h"

namespace palpate {

bool solve_mutual_skeleton(const Model& model, const State& state, std::span<const std::int32_t> slot,
                           std::int32_t from, Vec3 force_on_body_w, Skeleton& skeleton) PALPATE_RT {
  const auto anchors = static_cast<std::int32_t>(model.anchor.size());
  const auto count = static_cast<std::int32_t>(slot.size());
  skeleton.count = 0;
  if (anchors == 0 || anchors > kMaxMutualAnchors || count > kMaxRegions) return false;
  Anchor end[kMaxAnchors];
  for (std::int32_t a = 0; a < anchors; ++a) end[a] = model.anchor[static_cast<std::size_t>(a)];  // bound: kMaxAnchors
  for (std::int32_t i = 0; i < count; ++i) {                                                      // bound: kMaxRegions
    if (i == from) continue;
    const Region& other = state.region[slot[static_cast<std::size_t>(i)]];
    Anchor& at = end[mutual_beam(model, from, i)];
    at = end[0];
    at.position_m = other.centre_w;
    at.normal = other.normal_w;
    at.fixed = 1;
  }
  const Region& own = state.region[slot[static_cast<std::size_t>(from)]];
  return solve_skeleton_on(model, {end, static_cast<std::size_t>(anchors + count - 1)}, {}, own.centre_w,
                           force_on_body_w, skeleton);
}

}  // namespace palpate
