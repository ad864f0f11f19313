// A fixed point that is come nearer to by one step a tick, damped where the steps would go to and fro.
#pragma once

#include "rt_core/math.h"
#include "rt_core/state.h"

namespace palpate {

// A step that turns back by more than so much of the last one, for more ticks than so, is damped: by the secant, and
// again as soon as it turns in the next ticks. Where steps are G times too long a share of 1 / G of them ends there,
// and one that comes back by a fifth a tick is cut at 1.5 / G, before it goes to and fro again. Over a kink it goes at
// least every third tick, each time with half of the share or less, which a fifth does not make up for. A friction that
// slips and sticks turns a few steps back, too, and is left alone.
inline constexpr Real kStillTurns = 0.5, kLeastShare = 0.1, kRegain = 1.2;
inline constexpr std::int32_t kTurnsToDamp = 3, kDampedFor = 64;

// The share of `asked` that is gone.
inline Real damp(Real asked, DampedStep& step) PALPATE_RT {
  const Real now = abs_of(asked), was = abs_of(step.asked), share = 1 - step.held;
  const bool turns_back = asked * step.asked < 0 && now > kStillTurns * was;
  std::int32_t& turned = step.turned_ticks;
  turned = turns_back ? (turned < kTurnsToDamp ? turned + 1 : kDampedFor) : turned > 0 ? turned - 1 : 0;
  step.held = 1 - (turns_back && turned > kTurnsToDamp ? max_of(share * was / (was + now), kLeastShare)
                                                       : min_of(kRegain * share, 1.0));
  step.asked = asked;
  return 1 - step.held;
}

}  // namespace palpate
