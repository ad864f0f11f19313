// Two hands with a tool each, by a device each, on one body that stands still (Duriez & Andriot 2003, their platform).
// Contact takes the two for one tool in two parts, as fingers are: the second tool's pieces move against the first's,
// and every method knows such tools. What is a hand's own - sample, coupling, step, tangent, wrench, energy, limits -
// is found for one after the other by the code there is, with the second's memory in the place of the first's.
#pragma once

#include "rt_core/io.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline bool has_two_tools(const Model& model) PALPATE_RT { return model.params.held_part == HeldPart::kTwoTools; }

// Whose memory State has in its own fields: 1 while they are the second tool's.
inline std::int32_t hand_of(const State& state) PALPATE_RT {
  return state.other_tool.size() > 0 && state.other_tool[0].hand == 0 ? 1 : 0;
}
// The hand that a contact on `piece` is of.
inline std::int32_t hand_of(const Model& model, std::int32_t piece) PALPATE_RT {
  return has_two_tools(model) ? model.piece[static_cast<std::size_t>(piece)].group : 0;
}
// The tool of a hand, between its turns.
inline const Pose& tool_of(const State& state, std::int32_t hand) PALPATE_RT {
  return hand == hand_of(state) ? state.tool_w : state.other_tool[0].tool_w;
}

// Puts the other tool in the place of this one: while the object lives, its memory is in State's own fields, and what
// is found goes where Scratch has a hand's only tool.
class OthersTurn {
 public:
  OthersTurn(State& state, Scratch& scratch) PALPATE_RT;
  ~OthersTurn() PALPATE_RT;
  OthersTurn(const OthersTurn&) = delete;
  OthersTurn& operator=(const OthersTurn&) = delete;

 private:
  State& state_;
  Scratch& scratch_;
};

// `input` as the second hand's device has it. Where no device drives the tick (presses), the second tool rests where
// its own hand begins (grip_of(model)), turned as the scene describes it.
Input input_of_second(const Model& model, const Input& input) PALPATE_RT;

// Places the second tool's pieces in the first one's frame, now and at the last tick: part of the stage articulate.
void carry_second_tool(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

// Work that the other tool did on the body since the last tick, which is no energy of this one's contact.
double work_of_other_J(const State& state, const Scratch& scratch) PALPATE_RT;

}  // namespace palpate
