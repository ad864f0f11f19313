#include "sim_host/feel/device_grid.h"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/device_profile.h"

namespace palpate {

namespace {

// As the baker's: what is left to a device that is not quite what it was said to be.
constexpr double kCouplingShare = 0.8;

// `model` as baked for this device (config/bake/compile.cpp: add_device).
Model baked_for(const Model& model, const SceneDesc& scene, double damping, double delay_s, double encoder_m) {
  Model baked = model;
  ModelParams& p = baked.params;
  p.delay_s = delay_s;
  p.encoder_step_m = p.encoder_step_m > 0 ? encoder_m : 0;  // where it is smoothed
  const StiffnessBound bound =
      admissible_stiffness(damping, scene.device.friction_N, encoder_m, p.period_s, delay_s, scene.device.local_Hz);
  p.coupling_N_per_m = std::clamp(kCouplingShare * bound.value, 1.0, 1e4);
  const double late_s = p.local_period_s > 0 ? 0.5 * p.local_period_s : 0.5 * p.period_s + delay_s;
  p.coupling_Ns_per_m = p.coupling_N_per_m * late_s;
  return baked;
}

void add_runs(const Model& model, const SceneDesc& scene, const TouchPlace& place, double encoder_m, GridCell& cell) {
  for (const HandModel& hand : hand_models()) {
    FeelOptions options;
    options.hand = hand.title;
    options.device = {fmt::format("damping_N_s_per_m={}", cell.damping_N_s_per_m),
                      fmt::format("delay_s={}", cell.delay_s), fmt::format("encoder_m={}", encoder_m)};
    for (const Manoeuvre manoeuvre : {Manoeuvre::kTap, Manoeuvre::kPress, Manoeuvre::kLoop, Manoeuvre::kSlide}) {
      const FeelRun run = run_feel(model, scene, place, manoeuvre, options, nullptr);
      const FeelFigures& f = run.figures;
      cell.runs += 1;
      cell.swings += f.alternations > 0 ? 1 : 0;
      cell.faults += f.fault != 0 ? 1 : 0;
      cell.port_J = std::max(cell.port_J, f.port_J);
      if (manoeuvre == Manoeuvre::kPress) cell.felt_N_per_m = std::max(cell.felt_N_per_m, f.felt_N_per_m);
      if (!(f.hand_J > cell.hand_J)) continue;
      cell.hand_J = f.hand_J;
      cell.worst = fmt::format("{}, {} hand, {:g} um", run.manoeuvre, hand.title, 1e6 * encoder_m);
    }
  }
}

}  // namespace

std::vector<GridCell> device_grid(const Model& model, const SceneDesc& scene, const TouchPlace& place) {
  std::vector<GridCell> cells;
  for (const double damping : {0.05, 0.5, 2.5}) {
    for (const double delay_s : {0.0, 5e-4, 1e-3, 3e-3}) {
      GridCell cell;
      cell.damping_N_s_per_m = damping;
      cell.delay_s = delay_s;
      cell.coupling_least_N_per_m = 1e9;
      for (const double encoder_m : {0.0, 3e-5, 1e-4}) {
        const Model baked = baked_for(model, scene, damping, delay_s, encoder_m);
        cell.coupling_least_N_per_m = std::min(cell.coupling_least_N_per_m, baked.params.coupling_N_per_m);
        cell.coupling_most_N_per_m = std::max(cell.coupling_most_N_per_m, baked.params.coupling_N_per_m);
        add_runs(baked, scene, place, encoder_m, cell);
      }
      cells.push_back(cell);
    }
  }
  return cells;
}

std::string grid_markdown(const std::string& scene, const std::vector<GridCell>& cells) {
  std::string text;
  for (const GridCell& c : cells)
    text += fmt::format("| {} | {:g} | {:g} | {:.0f} to {:.0f} | {:.2f} | {:.2f} | {:.2f} {} | {} | {} | {} |\n", scene,
                        c.damping_N_s_per_m, 1e3 * c.delay_s, c.coupling_least_N_per_m, c.coupling_most_N_per_m,
                        1e-3 * c.felt_N_per_m, 1e3 * c.port_J, 1e3 * c.hand_J,
                        c.worst.empty() ? "" : "(" + c.worst + ")", c.swings, c.faults, c.runs);
  return text;
}

}  // namespace palpate
