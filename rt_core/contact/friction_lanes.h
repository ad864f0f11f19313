// Friction of four regions at a time: those that stick.
#pragma once

#include "rt_core/contact/friction.h"
#include "rt_core/lanes.h"

namespace palpate {

struct FrictionLoad4 {
  Vec3x4 step_w, normal_w;
  Double4 force_N;
};
struct Sticking4 {
  std::uint32_t which = 0;  // of the four, as bits; of the others nothing is told
  std::uint32_t slip = 0;   // of those, that are in FrictionMode::kSlip
  Vec3x4 stretch_w{}, force_w{}, direction_w{};
  Double4 energy_J{}, along_N_per_m{}, across_N_per_m{};
};

// Whether friction is such that stick_four() knows of any.
bool sticks_by_fours(const FrictionParameters& parameters) PALPATE_RT;
// friction_step() of those that touched before and stick, to the bit. `slipping`: FrictionMode::kSlip in the last tick,
// as bits; `touched`: in contact then.
Sticking4 stick_four(const FrictionParameters& parameters, const FrictionLoad4& load, const Vec3x4& stretch_w,
                     std::uint32_t touched, std::uint32_t slipping) PALPATE_RT;

}  // namespace palpate
