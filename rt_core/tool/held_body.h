// The elastic body in a hand (the clip in the hand: Duriez, Andriot & Kheddar 2003), against a tool that is fixed in
// the world with its frame on the world's, or that another hand holds by another device. Contact knows poses of the
// tool to the body only, so the tick stays in the body's frame: handles become the pose of the tool as seen from the
// body, and what the tick would render on the tool acts on the hand at the body the other way round. Safety judges the
// motion of the two to each other: one mode, one gain, one fault for both devices.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Whether some hand holds the body.
inline bool holds_body(const Model& model) PALPATE_RT {
  return model.params.held_part == HeldPart::kBody || model.params.held_part == HeldPart::kBoth;
}
inline Vec3 grip_of(const Model& model) PALPATE_RT {
  return {model.params.grip_x_m, model.params.grip_y_m, model.params.grip_z_m};
}

// The tool as seen from a body whose point `grip_m` is at the handle `body_w`: g + R^T (x - p), R^T q. Poses that are
// none (not finite, no rotation) give one that is none either; a rotation off by the wire's rounding is one.
inline Pose tool_seen(Vec3 grip_m, const Pose& body_w, const Pose& tool_w) PALPATE_RT {
  const Quat back = conjugate(body_w.orientation);
  return {grip_m + rotate(normalised(back), tool_w.position_m - body_w.position_m), back * tool_w.orientation};
}
// The handle at the body from which a tool on the world's frame is seen so: its inverse.
inline Pose handle_seeing(Vec3 grip_m, const Pose& tool) PALPATE_RT {
  const Quat forth = conjugate(tool.orientation);
  return {rotate(forth, grip_m - tool.position_m), forth};
}
// Where the device's handle is when the tool is to be at `tool` in the body's frame and a second device, if there is
// one, is at `second_w`.
inline Pose handle_for(const Model& model, const Pose& tool, const Pose& second_w = {}) PALPATE_RT {
  if (!holds_body(model)) return tool;
  if (model.params.held_part == HeldPart::kBody) return handle_seeing(grip_of(model), tool);
  return second_w * Pose{tool.position_m - grip_of(model), tool.orientation};
}

// `input` of a tick as the body sees it.
Input seen_from_body(const Model& model, const Input& input) PALPATE_RT;
// What the devices render, from the frame of the body and the tool's origin to the world and the handles: on the hand
// at the body the opposite force, its moment about that handle cut to the device's largest torque; and the stiffness
// felt there. For Drive::kDevice, after make_safe() has found the rest. Status: kTorqueClamped.
void render_on_body(const Model& model, const State& state, Scratch& scratch, Output& output) PALPATE_RT;

}  // namespace palpate
