// `palpate fit`: Young's modulus, Poisson's ratio and friction from measured presses.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "sim_host/cli.h"
#include "sim_host/fit/press_forward.h"
#include "sim_host/json_output.h"
#include "sim_host/overlay_options.h"
#include "sim_host/report/curve_error.h"

namespace palpate {

namespace {

struct FitCommand {
  std::string measured, scene, out;
  std::vector<std::string> wanted{"E"};
  SceneOverlays overlays;
  bool json = false;
};

struct Named {
  const char* word;
  Fitted what;
  const char* key;  // of the scene
  const char* unit;
};
constexpr Named kNamed[] = {{"E", Fitted::kModulus, "youngs_modulus_Pa", "Pa"},
                            {"nu", Fitted::kPoisson, "poisson_ratio", "-"},
                            {"friction", Fitted::kFriction, "mu_ref", "-"}};
const Named& name_of(Fitted what) {
  return *std::ranges::find_if(kNamed, [&](const Named& named) { return named.what == what; });
}

std::vector<Fitted> wanted_of(const FitCommand& command, const SceneDesc& scene, const Measurement& measured) {
  std::vector<Fitted> wanted;
  for (const Named& named : kNamed)
    if (std::ranges::find(command.wanted, named.word) != command.wanted.end()) wanted.push_back(named.what);
  const bool friction = std::ranges::find(wanted, Fitted::kFriction) != wanted.end();
  if (friction && scene.friction.law == FrictionLaw::kNone)
    throw std::runtime_error("--parameters friction: the scene has none; set friction.law, such as presliding");
  if (friction && !measured.vectors)
    throw std::runtime_error("--parameters friction: needs forces with a direction (fx_N, fy_N, fz_N)");
  return wanted;
}

// Forces are taken to be proportional to E while parameters are sought; where a law of the scene is not, a bake at the
// new E shows it, and the search goes on from there.
MaterialFit settled_fit(PressForward& forward, const MaterialGuess& guess, const std::vector<Fitted>& wanted,
                        const Measurement& measured) {
  constexpr int kMostRounds = 4;
  constexpr double kSettled = 2e-3;  // change of E between two rounds
  const ForwardModel model = [&](const MaterialGuess& material) { return forward(material); };
  MaterialFit fit = fit_material(model, guess, wanted, measured.force_N);
  for (int round = 1; round < kMostRounds; ++round) {
    const double before = fit.material.youngs_modulus_Pa;
    forward.settle(before);
    fit = fit_material(model, fit.material, wanted, measured.force_N);
    if (std::abs(fit.material.youngs_modulus_Pa / before - 1) < kSettled) break;
  }
  return fit;
}

CurveError left_over(const MaterialFit& fit, const Measurement& measured) {
  ForcePath truth, model;
  for (std::size_t i = 0; i < measured.force_N.size(); ++i) truth.x.push_back(static_cast<double>(i));
  model.x = truth.x;
  truth.force_N = measured.force_N;
  model.force_N = fit.force_N;
  return curve_error(truth, model);
}

std::string number(double value) { return fmt::format("{:.4g}", value); }

std::string fit_text(const MaterialFit& fit, const CurveError& error, std::size_t rows, int bakes) {
  std::string text;
  for (const FittedValue& value : fit.value) {
    const Named& named = name_of(value.what);
    if (value.identified)
      text += fmt::format("{:<9} {} +- {} {} (95 %)\n", named.word, number(value.value), number(value.half_width),
                          named.unit);
    else
      text += fmt::format("{:<9} not identified by these presses (+- {}); the scene's {} is kept\n", named.word,
                          number(value.half_width), number(value.value));
  }
  text += fmt::format("left over {} N per component (standard deviation), correlation from row to row {:.2f}{}\n",
                      number(fit.noise_N), fit.correlation,
                      fit.correlation > 0.8 ? ": the model errs, this is not noise" : "");
  text += fmt::format(
      "error     RMS {:.2f} %, largest {:+.2f} %; {:.0f} % of the {} rows' path below {:.0f} %, which a hand does not "
      "feel\n",
      100 * error.force_rms, 100 * error.force_largest, 100 * error.force_unnoticed, rows, 100 * kForceNoticed);
  return text + fmt::format("cost      {} evaluations, {} bakes\n", fit.evaluations, bakes);
}

void fill(Json& json, const MaterialFit& fit, const CurveError& error) {
  for (const FittedValue& value : fit.value)
    json["parameters"][name_of(value.what).word] = {
        {"value", value.value}, {"half_width_95", value.half_width}, {"identified", value.identified}};
  json["left_over_N"] = fit.noise_N;
  json["correlation"] = fit.correlation;
  json["force_rms"] = error.force_rms;
  json["force_largest"] = error.force_largest;
  json["force_unnoticed"] = error.force_unnoticed;
}

// An overlay for --with.
void write_overlay(const std::string& path, const MaterialFit& fit) {
  std::string material, friction;
  for (const FittedValue& value : fit.value) {
    if (!value.identified) continue;
    const std::string line = fmt::format("{} = {:.6g}\n", name_of(value.what).key, value.value);
    (value.what == Fitted::kFriction ? friction : material) += line;
  }
  std::ofstream out(path);
  if (!material.empty()) out << "[body.material]\n" << material;
  if (!friction.empty()) out << "[friction]\n" << friction;
  if (!out.flush()) throw std::runtime_error(path + ": cannot write");
  fmt::print(stderr, "wrote   {}\n", path);
}

int run_fit(const FitCommand& command, Json& json) {
  const SceneModel stated(command.scene, command.overlays);
  if (!stated.scene())
    throw std::runtime_error(command.scene + ": an image cannot be baked again; name the scene's .toml");
  const SceneDesc& scene = *stated.scene();
  const Measurement measured = read_measurement(read_csv_table(command.measured), stated.model());
  PressForward forward(scene, measured);
  const double friction = is_auto(scene.friction.mu_ref) ? 0.5 : scene.friction.mu_ref;
  const MaterialGuess guess{scene.material.youngs_modulus_Pa, stated.model().params.poisson_ratio, friction};
  const MaterialFit fit = settled_fit(forward, guess, wanted_of(command, scene, measured), measured);
  const CurveError error = left_over(fit, measured);
  fill(json, fit, error);
  fmt::print("{}", fit_text(fit, error, measured.pose.size(), forward.bakes()));
  if (!command.out.empty()) write_overlay(command.out, fit);
  const bool known = std::ranges::any_of(fit.value, [](const FittedValue& value) { return value.identified; });
  return known ? kExitOk : kExitFailed;
}

}  // namespace

void add_fit_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FitCommand>();
  CLI::App* command = app.add_subcommand("fit", "Young's modulus, Poisson's ratio and friction from measured presses");
  command->add_option("MEASURED", options->measured, "table (CSV) of poses or depths, with forces")->required();
  command->add_option("SCENE", options->scene, "scene (.toml) of the body, its support and the tool")->required();
  command->add_option("--parameters", options->wanted, "what is sought, as E,nu,friction")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::IsMember({"E", "nu", "friction"}));
  add_overlay_options(*command, options->overlays);
  command->add_option("--out", options->out, "write what was found as an overlay for --with (.toml)");
  add_json_flag(*command, options->json);
  command->footer(
      "Columns: x_mm, y_mm, z_mm (and qw, qx, qy, qz) as `palpate press` writes them, or depth_mm of a press by the "
      "scene's "
      "tool\non the body's highest point; fx_N, fy_N, fz_N, or f_N or force_N. nu and friction cost a bake per trial; "
      "E none.\n"
      "What the presses do not identify is said and left as the scene has it; exit code 1 when that is everything.\n"
      "Examples:\n"
      "  palpate fit measured.csv organ.toml --out organ_material.toml\n"
      "  palpate fit measured.csv organ.toml --parameters E,friction --json");
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "fit", [&](Json& json) { return run_fit(*options, json); });
  });
}

}  // namespace palpate
