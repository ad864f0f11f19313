// `palpate explain`: what a scene makes the tick do, and what that takes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "hal/device/device_profile.h"
#include "sim_host/bake/certificate_text.h"
#include "sim_host/bake/explain.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/cli.h"
#include "sim_host/overlay_options.h"

namespace palpate {

namespace {

struct ExplainOptions {
  std::string scene;
  SceneOverlays overlays;
  std::string profile;
  bool json = false;
};

int run_explain(const ExplainOptions& options, Json& json) {
  const SceneModel scene(options.scene, options.overlays);
  const std::int32_t budget = scene.scene() ? scene.scene()->budget_instructions : 0;
  json["scene"] = options.scene;
  json.update(explain_json(scene.model(), budget));
  json["certificate"] = certificate_json(scene.bytes());
  fmt::print("{}{}", explain(scene.model(), budget), certificate_text(scene.bytes()));
  if (options.profile.empty()) return kExitOk;
  DeviceProfile profile;
  const std::string refusal = refuse_profile(false, "", options.profile, scene.model().params, &profile);
  if (!profile.name.empty()) json["device"] = {{"profile", profile.name}, {"refused", refusal}};
  if (!profile.name.empty()) fmt::print("device  {}\n", profile_text(profile, scene.model().params));
  if (refusal.empty()) return kExitOk;
  if (profile.name.empty()) throw std::runtime_error(refusal);
  fmt::print("{}\n", refusal);
  return kExitFailed;
}

}  // namespace

void add_explain_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App* command =
      app.add_subcommand("explain", "Show what a scene makes each tick do: stages, laws, data and its readers, budget");
  command->add_option("SCENE", options->scene, "scene (.toml) or image (.pal)")->required();
  add_overlay_options(*command, options->overlays);
  command->add_option(
      "--profile", options->profile,
      "a device's profile (config/devices/*.toml): what the scene asks of it; exits with 1 when too much");
  command->footer(
      "Arrays that hold nothing are left out. What is baked but read by nobody does not pass the project's tests.\n"
      "Examples:\n"
      "  palpate explain config/scenes/half_shell.toml\n"
      "  palpate explain config/scenes/heart_compass_paper.toml --set coupling.law=coupled\n"
      "  palpate explain mallet.pal");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "explain", [&](Json& json) { return run_explain(*options, json); });
  });
}

}  // namespace palpate
