#include "rt_core/contact/contact.h"

#include "rt_core/tick.h"
#include "rt_core/tool/articulate.h"

namespace palpate {

const ContactMethod& contact_method(Method method) PALPATE_RT {
  switch (method) {
#define PALPATE_METHOD(name, word) \
  case Method::name:               \
    return word##_method;
    PALPATE_METHODS(PALPATE_METHOD)
#undef PALPATE_METHOD
  }
  return points_method;
}

void clear_contact(State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_wrench_w = scratch.other.contact_wrench_w = {};
  scratch.told_besides = scratch.other.told_besides = {};
  scratch.palm_w = {};
  scratch.energy_J = 0;
  scratch.residual_m = 0;
  scratch.strain = 0;
  for (Real& entry : state.contact_stiffness) entry = 0;  // bound: 36
  for (OtherTool& other : state.other_tool)               // bound: 1
    for (Real& entry : other.contact_stiffness) entry = 0;
}

void contact(const Model& model, State& state, Scratch& scratch, const StageProbe& probe) PALPATE_RT {
  const ContactMethod& method = contact_method(method_of(model));
  clear_contact(state, scratch);
  method.find_rows(model, state, scratch);
  probe.passed(Stage::kFindRows);
  method.solve(model, state, scratch);
  probe.passed(Stage::kSolve);
  method.account(model, state, scratch);
  load_pieces(model, state, scratch);
  probe.passed(Stage::kAccount);
}

}  // namespace palpate
