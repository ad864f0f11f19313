// The Z-width of a device: the stiffest spring that settles, against damping and delay, measured in the bench's loop
// with the rules of the literature drawn in.
#pragma once

#include "sim_host/feel/feel_loop.h"
#include "sim_host/view/drawing.h"

namespace palpate {

// A device with nothing but a mass and damping, which a spring without friction or quantisation is tried on.
struct BareDevice {
  double mass_kg = 1;
  double damping_N_s_per_m = 1;
  double delay_s = 0;
  double period_s = 1e-3;
  double friction_N = 0;
  double encoder_m = 0;
  double start_m = 0.01;  // where it is let go
  double local_Hz = 0;    // it evaluates the local contact model so often; 0: it holds forces
};

// Whether a two-sided spring (force -K x of the sampled position) comes to rest after the mass is pulled aside: the
// motion of the last quarter of `seconds` is smaller than that of the second, and than twice the first pull.
bool settles(const BareDevice& device, double stiffness_N_per_m, double seconds = 4);
// Whether it stands still in the end, to less than a tenth of the encoder's step.
bool rests(const BareDevice& device, double stiffness_N_per_m, double seconds = 4);
// The largest stiffness that settles, to 0.2 %.
double measured_limit_N_per_m(const BareDevice& device);
// 2b / (T + 2 tau): Colgate & Schenkel 1997 for tau = 0, Diolaiti et al. 2006 with delay. For a mass so heavy that
// the oscillation at the limit is slow against the tick it is exactly where the motion neither grows nor decays. With a
// local model T is that of the device's own loop, and tau 0.
double rule_limit_N_per_m(const BareDevice& device);

// Limits against damping for several delays, measured and by rule.
Drawing z_width_plot();

}  // namespace palpate
