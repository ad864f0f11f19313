// Whether a scene's worst tick fits its period on this machine. The image's bound is in instructions and holds for any
// tick; what a tick takes here is measured before the loop starts, on ticks that look for trouble. The tick itself
// never looks at a clock.
#pragma once

#include <string>

#include "rt_core/model.h"

namespace palpate {

// Part of a period that the tick may take; the rest is for the wake-up, the bus and telemetry.
inline constexpr double kTickShare = 0.8;  // tick_fit_text names it

inline bool fits_period(double tick_ns, double period_s) { return tick_ns <= kTickShare * 1e9 * period_s; }  // NaN: no

struct TickFit {
  double instructions = 0;  // the image's bound of the worst tick
  double slowest_ns = 0;    // of the ticks measured here
  double period_s = 0;
  bool fits() const { return fits_period(slowest_ns, period_s); }
};
std::string tick_fit_text(const TickFit& fit);

// The slowest of some hundred ticks with the tool at, in and across the surface, as far in as the contact law reaches,
// each the fastest of several repetitions (of more where it would not fit), so that what else the machine does
// meanwhile is left out. Fixed seed.
double measure_slowest_tick_ns(const Model& model);

}  // namespace palpate
