// Solves one tick's contact problem: pushes of the nodes and the tool's place, together.
#pragma once

#include "rt_core/contact/nodes/nodal.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

// Fills frames, compliances and gaps of scratch.nodal's nodes and solves for their pushes. `drift` is how far the
// tool would move from state.tool_w if nothing touched it: zero when it is held. Afterwards node.push, motion_m,
// force_N and torque_Nm hold the solution, scratch.residual_m its residual.
void solve_contacts(const Model& model, State& state, Scratch& scratch, const Twist& drift,
                    const Pose& tool_before_w) PALPATE_RT;

}  // namespace palpate
