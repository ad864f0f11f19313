// Memory for tests whose model is put together by hand, piece by piece: room for the largest scene there can be.
#pragma once

#include <cstring>

#include "sim_host/tick_memory.h"

namespace palpate::test {

inline Model roomiest_model() {
  Model model;
  model.sizes.n_tool_point = kMaxToolPoints;
  model.sizes.n_piece = kMaxPieces;
  model.sizes.n_joint = kMaxJoints;
  model.sizes.n_anchor = kMaxAnchors;
  model.sizes.n_corner = 1;
  model.params.articulation = Articulation::kTwoTools;  // room for the other one
  model.sizes.n_vertex = model.sizes.n_nodal = kMaxNodalVertices;
  return model;
}
inline StatePtr roomy_state() { return make_state(roomiest_model()); }
inline ScratchPtr roomy_scratch() { return make_scratch(roomiest_model()); }

// Fills all that a Scratch has with `byte`: nothing may depend on what an earlier tick left there.
inline void poison(Scratch& scratch, const Model& model, int byte) {
  std::memset(static_cast<void*>(&scratch), byte, scratch_bytes(model));
  create_scratch(model, &scratch);
}

}  // namespace palpate::test
