// What the skeleton's anchors carry while a tool presses: a table and a plot of force against depth.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "sim_host/view/drawing.h"

namespace palpate {

// One tick: per anchor the force of its beams on their tips, and the stress there (AnchorLoad), summed over regions.
struct AnchorSample {
  double time_s = 0, depth_m = 0;
  std::vector<double> force_N;
  std::vector<double> stress_Pa;
  std::int32_t degenerate = 0;  // regions whose skeleton had no usable stiffness
};
AnchorSample sample_anchors(const Model& model, const State& state, double time_s, double depth_m);

// One row per sample: time_s, depth_mm, then aN_F_N and aN_stress_Pa for every anchor N from 1. Throws
// std::runtime_error when it cannot be written.
void write_anchor_csv(const std::string& path, std::span<const AnchorSample> samples);

// Force at the anchors of these numbers (from 1; empty: the eight that carry most) against depth, from first touch to
// the deepest sample.
Drawing anchor_force_plot(const Model& model, std::span<const AnchorSample> samples, std::vector<int> anchors,
                          const std::string& title);

}  // namespace palpate
