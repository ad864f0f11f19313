// The local contact model: what a device does between two commands by itself.
//
// A command carries the force, how it answers a motion of the handle (a symmetric stiffness), and where the handle was
// taken to be when both were computed. The device evaluates F - K (x - x_k) at 5 to 10 kHz from its own encoder, so
// that the spring the hand feels is closed there and not over the bus: sampling and delay of the controller then reach
// only what the contact adds to its own tangent. The device trusts none of it: its bounds are below.
#pragma once

#include <cstdint>

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
// kLocalValid_s; a stiffness whose norm (the root of the squares of all nine entries) is above `most_N_per_m` is scaled
// down to it.
inline constexpr double kLocalValid_s = 5e-3;
LocalModel bounded_model(const LocalModel& model, double most_N_per_m) noexcept;

// Force at the handle's position. It does not turn round: what has gone beyond the surface is not pulled back.
Vec3 local_force_N(Vec3 force_N, const LocalModel& model, Vec3 position_m) noexcept;

}  // namespace palpate
