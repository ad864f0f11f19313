// A scene on a grid of devices and hands: for each damping and delay the worst of what a hand may notice, over
// encoders, hands and manoeuvres. The coupling is what the baker would choose for the device, which is stated truly.
#pragma once

#include <string>

#include "sim_host/feel/feel.h"

namespace palpate {

struct GridCell {
  double damping_N_s_per_m = 0, delay_s = 0;
  std::vector<double> encoder_m;                                   // to be played with each of these
  std::vector<std::string> hands;                                  // and with each of these: of hand_models()
  double coupling_least_N_per_m = 1e9, coupling_most_N_per_m = 0;  // over the encoders
  double felt_N_per_m = 0;                                         // stiffest felt in a press, over encoders and hands
  double port_J = 0, hand_J = 0;
  std::string worst;  // where the hand got most
  int swings = 0, faults = 0, runs = 0;
};

// Up to here what a hand is given counts as none: it lifts a handle of 0.1 kg by 10 um.
inline constexpr double kGridHandMost_J = 1e-5;

// `model` as the baker makes it for this device, of which the scene's [device] says the rest (config/bake/compile.cpp).
Model baked_for(const Model& model, const SceneDesc& scene, double damping, double delay_s, double encoder_m);

// Damping 0.05, 0.5 and 2.5 N s/m; delay 0, 0.5, 1 and 3 ms; encoders of 0, 30 and 100 um; light, medium, firm and
// strong hands. `coarse`: its corners (the ends of all four) and its centre (0.5 N s/m, 0.5 ms, 30 um, medium).
std::vector<GridCell> grid_cells(bool coarse);
// Plays tap, press, loop, slide and hold with every encoder and hand of the cell. Calls from several threads are fine.
void run_cell(const Model& model, const SceneDesc& scene, const TouchPlace& place, GridCell& cell);

// A table in a file, a row for each scene and cell. It is written anew after each row, so that a run that was stopped
// goes on where it was: rows that are there are kept.
class GridFile {
 public:
  // `keep`: takes over the rows that the file holds; the caller vouches that they are of the same program and scenes.
  GridFile(std::string path, bool keep);
  bool has(const std::string& scene, const GridCell& cell) const;
  void add(const std::string& scene, const GridCell& cell);  // throws std::runtime_error when it cannot be written
  std::string text() const;

 private:
  std::string path_;
  std::vector<std::string> row_;
};

}  // namespace palpate
