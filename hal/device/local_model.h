// The local contact model: what a device does between two commands by itself.
//
// A command carries the force, how it answers a motion of the handle (a symmetric stiffness), and where the handle was
// taken to be when both were computed. The device evaluates F - K (x - x_k) at 5 to 10 kHz from its own encoder, so
// that the spring the hand feels is closed there and not over the bus: sampling and delay of the controller then reach
// only what the contact adds to its own tangent. The device trusts none of it: its bounds are below.
//
// What it renders goes with the handle at once and with the commands slowly. The newest model says what the handle's
// motion since the last period makes, and that is added as it is: a spring, hence passive whatever its rest point. What
// is then left between the force rendered and the one evaluated was made by commands (a first one, a lost one, one
// garbled in memory, an enable that ends) or by an encoder that jumped, and is approached with a slope. A slope on all
// of it, as before 2026-11-25, came late on the way in and on the way out: a tap of 0.3 m/s on 4.3 N/mm gave the hand
// 4.4 mJ.
#pragma once

#include <cstdint>

#include "rt_core/safety/local_device.h"
#include "rt_core/vec.h"

namespace palpate {

// In the device frame. `valid_s` = 0: none, the force is held.
struct LocalModel {
  Vec3 point_m;
  Vec3 along_N_per_m;   // xx, yy, zz
  Vec3 across_N_per_m;  // yz, xz, xy
  double valid_s = 0;   // after the command took effect; from then on the force stays as it is
};

// A command's model is refused as a whole, {} then, when a number is none, when the stiffness is not positive
// semi-definite (to a millionth of its trace and what the wire rounds), or when it claims to be valid for longer than
// kLocalValid_s; a stiffness that is above `most_N_per_m` along a line (stiffness_size) is scaled down to it.
inline constexpr double kLocalValid_s = 5e-3;
LocalModel bounded_model(const LocalModel& model, double most_N_per_m) noexcept;

// Force at the handle's position. It does not turn round: what has gone beyond the surface is not pulled back.
Vec3 local_force_N(Vec3 force_N, const LocalModel& model, Vec3 position_m) noexcept;

// Of the device's own loop.
struct LocalLoop {
  double period_s = 1e-4;
  double force_max_N = 0;
  double slope_N_per_s = 0;  // of what is not the handle's motion, where the encoder is fine; 0: any
  double encoder_step_m = 0;
};

// The handle's way in one period.
struct LocalWay {
  Vec3 from_m, to_m;
};

// What the way changes of the force evaluated, within the force limit.
Vec3 moved_force_N(const LocalLoop& loop, Vec3 force_N, const LocalModel& model, const LocalWay& way) noexcept;

// What is rendered next after `rendered_N`: the model's part of the way, and towards what it says at the end of it.
// Never above the limit, nor turned farther round against F than `rendered_N` was.
Vec3 next_force_N(const LocalLoop& loop, Vec3 rendered_N, Vec3 force_N, const LocalModel& model,
                  const LocalWay& way) noexcept;

}  // namespace palpate
