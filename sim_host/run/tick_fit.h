// Whether a scene's worst tick fits its period on this machine: the image's bound in instructions times what one of the
// tick's own takes here. Asked once, before the loop; the tick itself never looks at a clock.
#pragma once

#include <string>

#include "rt_core/model.h"

namespace palpate {

// Part of a period that the tick may take; the rest is for the wake-up, the bus and telemetry.
inline constexpr double kTickShare = 0.8;  // tick_fit_text names it

struct TickFit {
  double instructions = 0;  // the image's bound of the worst tick
  double instruction_ns = 0;
  double period_s = 0;
  double worst_ns() const { return instructions * instruction_ns; }
  bool fits() const { return worst_ns() <= kTickShare * 1e9 * period_s; }  // NaN does not
};
std::string tick_fit_text(const TickFit& fit);

// Nanoseconds that an instruction of the tick takes on this machine now: searches of the scene's surface, whose number
// of instructions is known, the fastest of several rounds. A few milliseconds.
double measure_instruction_ns(const Model& model);

}  // namespace palpate
