// The cubic law (cubic_law.h) at four depths at a time, to the bit.
#pragma once

#include "rt_core/contact/cubic_law.h"
#include "rt_core/lanes.h"

namespace palpate {

struct LawPoint4 {
  Double4 force_N, tangent_N_per_m;
};

inline LawPoint4 law_at(const CubicLaw& law, const Double4& depth_m) PALPATE_RT {
  const Double4 k1 = splat4(law.k1_N_per_m), most = splat4(law.max_depth_m), huge = splat4(kHuge);
  const Double4 inside = depth_m < most ? depth_m : most;
  const Double4 cubic = splat4(law.k3_N_per_m3) * inside * inside;
  const Double4 tangent = k1 + splat4(3.0) * cubic;
  const Double4 force = (k1 + cubic) * inside;
  const Double4 beyond = force + tangent * ((depth_m < huge ? depth_m : huge) - inside);
  const Mask4 presses = depth_m > Double4{};
  return {presses ? (depth_m <= most ? force : beyond) : Double4{}, presses ? tangent : Double4{}};
}

inline Double4 law_energy_J(const CubicLaw& law, const Double4& depth_m) PALPATE_RT {
  const Double4 k1 = splat4(law.k1_N_per_m), k3 = splat4(law.k3_N_per_m3), most = splat4(law.max_depth_m);
  const Double4 inside = depth_m < most ? depth_m : most, square = inside * inside;
  const Double4 energy = (splat4(0.5) * k1 + splat4(0.25) * k3 * square) * square;
  if (bits_of(depth_m > most) == 0) return depth_m > Double4{} ? energy : Double4{};
  const Double4 beyond = (depth_m < splat4(kHuge) ? depth_m : splat4(kHuge)) - inside;
  const LawPoint4 edge = law_at(law, inside);
  const Double4 more = (edge.force_N + splat4(0.5) * edge.tangent_N_per_m * beyond) * beyond;
  return depth_m > Double4{} ? (depth_m <= most ? energy : energy + more) : Double4{};
}

// Four of law_depth_m(): 160 instructions each one by one.
Double4 law_depth_m(const CubicLaw& law, const Double4& force_N) PALPATE_RT;

}  // namespace palpate
