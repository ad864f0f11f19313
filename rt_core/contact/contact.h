// The one switch between the methods of contact, and what a method is: three steps over the rows of one problem
// (contact/problem.h). A method is a folder beside this file; a further one is that folder, a name in Method and its
// line in contact.cpp.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline Method method_of(const Model& model) PALPATE_RT { return method_of(model.params); }

struct ContactMethod {
  // What touches, and where: the rows of this tick's problem. Reads the tool's and its pieces' poses.
  void (*find_rows)(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
  // The forces of the rows. Afterwards every region in contact holds its normal load.
  void (*solve)(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
  // What they do: wrench, energy and tangent stiffness (scratch.contact_wrench_w, energy_J, state.contact_stiffness),
  // where the tool goes (scratch.tool_corrected_w), and the memory of regions and friction for the next tick.
  void (*account)(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
};

extern const ContactMethod points_method, tips_method, nodes_method;
const ContactMethod& contact_method(Method method) PALPATE_RT;

// What the stage owns, as nothing pressing leaves it: total wrench, energy, residual, strain, tangent stiffness.
void clear_contact(State& state, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
