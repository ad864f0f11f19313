#include "rt_core/contact/cubic_law.h"

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

}  // namespace palpate
