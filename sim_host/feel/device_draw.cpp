#include "sim_host/feel/device_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "sim_host/feel/device_grid.h"

namespace palpate {

namespace {

// What standard distributions draw from the same generator differs between libraries; these do not.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t index) : random_(seed * std::uint64_t{0x9E3779B97F4A7C15} + index) {}
  double even(double lowest, double highest) {
    return lowest + (highest - lowest) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  double log_even(double lowest, double highest) { return lowest * std::pow(highest / lowest, even(0, 1)); }

 private:
  std::mt19937_64 random_;
};

// A jump of the encoder and a hand that beats the motors may well be given energy; what they do else may not.
bool is_quiet(Manoeuvre manoeuvre) {
  return manoeuvre != Manoeuvre::kOverload && manoeuvre != Manoeuvre::kPush && manoeuvre != Manoeuvre::kTeleport;
}

struct SceneCount {
  int runs = 0, good = 0;
  double hand_J = 0, step = 0, least_N_per_m = 1e9, most_N_per_m = 0;
  std::string failures;
};
SceneCount count(const std::string& scene, const std::vector<DrawnRun>& runs) {
  SceneCount c;
  for (const DrawnRun& d : runs) {
    if (d.run.scene != scene) continue;
    c.runs += 1;
    c.good += d.failure.empty() ? 1 : 0;
    c.step = std::max(c.step, d.run.figures.step_share);
    if (is_quiet(manoeuvre_of(d.run.manoeuvre))) c.hand_J = std::max(c.hand_J, d.run.figures.hand_J);
    c.least_N_per_m = std::min(c.least_N_per_m, d.coupling_N_per_m);
    c.most_N_per_m = std::max(c.most_N_per_m, d.coupling_N_per_m);
    if (!d.failure.empty())
      c.failures +=
          fmt::format("{}{} {} ({})", c.failures.empty() ? "" : "; ", d.run.manoeuvre, d.failure, d.device.text());
  }
  return c;
}

}  // namespace

std::string DrawnDevice::text() const {
  return fmt::format("b {:.2f}, tau {:.1f} ms, {:.0f} um, {:.2f} N, hand {:.0f} N/m", damping_N_s_per_m, 1e3 * delay_s,
                     1e6 * encoder_m, friction_N, hand_N_per_m);
}

DrawnDevice draw_device(std::uint64_t seed, std::uint64_t index) {
  Draw draw(seed, index);
  DrawnDevice d;
  d.damping_N_s_per_m = draw.log_even(0.05, 2.5);
  d.delay_s = kFeelSubstep_s * std::floor(draw.even(0, 31));
  d.encoder_m = draw.even(0, 1e-4);
  d.friction_N = draw.even(0.02, 0.1);
  d.hand_N_per_m = draw.log_even(100, 2000);
  d.hand_kg = draw.log_even(0.05, 0.2);
  d.hand_N_s_per_m = 2 * draw.even(0.1, 0.6) * std::sqrt(d.hand_N_per_m * d.hand_kg);
  return d;
}

std::string drawn_failure(Manoeuvre manoeuvre, const FeelRun& run) {
  std::string text = feel_failure(run);
  // A tremor is of the size of an encoder's steps, and goes on: what they make of it is bounded by its way alone.
  const double most_J =
      manoeuvre == Manoeuvre::kTremor ? std::max(kGridHandMost_J, run.figures.quantum_J) : kGridHandMost_J;
  if (is_quiet(manoeuvre) && run.figures.hand_J > most_J)
    text += fmt::format("{}gives the hand {:.2g} mJ", text.empty() ? "" : ", ", 1e3 * run.figures.hand_J);
  return text;
}

std::vector<DrawnRun> run_drawn(const Model& model, const SceneDesc& scene, const TouchPlace& place,
                                const DrawnDevice& d) {
  SceneDesc stated = scene;
  stated.device.friction_N = d.friction_N;
  const Model baked = baked_for(model, stated, d.damping_N_s_per_m, d.delay_s, d.encoder_m);
  FeelOptions options;
  for (const auto& [name, value] :
       {std::pair{"damping_N_s_per_m", d.damping_N_s_per_m}, std::pair{"delay_s", d.delay_s},
        std::pair{"encoder_m", d.encoder_m}, std::pair{"friction_N", d.friction_N},
        std::pair{"hand_stiffness_N_per_m", d.hand_N_per_m}, std::pair{"hand_damping_N_s_per_m", d.hand_N_s_per_m},
        std::pair{"hand_mass_kg", d.hand_kg}})
    options.device.push_back(fmt::format("{}={}", name, value));
  std::vector<DrawnRun> runs;
  for (const Manoeuvre manoeuvre :
       {Manoeuvre::kTap, Manoeuvre::kPress, Manoeuvre::kLoop, Manoeuvre::kSlide, Manoeuvre::kHold, Manoeuvre::kTremor,
        Manoeuvre::kTurn, Manoeuvre::kOverload, Manoeuvre::kPush, Manoeuvre::kTeleport}) {
    const FeelRun run = run_feel(baked, scene, place, manoeuvre, options, nullptr);
    runs.push_back({run, d, baked.params.coupling_N_per_m, drawn_failure(manoeuvre, run)});
  }
  return runs;
}

std::string drawn_table(const std::vector<DrawnRun>& runs) {
  std::string text, last;
  for (const DrawnRun& d : runs) {
    const std::string head =
        fmt::format("{:<25}{}, coupling {:.0f} N/m", d.run.scene, d.device.text(), d.coupling_N_per_m);
    if (head != last) text += (last.empty() ? "" : "\n") + head;
    last = head;
    if (!d.failure.empty()) text += fmt::format("\n  {}: {}", d.run.manoeuvre, d.failure);
  }
  return text + "\n";
}

std::string drawn_markdown(const std::vector<DrawnRun>& runs) {
  std::string text =
      "| scene | coupling N/m | largest step % | hand mJ | good of runs | what is not |\n|---|---|---|---|---|---|\n";
  std::vector<std::string> scenes;
  for (const DrawnRun& d : runs)
    if (std::find(scenes.begin(), scenes.end(), d.run.scene) == scenes.end()) scenes.push_back(d.run.scene);
  for (const std::string& scene : scenes) {
    const SceneCount c = count(scene, runs);
    text += fmt::format("| {} | {:.0f} to {:.0f} | {:.1f} | {:.2f} | {} of {} | {} |\n", scene, c.least_N_per_m,
                        c.most_N_per_m, 100 * c.step, 1e3 * c.hand_J, c.good, c.runs, c.failures);
  }
  return text;
}

std::string drawn_json(const std::vector<DrawnRun>& runs) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const DrawnRun& d : runs) {
    const FeelFigures& f = d.run.figures;
    all.push_back({{"scene", d.run.scene},
                   {"manoeuvre", d.run.manoeuvre},
                   {"damping_N_s_per_m", d.device.damping_N_s_per_m},
                   {"delay_s", d.device.delay_s},
                   {"encoder_m", d.device.encoder_m},
                   {"friction_N", d.device.friction_N},
                   {"hand_N_per_m", d.device.hand_N_per_m},
                   {"hand_N_s_per_m", d.device.hand_N_s_per_m},
                   {"hand_kg", d.device.hand_kg},
                   {"coupling_N_per_m", d.coupling_N_per_m},
                   {"step_share", f.step_share},
                   {"alternations", f.alternations},
                   {"port_J", f.port_J},
                   {"hand_J", f.hand_J},
                   {"quantum_J", f.quantum_J},
                   {"noise_N", f.noise_N},
                   {"object_N_per_m", f.object_N_per_m},
                   {"failure", d.failure}});
  }
  return all.dump(2) + "\n";
}

}  // namespace palpate
