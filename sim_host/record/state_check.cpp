#include "sim_host/record/state_check.h"

#include "rt_core/contact/regions.h"

namespace palpate {

namespace {

using std::int32_t;
using std::int64_t;

// Index of an element, or -1 for none.
bool is_index_or_none(int64_t index, int64_t size) noexcept { return index >= -1 && index < size; }
bool is_friction(FrictionMode mode) noexcept { return mode >= FrictionMode::kFree && mode <= FrictionMode::kSlip; }
// Rounding moves a quaternion's square by 1e-15 a tick at most and the tick normalises; anything else never was one.
bool is_pose(const Pose& pose) noexcept {
  const Quat& q = pose.orientation;
  const Real s = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return is_finite(pose) && s > 0.99 && s < 1.01;
}
bool is_wrench(const Wrench& wrench) noexcept { return is_finite(wrench.force_N) && is_finite(wrench.torque_Nm); }

template <class... Vectors>
bool are_finite(const Vectors&... v) noexcept {
  return (is_finite(v) && ...);
}

StateFault check_poses(const State& state) noexcept {
  if (!is_pose(state.told_w)) return {"told_w"};
  if (!is_pose(state.device_w) || !is_pose(state.device_previous_w)) return {"device_w"};
  if (!is_pose(state.tool_w) || !is_pose(state.tool_previous_w)) return {"tool_w"};
  for (const double k : state.contact_stiffness)
    if (!is_finite(k)) return {"contact_stiffness"};
  if (state.rejected_ticks < 0 || state.rejected_ticks > kMaxRejectedTicks) return {"rejected_ticks"};
  if (state.unseen_ticks < 0 || state.unseen_ticks > kMaxRejectedTicks) return {"unseen_ticks"};
  if (state.apart != 0 && state.apart != 1) return {"apart"};
  if (!are_finite(state.seat_m, state.seat_rad)) return {"seat_m"};
  return {};
}

StateFault check_elastic(const State& state) noexcept {
  if (state.elastic.moved != 0 && state.elastic.moved != 1) return {"elastic.moved"};
  for (int32_t i = 0; i < state.elastic.soft_rootJ.size(); ++i)
    if (!is_finite(state.elastic.soft_rootJ[i])) return {"elastic.soft_rootJ", i};
  return {};
}

StateFault check_points(const Model& model, const State& state) noexcept {
  for (int64_t i = 0; i < model.sizes.n_tool_point; ++i) {
    const PointState& p = state.point[i];
    if (!is_index_or_none(p.triangle, model.sizes.n_triangle)) return {"point.triangle", i};
    if (!is_index_or_none(p.region, kMaxRegions)) return {"point.region", i};
    if (!are_finite(p.closest_w, p.normal_w, p.gap_m, p.gap_bound_m)) return {"point", i};
  }
  return {};
}

StateFault check_region(const Model& model, const Region& r, int64_t i) noexcept {
  if (r.lost_ticks < 0 || r.lost_ticks > region_memory_ticks(model.params)) return {"region.lost_ticks", i};
  if (r.point_count < 0) return {"region.point_count", i};
  if (!is_friction(r.friction)) return {"region.friction", i};
  const bool finite =
      are_finite(r.area_m2, r.depth_max_m, r.centre_w, r.normal_w, r.normal_force_N, r.friction_force_w) &&
      are_finite(r.depth_equivalent_m, r.energy_J, r.tangent_N_per_m, r.lean_tool_m) &&
      are_finite(r.lean_normal_tool, r.stretch_w, r.tangential_k_N_per_m, r.reversal_N_per_m);
  return finite && is_wrench(r.wrench_w) ? StateFault{} : StateFault{"region", i};
}

// Slots with id 0 are empty and never read.
StateFault check_regions(const Model& model, const State& state) noexcept {
  for (int32_t i = 0; i < kMaxRegions; ++i) {
    const Region& region = state.region[i];
    if (region.id == 0) continue;
    if (region.id >= state.next_region_id) return {"region.id", i};
    for (int32_t other = 0; other < i; ++other)
      if (state.region[other].id == region.id) return {"region.id", i};
    if (const StateFault fault = check_region(model, region, i); fault.field != nullptr) return fault;
  }
  return {};
}

StateFault check_nodes(const Model& model, const State& state) noexcept {
  const NodalState& nodal = state.nodal;
  if (nodal.count < 0 || nodal.count > kMaxContacts) return {"nodal.count"};
  if (nodal.count > 0 && model.sizes.n_nodal == 0) return {"nodal.count"};
  if (!is_finite(nodal.far_share)) return {"nodal.far_share"};
  for (int32_t i = 0; i < nodal.count; ++i) {
    const NodalContact& c = nodal.contact[i];
    if (c.vertex < 0 || c.vertex >= model.sizes.n_nodal) return {"nodal.contact.vertex", i};
    if (c.piece < 0 || c.piece >= model.sizes.n_piece) return {"nodal.contact.piece", i};
    if (!is_index_or_none(c.region, kMaxRegions)) return {"nodal.contact.region", i};
    if (!is_friction(c.friction)) return {"nodal.contact.friction", i};
    if (!are_finite(c.force_w, c.anchor_tool_m)) return {"nodal.contact", i};
  }
  for (int32_t i = 0; i < nodal.motion.size(); ++i) {
    const RegionMotion& m = nodal.motion[i];
    if (!are_finite(m.centre_w, m.translation_m, m.rotation_rad, m.reach_m, m.growth, m.finite))
      return {"nodal.motion", i};
  }
  return {};
}

StateFault check_safety(const SafetyState& s) noexcept {
  if (s.mode < Mode::kIdle || s.mode > Mode::kFault) return {"safety.mode"};
  if (!(s.ramp >= 0 && s.ramp <= 1)) return {"safety.ramp"};
  if (s.stopping != 0 && s.stopping != 1) return {"safety.stopping"};
  if (!is_pose(s.tool_corrected_w)) return {"safety.tool_corrected_w"};
  if (!is_wrench(s.last_good_w)) return {"safety.last_good_w"};
  return is_wrench(s.last_device_w) ? StateFault{} : StateFault{"safety.last_device_w"};
}

StateFault check_live(const SettingsState& live) noexcept {
#define PALPATE_FIELD(name, lowest, highest, key, meaning) \
  if (!(live.name >= lowest && live.name <= highest)) return {"live." #name};
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return {};
}

StateFault check_articulation(const ArticulationState& a) noexcept {
  if (a.started < 0 || a.started > 1 || a.moved < 0 || a.moved > 1) return {"articulation.started"};
  for (int32_t i = 0; i < kMaxFingers; ++i)
    if (!(a.closing[i] >= 0 && a.closing[i] <= 1)) return {"articulation.closing", i};
  for (int64_t i = 0; i < a.joint.size(); ++i)
    if (!are_finite(a.joint[i], a.axis_tool[i], a.origin_tool_m[i])) return {"articulation.joint", i};
  for (int64_t i = 0; i < a.motion_tool.size(); ++i) {
    if (!is_pose(a.motion_tool[i]) || !is_pose(a.motion_previous_tool[i])) return {"articulation.motion_tool", i};
    if (!are_finite(a.piece_force_tool_N[i], a.piece_torque_tool_Nm[i])) return {"articulation.piece_force", i};
  }
  return {};
}

}  // namespace

StateFault check_state(const Model& model, const State& state) noexcept {
  if (!is_laid_out_for(model, state)) return {"layout"};
  if (state.first_point < 0 || (state.first_point > 0 && state.first_point >= model.sizes.n_tool_point))
    return {"first_point"};
  const StateFault faults[] = {
      check_poses(state),        check_points(model, state), check_regions(model, state),
      check_nodes(model, state), check_safety(state.safety), check_articulation(state.articulation),
      check_elastic(state),      check_live(state.live),
  };
  for (const StateFault& fault : faults)
    if (fault.field != nullptr) return fault;
  return {};
}

}  // namespace palpate
