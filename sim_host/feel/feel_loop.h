// A controller against the simulated device and hand in virtual time: once a period a sample goes in and a command
// comes out, while the plant moves on in sub-steps of a tenth of a millisecond. Faster than real time, no clock, no
// thread: the same options give the same bits. What the loop of the controller adds (frames, arming, its own faults) is
// left out; tests/hal has it.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hal/device/device_sim.h"
#include "rt_core/io.h"

namespace palpate {

inline constexpr double kFeelSubstep_s = 1e-4;

// Something that happens to samples from `time_s` on.
struct SampleEvent {
  double time_s = 0;
  std::uint32_t lose = 0;  // samples lost
  Vec3 shift_m;            // counts lost or won by the encoder
};

struct FeelSetup {
  PlantOptions plant;          // period_s, substeps and delay_ticks are set by the loop
  double period_s = 1e-3;      // of the controller
  double delay_s = 0;          // from sample to motor; rounded to sub-steps
  double encoder_rad = 0;      // angular quantum about each axis, from the first orientation
  double sample_period_s = 0;  // of the device; 0: the controller's
  bool echoes = true;          // samples tell which command acted when they were made
  int lost_of_16 = 0;          // commands: of every 16 the first so many do not arrive
  HandPath path;
  std::vector<SampleEvent> event;                     // by time
  std::function<JointCommand(double time_s)> joints;  // empty: none
};

// What a tick saw and did, and where the plant stood when its sample was made.
struct FeelTick {
  double time_s = 0;
  Pose handle_w;  // exact
  Input input;
  Output output;
  PlantEnergy energy;  // until now
  double kinetic_J = 0;
  // Of a device that evaluates the local model: its motors now, and all that they changed until now beyond what the
  // handle's exact motion made of the models.
  Vec3 rendered_N, unmoved_N;
  // The controller's to tell: work of driven fingers on the object; how far its coupling is stretched.
  double fingers_J = 0, stretch_m = 0, stretch_rad = 0;
};

using FeelController = std::function<void(const Input&, Output&)>;
using FeelListener = std::function<void(const FeelTick&)>;

// Plays the path to its end.
void run_feel_loop(const FeelSetup& setup, const FeelController& controller, const FeelListener& listen);

}  // namespace palpate
