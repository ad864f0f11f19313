// The method `nodes`: contact between the tool's convex pieces and the surface nodes of a finite-element body, solved
// as a linear complementarity problem on the body's compliance, its Delassus operator (Duriez, Andriot & Kheddar 2003),
// here with unit normals, friction and the virtual coupling in the same problem. Its parts, in the order of a tick.
// Equations and measured errors: docs/models_contact_lcp.md.
#pragma once

#include "rt_core/contact/nodes/node_problem.h"
#include "rt_core/model.h"
#include "rt_core/state.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

// Nodes near the tool (near_nodes.cpp), with gaps and normals where the body's far field has carried them:
// problem.near. Bound: n_vertex / 4 steps per piece.
void find_near_nodes(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

// When not all near nodes fit into a problem, as many join those that pushed as fill whole lanes: at least kMinJoining,
// and no fewer than make a problem of kMinChosen. Where none pushed, or so many that the problem would exceed
// kMostChosen, as many as fit.
inline constexpr std::int32_t kMinJoining = 6;
inline constexpr std::int32_t kMinChosen = 32;
inline constexpr std::int32_t kMostChosen = 48;
inline constexpr std::int32_t kMaxJoining = kMaxContacts;
// Displacements predicted in one tick, as pushes times nodes that they move, eight nodes for one.
inline constexpr std::int32_t kMaxPredictions = 256;

// Which of the nodes near the tool make up the tick's contact problem: all of them while they fit. Otherwise those that
// pushed last tick and, of the others, the deepest where last tick's pushes have moved the body: a node that neither
// pushes nor penetrates has no part in the problem, and one that does after this tick joins in the next. Where
// kMaxPredictions is too few, they are for those of the smallest gap and, in turns, some of the others. Status:
// kContactsDropped when one that penetrates is left out. Fills problem.node. Bound: n_vertex steps and
// kMaxPredictions.
void choose_nodes(const Model& model, const State& state, Scratch& scratch) PALPATE_RT;

inline bool is_held(const Model& model, const ContactNode& node) PALPATE_RT {
  return model.nodal_vertex[static_cast<std::size_t>(node.vertex)].is_free == 0;
}
// Rows and columns of the compliance at the candidates: problem.influence. Bound: 9 kMaxContacts^2 numbers.
void gather_influence(const Model& model, ContactProblem& problem) PALPATE_RT;
// Normal compliances problem.normal.compliance = N (C + G K_coupling^-1 G^T) N^T, in double precision, with the
// regularisation on the diagonal and a stiff wall under held nodes. Needs normals and arms. Bound: kMaxContacts^2.
void gather_normal(const Model& model, ContactProblem& problem) PALPATE_RT;
// Every node's tangents, turned to those of its own compliance, and its friction block. Bound: kMaxContacts.
void make_frames(const Model& model, ContactProblem& problem, Real mu) PALPATE_RT;

// Solves the tick's problem, pushes of the nodes and the tool's place together: fills frames, compliances and gaps of
// the problem's nodes, then finds their pushes. `drift` is how far the tool would move from state.tool_w if nothing
// touched it: zero when it is held. Afterwards node.push, motion_m, force_N and torque_Nm hold the solution,
// scratch.residual_m its residual.
void solve_contacts(const Model& model, State& state, Scratch& scratch, const Twist& drift,
                    const Pose& tool_before_w) PALPATE_RT;

// Groups the contacts into lasting regions, sums what they do to the tool, and fits how the surface around each has
// moved. Status: kRegionsDropped.
void find_nodal_regions(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
