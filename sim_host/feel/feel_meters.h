// What a hand would notice, measured from the ticks of a bench run: energy that comes back, forces that swing or step,
// a tool that lags, how stiff the object seems and how rough it is at rest.
#pragma once

#include <string>
#include <vector>

#include "rt_core/model.h"
#include "sim_host/feel/feel_loop.h"

namespace palpate {

struct FeelFigures {
  double duration_s = 0;
  double force_max_N = 0;  // commanded
  double model_max_N = 0;  // of the object on the virtual tool
  double depth_max_m = 0;  // penetration told by the tick
  // Largest change of the force, and of the torque, that a command made at once, beyond what the device made of the
  // last one by the local model, of the device's largest.
  double step_share = 0, torque_step_share = 0;
  double step_at_s = 0;
  int alternations = 0;         // ticks in which the force swung to and fro; see SwingMeter
  int torque_alternations = 0;  // and the torque
  int alternation_run = 0;      // most of them in a row
  double lag_m = 0;             // largest distance from handle to tool
  // Largest stretch of the coupling that acted, force and torque, of what F_max and the largest torque stretch it.
  double leash_share = 0;
  double force_limit_N = 0;  // the device's largest force: no object is pressed harder
  double felt_N_per_m = 0;   // rise of the force over the way of the handle, between half and all of the largest force
  double noise_N = 0;        // RMS of the commands at 50 to 500 Hz in the last second
  bool local = false;        // the device makes the force between commands by itself
  double coupling_N_per_m = 0;  // of the scene
  // The object's own stiffness where it pressed in the last second: RMS of its force over that of the tool along the
  // mean force, about their means; 0: still.
  double object_N_per_m = 0;
  int contacts = 0;      // times the force rose from zero
  double port_J = 0;     // most that one contact returned at the motors, more than handle and fingers gave it
  double fingers_J = 0;  // work of driven fingers on the object, at most
  double hand_J = 0;     // most of that which reached the hand, after the device's own losses
  // Most that the encoder's steps D can give in a contact: the handle is taken to be within D of where it is along
  // every axis, so K D of its way along them, of which friction takes its own (docs/stability.md).
  double quantum_J = 0;
  std::uint32_t status = 0;  // bits seen, together
  std::uint32_t fault = 0;
  int worst_mode = 0;  // of Mode
};

// Swings: ticks in which a component of the force changes by more than `least` against its change of the tick before,
// which was as large. One such turn alone is a peak, not a swing; with a second right behind it both count.
class SwingMeter {
 public:
  explicit SwingMeter(double least) : least_(least) {}
  void add(double value);
  int turns() const { return turns_; }
  int longest() const { return longest_; }

 private:
  double least_, last_ = 0, step_ = 0;
  int turns_ = 0, run_ = 0, longest_ = 0;
};

// RMS of `sample` between two frequencies: Hann window, direct transform, mean removed.
double band_rms(const std::vector<double>& sample, double period_s, double lowest_Hz, double highest_Hz);

class FeelMeters {
 public:
  FeelMeters(const ModelParams& params, const FeelSetup& setup);
  void add(const FeelTick& tick);
  FeelFigures figures() const;

 private:
  void add_steps(const FeelTick& tick);
  void add_torque(const FeelTick& tick);
  void add_energy(const FeelTick& tick);
  double felt_stiffness() const;
  std::size_t last_second() const;  // its first tick
  double noise() const;
  double object_stiffness() const;

  const ModelParams& params_;
  const double encoder_m_, friction_N_;
  FeelFigures figures_;
  SwingMeter swing_[3], torque_swing_[3];
  std::vector<Vec3> force_, handle_, contact_N_, tool_m_;
  FeelTick last_;
  bool touching_ = false;
  double port_begin_J_ = 0, hand_begin_J_ = 0, quantum_J_ = 0;
};

}  // namespace palpate
