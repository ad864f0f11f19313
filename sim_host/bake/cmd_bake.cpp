// `palpate bake`: from a scene description to the image the controller maps; or shows an image or the schema.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/bake/compile.h"
#include "sim_host/bake/bake_set.h"
#include "sim_host/bake/image_dump.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/cli.h"
#include "sim_host/json_output.h"

namespace palpate {

namespace {

struct BakeOptions {
  std::vector<std::string> scene;
  std::string output, dump, shard;
  SceneOverlays overlays;
  bool report = false, schema = false, json = false, merge = false;
  unsigned jobs = 0;
};

int dump_image(const std::string& path, Json& json) {
  const ImageFile image(path);
  const auto& header = *reinterpret_cast<const ImageHeader*>(image.bytes().data());
  json.update(image_json(header, image.model()));
  fmt::print("{}", image_dump(header, image.model()));
  return kExitOk;
}

int bake(const BakeOptions& options, Json& json) {
  const std::string& scene = options.scene.front();
  const std::string output =
      options.output.empty() ? std::filesystem::path(scene).stem().string() + ".pal" : options.output;
  const BakeRun run{isatty(STDERR_FILENO) != 0 ? progress_bar(stderr) : Progress{}, options.jobs};
  const CompileResult result = compile_scene(load_scene(scene, options.overlays), run);
  std::string error;
  if (!save_image(output, result.bytes, error)) throw std::runtime_error(output + ": " + error);
  json.update(bake_json(scene, output, result.report));
  if (options.report) fmt::print("{}", report_text(result.report));
  if (!options.report) {
    for (const std::string& line : result.report.model) fmt::print("model   {}\n", line);
    for (const std::string& warning : result.report.warnings) fmt::print(stderr, "warning: {}\n", warning);
  }
  fmt::print("baked   {} -> {} ({} triangles, {} bytes)\n", scene, output, result.report.triangles,
             result.bytes.size());
  return kExitOk;
}

// Several scenes, or parts of a set.
int bake_many(const BakeOptions& options, Json& json) {
  if (options.output.empty() || std::filesystem::is_regular_file(options.output))
    throw std::runtime_error("bake: several scenes, --shard and --merge need a folder: -o FOLDER");
  if (options.report) throw std::runtime_error("bake: --report is for one scene");
  const BakeSet set{options.scene, options.output, options.overlays, options.jobs};
  if (options.merge) return merge_shards(set, json);
  return bake_shard(set, options.shard.empty() ? Shard{} : parse_shard(options.shard), json);
}

int run_bake(const BakeOptions& options, Json& json) {
  if (options.schema) {
    fmt::print("{}", schema_markdown());
    return kExitOk;
  }
  if (!options.dump.empty()) return dump_image(options.dump, json);
  if (options.scene.empty()) throw std::runtime_error("bake: name a scene, --dump IMAGE or --schema (see --help)");
  if (options.scene.size() > 1 || !options.shard.empty() || options.merge) return bake_many(options, json);
  return bake(options, json);
}

}  // namespace

void add_bake_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* command = app.add_subcommand("bake", "Compile a scene into the image that the controller runs");
  auto* scene = command->add_option("SCENE", options->scene, "scene file (.toml); several go into a folder");
  command
      ->add_option("-o,--output", options->output,
                   "image to write; default: the scene's name with .pal, here. Of several scenes: the folder")
      ->needs(scene);
  command->add_flag("--report", options->report, "print what the scene became: mesh, anchors, law, stiffness bounds")
      ->needs(scene);
  command
      ->add_option("--with", options->overlays.file,
                   "lay a file with some of the scene's tables over it, such as another tool or material; repeatable")
      ->needs(scene);
  command->add_option("--set", options->overlays.setting, "KEY=VALUE: set one key; repeatable")->needs(scene);
  command
      ->add_option("--jobs", options->jobs,
                   "threads for check presses, which go side by side; 0: as many as there are processors. The image is "
                   "the same whatever their number")
      ->needs(scene)
      ->capture_default_str()
      ->check(CLI::Range(0U, 256U));
  auto* shard = command
                    ->add_option("--shard", options->shard,
                                 "K/N: bake the K-th of N parts of the scenes. What the folder has of this build and "
                                 "these files is kept, so an interrupted set goes on")
                    ->needs(scene);
  command
      ->add_flag("--merge", options->merge,
                 "bake nothing: say whether the folder has every scene, and write a table of all, bake.csv")
      ->needs(scene)
      ->excludes(shard);
  auto* dump = command->add_option("--dump", options->dump, "print the contents of an image instead")->excludes(scene);
  add_json_flag(*command, options->json);
  command->add_flag("--schema", options->schema, "print all keys of a scene file, as Markdown, instead")
      ->excludes(scene)
      ->excludes(dump)
      ->excludes(command->get_option("--json"));
  command->footer(
      "Examples:\n"
      "  palpate bake config/scenes/ellipsoid_mallet.toml -o mallet.pal --report\n"
      "  palpate bake config/scenes/tools_on_cylinder.toml --with config/scenes/tools/cone_45.toml -o cone.pal\n"
      "  palpate bake config/scenes/tools_on_cylinder.toml --set body.material.youngs_modulus_Pa=1e6\n"
      "  palpate bake patients/*.toml -o images\n"
      "  palpate bake patients/*.toml -o images --shard 2/8 && palpate bake patients/*.toml -o images --merge\n"
      "  palpate bake --dump mallet.pal\n"
      "  palpate bake --schema > scene_keys.md");
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "bake", [&](Json& json) { return run_bake(*options, json); });
  });
}

}  // namespace palpate
