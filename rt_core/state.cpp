#include "rt_core/state.h"

#include "rt_core/hash.h"

namespace palpate {

namespace {

// Calls visit(name, values...) for everything in `state` that can influence a later tick, in a fixed order. Dead slots
// and unused entries are left out: they are never read.
template <class Visitor>
void visit_region(const Region& r, Visitor&& visit) PALPATE_RT {
  visit("region.id", r.id, r.born_tick, r.lost_ticks, r.point_count);
  if (r.id == 0) return;
  visit("region.area_m2", r.area_m2);
  visit("region.depth_max_m", r.depth_max_m);
  visit("region.centre_w", r.centre_w);
  visit("region.normal_w", r.normal_w);
  visit("region.normal_force_N", r.normal_force_N);
  visit("region.friction_force_w", r.friction_force_w);
  visit("region.wrench_w", r.wrench_w);
  visit("region.depth_equivalent_m", r.depth_equivalent_m);
  visit("region.energy_J", r.energy_J, r.tangent_N_per_m);
  visit("region.lean_tool_m", r.lean_tool_m, r.lean_normal_tool);
  visit("region.stretch_w", r.stretch_w);
  visit("region.tangential_k_N_per_m", r.tangential_k_N_per_m, r.reversal_N_per_m);
  visit("region.friction", static_cast<std::int32_t>(r.friction));
  visit("region.origin_w", r.origin_w);
}

template <class Visitor>
void visit_nodal(const State& state, Visitor&& visit) PALPATE_RT {
  const NodalState& nodal = state.nodal;
  visit("nodal.count", nodal.count);
  visit("nodal.far_share", nodal.far_share);
  for (std::int32_t i = 0; i < nodal.count; ++i) {  // bound: kMaxContacts
    const NodalContact& c = nodal.contact[i];
    visit("nodal.vertex", c.vertex, c.piece, c.region, static_cast<std::int32_t>(c.friction));
    visit("nodal.force_w", c.force_w);
    visit("nodal.anchor_tool_m", c.anchor_tool_m);
  }
  for (std::int32_t r = 0; r < kMaxRegions; ++r)
    if (state.region[r].id != 0) {
      const RegionMotion& m = nodal.motion[r];
      visit("nodal.motion", m.centre_w, m.translation_m, m.rotation_rad, m.reach_m, m.growth, m.finite);
    }
}

template <class Visitor>
void visit_safety(const SafetyState& s, Visitor&& visit) PALPATE_RT {
  visit("safety.mode", static_cast<std::int32_t>(s.mode), s.fault, s.last_commands, s.stopping);
  visit("safety.ramp", s.ramp);
  visit("safety.tool_corrected_w", s.tool_corrected_w);
  visit("safety.last_good_w", s.last_good_w);
  visit("safety.last_device_w", s.last_device_w);
}

template <class Visitor>
void visit_articulation(const Model& model, const ArticulationState& a, Visitor&& visit) PALPATE_RT {
  for (const double closing : a.closing) visit("articulation.closing", closing);  // bound: kMaxFingers
  visit("articulation.moved", a.started, a.moved);
  for (std::int64_t j = 0; j < model.sizes.n_joint; ++j) {  // bound: kMaxJoints
    visit("articulation.joint", a.joint[j]);
    visit("articulation.axis_tool", a.axis_tool[j], a.origin_tool_m[j]);
  }
  for (std::int64_t p = 0; p < model.sizes.n_piece; ++p) {  // bound: kMaxPieces
    visit("articulation.motion_tool", a.motion_tool[p], a.motion_previous_tool[p]);
    visit("articulation.piece_force_tool_N", a.piece_force_tool_N[p], a.piece_torque_tool_Nm[p]);
  }
}

template <class Visitor>
void visit_state(const Model& model, const State& state, Visitor&& visit) PALPATE_RT {
  visit("tick", state.tick);
  visit("device_w", state.device_w, state.device_previous_w);
  visit("tool_w", state.tool_w, state.tool_previous_w);
  for (const double k : state.contact_stiffness) visit("contact_stiffness", k);
  visit("started", state.started, state.rejected_ticks, state.next_region_id);
  for (std::int64_t i = 0; i < model.sizes.n_tool_point; ++i) {  // bound: kMaxToolPoints
    const PointState& p = state.point[i];
    visit("point.closest_w", p.closest_w, p.normal_w);
    visit("point.gap_m", p.gap_m, p.gap_bound_m);
    visit("point.triangle", p.triangle, p.region);
  }
  for (const Region& region : state.region) visit_region(region, visit);  // bound: kMaxRegions
  if (model.params.backend != 0) visit_nodal(state, visit);
  visit_safety(state.safety, visit);
  if (model.params.articulation != 0) visit_articulation(model, state.articulation, visit);
}

// Hashes of the visited fields of one state, for comparison. Host use: 128 KiB on the stack.
struct FieldHashes {
  static constexpr int kMost = 8192;
  const char* name[kMost];
  std::uint64_t hash[kMost];
  int count = 0;
};

void collect(const Model& model, const State& state, FieldHashes& fields) noexcept {
  visit_state(model, state, [&fields](const char* name, const auto&... values) PALPATE_RT {
    Hasher hasher;
    (hasher.add(values), ...);
    if (fields.count == FieldHashes::kMost) return;
    fields.name[fields.count] = name;
    fields.hash[fields.count++] = hasher.value;
  });
}

}  // namespace

void reset(State& state) PALPATE_RT { state = State{}; }

std::uint64_t hash_state(const Model& model, const State& state) PALPATE_RT {
  Hasher hasher;
  visit_state(model, state, [&hasher](const char*, const auto&... values) PALPATE_RT { (hasher.add(values), ...); });
  return hasher.value;
}

const char* first_difference(const Model& model, const State& a, const State& b) noexcept {
  FieldHashes of_a, of_b;
  collect(model, a, of_a);
  collect(model, b, of_b);
  const int shorter = of_a.count < of_b.count ? of_a.count : of_b.count;
  for (int i = 0; i < shorter; ++i)
    if (of_a.hash[i] != of_b.hash[i]) return of_a.name[i];
  return of_a.count == of_b.count ? nullptr : "number of live fields";
}

}  // namespace palpate
