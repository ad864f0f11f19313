// The stage `deform`: one skeleton per region in contact, anchors' displacements summed and stresses maximised.
#include "rt_core/skeleton/beam_table.h"
#include "rt_core/skeleton/skeleton.h"
#include "rt_core/skeleton/temporal_order.h"
#include "rt_core/stages.h"

namespace palpate {
namespace {

std::int32_t anchor_count(const Model& model) PALPATE_RT {
  const auto n = static_cast<std::int64_t>(model.anchor.size());
  return n < kMaxAnchors ? static_cast<std::int32_t>(n) : kMaxAnchors;
}

void clear_anchors(State& state, std::int32_t anchors) PALPATE_RT {
  for (std::int32_t a = 0; a < anchors; ++a) state.anchor[a] = {};
  // All-zero bytes are +0.0: whole rows at once instead of one component at a time.
  for (auto& row : state.anchor_by_region) __builtin_memset(&row, 0, static_cast<std::size_t>(anchors) * sizeof(Vec3));
}

// Adds what one region does to one anchor.
inline void record_anchor(const BeamStress& stress, Vec3 displacement_w, std::int32_t slot, std::int32_t a,
                          State& state) PALPATE_RT {
  const Real axial_Pa = stress.axial_Pa;
  AnchorState& anchor = state.anchor[a];
  anchor.displacement_w += displacement_w;
  anchor.stress_Pa = max_of(abs_of(axial_Pa) + stress.bending_Pa, anchor.stress_Pa);
  anchor.shear_stress_Pa = max_of(stress.shear_Pa, anchor.shear_stress_Pa);
  if (abs_of(axial_Pa) > abs_of(anchor.axial_stress_Pa)) anchor.axial_stress_Pa = axial_Pa;
  state.anchor_by_region[slot][a] = displacement_w;
}

// Adds one region's skeleton to the anchors.
void record_anchors(const Model& model, const Skeleton& skeleton, std::int32_t slot, State& state) PALPATE_RT {
  for (std::int32_t a = 0; a < skeleton.count; ++a) {  // <= kMaxAnchors
    const SkeletonAnchor result =
        skeleton_anchor(skeleton, model.anchor[static_cast<std::size_t>(a)], model.params.poisson_ratio, a);
    record_anchor(result.stress, result.displacement_w, slot, a, state);
  }
}

Vec3 force_on_body(const Region& region) PALPATE_RT {
  return -(region.normal_force_N * region.normal_w + region.friction_force_w);
}

// All regions with baked beams. The beams end at the anchors' rest positions: CouplingLaw::kTemporal moves none of
// them.
void deform_by_table(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  std::int32_t order[kMaxRegions];
  const std::int32_t count = contact_order(state, order);
  BeamTableSkeleton skeleton;
  for (std::int32_t i = 0; i < count; ++i) {  // <= kMaxRegions
    const SurfaceSpot spot = locate_contact(model, state, order[i]);
    if (!solve_beam_table(model, spot, force_on_body(state.region[order[i]]), skeleton)) {
      scratch.status |= Status::kSkeletonDegenerate;
      continue;
    }
    for (std::int32_t a = 0; a < skeleton.count; ++a) {  // <= kMaxAnchors
      const BeamTableAnchor result = beam_table_anchor(model, skeleton, a);
      record_anchor(result.stress, result.displacement_w, order[i], a, state);
    }
  }
}

}  // namespace

void deform(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  const std::int32_t anchors = anchor_count(model);
  clear_anchors(state, anchors);
  if (anchors == 0 || model.params.skeleton_law == static_cast<std::int32_t>(SkeletonLaw::kNone)) return;
  if (uses_beam_table(model)) return deform_by_table(model, state, scratch);

  const bool temporal = uses_temporal_order(model);
  std::int32_t order[kMaxRegions];
  const std::int32_t count = contact_order(state, order);
  Skeleton skeleton;
  for (std::int32_t i = 0; i < count; ++i) {  // <= kMaxRegions
    const Region& region = state.region[order[i]];
    Vec3 offset[kMaxAnchors];
    for (std::int32_t a = 0; temporal && a < anchors; ++a) offset[a] = state.anchor[a].displacement_w;
    const std::span<const Vec3> offsets = temporal ? std::span<const Vec3>(offset) : std::span<const Vec3>();
    if (solve_skeleton(model, offsets, region.centre_w, force_on_body(region), skeleton)) {
      record_anchors(model, skeleton, order[i], state);
    } else {
      scratch.status |= Status::kSkeletonDegenerate;
    }
  }
}

}  // namespace palpate
