// Settings that may change while a run goes on. What is wanted comes with each tick's input, so that a recording holds
// it and a replay makes the same bits; the state holds what acts now, and follows what is wanted by a bounded step a
// tick.
#pragma once

#include <cstdint>

#include "rt_core/base.h"

namespace palpate {

// X(name, lowest, highest, scene key, meaning). Factors of what was baked, 1 to begin with. The device's own limits and
// the coupling it admits are bounds: those two go down only.
#define PALPATE_LIVE_SETTINGS(X)                                                                                  \
  X(stiffness, 0.1, 2, "body.material.youngs_modulus_Pa", "force of the body at a given depth, friction with it") \
  X(friction, 0, 2, "friction.mu_ref", "limits of static and sliding friction")                                   \
  X(force_limit, 0.05, 1, "device.force_max_N", "largest force and torque that are rendered")                     \
  X(coupling, 0.05, 1, "device.coupling_N_per_m", "stiffness and damping of the coupling between handle and tool")

// Of the same size as JointCommand's numbers: it travels in every record.
struct LiveSettings {
#define PALPATE_FIELD(name, lowest, highest, key, meaning) float name = 1;
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  friend bool operator==(const LiveSettings&, const LiveSettings&) = default;
};

// Whether they are ones a host may send.
inline bool is_valid(const LiveSettings& settings) PALPATE_RT {
#define PALPATE_FIELD(name, lowest, highest, key, meaning) \
  if (!(settings.name >= static_cast<float>(lowest) && settings.name <= static_cast<float>(highest))) return false;
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  return true;
}

}  // namespace palpate
