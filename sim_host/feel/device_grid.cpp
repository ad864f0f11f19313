#include "sim_host/feel/device_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "config/bake/time_params.h"
#include "rt_core/device_profile.h"

namespace palpate {

namespace {

constexpr const char* kHead =
    "| scene | b N s/m | tau ms | coupling N/m | felt N/mm | port mJ | hand mJ | runs that swing | with a fault | runs "
    "| verdict |\n|---|---|---|---|---|---|---|---|---|---|---|\n";

void add_run(const FeelRun& run, const std::string& where, GridCell& cell) {
  const FeelFigures& f = run.figures;
  cell.runs += 1;
  cell.swings += f.alternations > 0 ? 1 : 0;
  cell.faults += f.fault != 0 ? 1 : 0;
  cell.port_J = std::max(cell.port_J, f.port_J);
  if (!(f.hand_J > cell.hand_J)) return;
  cell.hand_J = f.hand_J;
  cell.worst = where;
}

// The columns that say which row it is.
std::string key_of(const std::string& scene, const GridCell& cell) {
  return fmt::format("| {} | {:g} | {:g} |", scene, cell.damping_N_s_per_m, 1e3 * cell.delay_s);
}

std::string row_of(const std::string& scene, const GridCell& c) {
  const bool good = c.hand_J <= kGridHandMost_J && c.swings == 0 && c.faults == 0;
  return key_of(scene, c) + fmt::format(" {:.0f} to {:.0f} | {:.2f} | {:.2f} | {:.2f}{} | {} | {} | {} | {} |\n",
                                        c.coupling_least_N_per_m, c.coupling_most_N_per_m, 1e-3 * c.felt_N_per_m,
                                        1e3 * c.port_J, 1e3 * c.hand_J, c.worst.empty() ? "" : " (" + c.worst + ")",
                                        c.swings, c.faults, c.runs, good ? "good" : "not good");
}

}  // namespace

Model baked_for(const Model& model, const SceneDesc& scene, double damping, double delay_s, double encoder_m) {
  Model baked = model;
  ModelParams& p = baked.params;
  p.delay_s = delay_s;
  const StiffnessBound bound =
      admissible_stiffness(damping, scene.device.friction_N, encoder_m, p.period_s, delay_s, scene.device.local_Hz);
  p.coupling_N_per_m = std::clamp(std::min(coupling_share(scene.device.local_Hz) * bound.value,
                                           impact_coupling_N_per_m(scene.device.local_Hz, delay_s, p.force_max_N)),
                                  1.0, 1e4);
  // Torques are held, whatever the device does by itself.
  const StiffnessBound turning = admissible_stiffness(scene.device.damping_Nms_per_rad, scene.device.friction_Nm,
                                                      scene.device.encoder_step_rad, p.period_s, delay_s);
  p.coupling_Nm_per_rad = std::clamp(coupling_share(0) * turning.value, 1e-6, 1e4);
  SceneDesc stated = scene;
  stated.device.delay_s = delay_s;
  stated.device.encoder_step_m = encoder_m;
  stated.device.coupling_Ns_per_m = kAuto;
  set_times(stated, p);
  return baked;
}

std::vector<GridCell> grid_cells(bool coarse) {
  const std::vector<std::string> ends{hand_models().front().title, hand_models().back().title};
  std::vector<std::string> all;
  for (const HandModel& hand : hand_models()) all.emplace_back(hand.title);
  std::vector<GridCell> cells;
  const auto add = [&](double damping, double delay_s, std::vector<double> encoder_m, std::vector<std::string> hands) {
    GridCell cell;
    cell.damping_N_s_per_m = damping;
    cell.delay_s = delay_s;
    cell.encoder_m = std::move(encoder_m);
    cell.hands = std::move(hands);
    cells.push_back(std::move(cell));
  };
  if (coarse) {
    for (const double damping : {0.05, 2.5})
      for (const double delay_s : {0.0, 3e-3}) add(damping, delay_s, {0, 1e-4}, ends);
    add(0.5, 5e-4, {3e-5}, {"medium"});
    return cells;
  }
  for (const double damping : {0.05, 0.5, 2.5})
    for (const double delay_s : {0.0, 5e-4, 1e-3, 3e-3}) add(damping, delay_s, {0, 3e-5, 1e-4}, all);
  return cells;
}

void run_cell(const Model& model, const SceneDesc& scene, const TouchPlace& place, GridCell& cell) {
  for (const double encoder_m : cell.encoder_m) {
    const Model baked = baked_for(model, scene, cell.damping_N_s_per_m, cell.delay_s, encoder_m);
    cell.coupling_least_N_per_m = std::min(cell.coupling_least_N_per_m, baked.params.coupling_N_per_m);
    cell.coupling_most_N_per_m = std::max(cell.coupling_most_N_per_m, baked.params.coupling_N_per_m);
    for (const std::string& hand : cell.hands) {
      FeelOptions options;
      options.hand = hand;
      options.device = {fmt::format("damping_N_s_per_m={}", cell.damping_N_s_per_m),
                        fmt::format("delay_s={}", cell.delay_s), fmt::format("encoder_m={}", encoder_m)};
      for (const Manoeuvre manoeuvre :
           {Manoeuvre::kTap, Manoeuvre::kPress, Manoeuvre::kLoop, Manoeuvre::kSlide, Manoeuvre::kHold}) {
        const FeelRun run = run_feel(baked, scene, place, manoeuvre, options, nullptr);
        add_run(run, fmt::format("{}, {} hand, {:g} um", run.manoeuvre, hand, 1e6 * encoder_m), cell);
        if (manoeuvre == Manoeuvre::kPress) cell.felt_N_per_m = std::max(cell.felt_N_per_m, run.figures.felt_N_per_m);
      }
    }
  }
}

GridFile::GridFile(std::string path, bool keep) : path_(std::move(path)) {
  std::ifstream file(path_);
  std::string line, head;
  if (!keep || !file) return;
  for (int i = 0; i < 2 && std::getline(file, line); ++i) head += line + "\n";
  if (head != kHead) throw std::runtime_error(path_ + ": no table of a grid to go on with; choose another file");
  while (std::getline(file, line))
    if (line.size() > 2 && line.back() == '|') row_.push_back(line + "\n");
}

bool GridFile::has(const std::string& scene, const GridCell& cell) const {
  const std::string key = key_of(scene, cell);
  return std::any_of(row_.begin(), row_.end(), [&](const std::string& row) { return row.rfind(key, 0) == 0; });
}

// A scene's rows stand together, by their own order: damping, then delay.
void GridFile::add(const std::string& scene, const GridCell& cell) {
  const std::string row = row_of(scene, cell), of_scene = "| " + scene + " |";
  const auto numbers = [&](const std::string& text) { return std::stod(text.substr(of_scene.size())); };
  auto place = row_.end();
  for (auto it = row_.begin(); it != row_.end(); ++it) {
    if (it->rfind(of_scene, 0) != 0) continue;
    place = it + 1;
    const double b = numbers(*it);
    const double tau = std::stod(it->substr(it->find('|', of_scene.size()) + 1));
    if (b < cell.damping_N_s_per_m || (b == cell.damping_N_s_per_m && tau < 1e3 * cell.delay_s)) continue;
    place = it;
    break;
  }
  row_.insert(place, row);
  const std::string part = path_ + ".part";
  std::ofstream file(part);
  file << text();
  file.close();
  if (!file || std::rename(part.c_str(), path_.c_str()) != 0) throw std::runtime_error(path_ + ": cannot write");
}

std::string GridFile::text() const {
  std::string text = kHead;
  for (const std::string& row : row_) text += row;
  return text;
}

}  // namespace palpate
