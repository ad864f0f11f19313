// Which of the nodes near the tool make up the tick's contact problem.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// When not all near nodes fit into a problem, as many join those that pushed as fill whole lanes: at least kMinJoining,
// and no fewer than make a problem of kMinChosen. Where none pushed, or so many that the problem would exceed
// kMostChosen, as many as fit.
inline constexpr std::int32_t kMinJoining = 6;
inline constexpr std::int32_t kMinChosen = 32;
inline constexpr std::int32_t kMostChosen = 48;
inline constexpr std::int32_t kMaxJoining = kMaxContacts;
// Displacements predicted in one tick, as pushes times nodes that they move, eight nodes for one.
inline constexpr std::int32_t kMaxPredictions = 256;

// All of them while they fit. Otherwise those that pushed last tick and, of the others, the deepest where last tick's
// pushes have moved the body: a node that neither pushes nor penetrates has no part in the problem, and one that does
// after this tick joins in the next. Where kMaxPredictions is too few, they are for those of the smallest gap and, in
// turns, some of the others. Status: kContactsDropped when one that penetrates is left out. Fills scratch.nodal.node.
// Bound: n_vertex steps and kMaxPredictions.
void choose_nodes(const Model& model, const State& state, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
