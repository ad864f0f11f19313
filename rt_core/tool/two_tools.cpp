#include "rt_core/tool/two_tools.h"

#include "rt_core/tool/articulate.h"
#include "rt_core/tool/held_body.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

namespace {

template <class T>
void exchange(T& a, T& b) PALPATE_RT {
  const T kept = a;
  a = b;
  b = kept;
}
void exchange(Matrix6& a, Matrix6& b) PALPATE_RT {
  for (std::int32_t i = 0; i < 36; ++i) exchange(a[i], b[i]);  // bound: 36
}

void exchange_tools(State& state, Scratch& scratch) PALPATE_RT {
  OtherTool& other = state.other_tool[0];
#define PALPATE_EXCHANGE(type, name, initial, meaning) exchange(state.name, other.name);
  PALPATE_TOOL_STATE(PALPATE_EXCHANGE)
#undef PALPATE_EXCHANGE
  other.hand = 1 - other.hand;
  OtherFound& found = scratch.other;
  exchange(scratch.contact_wrench_w, found.contact_wrench_w);
  exchange(scratch.stiffness, found.stiffness);
  exchange(scratch.told_besides, found.told_besides);
  exchange(scratch.tool_corrected_w, found.tool_corrected_w);
  exchange(scratch.grip_w, found.grip_w);
}

// `pose` in the frame of `tool`.
Pose seen_from(const Pose& tool, const Pose& pose) PALPATE_RT {
  return {inverse_transform(tool, pose.position_m), normalised(conjugate(tool.orientation) * pose.orientation)};
}

}  // namespace

OthersTurn::OthersTurn(State& state, Scratch& scratch) PALPATE_RT : state_(state), scratch_(scratch) {
  exchange_tools(state_, scratch_);
}

OthersTurn::~OthersTurn() PALPATE_RT { exchange_tools(state_, scratch_); }

Input input_of_second(const Model& model, const Input& input) PALPATE_RT {
  Input second = input;
  second.pose_w = input.drive == Drive::kDevice ? input.second_w : Pose{grip_of(model), {}};
  return second;
}

void carry_second_tool(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  ArticulationState& a = state.articulation;
  const OtherTool& other = state.other_tool[0];
  const Pose now = seen_from(state.tool_w, other.tool_w);
  const Pose before = seen_from(state.tool_previous_w, other.tool_previous_w);
  scratch.work.joints += a.motion_tool.size();
  for (std::int32_t p = 0; p < a.motion_tool.size(); ++p) {  // bound: kMaxPieces
    const bool second = hand_of(model, p) != 0;
    a.motion_tool[p] = second ? now : Pose{};
    a.motion_previous_tool[p] = second ? before : Pose{};
  }
}

double work_of_other_J(const State& state, const Scratch& scratch) PALPATE_RT {
  if (state.other_tool.size() == 0) return 0;
  const OtherTool& other = state.other_tool[0];
  const Twist way = twist_between(other.tool_previous_w, other.tool_w);
  const Wrench &now = scratch.other.contact_wrench_w, &before = other.safety.object_w;
  return -0.5 * (dot(now.force_N + before.force_N, way.translation_m) +
                 dot(now.torque_Nm + before.torque_Nm, way.rotation_rad));
}

}  // namespace palpate
