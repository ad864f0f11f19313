// A State in words: every field of its tables by name, for people and for naming where two States part.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rt_core/state.h"

namespace palpate {

// Name ("region[3].stretch_w") and value, 17 digits, of everything that can influence a later tick, in the tables'
// order.
std::vector<std::pair<std::string, std::string>> list_state(const State& state);
// Name of the first field that differs in any bit, or an empty text.
std::string first_state_difference(const State& a, const State& b);

}  // namespace palpate
