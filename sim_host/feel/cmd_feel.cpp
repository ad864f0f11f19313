// `palpate feel`: what a hand feels of a scene, in virtual time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "config/parallel.h"
#include "sim_host/bake/default_path.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/feel/device_draw.h"
#include "sim_host/feel/device_grid.h"
#include "sim_host/feel/feel.h"
#include "sim_host/feel/z_width.h"
#include "sim_host/json_output.h"
#include "sim_host/overlay_options.h"

namespace palpate {

namespace {

struct FeelCommand {
  std::vector<std::string> scenes, manoeuvres;
  SceneOverlays overlays;
  FeelOptions options;
  std::string csv, markdown, map, grid;
  bool coarse = false, resume = false;
  int random = 0;
  std::uint64_t seed = 1;
  unsigned jobs = 1;
  JsonOption json;
};

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error(path + ": cannot write");
  fmt::print("wrote   {}\n", path);
}

std::vector<Manoeuvre> wanted(const FeelCommand& command) {
  std::vector<Manoeuvre> list;
  for (const std::string& title : command.manoeuvres) list.push_back(manoeuvre_of(title));
  if (list.empty())
    for (const ManoeuvreText& text : manoeuvre_texts()) list.push_back(text.manoeuvre);
  return list;
}

// The cells that are not in the table yet, shared out to threads; what a row says does not depend on their number.
void feel_grid(const FeelCommand& command, const Model& model, const SceneDesc& scene, const TouchPlace& place,
               GridFile& table) {
  std::vector<GridCell> cells = grid_cells(command.coarse);
  std::erase_if(cells, [&](const GridCell& cell) { return table.has(scene.name, cell); });
  std::mutex mutex;
  for_each_piece(cells.size(), command.jobs, [&](std::size_t i) {
    run_cell(model, scene, place, cells[i]);
    const std::lock_guard lock(mutex);
    table.add(scene.name, cells[i]);
  });
}

// What the scenes named have made, in this order.
struct FeelResults {
  std::vector<FeelRun> runs;
  std::vector<DrawnRun> drawn;
  GridFile table;
};

void feel_drawn(const FeelCommand& command, const Model& model, const SceneDesc& scene, const TouchPlace& place,
                std::vector<DrawnRun>& drawn) {
  std::vector<std::vector<DrawnRun>> runs(static_cast<std::size_t>(command.random));
  for_each_piece(runs.size(), command.jobs,
                 [&](std::size_t i) { runs[i] = run_drawn(model, scene, place, draw_device(command.seed, i)); });
  for (const std::vector<DrawnRun>& of_device : runs) drawn.insert(drawn.end(), of_device.begin(), of_device.end());
}

void feel_scene(const FeelCommand& command, const std::string& path, FeelResults& results) {
  const SceneModel compiled(path, command.overlays);
  if (!compiled.scene())
    throw std::runtime_error(path + ": an image names no device and no path; name the scene's .toml");
  SceneDesc scene = *compiled.scene();
  add_default_path(scene, compiled.model());
  if (scene.device.holds != HeldPart::kTool)
    throw std::runtime_error(path + ": feel moves one tool by one hand, and here device.holds is \"" +
                             std::string(word_of(scene.device.holds)) + "\"; leave it out");
  const TouchPlace place = touch_place_of(compiled.model(), scene);
  if (!command.grid.empty()) return feel_grid(command, compiled.model(), scene, place, results.table);
  if (command.random > 0) return feel_drawn(command, compiled.model(), scene, place, results.drawn);
  for (const Manoeuvre manoeuvre : wanted(command)) {
    std::string rows;
    FeelListener listen;
    if (!command.csv.empty()) listen = [&](const FeelTick& tick) { rows += feel_csv_row(tick); };
    const FeelRun run = run_feel(compiled.model(), scene, place, manoeuvre, command.options, listen);
    results.runs.push_back(run);
    if (command.csv.empty()) continue;
    std::filesystem::create_directories(command.csv);
    write_file(fmt::format("{}/{}.{}.csv", command.csv, run.scene, run.manoeuvre), feel_csv_header() + rows);
  }
}

int tell(std::size_t runs, std::size_t failed, Json& json) {
  json["failed_runs"] = failed;
  fmt::print("{} of {} runs as they should be (docs/stability.md)\n", runs - failed, runs);
  return failed == 0 ? kExitOk : kExitFailed;
}

int tell_runs(const FeelCommand& command, const std::vector<FeelRun>& runs, Json& json) {
  fmt::print("{}", feel_table(runs));
  json["runs"] = Json::parse(feel_json(runs));
  if (!command.json.file.empty()) write_file(command.json.file, feel_json(runs));
  if (!command.markdown.empty()) write_file(command.markdown, feel_markdown(runs));
  const auto failed =
      std::count_if(runs.begin(), runs.end(), [](const FeelRun& run) { return !feel_failure(run).empty(); });
  return tell(runs.size(), static_cast<std::size_t>(failed), json);
}

int tell_drawn(const FeelCommand& command, const std::vector<DrawnRun>& drawn, Json& json) {
  fmt::print("{}", drawn_table(drawn));
  json["runs"] = Json::parse(drawn_json(drawn));
  if (!command.json.file.empty()) write_file(command.json.file, drawn_json(drawn));
  if (!command.markdown.empty()) write_file(command.markdown, drawn_markdown(drawn));
  const auto failed =
      std::count_if(drawn.begin(), drawn.end(), [](const DrawnRun& run) { return !run.failure.empty(); });
  return tell(drawn.size(), static_cast<std::size_t>(failed), json);
}

int run(const FeelCommand& command, Json& json) {
  if (!command.map.empty()) {
    z_width_plot().save(command.map);
    json["map"] = command.map;
    fmt::print("wrote   {}\n", command.map);
  }
  FeelResults results{{}, {}, GridFile(command.grid, command.resume)};
  for (const std::string& path : command.scenes) feel_scene(command, path, results);
  if (!command.grid.empty()) {
    json["grid"] = command.grid;
    fmt::print("{}wrote   {}\n", results.table.text(), command.grid);
  }
  if (!results.drawn.empty()) return tell_drawn(command, results.drawn, json);
  return results.runs.empty() ? kExitOk : tell_runs(command, results.runs, json);
}

std::string footer() {
  std::string text = "Manoeuvres:\n";
  for (const ManoeuvreText& m : manoeuvre_texts()) text += fmt::format("  {:<10}{}\n", m.title, m.what);
  return text +
         "Columns: docs/stability.md. The scene's [device] is what the controller takes the device for; --device is "
         "what "
         "it is.\n"
         "Examples:\n"
         "  palpate feel config/scenes/half_shell.toml\n"
         "  palpate feel config/scenes/*.toml --manoeuvre overload --manoeuvre push --json feel.json\n"
         "  palpate feel config/scenes/ring.toml --hand light --device damping_N_s_per_m=0.1 --device delay_s=0.001\n"
         "  palpate feel config/scenes/ring.toml --set device.force_max_N=25 --manoeuvre push --csv ticks\n"
         "  palpate feel config/scenes/half_shell_paper.toml --random 20 --seed 7 --jobs 0\n"
         "  palpate feel --map z_width.png";
}

}  // namespace

void add_feel_command(CLI::App& app, int& exit_code) {
  auto settings = std::make_shared<FeelCommand>();
  CLI::App* command = app.add_subcommand(
      "feel", "Feel scenes with simulated hands in virtual time: energy, swings, steps, lag, stiffness, noise");
  command->add_option("SCENES", settings->scenes, "scenes (.toml)");
  add_overlay_options(*command, settings->overlays);
  command->add_option("--manoeuvre", settings->manoeuvres, "only this one, below; repeatable");
  command->add_option("--hand", settings->options.hand, "light, medium, firm or strong; default: the scene's");
  command->add_option("--device", settings->options.device,
                      "NAME=VALUE: a property of the real device or hand (SI units), repeatable");
  command->add_option("--csv", settings->csv, "folder for a table of every tick of every run");
  add_json_option(*command, settings->json, "write the runs' figures there");
  command->add_option("--markdown", settings->markdown, "write them as a table (.md)")->check(ends_in({".md"}));
  command
      ->add_option("--grid", settings->grid,
                   "write the worst over a grid of devices and hands instead (.md); minutes for each scene")
      ->check(ends_in({".md"}));
  command->add_flag("--coarse", settings->coarse, "of the grid only corners and centre: a tenth of the time");
  command->add_flag("--resume", settings->resume,
                    "keep the rows that the grid's file holds, of this program and these scenes");
  command
      ->add_option("--random", settings->random,
                   "so many devices and hands drawn at random instead, ten manoeuvres with each, stated truly")
      ->check(CLI::Range(1, 100000))
      ->excludes("--grid");
  command->add_option("--seed", settings->seed, "of the draw; default 1")->needs("--random");
  command
      ->add_option("--jobs", settings->jobs,
                   "rows of the grid, or drawn devices, at a time; 0: as many as there are processors")
      ->check(CLI::Range(0U, 256U));
  command->add_option("--map", settings->map, "draw which stiffness a device keeps passive (.svg or .png)")
      ->check(ends_in({".svg", ".png"}));
  command->footer(footer());
  command->callback([settings, &exit_code] {
    if (settings->scenes.empty() && settings->map.empty()) throw CLI::RequiredError("SCENES or --map");
    exit_code = run_with_json(settings->json.wanted(), "feel", [&](Json& json) { return run(*settings, json); });
  });
}

}  // namespace palpate
