// A scene on a grid of devices and hands: for each damping and delay the worst of what a hand may notice, over
// encoders, hands and manoeuvres. The coupling is what the baker would choose for the device, which is stated truly.
#pragma once

#include <string>

#include "sim_host/feel/feel.h"

namespace palpate {

struct GridCell {
  double damping_N_s_per_m = 0, delay_s = 0;
  double coupling_least_N_per_m = 0, coupling_most_N_per_m = 0;  // over the encoders
  double felt_N_per_m = 0;                                       // stiffest felt in a press, over encoders and hands
  double port_J = 0, hand_J = 0;
  std::string worst;  // where the hand got most
  int swings = 0, faults = 0, runs = 0;
};

// Damping 0.05, 0.5 and 2.5 N s/m; delay 0, 0.5, 1 and 3 ms; encoders of 0, 30 and 100 um; light, medium, firm and
// strong hands; tap, press, loop and slide.
std::vector<GridCell> device_grid(const Model& model, const SceneDesc& scene, const TouchPlace& place);
std::string grid_markdown(const std::string& scene, const std::vector<GridCell>& cells);

}  // namespace palpate
