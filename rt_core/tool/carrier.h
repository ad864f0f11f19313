// The rigid motion that carries a piece and its tool points: the tool's own pose, or for an articulated tool that pose
// and the motion of the piece by its joints.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline bool is_articulated(const Model& model) PALPATE_RT {
  return model.params.articulation != static_cast<std::int32_t>(Articulation::kRigid);
}
// Tool-frame coordinates with all joints at zero (ToolPiece, ToolPoint) to the world: with the tool at `tool_w` and the
// joints of this tick or of the last; or as the tool stands now and stood at the last tick.
inline Pose carrier_at(const Model& model, const State& state, const Pose& tool_w, std::int32_t piece) PALPATE_RT {
  return is_articulated(model) ? tool_w * state.articulation.motion_tool[piece] : tool_w;
}
inline Pose carrier_previous_at(const Model& model, const State& state, const Pose& tool_w,
                                std::int32_t piece) PALPATE_RT {
  return is_articulated(model) ? tool_w * state.articulation.motion_previous_tool[piece] : tool_w;
}
inline Pose carrier_w(const Model& model, const State& state, std::int32_t piece) PALPATE_RT {
  return carrier_at(model, state, state.tool_w, piece);
}
inline Pose carrier_previous_w(const Model& model, const State& state, std::int32_t piece) PALPATE_RT {
  return carrier_previous_at(model, state, state.tool_previous_w, piece);
}
// The frame in which places of contact keep still against one another: the tool's, or for a tool whose parts move
// against one another the body's.
inline Pose lean_frame_w(const Model& model, const State& state) PALPATE_RT {
  return is_articulated(model) ? Pose{} : state.tool_w;
}

}  // namespace palpate
