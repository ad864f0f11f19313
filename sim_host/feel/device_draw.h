// Devices and hands drawn at random: what was tuned on the grid of device_grid.h is judged on others here.
#pragma once

#include <cstdint>
#include <string>

#include "sim_host/feel/feel.h"

namespace palpate {

// A device as it is and is stated, and the hand that holds it.
struct DrawnDevice {
  double damping_N_s_per_m = 0, delay_s = 0, encoder_m = 0, friction_N = 0;
  double hand_N_per_m = 0, hand_N_s_per_m = 0, hand_kg = 0;
  std::string text() const;
};
// Number `index` of `seed`: damping 0.05 to 2.5 N s/m, hand 100 to 2000 N/m and its mass 0.05 to 0.2 kg evenly in their
// logarithm; delay 0 to 3 ms in steps of the bench's 0.1 ms, encoder 0 to 100 um, friction 0.02 to 0.1 N and the hand's
// damping ratio 0.1 to 0.6 evenly. The same numbers on every machine.
DrawnDevice draw_device(std::uint64_t seed, std::uint64_t index);

struct DrawnRun {
  FeelRun run;
  DrawnDevice device;
  double coupling_N_per_m = 0;  // what the baker chooses for it
  std::string failure;          // drawn_failure()
};
// feel_failure(), and energy at the hand where none may arrive; "" when the run is good.
std::string drawn_failure(Manoeuvre manoeuvre, const FeelRun& run);

// Tap, press, loop, slide, hold, tremor, turn, overload, push and teleport with this device. Overload and push have a
// hand of 2000 N/m. Calls from several threads are fine.
std::vector<DrawnRun> run_drawn(const Model& model, const SceneDesc& scene, const TouchPlace& place,
                                const DrawnDevice& device);

std::string drawn_table(const std::vector<DrawnRun>& runs);     // for people: a line for each device
std::string drawn_markdown(const std::vector<DrawnRun>& runs);  // of docs/stability.md: a row for each scene
std::string drawn_json(const std::vector<DrawnRun>& runs);      // every run

}  // namespace palpate
