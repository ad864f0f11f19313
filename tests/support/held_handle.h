// A handle held against a spring that is closed on what an encoder tells of it, for tests of what smooths the encoder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

namespace palpate::test {

// What an encoder tells of x; `edge`: where x = 0 lies between two steps, in steps.
inline double told_m(double x, double step_m, double edge = 0) {
  return step_m * (std::floor(x / step_m + edge + 0.5) - edge);
}

struct HeldHandle {
  double mass_kg, damping_Ns_per_m, delay_s, period_s;  // of the device; the spring's force is late by the delay
  double hand_N_per_m, hand_Ns_per_m, hand_kg;
  double stiffness_N_per_m;  // of the spring
  double step_m;             // of the encoder
  double duration_s;
};

// RMS of the spring's force in the last third of the time, after the handle was let go `aside_m` from where it rests.
// `estimate(told_m)`: where the handle is taken to be, once a period.
template <class Estimate>
double unrest_N(const HeldHandle& h, double friction_N, double aside_m, double edge, Estimate estimate) {
  constexpr double kSubstep_s = 2e-5;
  const double mass = h.mass_kg + h.hand_kg;
  const int substeps = static_cast<int>(std::lround(h.period_s / kSubstep_s));
  std::deque<double> on_the_way(static_cast<std::size_t>(std::lround(h.delay_s / kSubstep_s)) + 1, 0.0);
  double x = aside_m, v = 0, sum = 0, squares = 0;
  const int ticks = static_cast<int>(std::lround(h.duration_s / h.period_s)), counted = ticks / 3;
  for (int i = 0; i < ticks; ++i) {
    const double force = -h.stiffness_N_per_m * estimate(told_m(x, h.step_m, edge));
    if (i >= ticks - counted) sum += force, squares += force * force;
    for (int k = 0; k < substeps; ++k) {
      on_the_way.push_back(force);
      const double moved = on_the_way.front() - h.hand_N_per_m * x - (h.hand_Ns_per_m + h.damping_Ns_per_m) * v;
      on_the_way.pop_front();
      if (v == 0 && std::abs(moved) <= friction_N) continue;
      const double next = v + kSubstep_s / mass * (moved - std::copysign(friction_N, v != 0 ? v : moved));
      v = friction_N > 0 && next * v < 0 ? 0 : next;
      x += kSubstep_s * v;
    }
  }
  return std::sqrt(std::max(0.0, squares / counted - sum * sum / counted / counted));
}

}  // namespace palpate::test
