// Mass, damping, friction and delay of a handle that nobody holds, from forces commanded along one axis and positions
// told: the parameters with which a simulated handle moves as the real one did (output error: Ljung 1999, section 7.2).
#pragma once

#include <vector>

namespace palpate {

// Sample n was told, then force n was commanded.
struct DeviceRecord {
  double period_s = 1e-3;
  std::vector<double> force_N, position_m;
};

struct DeviceFit {
  double mass_kg = 0, damping_Ns_per_m = 0, friction_N = 0;
  double delay_s = 0;     // from sample to force, beyond the tick
  double offset_m = 0;    // of the first sample from where the handle was, within the encoder's step
  double residual_m = 0;  // RMS of what the model leaves
  double travel_m = 0;    // of the record
};

// Positions of the model under the record's forces, from rest. Exact for forces that change within a step.
std::vector<double> handle_motion(const DeviceRecord& record, const DeviceFit& handle);
// Never throws; a record that fits no handle has a large residual. Delays of 0 to 6 ms.
DeviceFit fit_device(const DeviceRecord& record);

// The encoder's step: of the levels told, the smallest gap, when the others are whole multiples of it; 0 when they are
// not, as of an encoder finer than what can be seen.
double encoder_step_m(const std::vector<double>& position_m);

}  // namespace palpate
