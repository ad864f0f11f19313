// The number of soft modes, known to the compiler where it is the usual one. Their loops are a few entries long:
// counting and branching were half of what they took. The order of the sums, and so the bits, are those of any count.
#pragma once

#include <cstdint>
#include <type_traits>

#include "rt_core/base.h"

namespace palpate {

using TwoModes = std::integral_constant<std::int32_t, 2>;    // of many finger parts on one body: none ships
using ThreeModes = std::integral_constant<std::int32_t, 3>;  // of a block that bends two ways and turns
using FourModes = std::integral_constant<std::int32_t, 4>;   // every other shipped scene's

// use(TwoModes), use(FourModes), use(ThreeModes) or use(soft).
template <class Use>
void with_mode_count(std::int32_t soft, const Use& use) PALPATE_RT {
  if (soft == TwoModes::value) return use(TwoModes{});
  if (soft == FourModes::value) return use(FourModes{});
  if (soft == ThreeModes::value) return use(ThreeModes{});
  use(soft);
}

}  // namespace palpate
