// What was put out in the last ticks and is still under way to the motors: the delay of the device is known.
#pragma once

#include "rt_core/model.h"
#include "rt_core/vec.h"

namespace palpate {

inline Vec3 vec_at(const double* of) PALPATE_RT { return {of[0], of[1], of[2]}; }

// The delay in ticks: in this tick `now` acts, which was put out its whole ones ago, but for `part` of it, at its
// begin, what was put out a tick earlier, `before`.
struct Late {
  const double *now, *before;
  double part;
  // Of the three numbers from `first` on.
  Vec3 mean(std::int32_t first) const PALPATE_RT {
    return (1 - part) * vec_at(now + first) + part * vec_at(before + first);
  }
};
inline Late late_of(const ModelParams& params, const double* newest, std::int32_t numbers) PALPATE_RT {
  const double late = clamp_to(params.delay_s / params.period_s, 0, kForceHistory - 1.001);
  const auto whole = static_cast<std::int32_t>(late);
  const double* now = newest + numbers * whole;
  return {now, now + numbers, late - whole};
}

// `now` before what a history of so many numbers a tick has.
inline void remember(const double* now, std::int32_t numbers, double* history) PALPATE_RT {
  for (std::int32_t i = numbers * kForceHistory - 1; i >= numbers; --i) history[i] = history[i - numbers];  // bound: it
  for (std::int32_t i = 0; i < numbers; ++i) history[i] = now[i];
}

}  // namespace palpate
