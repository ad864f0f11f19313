// Where the coupling is held when samples come again after a gap, or after a jump of the encoder: not at the handle,
// but where it was held before, apart from the handle by the way that nobody saw. The force goes on from what was
// commanded, and no spring is stretched by a way against which the hand worked less, or not at all. Before, the tool
// caught up through the coupling: 30 lost samples on the way in gave the hand up to 3.0 mJ, an encoder that jumped by
// 4 mm under a local model up to 32 (2026-11-25).
#pragma once

#include "rt_core/io.h"
#include "rt_core/model.h"
#include "rt_core/state.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

// The end of the coupling that moves with the handle: the handle itself, but for what stands apart.
inline Pose coupling_end(const State& state) PALPATE_RT {
  return state.apart == 0 ? state.device_w : moved(state.device_w, {state.seat_m, state.seat_rad});
}

// Whether `handle_w`, a sample that is believed, comes after more than is bridged, or after samples that were refused
// and is not where the handle's motion leads.
bool comes_anew(const Model& model, const State& state, const Input& input, const Pose& handle_w) PALPATE_RT;

// Takes the handle to be at `handle_w` without a motion, and the coupling to be held where it was. What the hand may
// have got on the way, at the forces that acted since, is not paid; nor is, where the force is gone and so the contact
// over for the hand, what coupling and object would give back.
void seat_anew(const Model& model, State& state, const Pose& handle_w) PALPATE_RT;

// Brings the coupling's end back to the handle, by what gives the hand nothing: as far as that leaves the coupling
// less stretched, at once; in free air, by a little a tick. And lets it give way while there is energy nobody paid.
void ease_seat(const Model& model, State& state) PALPATE_RT;

// The account while the end stands apart: `made_J` of a tick as drain_energy() finds it, gain and gap included.
void count_unpaid(State& state, double made_J) PALPATE_RT;

void forget_seat(State& state) PALPATE_RT;

}  // namespace palpate
