// `palpate report`: speed against error, of every model of the product on the same physical cases.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "sim_host/bake/scene_model.h"
#include "sim_host/build_id.h"
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/file_text.h"
#include "sim_host/json_output.h"
#include "sim_host/latency/machine_identity.h"
#include "sim_host/overlay_options.h"
#include "sim_host/report/case_report.h"
#include "sim_host/report/csv_table.h"

namespace palpate {

namespace {

namespace fs = std::filesystem;

struct ReportCommand {
  std::vector<std::string> scenes, models;
  std::string all, out = "report", markdown, picture;
  SceneOverlays overlays;
  std::vector<double> place_mm, normal{0, 1, 0};
  double radius_mm = 0, depth_mm = 0;
  bool solve = false, again = false, quick = false, json = false;
};

void write_page(const std::string& path, const std::string& text, bool told = true) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error(path + ": cannot write");
  if (told) fmt::print("wrote   {}\n", path);
}

// The first comment of a scene: what it says of itself.
std::string about(const std::string& scene_text) {
  std::istringstream in(scene_text);
  std::string line, text;
  while (std::getline(in, line) && line.starts_with("#") && !line.starts_with("# A case of")) text += line.substr(1);
  return text.empty() ? text : text.substr(1);
}

std::string machine_text() {
  const MachineIdentity machine = identify_machine({}, "loopback");
  double load[3] = {};
  const bool known = getloadavg(load, 3) > 0;
  return fmt::format("{} x {}, {}{}", machine.cpus, machine.cpu_model, machine.kernel,
                     known ? fmt::format(", load {:.1f}", load[0]) : "");
}

// Highest vertex: where a scene without a place is pressed.
PressPlace place_on_top(const Model& model) {
  PressPlace press;
  double highest = -kHuge;
  for (const Vec3& vertex : model.vertex_m)
    if (vertex.y > highest) highest = vertex.y, press.place_m = vertex;
  for (const ToolPoint& point : model.tool_point) press.radius_m = std::max(press.radius_m, point.margin_m);
  press.depth_m = 0.5 * press.radius_m;
  return press;
}

PressPlace stated_place(const ReportCommand& command, const SceneDesc& scene) {
  PressPlace press;
  if (command.place_mm.empty()) {
    press = place_on_top(SceneModel(scene).model());
  } else {
    press.place_m = 1e-3 * Vec3{command.place_mm[0], command.place_mm[1], command.place_mm[2]};
    const Vec3 normal{command.normal[0], command.normal[1], command.normal[2]};
    if (!(norm(normal) > 0)) throw std::runtime_error("--normal: 0,0,0 is no direction; give the outward normal");
    press.normal = (1 / norm(normal)) * normal;
    press.radius_m = 8e-3;
    press.depth_m = 4e-3;
  }
  if (command.radius_mm > 0) press.radius_m = 1e-3 * command.radius_mm;
  if (command.depth_mm > 0) press.depth_m = 1e-3 * command.depth_mm;
  return press;
}

std::uint64_t text_hash(const std::string& text) {
  std::uint64_t hash = 1469598103934665603u;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

// Of the files in OUT/runs: changed with their keys, so that older ones are made again.
constexpr char kRunFormat[] = "surface";

class Reporter {
 public:
  explicit Reporter(const ReportCommand& command) : command_(command) {
    fs::create_directories(command.out + "/runs");
    for (const std::string& name : command.models)
      if (find_variant(name) == nullptr) throw std::runtime_error("--model: no model " + name + "; " + known_models());
  }

  CaseReport report(const std::string& scene_path) const {
    const SceneDesc scene = load_scene(scene_path, command_.overlays);
    const std::string scene_text = file_text(scene_path);
    CaseReport report;
    report.name = scene.name;
    report.about = about(scene_text);
    report.scene = scene_path;
    const std::string reference = reference_path(scene_path);
    if (command_.solve) {
      fmt::print("{}: solving by finite elements, minutes\n", scene.name);
      const ReferenceCurve curve = solve_reference(scene, stated_place(command_, scene));
      write_reference(reference, curve);
      fmt::print("wrote   {}\n", reference);
    }
    if (fs::exists(reference)) report.reference = read_reference(reference);
    report.press = report.reference ? report.reference->press : stated_place(command_, scene);
    const std::string key = kRunFormat + scene_text + file_text(reference) +
                            file_text(reference_surface_path(reference)) + kBuildId + overlay_text();
    for (const ModelVariant& variant : model_variants())
      if (wanted(variant)) report.runs.push_back(run(variant, scene, report, key));
    return report;
  }

  static std::string known_models() {
    std::string text = "there are";
    for (const ModelVariant& variant : model_variants()) text += std::string(" ") + variant.name;
    return text;
  }

 private:
  bool wanted(const ModelVariant& variant) const {
    return command_.models.empty() || std::ranges::find(command_.models, variant.name) != command_.models.end();
  }
  std::string overlay_text() const {
    std::string text;
    for (const std::string& file : command_.overlays.file) text += file_text(file);
    for (const std::string& setting : command_.overlays.setting) text += setting;
    return text;
  }
  // A run that an earlier report of the same scene, reference and build has made is taken from there.
  ModelRun run(const ModelVariant& variant, const SceneDesc& scene, const CaseReport& report,
               const std::string& key) const {
    const PressPlace& p = report.press;
    const std::string place = fmt::format("{} {} {} {} {} {} {} {}", p.place_m.x, p.place_m.y, p.place_m.z, p.normal.x,
                                          p.normal.y, p.normal.z, p.radius_m, p.depth_m);
    const std::string path = fmt::format("{}/runs/{}.{}.{:016x}.json", command_.out, report.name, variant.name,
                                         text_hash(key + place + (command_.quick ? "quick" : "")));
    if (!command_.again && fs::exists(path)) return run_of_json(file_text(path));
    fmt::print("{:<18}{:<16}", report.name, variant.name);
    std::fflush(stdout);
    ModelRunOptions options;
    options.count = !command_.quick;
    const ModelRun made = run_model(variant, scene, p, report.reference ? &*report.reference : nullptr, options);
    write_page(path, run_json(made), false);
    fmt::print("{}\n", told(made));
    return made;
  }
  static std::string told(const ModelRun& run) {
    if (!run.refused.empty()) return "not for this case";
    const std::string cost = run.count.counted ? fmt::format("{} instructions", run.count.worst)
                                               : fmt::format("{:.1f} us ({})", run.p50_us, run.count.why_not);
    if (!run.error) return cost;
    return fmt::format("RMS {:6.2f} %, largest {:7.2f} %, {}", 100 * run.error->force_rms,
                       100 * run.error->force_largest, cost);
  }

  const ReportCommand& command_;
};

std::vector<std::string> scenes_of(const ReportCommand& command) {
  std::vector<std::string> scenes = command.scenes;
  if (!command.all.empty()) {
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(command.all))
      if (entry.path().extension() == ".toml") found.push_back(entry.path().string());
    std::ranges::sort(found);
    if (found.empty()) throw std::runtime_error(command.all + ": no scene (.toml) in this folder");
    scenes.insert(scenes.end(), found.begin(), found.end());
  }
  if (scenes.empty()) throw std::runtime_error("report: name scenes, or a folder of them with --all DIR (see --help)");
  return scenes;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

int run_report(const ReportCommand& command, Json& json) {
  const std::vector<std::string> scenes = scenes_of(command);
  if (command.solve && scenes.size() > 1 && !command.place_mm.empty())
    throw std::runtime_error("--place: one place is for one scene; name one scene");
  const Reporter reporter(command);
  std::vector<CaseReport> cases;
  for (const std::string& scene : scenes) cases.push_back(reporter.report(scene));
  const ReportStamp stamp{today(), kBuildId, machine_text()};
  write_page(command.out + "/report.html", report_html(cases, stamp));
  write_page(command.out + "/report.csv", report_csv(cases));
  const std::string figures = report_json(cases, stamp);
  json["folder"] = command.out;
  json.update(Json::parse(figures));
  write_page(command.out + "/report.json", figures);
  if (!command.markdown.empty()) write_page(command.markdown, report_markdown(cases, stamp));
  if (!command.picture.empty()) {
    pareto_plot(cases, "Every model on every case: error against cost").save(command.picture);
    fmt::print("wrote   {}\n", command.picture);
  }
  return kExitOk;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReportCommand>();
  CLI::App* command =
      app.add_subcommand("report", "Speed against error: every model on the same press, beside finite elements");
  command->add_option("SCENE", options->scenes, "scenes (.toml); SCENE.reference.csv beside one is its reference");
  command->add_option("--all", options->all, "all scenes of this folder too")->type_name("DIR");
  command->add_option("--out", options->out, "folder for report.html, report.csv, report.json and the runs")
      ->capture_default_str();
  command->add_option("--model", options->models, "only this model; repeatable");
  add_overlay_options(*command, options->overlays);
  command->add_flag("--solve", options->solve, "first make the reference by finite elements, which takes minutes");
  command->add_option("--place", options->place_mm, "where the ball presses, mm; default: the body's highest point")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--normal", options->normal, "outward direction there")->delimiter(',')->expected(3);
  command->add_option("--radius-mm", options->radius_mm, "of the ball; default: the scene's tip")->check(above_zero());
  command->add_option("--depth-mm", options->depth_mm, "of the press; default: half the radius")->check(above_zero());
  command->add_flag("--again", options->again, "run what an earlier report has already run");
  command->add_flag("--quick", options->quick, "count no instructions");
  command->add_option("--markdown", options->markdown, "also write the tables as Markdown");
  command->add_option("--picture", options->picture, "also draw error against cost (.svg or .png)")
      ->check(ends_in({".svg", ".png"}));
  command->footer(
      "Runs are kept in OUT/runs: a report that was interrupted goes on where it was. Metrics and cases: "
      "docs/accuracy.md.\n"
      "Examples:\n"
      "  palpate report --all tests/accuracy --out report\n"
      "  palpate report organ.toml --solve --depth-mm 3\n"
      "  palpate report tests/accuracy/block.toml --model elastic --model tip");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "report", [&](Json& json) { return run_report(*options, json); });
  });
}

}  // namespace palpate
