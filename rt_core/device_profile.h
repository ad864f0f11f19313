// What must be known of a haptic device before it is driven: one table, from which the scene's [device] keys, the
// reader of device profiles (hal/device/device_profile.h) and their ranges are made.
#pragma once

#include "rt_core/base.h"
#include "rt_core/limits.h"

namespace palpate {

// X(member, key, default, lowest, highest, scale to SI, meaning); default in SI, lowest and highest in the key's unit.
#define PALPATE_PROFILE_KEYS(X)                                                                           \
  X(mass_kg, "mass_kg", 0.1, 1e-3, 100, 1, "moving mass at the handle")                                   \
  X(inertia_kg_m2, "inertia_kg_m2", 1e-4, 1e-8, 10, 1, "moving inertia at the handle")                    \
  X(damping_Ns_per_m, "damping_Ns_per_m", 2.5, 0, 1000, 1, "physical damping b")                          \
  X(damping_Nms_per_rad, "damping_Nms_per_rad", 1e-3, 0, 10, 1, "physical rotational damping")            \
  X(friction_N, "friction_N", 0.06, 0, 100, 1, "Coulomb friction f_c")                                    \
  X(friction_Nm, "friction_Nm", 5e-4, 0, 10, 1, "rotational Coulomb friction")                            \
  X(encoder_step_m, "encoder_step_mm", 3e-5, 0, 10, 1e-3, "position resolution Delta")                    \
  X(encoder_step_rad, "encoder_step_rad", 1e-3, 0, 1, 1, "angular resolution")                            \
  X(delay_s, "delay_ms", 5e-4, 0, 100, 1e-3, "delay tau from sample to force, beyond the tick")           \
  X(force_max_N, "force_max_N", 8.5, 0.01, kWireForceMax_N, 1,                                            \
    "largest force commanded; the highest is what a command can carry")                                   \
  X(torque_max_Nm, "torque_max_Nm", 0.188, 0, kWireTorqueMax_Nm, 1, "largest torque commanded; the same") \
  X(local_Hz, "local_kHz", 0, 0, 100, 1e3,                                                                \
    "how often the device evaluates the local contact model; 0: never, it holds the force of a command")

// Stiffest spring a sampled device keeps passive: min(2b / (T + 2 tau), 2 f_c / Delta): viscous damping against
// sampling and delay (Colgate & Brown 1994), Coulomb friction against the encoder's step (Abbott & Okamura 2005).
struct StiffnessBound {
  double value = 0;
  bool by_damping = true;  // which of the two is smaller
};
inline StiffnessBound admissible_stiffness(double damping, double friction, double encoder_step, double period_s,
                                           double delay_s) {
  const double by_damping = 2 * damping / (period_s + 2 * delay_s);
  // A device without quantisation needs no friction; one with neither is bounded by its damping alone.
  const double by_friction = encoder_step > 0 ? 2 * friction / encoder_step : kHuge;
  return {by_damping <= by_friction ? by_damping : by_friction, by_damping <= by_friction};
}
// The same for a device that evaluates the local contact model `local_Hz` times a second from its own encoder: the
// spring is closed there, and smoothed (safety/encoder_observer.h) it plays within half an encoder step. Without one,
// local_Hz = 0, with the controller's period and the whole delay.
inline StiffnessBound admissible_stiffness(double damping, double friction, double encoder_step, double period_s,
                                           double delay_s, double local_Hz) {
  if (!(local_Hz > 0)) return admissible_stiffness(damping, friction, encoder_step, period_s, delay_s);
  return admissible_stiffness(damping, friction, 0.5 * encoder_step, 1 / local_Hz, 0);
}
inline const char* reason_of(const StiffnessBound& bound) {
  return bound.by_damping ? "2b / (T + 2 tau)" : "2 f_c / Delta";
}

}  // namespace palpate
