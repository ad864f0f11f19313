// The properties of the simulated device and hand that have a name outside: palpate-device --set NAME=VALUE.
#pragma once

#include "hal/device/device_sim.h"

// X(name): members of PlantOptions, numbers in SI units; delay_ticks and substeps, whole numbers, stand apart.
#define PALPATE_PLANT_OPTIONS(X) \
  X(mass_kg)                     \
  X(damping_N_s_per_m)           \
  X(friction_N)                  \
  X(inertia_kg_m2)               \
  X(damping_Nm_s_per_rad)        \
  X(friction_Nm)                 \
  X(encoder_m)                   \
  X(noise_m)                     \
  X(force_max_N)                 \
  X(torque_max_Nm)               \
  X(hand_mass_kg)                \
  X(hand_stiffness_N_per_m)      \
  X(hand_damping_N_s_per_m)      \
  X(hand_stiffness_Nm_per_rad)   \
  X(hand_damping_Nm_s_per_rad)   \
  X(tremor_m)                    \
  X(tremor_rad)                  \
  X(tremor_Hz)                   \
  X(local_Hz)                    \
  X(local_N_per_m)               \
  X(period_s)
