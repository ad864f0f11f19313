// What the bench's figures are allowed to be, and how they are told.
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "sim_host/feel/feel.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

constexpr double kStepShareMax =
    0.10;  // of the largest force, in one tick; the output keeps below it (kOutputStepShare)
// The tool goes on by its prediction and is corrected at the tick's end: 1.05 in a push at 0.5 m/s (2026-11-25).
constexpr double kLeashSlack = 1.1;
// What a trembling hand hears of the encoder. Of an object stiffer than the coupling it feels the coupling, whose noise
// is the device's own.
constexpr double kTremorNoiseMost_N = 2e-3;
constexpr double kModelSlack = 2;  // for the tick of a jump of the encoder: the tool is corrected at its end

void fail(std::string& text, const std::string& what) { text += (text.empty() ? "" : ", ") + what; }

std::string cells(const FeelRun& run, const char* row) {
  const FeelFigures& f = run.figures;
  return fmt::format(fmt::runtime(row), run.scene, run.manoeuvre, f.force_max_N, f.model_max_N, 100 * f.step_share,
                     f.alternations, 1e3 * f.lag_m, 1e-3 * f.felt_N_per_m, 1e3 * f.noise_N, 1e3 * f.port_J,
                     1e3 * f.hand_J, feel_failure(run).empty() ? "" : feel_failure(run));
}

// Worst of some manoeuvres of a scene.
struct Worst {
  double step = 0, model = 0;
  int swings = 0;
};
Worst worst_of(const std::string& scene, const std::vector<FeelRun>& runs, std::initializer_list<const char*> titles) {
  Worst worst;
  for (const FeelRun& run : runs) {
    const bool counts = run.scene == scene && std::find(titles.begin(), titles.end(), run.manoeuvre) != titles.end();
    if (!counts) continue;
    worst.step = std::max(worst.step, 100 * run.figures.step_share);
    worst.model = std::max(worst.model, run.figures.model_max_N);
    worst.swings += run.figures.alternations;
  }
  return worst;
}

FeelFigures figures_of(const std::string& scene, const char* title, const std::vector<FeelRun>& runs) {
  for (const FeelRun& run : runs)
    if (run.scene == scene && run.manoeuvre == title) return run.figures;
  return {};
}

std::string scene_row(const std::string& scene, const std::vector<FeelRun>& runs) {
  const FeelFigures press = figures_of(scene, "press", runs), tap = figures_of(scene, "tap", runs);
  const FeelFigures loop = figures_of(scene, "loop", runs), slow = figures_of(scene, "slow", runs);
  const Worst quiet = worst_of(scene, runs, {"tap", "press", "slide", "loop", "hold", "tremor", "turn"});
  const Worst hard = worst_of(scene, runs, {"overload", "push"}), jump = worst_of(scene, runs, {"teleport"});
  return fmt::format(
      "| {} | {:.2f} | {:.2f}, {:.2f} | {:.2f}, {:.2f} | {:.1f}, {:.1f} | {:.1f} | {} | {:.1f}, {}, {:.1f} | {:.1f}, "
      "{} | {:.1f} | {} |\n",
      scene, 1e-3 * press.felt_N_per_m, 1e3 * tap.port_J, 1e3 * tap.hand_J, 1e3 * loop.port_J, 1e3 * loop.hand_J,
      1e3 * figures_of(scene, "hold", runs).noise_N, 1e3 * figures_of(scene, "tremor", runs).noise_N, quiet.step,
      quiet.swings, hard.step, hard.swings, hard.model, jump.step, jump.swings, worst_of(scene, runs, {"lost"}).step,
      bit_names(fault_bit_texts(), slow.fault));
}

}  // namespace

std::string feel_failure(const FeelRun& run) {
  const FeelFigures& f = run.figures;
  std::string text;
  if (f.alternations > 0) fail(text, fmt::format("swings in {} ticks", f.alternations));
  if (f.torque_alternations > 0) fail(text, fmt::format("torque swings in {} ticks", f.torque_alternations));
  if (!(f.step_share < kStepShareMax)) fail(text, fmt::format("steps by {:.0f} %", 100 * f.step_share));
  if (!(f.torque_step_share < kStepShareMax))
    fail(text, fmt::format("torque steps by {:.0f} %", 100 * f.torque_step_share));
  const bool jumps = run.manoeuvre == "teleport";
  if (!(f.leash_share <= (jumps ? kModelSlack : kLeashSlack)))
    fail(text, fmt::format("stretches the coupling to {:.0f} % of its limit", 100 * f.leash_share));
  if (f.model_max_N > kModelSlack * f.force_limit_N) fail(text, fmt::format("winds up to {:.0f} N", f.model_max_N));
  const bool held = !f.local && f.object_N_per_m <= f.coupling_N_per_m;
  if (run.manoeuvre == "tremor" && held && f.noise_N > kTremorNoiseMost_N)
    fail(text, fmt::format("is rough by {:.1f} mN", 1e3 * f.noise_N));
  const std::uint32_t wanted = run.manoeuvre == "slow" ? Fault::kSamplesSparse : 0u;  // it must not be rendered
  if (wanted != 0 && f.fault == 0) fail(text, "renders too few samples");
  if ((f.fault & ~wanted) != 0) fail(text, "fault " + bit_names(fault_bit_texts(), f.fault));
  return text;
}

std::string feel_table(const std::vector<FeelRun>& runs) {
  std::string text =
      fmt::format("{:<25}{:<10}{:>8}{:>8}{:>7}{:>7}{:>7}{:>7}{:>7}{:>8}{:>8}  {}\n", "scene", "manoeuvre", "force N",
                  "model N", "step %", "swings", "lag mm", "N/mm", "mN RMS", "port mJ", "hand mJ", "");
  for (const FeelRun& run : runs)
    text += cells(run, "{:<25}{:<10}{:>8.2f}{:>8.1f}{:>7.2f}{:>7}{:>7.2f}{:>7.2f}{:>7.1f}{:>8.3f}{:>8.3f}  {}\n");
  return text;
}

std::string feel_markdown(const std::vector<FeelRun>& runs) {
  std::vector<std::string> scenes;
  for (const FeelRun& run : runs)
    if (std::find(scenes.begin(), scenes.end(), run.scene) == scenes.end()) scenes.push_back(run.scene);
  std::string text =
      "| scene | felt N/mm | tap: port, hand mJ | loop: port, hand mJ | noise mN: hold, tremor | largest step % | "
      "swings "
      "| overload and push: step %, swings, model N | teleport: step %, swings | lost: step % | slow: "
      "N "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& scene : scenes) text += scene_row(scene, runs);
  return text;
}

std::string feel_json(const std::vector<FeelRun>& runs) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const FeelRun& run : runs) {
    const FeelFigures& f = run.figures;
    all.push_back({{"scene", run.scene},
                   {"manoeuvre", run.manoeuvre},
                   {"duration_s", f.duration_s},
                   {"force_max_N", f.force_max_N},
                   {"model_max_N", f.model_max_N},
                   {"depth_max_m", f.depth_max_m},
                   {"step_share", f.step_share},
                   {"torque_step_share", f.torque_step_share},
                   {"step_at_s", f.step_at_s},
                   {"alternations", f.alternations},
                   {"torque_alternations", f.torque_alternations},
                   {"alternation_run", f.alternation_run},
                   {"leash_share", f.leash_share},
                   {"lag_m", f.lag_m},
                   {"force_limit_N", f.force_limit_N},
                   {"felt_N_per_m", f.felt_N_per_m},
                   {"noise_N", f.noise_N},
                   {"coupling_N_per_m", f.coupling_N_per_m},
                   {"object_N_per_m", f.object_N_per_m},
                   {"contacts", f.contacts},
                   {"port_J", f.port_J},
                   {"hand_J", f.hand_J},
                   {"quantum_J", f.quantum_J},
                   {"fingers_J", f.fingers_J},
                   {"status", bit_names(status_bit_texts(), f.status)},
                   {"fault", bit_names(fault_bit_texts(), f.fault)},
                   {"failure", feel_failure(run)}});
  }
  return all.dump(2) + "\n";
}

}  // namespace palpate
