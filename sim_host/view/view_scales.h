// The scales of a view: colours of displacement, lengths of force arrows, the bar that says how long a millimetre is.
#pragma once

#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// A round length of 1, 2 or 5 times a power of ten, the largest that is not above `most`; 0 unless that is positive.
double round_below(double most);

// Colours run from 0 to `top_m`, which has a tick; contour lines stand at the ticks.
struct DisplacementScale {
  double top_m = 1e-3;
  std::vector<double> tick_mm;
};
// For a largest displacement; `fixed`: that is the top as it is, otherwise it is rounded up to the next tick.
DisplacementScale displacement_scale(double largest_m, bool fixed);

// Arrows of one scale: a newton has the same length wherever it is drawn, and for the whole run.
struct ForceScale {
  double m_per_N = 0;
  double reference_N = 0;  // round: of the arrow in the legend
};
// `largest_N`: the run's largest force of one region; its arrow is as long as 0.45 of the body's extent.
ForceScale force_scale(double largest_N, double body_size_m);

// A force to draw: from where it acts, on the tool.
struct DrawnForce {
  Vec3 tail_w, force_N;
  Vec3 friction_N;  // its tangential part
};
// What the body does to the tool in all, of every region in contact, and what a picture's first line says of it: where
// there are several, that the number is their sum, which no arrow has.
struct ForceSum {
  Vec3 sum_N;
  double largest_N = 0, depth_m = 0;
  int regions = 0;
};
ForceSum force_sum(const State& state);
std::string force_words(const ForceSum& sum);
// What a body's colours are, for the legend: displacement that the model computes everywhere, or a law of shape drawn
// around the contact that it computes.
const char* colour_meaning(const Model& model);
// Of each region in contact, the largest first; none below a hundredth of it.
std::vector<DrawnForce> drawn_forces(const State& state);

}  // namespace palpate
