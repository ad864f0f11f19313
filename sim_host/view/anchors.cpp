#include "sim_host/view/anchors.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "rt_core/contact/regions.h"
#include "rt_core/skeleton/mutual_skeleton.h"

namespace palpate {
namespace {

void add(const BeamStress& stress, Vec3 displacement_w, Vec3 force_w, AnchorLoad& anchor) {
  anchor.displacement_w += displacement_w;
  anchor.force_w += force_w;
  anchor.stress_Pa += std::abs(stress.axial_Pa) + stress.bending_Pa;
  anchor.shear_stress_Pa += stress.shear_Pa;
  anchor.axial_stress_Pa += stress.axial_Pa;
}

Vec3 force_on_body(const Region& region) {
  return -(region.normal_force_N * region.normal_w + region.friction_force_w);
}

bool add_table_beams(const Model& model, const State& state, std::int32_t slot, AnchorField& field) {
  BeamTableSkeleton skeleton;
  const SurfaceSpot spot = locate_contact(model, state, slot);
  const bool temporal = model.params.coupling_law == CouplingLaw::kTemporalPaper;
  std::vector<Vec3> moved;
  for (std::int32_t a = 0; temporal && a < field.count; ++a) moved.push_back(field.anchor[a].displacement_w);
  if (!solve_beam_table(model, spot, force_on_body(state.region[slot]), skeleton, moved)) return false;
  for (std::int32_t a = 0; a < skeleton.count; ++a) {
    const BeamTableAnchor result = beam_table_anchor(model, skeleton, a);
    field.by_region_w[slot][a] = result.displacement_w;
    add(result.stress, result.displacement_w, skeleton.force_w[a], field.anchor[a]);
  }
  return true;
}

bool solve_straight_beams(const Model& model, const State& state, std::span<const std::int32_t> order,
                          std::int32_t index, const AnchorField& field, Skeleton& skeleton) {
  const Region& region = state.region[order[static_cast<std::size_t>(index)]];
  if (model.params.coupling_law == CouplingLaw::kMutualPaper && order.size() > 1)
    return solve_mutual_skeleton(model, state, order, index, force_on_body(region), skeleton);
  const bool temporal = model.params.coupling_law == CouplingLaw::kTemporalPaper;
  std::vector<Vec3> offset;
  for (std::int32_t a = 0; temporal && a < field.count; ++a) offset.push_back(field.anchor[a].displacement_w);
  return solve_skeleton(model, offset, region.centre_w, force_on_body(region), skeleton);
}

// Of the region order[index]. Beams between contacts move nothing: both ends are contacts.
bool add_straight_beams(const Model& model, const State& state, std::span<const std::int32_t> order, std::int32_t index,
                        AnchorField& field) {
  const std::int32_t slot = order[static_cast<std::size_t>(index)];
  Skeleton skeleton;
  if (!solve_straight_beams(model, state, order, index, field, skeleton)) return false;
  for (std::int32_t a = 0; a < field.count; ++a) {
    const Anchor& anchor = model.anchor[static_cast<std::size_t>(a)];
    const Vec3 force_w = skeleton.force_w[a];
    field.by_region_w[slot][a] = anchor_displacement(skeleton, anchor, a);
    add(straight_beam_stress(skeleton.beam[a], section_of(anchor), model.params.poisson_ratio, force_w),
        field.by_region_w[slot][a], force_w, field.anchor[a]);
  }
  return true;
}

}  // namespace

BeamStress straight_beam_stress(const StraightBeam& beam, const BeamSection& section, Real poisson_ratio,
                                Vec3 tip_force) {
  BeamStress stress;
  if (!(section.area_m2 > 0 && section.inertia_m4 > 0)) return stress;
  const Real axial_N = dot(beam.axis, tip_force);
  const Real transverse_N = norm(tip_force - axial_N * beam.axis);
  stress.axial_Pa = axial_N / section.area_m2;
  stress.bending_Pa = transverse_N * beam.length_m * section.radius_m / section.inertia_m4;
  // Saint-Venant's flexure of a circular section at its centre (Luo & Xiao 2006, section V).
  const Real r2 = section.radius_m * section.radius_m;
  const Real scale = transverse_N / (2.0 * (1.0 + poisson_ratio) * section.inertia_m4);
  if (poisson_ratio > -1) stress.shear_Pa = scale * ((3.0 + 2.0 * poisson_ratio) * r2 / 4.0);
  return stress;
}

BeamTableAnchor beam_table_anchor(const Model& model, const BeamTableSkeleton& skeleton, std::int32_t index) {
  BeamTableAnchor result;
  const Vec3 force = skeleton.force_w[index];
  Real inner = 0, outer = 0, side = 0, shear_in = 0, shear_out = 0;
  for (int corner = 0; corner < 3; ++corner) {
    const SurfaceSpot& spot = skeleton.spot[index];
    const Vec3 f = spot.weight[corner] * force;
    const std::size_t at =
        static_cast<std::size_t>(spot.vertex[corner]) * model.anchor.size() + static_cast<std::size_t>(index);
    const BeamResponse& row = model.beam_response[at];
    inner += dot(row.inner_Pa_per_N, f);
    outer += dot(row.outer_Pa_per_N, f);
    side += dot(row.side_Pa_per_N, f);
    result.stress.axial_Pa += dot(row.axial_Pa_per_N, f);
    shear_in += dot(row.shear_in_Pa_per_N, f);
    shear_out += dot(row.shear_out_Pa_per_N, f);
  }
  const Real extreme = std::max(std::abs(inner), std::abs(outer)) + std::abs(side);
  result.stress.bending_Pa = std::max(extreme - std::abs(result.stress.axial_Pa), 0.0);
  result.stress.shear_Pa = std::sqrt(shear_in * shear_in + shear_out * shear_out);
  result.displacement_w = beam_table_displacement(model, skeleton, index);
  return result;
}

AnchorField anchors_of(const Model& model, const State& state) {
  AnchorField field;
  if (model.params.skeleton_law == SkeletonLaw::kNone) return field;
  field.count = std::min(static_cast<std::int32_t>(model.anchor.size()), kMaxAnchors);
  if (field.count == 0) return field;
  std::int32_t order[kMaxRegions];
  const std::int32_t regions = contact_order(state, order);
  const std::span<const std::int32_t> all(order, static_cast<std::size_t>(regions));
  for (std::int32_t i = 0; i < regions; ++i) {
    const bool carried = uses_beam_table(model) ? add_table_beams(model, state, order[i], field)
                                                : add_straight_beams(model, state, all, i, field);
    field.degenerate += carried ? 0 : 1;
  }
  return field;
}

}  // namespace palpate
