#include "sim_host/feel/finger_work.h"

#include <algorithm>

#include "hal/device/hand_path.h"
#include "rt_core/tool/articulate.h"

namespace palpate {

namespace {

// Normal forces by contact, and each region's friction spread over its contacts as their normal forces are.
std::vector<Wrench> loads(const Model& model, const State& state, const Scratch& scratch) {
  std::vector<Wrench> load(model.piece.size());
  double normal_N[kMaxRegions] = {};
  for (std::int32_t i = 0; i < scratch.contact_count; ++i)
    if (scratch.contact[i].region >= 0) normal_N[scratch.contact[i].region] += scratch.contact[i].force_N;
  const Quat to_tool = conjugate(state.tool_w.orientation);
  for (std::int32_t i = 0; i < scratch.contact_count; ++i) {
    const Contact& contact = scratch.contact[i];
    if (!(contact.force_N > 0) || contact.region < 0) continue;
    const double share = contact.force_N / normal_N[contact.region];
    const Vec3 force_w = contact.force_N * contact.normal_w + share * state.region[contact.region].friction_force_w;
    const Vec3 force = rotate(to_tool, force_w);
    Wrench& sum = load[static_cast<std::size_t>(contact.piece)];
    sum.force_N += force;
    sum.torque_Nm += cross(inverse_transform(state.tool_w, contact.position_w), force);
  }
  return load;
}

}  // namespace

FingerWork::FingerWork(const Model& model, const State& state, const Scratch& scratch)
    : model_(model), state_(state), scratch_(scratch), load_tool_(model.piece.size()) {}

void FingerWork::add() {
  if (!is_articulated(model_)) return;
  const std::vector<Wrench> now = loads(model_, state_, scratch_);
  const ArticulationState& a = state_.articulation;
  for (std::size_t p = 0; p < now.size() && a.moved != 0; ++p) {
    const auto piece = static_cast<std::int32_t>(p);
    const Pose before = a.motion_previous_tool[piece], after = a.motion_tool[piece];
    const Quat turn = after.orientation * conjugate(before.orientation);
    const Vec3 way = after.position_m - rotate(turn, before.position_m);  // of the point at the tool's origin
    // Midway: the forces turn and move with the part, the mean of both ends is exact to the third order of a step.
    work_J_ -= 0.5 * (dot(now[p].force_N + load_tool_[p].force_N, way) +
                      dot(now[p].torque_Nm + load_tool_[p].torque_Nm, rotation_vector(turn)));
  }
  load_tool_ = now;
}

}  // namespace palpate
