// A State in words: every field of its tables by name, for people.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rt_core/state.h"

namespace palpate {

// Name ("region[3].stretch_w") and value, 17 digits, of everything that can influence a later tick, in the tables'
// order.
std::vector<std::pair<std::string, std::string>> list_state(const State& state);

}  // namespace palpate
