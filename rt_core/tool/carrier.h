// The rigid motion that carries a piece and its tool points: the tool's own pose, or for an articulated tool that pose
// and the motion of the piece by its joints.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline bool is_articulated(const Model& model) PALPATE_RT {
  return model.params.articulation != static_cast<std::int32_t>(Articulation::kRigid);
}
// Tool-frame coordinates with all joints at zero (ToolPiece, ToolPoint) to the world, now and at the last tick.
inline Pose carrier_w(const Model& model, const State& state, std::int32_t piece) PALPATE_RT {
  return is_articulated(model) ? state.tool_w * state.articulation.motion_tool[piece] : state.tool_w;
}
inline Pose carrier_previous_w(const Model& model, const State& state, std::int32_t piece) PALPATE_RT {
  if (!is_articulated(model)) return state.tool_previous_w;
  return state.tool_previous_w * state.articulation.motion_previous_tool[piece];
}

}  // namespace palpate
