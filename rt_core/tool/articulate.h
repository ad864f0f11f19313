// Articulated tools: joints that move the tool's pieces. The stage `articulate` is declared in tick.h.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Load of each piece from the contacts of this tick, for the next tick's stops; and the palm's share of a hand's
// balance: what it must exert on the body against the fingers' forces and the body's weight (scratch.palm_w). Whether
// fingers and palm can hold it is judged outside the tick, which nothing of it would change
// (sim_host/press/grasp_stability.h). Part of the stage contact; a rigid tool has no joints to stop: returns at once.
// Bound: kMaxContacts.
void load_pieces(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

// Frame of every link in the tool frame for the joint positions `joint`; writes sizes.n_joint poses, and the joints'
// axes where the pointers are not null. `which`, as bits: of those joints alone, each with all its parents. Bound:
// kMaxJoints.
void place_links(const Model& model, const double* joint, Pose* link_tool, Vec3* axis_tool, Vec3* origin_tool_m,
                 std::uint32_t which = ~0u) PALPATE_RT;

// The rigid motion that carries a piece and its tool points: the tool's own pose, or for an articulated tool that pose
// and the motion of the piece by its joints.

inline bool is_articulated(const Model& model) PALPATE_RT { return model.params.articulation != Articulation::kRigid; }
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
