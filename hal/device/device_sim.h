// A simulated haptic device held by a simulated hand. The handle is a mass with damping and Coulomb friction; the hand
// adds its mass and pulls the handle along a path through a spring and damper (impedance). The motors are late by whole
// ticks and saturate; the encoders quantise. Deterministic: same options, path and commands give the same motion.
#pragma once

#include <cstdint>

#include "hal/device/device.h"
#include "hal/device/hand_path.h"
#include "hal/device/kinematics.h"
#include "hal/device/local_handle.h"
#include "hal/loop/clock.h"

namespace palpate {

// The defaults resemble a desktop device of the Phantom 1.5 class held lightly; they are assumptions, not a data sheet.
struct PlantOptions {
  double mass_kg = 0.1;  // of the handle, as felt at its tip
  double damping_N_s_per_m = 0.5;
  double friction_N = 0.05;     // Coulomb
  double inertia_kg_m2 = 2e-4;  // about every axis
  double damping_Nm_s_per_rad = 1e-3;
  double friction_Nm = 1e-3;
  double encoder_m = 3e-5;  // position quantum; 0: none
  double noise_m = 0;       // uniform noise of this half width before quantisation
  std::uint64_t noise_seed = 1;
  double force_max_N = 8.5;  // motors: magnitude is cut, direction kept
  double torque_max_Nm = 0.2;
  int delay_ticks = 1;        // extra periods from command to motor, 0..kMaxDelayTicks
  double hand_mass_kg = 0.1;  // part of the hand that moves with the handle
  double hand_stiffness_N_per_m = 300;
  double hand_damping_N_s_per_m = 5;
  double hand_stiffness_Nm_per_rad = 1;
  double hand_damping_Nm_s_per_rad = 2e-2;
  double tremor_m = 0;       // amplitude of the hand's tremor: it aims aside by so much, a circle in two axes
  double tremor_rad = 0;     // and turns by so much
  double tremor_Hz = 9;      // physiological: 8 to 12 Hz
  double local_Hz = 0;       // evaluations of the local contact model; 0: forces are held
  double local_N_per_m = 0;  // stiffest it evaluates; 0: what its damping, friction and encoder admit
  // What commands change of its force in a millisecond at most, as a share of its limit; 0: any.
  double local_slope_share_per_ms = kLocalSlopeShare_per_ms;
  double period_s = 1e-3;  // device tick: commands are taken over and samples made
  int substeps = 20;       // of the integration per period, 1..1000
};

inline constexpr int kMaxDelayTicks = 63;  // 6.3 ms in a bench that steps the plant ten times a tick

// Work since the start. The midpoint rule balances exactly: motor + hand - lost is the kinetic energy, to rounding.
struct PlantEnergy {
  double motor_J = 0;  // of the motors on the handle
  double hand_J = 0;   // of the hand on the handle
  double lost_J = 0;   // in the device's damping and friction
  // What motors gave and the device did not swallow: above 0 it went into the hand.
  double to_hand_J() const noexcept { return motor_J - lost_J; }
};

// Mechanics only: implicit midpoint with an exact Coulomb step, unconditionally stable and of second order.
class DevicePlant {
 public:
  DevicePlant(const PlantOptions& options, HandPath path);  // starts at rest at the path's first pose

  // One period under `command`, which enters the delay line first; zero force if not enabled.
  void step(const DeviceCommand& command) noexcept;
  // From now on the hand leaves its path and goes where it is told, as smoothly and no faster than a hand does; told
  // again before each step or not at all, then it stays there.
  void pull(const Pose& target, bool trigger) noexcept;
  // The same, to where the hand is now; nothing when it is pulled already.
  void hold() noexcept {
    if (!pulled_) pull(path_.at(time_s()).pose, path_.at(time_s()).trigger);
  }
  Pose pose() const noexcept { return pose_; }  // exact, device frame
  Vec3 velocity_m_per_s() const noexcept { return velocity_; }
  Vec3 spin_rad_per_s() const noexcept { return spin_; }
  // With noise and encoder quantum; draws noise. Of a device that evaluates the local model: what it smoothed of that.
  Vec3 measured_m() noexcept;
  void freeze_encoder(bool frozen) noexcept { frozen_ = frozen; }               // repeats the last measurement
  void shift_encoder(Vec3 offset_m) noexcept { encoder_shift_m_ += offset_m; }  // lost counts
  Wrench motor() const noexcept { return motor_; }                              // rendered in the last period
  // Of a device that evaluates the local model: all that its force changed beyond what the handle's own, exact motion
  // made of the model.
  Vec3 unmoved_N() const noexcept { return unmoved_N_; }
  bool trigger() const noexcept { return aim_at(time_s()).trigger; }  // the hand holds the closing button
  bool saturated() const noexcept { return saturated_; }
  std::uint32_t obeyed() const noexcept { return due_.number; }  // number of the command that acted last
  double time_s() const noexcept { return static_cast<double>(ticks_) * options_.period_s; }
  std::uint64_t ticks() const noexcept { return ticks_; }
  const PlantOptions& options() const noexcept { return options_; }
  const PlantEnergy& energy() const noexcept { return energy_; }
  double kinetic_J() const noexcept;

 private:
  static constexpr std::uint64_t kDelaySlots = kMaxDelayTicks + 1;
  void drive(const DeviceCommand& command) noexcept;
  void evaluate_local(double elapsed_s) noexcept;
  Vec3 encoder_m() noexcept;
  HandTarget hand_at(double time_s) const noexcept;
  void integrate(double time_s, double dt_s) noexcept;
  double noise() noexcept;
  HandTarget aim_at(double time_s) const noexcept;
  void follow() noexcept;

  PlantOptions options_;
  HandPath path_;
  Pose pose_;
  Vec3 velocity_, spin_;
  Wrench motor_;
  PlantEnergy energy_;
  bool saturated_ = false;
  DeviceCommand delay_[kDelaySlots];
  std::uint64_t ticks_ = 0;
  std::uint64_t random_;
  // Of a hand that is pulled: where it is told to go, and where it is at `hand_s_`.
  bool pulled_ = false;
  Pose wish_;
  HandTarget hand_;
  double hand_s_ = 0;
  bool frozen_ = false;
  Vec3 encoder_shift_m_, last_measured_m_;
  // Of the local model: the command in force, how old it is, where the handle is within an encoder step.
  DeviceCommand due_;
  double age_s_ = 0, local_due_s_ = 0;
  Vec3 observed_m_, evaluated_m_, last_exact_m_;
  LocalHandle handle_;
  Vec3 unmoved_N_;
};

// The plant as a Device in virtual time: each receive() first lets it run up to the clock, holding the last command, so
// a loop that misses slots meets a device that went on without it.
class SimulatedDevice {
 public:
  SimulatedDevice(const PlantOptions& options, HandPath path, const VirtualClock& clock);
  void receive(DeviceSample& sample) noexcept;
  bool transmit(const DeviceCommand& command) noexcept;
  DevicePlant& plant() noexcept { return plant_; }

 private:
  DevicePlant plant_;
  const VirtualClock& clock_;
  std::int64_t start_ns_, period_ns_;
  DeviceCommand command_;
  bool first_ = true;
  DeviceSample sample_;
};

static_assert(Device<SimulatedDevice>);

}  // namespace palpate
