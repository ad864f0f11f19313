#include "sim_host/press/grasp_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "config/hand/hand_model.h"
#include "sim_host/press/press.h"
#include "sim_host/view/anchors.h"

namespace palpate {

namespace {

// The scene's poses, with every finger's command taken from its delay earlier.
std::vector<TimedPose> delayed_poses(const SceneDesc& scene, double period_s, const GraspOptions& options) {
  std::vector<TimedPose> poses = scripted_poses(scene.path, period_s);
  const std::vector<TimedPose> told = poses;
  for (std::size_t f = 0; f < kMaxFingers; ++f) {
    const auto late = static_cast<std::size_t>(std::llround(std::max(0.0, options.delay_s[f]) / period_s));
    for (std::size_t n = 0; n < poses.size(); ++n)
      poses[n].joints.closing[f] = told[n >= late ? n - late : 0].joints.closing[f];
  }
  return poses;
}

// Index of the last pose at which all fingers are told to be as closed as they ever are.
std::size_t end_of_hold(const std::vector<TimedPose>& poses) {
  float most = 0;
  std::size_t last = 0;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    float sum = 0;
    for (const float closing : poses[n].joints.closing) sum += closing;
    if (sum < most) continue;
    most = sum;
    last = n;
  }
  return last;
}

// Extreme-fibre stress at each anchor, summed over the regions' beams that end there.
std::vector<double> anchor_stresses_Pa(const Model& model, const State& state) {
  const AnchorField field = anchors_of(model, state);
  std::vector<double> stress;
  for (std::size_t a = 0; a < model.anchor.size(); ++a) stress.push_back(field.anchor[a].stress_Pa);
  return stress;
}

double normal_sum_N(const State& state) {
  double sum = 0;
  for (const Region& region : state.region) sum += region.id != 0 && region.lost_ticks == 0 ? region.normal_force_N : 0;
  return sum;
}

void keep_hold(const Model& model, const PressRow& row, const State& state, GraspRun& run) {
  run.held = copy_of(state);
  run.contact_w = row.record.output.contact_w;
  run.palm_w = row.record.output.palm_w;
  run.regions = row.record.output.regions;
  run.held_stress_Pa = anchor_stresses_Pa(model, state);
  run.part_force_N.assign(kHandParts + 1, 0);
  for (std::size_t p = 0; p < model.piece.size(); ++p) {
    const std::int32_t part = model.piece[p].part;
    if (part < 1 || part > kHandParts) continue;
    const double force_N = norm(state.articulation.piece_force_tool_N.data()[p]);
    run.part_force_N[static_cast<std::size_t>(part)] += force_N;
    run.finger_force_N[model.piece[p].group] += force_N;
  }
}

bool is_at_rest(const Output& output) {
  return output.contact_w == Wrench{} && output.energy_J == 0 && output.regions == 0;
}

}  // namespace

GraspRun run_grasp(const Model& model, const SceneDesc& scene, const GraspOptions& options) {
  if (scene.path.point.empty()) throw std::runtime_error(scene.name + ": no [[path.point]]: nothing to play");
  if (scene.articulation != Articulation::kHand)
    throw std::runtime_error(scene.name + ": no [hand]; this command plays hand scenes, `palpate press` plays any");
  const std::vector<TimedPose> poses = delayed_poses(scene, model.params.period_s, options);
  const std::size_t hold_end = end_of_hold(poses);
  const auto watched = static_cast<std::size_t>(0.2 / model.params.period_s);
  GraspRun run;
  run.name = scene.name;
  run.stress_Pa.resize(model.anchor.size());
  const StatePtr state = make_state(model);
  std::size_t n = 0;
  double before_N = -1;
  press(model, poses, {options.hand_N_per_m}, *state, nullptr,
        [&](const PressRow& row, const State& now, const Scratch&) {
          const double sum_N = normal_sum_N(now);
          run.residual_max_m = std::max(run.residual_max_m, row.record.output.residual_m);
          run.ticks += 1;
          run.unconverged_ticks += (row.record.output.status & Status::kNotConverged) != 0 ? 1 : 0;
          if (n + watched > hold_end && n <= hold_end && sum_N > 0)
            run.chatter = std::max(run.chatter, std::abs(sum_N - before_N) / sum_N);
          before_N = sum_N;
          if (n % static_cast<std::size_t>(std::max(1, options.every)) == 0) {
            run.time_s.push_back(row.time_s);
            const std::vector<double> stress = anchor_stresses_Pa(model, now);
            for (std::size_t a = 0; a < stress.size(); ++a) run.stress_Pa[a].push_back(stress[a]);
          }
          if (n == hold_end) keep_hold(model, row, now, run);
          if (n + 1 == poses.size()) run.back_at_rest = is_at_rest(row.record.output);
          n += 1;
        });
  return run;
}

double force_difference(const GraspRun& a, const GraspRun& b) {
  double most = 0, difference = 0;
  for (std::size_t part = 0; part < std::min(a.part_force_N.size(), b.part_force_N.size()); ++part) {
    most = std::max(most, std::max(a.part_force_N[part], b.part_force_N[part]));
    difference = std::max(difference, std::abs(a.part_force_N[part] - b.part_force_N[part]));
  }
  return most > 0 ? difference / most : 0;
}

}  // namespace palpate
