// The one switch between the methods of contact, and what a method is: three steps over the rows of one problem
// (contact/problem.h), and what a loader asks of it. A method is a folder beside this file; a further one is that
// folder, its name in PALPATE_METHODS (laws.h), its parameters and arrays in model.h and what it remembers in state.h.
#pragma once

#include "rt_core/image.h"
#include "rt_core/model.h"
#include "rt_core/stage_cost.h"
#include "rt_core/state.h"

namespace palpate {

inline Method method_of(const Model& model) PALPATE_RT { return method_of(model.params); }

struct ContactMethod {
  using Step = void (*)(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
  using Check = ImageResult (*)(const Model& model) noexcept;

  // What touches, and where: the rows of this tick's problem. Reads the tool's and its pieces' poses.
  Step find_rows;
  // The forces of the rows. Afterwards every region in contact holds its normal load.
  Step solve;
  // What they do: wrench, energy and tangent stiffness (scratch.contact_wrench_w, energy_J, state.contact_stiffness),
  // where the tool goes (scratch.tool_corrected_w), and the memory of regions and friction for the next tick.
  Step account;
  // What it asks of the tool: rules between parameters and pieces (check_method in image_check.h).
  Check check_tool;
  // Its arrays and parameters, so that the tick may index and divide; those of every method have passed.
  Check check_data;
  // Adds what its capacities allow one tick at most (work.h), all met at once.
  void (*add_most_work)(const Model& model, const SceneSizes& sizes, Work& work) noexcept;
  // Working memory of its own, Scratch::own: its size, and what is made there. Null: it needs none.
  std::size_t (*scratch_bytes)(const Model& model) noexcept = nullptr;
  void (*create_scratch)(const Model& model, void* block) noexcept = nullptr;
};

#define PALPATE_METHOD(name, word) extern const ContactMethod word##_method;
PALPATE_METHODS(PALPATE_METHOD)
#undef PALPATE_METHOD
const ContactMethod& contact_method(Method method) PALPATE_RT;

// What the stage owns, as nothing pressing leaves it: total wrench, energy, residual, strain, tangent stiffness.
void clear_contact(State& state, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
