// A scripted grasp played without a device, and what it does to the body: the figures of Cui & Xiao 2008.
#pragma once

#include "sim_host/tick_memory.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

struct GraspOptions {
  double hand_N_per_m = 0;  // 0: the wrist is held at the path; otherwise PressDrive's hand
  // Seconds by which each finger starts to close later than the scene says, thumb first.
  double delay_s[kMaxFingers] = {};
  int every = 10;  // ticks between samples of the history
};

struct GraspRun {
  std::string name;
  std::vector<double> time_s;
  // Summed over the regions (AnchorLoad::stress_Pa). History: per anchor, per sample.
  std::vector<std::vector<double>> stress_Pa;
  // At the end of the hold: the last tick with every finger told to be as closed as it ever is.
  StatePtr held;
  std::vector<double> held_stress_Pa;  // per anchor
  Wrench contact_w, palm_w;
  std::vector<double> part_force_N;         // sum of the normal forces on each finger part; [0] unused
  double finger_force_N[kMaxFingers] = {};  // and of each finger's parts
  std::int32_t regions = 0;
  double chatter = 0;         // largest relative change of the summed normal force per tick over the last 0.2 s of hold
  bool back_at_rest = false;  // no force, no region (so no displacement), no energy at the end
  double residual_max_m = 0;
  std::uint64_t ticks = 0, unconverged_ticks = 0;
};

// `model` may differ from the scene's own in its parameters. Throws std::runtime_error when the scene has no path or no
// hand.
GraspRun run_grasp(const Model& model, const SceneDesc& scene, const GraspOptions& options);

// Largest relative difference of the parts' forces between two runs, against the largest force.
double force_difference(const GraspRun& a, const GraspRun& b);

}  // namespace palpate
