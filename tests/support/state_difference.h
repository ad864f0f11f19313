// Where two States part, for the messages of tests.
#pragma once

#include <algorithm>
#include <string>

#include "sim_host/record/state_dump.h"

namespace palpate::test {

// Name of the first field whose 17 digits differ, or an empty text.
inline std::string first_state_difference(const State& a, const State& b) {
  const auto of_a = list_state(a), of_b = list_state(b);
  for (std::size_t i = 0; i < std::min(of_a.size(), of_b.size()); ++i) {
    const std::string &in_a = of_a[i].first, &in_b = of_b[i].first;
    if (in_a != in_b) return in_a.size() > in_b.size() ? in_a : in_b;  // an entry that only one of them uses
    if (of_a[i].second != of_b[i].second) return in_a;
  }
  return of_a.size() == of_b.size() ? "" : "number of entries in use";
}

}  // namespace palpate::test
