// The public entry of the real-time core, and the stages of a tick. Each is a free function of (Model, State, Scratch):
// no other memory, no clock, no text. Their one list is PALPATE_STAGES in status.h; the table in docs/architecture.md,
// which a test holds against it, says what each reads and writes, its loop bound and its status bits.
#pragma once

#include "rt_core/io.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Called after each stage, when given: the HAL takes a time stamp there. rt_core itself never reads a clock.
struct StageProbe {
  void (*mark)(void* context, Stage stage) PALPATE_RT = nullptr;
  void* context = nullptr;

  void passed(Stage stage) const PALPATE_RT {
    if (mark != nullptr) mark(context, stage);
  }
};

// Checks the sample and predicts the tool pose from device pose and last tick's tangent stiffness.
// Writes state.device*, state.tool*, scratch.status.
void sense(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT;
// Moves the joints of an articulated tool towards the command of `input`, at their bounded speeds, within their limits,
// and never so that a part loaded above the stop force would be pressed harder; then places every piece. At the first
// tick the joints stand at their open positions. A rigid tool has no joints: returns at once. Reads the loads of the
// last tick. Writes state.articulation (but the loads), scratch.status: kJointLimited, kJointStopped. Bound: kMaxPieces
// * kMaxJoints.
void articulate(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT;
// The contact problem of this tick, by the scene's method (contact/contact.h): finds its rows, solves for their forces,
// accounts for them. Writes state.point, region, nodal, contact_stiffness and the pieces' loads, scratch.contact, the
// totals in scratch and scratch.tool_corrected_w. Passes kFindRows, kSolve and kAccount to the probe.
void contact(const Model& model, State& state, Scratch& scratch, const StageProbe& probe) PALPATE_RT;
// Coupling wrench, finite check, limits, mode machine. Writes state.safety, state.tool_w, output.device_w, fault,
// mode.
void make_safe(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output) PALPATE_RT;
// Totals of the tick into the output, and the next tick's number.
void publish(State& state, const Scratch& scratch, Output& output) PALPATE_RT;

// Renders one period. Deterministic: the same model, state and input give the same bits in state and output.
// Bounded, allocation-free, lock-free. `output` is completely overwritten. Safe for every input, NaN included.
void tick(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output,
          const StageProbe& probe = {}) PALPATE_RT;

}  // namespace palpate
