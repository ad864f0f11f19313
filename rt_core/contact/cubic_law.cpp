#include "rt_core/contact/cubic_law.h"

#include "rt_core/contact/cubic_law_lanes.h"
#include "rt_core/limits.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

// Root of k1 D + k3 D^3 = F for F > 0. With D = D0 y, D0 = min(F/k1, cbrt(F/k3)) >= D, the equation is
// a y + b y^3 = 1 with a, b <= 1 and max(a, b) = 1: free of scale, so nothing overflows for any k1, k3. The left side
// is convex and y = 1 lies above the root, so Newton's steps fall monotonically and quadratically onto it. Rejected:
// Cardano's formula in its cancellation-free form D = q / (u^2 + p/3 + v^2). It is as accurate, but p^3 overflows for
// small k3; the 60 instructions it saves (120 against 180, callgrind, 2026-11-21) are spent once or twice per region.
Real cubic_depth(const CubicLaw& law, Real force_N) PALPATE_RT {
  const Real k1 = law.k1_N_per_m, k3 = law.k3_N_per_m3;
  const Real linear = k1 > 0 ? force_N / k1 : 0.0;
  if (!(k3 > 0)) return linear;
  const Real cubic = math::cbrt(force_N / k3);
  const Real bound = k1 > 0 ? min_of(linear, cubic) : cubic;
  const Real a = k1 * bound / force_N;
  const Real b = k3 * bound * bound * bound / force_N;
  Real y = 1.0;
  for (std::int32_t i = 0; i < kInverseLawIterations; ++i) {  // bound: kInverseLawIterations
    const Real square = y * y;
    y = (1.0 + 2.0 * b * square * y) / (a + 3.0 * b * square);
  }
  return bound * y;
}

}  // namespace

Real law_depth_m(const CubicLaw& law, Real force_N) PALPATE_RT {
  if (!(force_N > 0)) return 0.0;
  const Real force = min_of(force_N, kHuge);
  if (!(law.max_depth_m < kHuge)) return cubic_depth(law, force);
  const LawPoint edge = law_at(law, law.max_depth_m);
  if (force <= edge.force_N) return cubic_depth(law, force);
  return edge.tangent_N_per_m > 0 ? law.max_depth_m + (force - edge.force_N) / edge.tangent_N_per_m : 0.0;
}

Double4 law_depth_m(const CubicLaw& law, const Double4& force_N) PALPATE_RT {
  const Real k1 = law.k1_N_per_m, k3 = law.k3_N_per_m3;
  const Mask4 presses = force_N > Double4{};
  const Double4 force = where(presses, force_N, splat4(1.0)), cube = force / splat4(k3);
  const Mask4 usual = (cube > splat4(1e-300)) & (cube < splat4(1e300)) & (force < splat4(kHuge));
  if (!(k1 > 0 && k3 > 0 && law.max_depth_m < kHuge) || bits_of(usual) != 15)
    return Double4{law_depth_m(law, force_N[0]), law_depth_m(law, force_N[1]), law_depth_m(law, force_N[2]),
                   law_depth_m(law, force_N[3])};
  const Double4 linear = force / splat4(k1), cubic = math::cube_roots(cube), bound = linear < cubic ? linear : cubic;
  const Double4 a = splat4(k1) * bound / force, b = splat4(k3) * bound * bound * bound / force;
  Double4 y = splat4(1.0);
  for (std::int32_t i = 0; i < kInverseLawIterations; ++i) {  // bound: kInverseLawIterations
    const Double4 square = y * y;
    y = (splat4(1.0) + splat4(2.0) * b * square * y) / (a + splat4(3.0) * b * square);
  }
  const LawPoint edge = law_at(law, law.max_depth_m);
  const Double4 beyond = splat4(law.max_depth_m) + (force - splat4(edge.force_N)) / splat4(edge.tangent_N_per_m);
  return where(presses, where(force <= splat4(edge.force_N), bound * y, beyond), Double4{});
}

}  // namespace palpate
