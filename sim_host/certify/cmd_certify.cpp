// `palpate certify`: looks for the dearest tick of a scene and writes what it found into the image.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "config/bake/image_writer.h"
#include "config/scene/progress.h"
#include "rt_core/stage_cost.h"
#include "sim_host/bake/certificate_text.h"
#include "sim_host/bake/default_path.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/certify/tick_certify.h"
#include "sim_host/cli.h"
#include "sim_host/overlay_options.h"

namespace palpate {

namespace {

struct CertifyTicksOptions {
  std::string scene, along, output;
  SceneOverlays overlays;
  TickSearchOptions search;
  bool json = false;
};

void fill(Json& json, const CertifyTicksOptions& options, const Model& model, const Certified& certified) {
  json["scene"] = options.scene;
  json.update(tick_json(certified.certificate));
  json["stated_instructions"] = worst_tick_instructions(model);
  json["found_by"] = certified.search.found_by;
  json["seed"] = options.search.seed;
  json["beyond_stated_ticks"] = certified.search.beyond_stated;
  json["warm_us"] = certified.times.warm_us;
  json["cold_us"] = certified.times.cold_us;
}

int run_certify_ticks(CertifyTicksOptions& options, Json& json) {
  const SceneModel scene(options.scene, options.overlays);
  const Progress bar = isatty(STDERR_FILENO) != 0 ? progress_bar(stderr) : Progress{};
  if (bar) options.search.progress = [&](double share) { bar("ticks", std::min(share, 1.0)); };
  std::vector<TimedPose> path;
  double hand_N_per_m = 0;
  std::optional<SceneDesc> described = scene.scene();
  if (!options.along.empty()) {
    described = load_scene(options.along, {});
    add_default_path(*described, scene.model());
  }
  if (described && !described->path.point.empty()) {
    path = scripted_poses(described->path, scene.model().params.period_s);
    hand_N_per_m = described->path.hand_stiffness_N_per_m;
  }
  const Certified certified = certify_ticks(scene.bytes(), path, hand_N_per_m, options.search);
  fill(json, options, scene.model(), certified);
  fmt::print("{}", certified_text(scene.model(), certified));
  const std::string output =
      options.output.empty() ? std::filesystem::path(options.scene).stem().string() + ".pal" : options.output;
  std::string error;
  if (!save_image(output, with_certificate(scene.bytes(), certified.certificate), error))
    throw std::runtime_error(output + ": " + error);
  json["image"] = output;
  fmt::print("certified {} -> {}\n", options.scene, output);
  if (certified.search.beyond_stated == 0) return kExitOk;
  fmt::print("{} ticks took more than the image states; bake the scene anew, and report it if that does not help\n",
             certified.search.beyond_stated);
  return kExitFailed;
}

}  // namespace

void add_certify_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CertifyTicksOptions>();
  CLI::App* command =
      app.add_subcommand("certify", "Look for the dearest tick of a scene; write what was found into its image");
  command->add_option("SCENE", options->scene, "scene (.toml) or image (.pal)")->required();
  command->add_option("--along", options->along, "scene (.toml) whose path is followed too, where SCENE is an image");
  add_overlay_options(*command, options->overlays);
  command->add_option("-o,--output", options->output, "image to write; default: the scene's name with .pal, here");
  command->add_option("--ticks", options->search.ticks, "ticks to look at; half of them climb from the dearest found")
      ->capture_default_str()
      ->check(CLI::Range(std::int64_t{100}, std::int64_t{1'000'000'000}));
  command->add_option("--seed", options->search.seed, "of the search: the same seed finds the same")
      ->capture_default_str();
  command->footer(
      "Exits with 1 when a tick took more than the image states, by which a controller judges whether it fits.\n"
      "The image itself stays as it is: recordings that name it still do.\n"
      "Examples:\n"
      "  palpate certify config/scenes/ring.toml -o ring.pal\n"
      "  palpate certify ring.pal --along config/scenes/ring.toml\n"
      "  palpate certify mallet.pal --ticks 10000000 --seed 7 -o mallet.pal");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "certify", [&](Json& json) { return run_certify_ticks(*options, json); });
  });
}

}  // namespace palpate
