// Checks a State that came from outside (a recording, a peer) before a tick uses it: the tick indexes with what the
// State holds and does not look twice. Not for the tick: it runs once per State, and a host may run it on live ones.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// First field that no run of this model can have left behind; field is nullptr when every index, count, enumeration and
// number is one that a tick may be given.
struct StateFault {
  const char* field = nullptr;  // static text
  std::int64_t index = -1;      // element within it, where that makes sense
};

StateFault check_state(const Model& model, const State& state) noexcept;

}  // namespace palpate
