// Articulated tools: joints that move the tool's pieces. The stage `articulate` is declared in stages.h.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Load of each piece from the contacts of this tick, for the next tick's stops; and the palm's share of a hand's
// balance: what it must exert on the body against the fingers' forces and the body's weight (scratch.palm_w;
// Status::kGraspUnstable when it would have to pull). Part of the stage contact; a rigid tool has no joints to stop:
// returns at once. Bound: kMaxContacts.
void load_pieces(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

// Frame of every link in the tool frame for the joint positions `joint`; writes sizes.n_joint poses, and the joints'
// axes where the pointers are not null. Bound: kMaxJoints.
void place_links(const Model& model, const double* joint, Pose* link_tool, Vec3* axis_tool,
                 Vec3* origin_tool_m) PALPATE_RT;

}  // namespace palpate
