// `palpate bake`: from a scene description to the image the controller maps; or shows an image or the schema.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "config/bake/compile.h"
#include "sim_host/bake/image_dump.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/cli.h"

namespace palpate {

namespace {

struct BakeOptions {
  std::string scene, output, dump;
  SceneOverlays overlays;
  bool report = false, schema = false;
  unsigned jobs = 0;
};

int dump_image(const std::string& path) {
  const ImageFile image(path);
  fmt::print("{}", image_dump(*reinterpret_cast<const ImageHeader*>(image.bytes().data()), image.model()));
  return kExitOk;
}

int bake(const BakeOptions& options) {
  const std::string output =
      options.output.empty() ? std::filesystem::path(options.scene).stem().string() + ".pal" : options.output;
  const BakeRun run{isatty(STDERR_FILENO) != 0 ? progress_bar(stderr) : Progress{}, options.jobs};
  const CompileResult result = compile_scene(load_scene(options.scene, options.overlays), run);
  std::string error;
  if (!save_image(output, result.bytes, error)) throw std::runtime_error(output + ": " + error);
  if (options.report) fmt::print("{}", report_text(result.report));
  if (!options.report) {
    for (const std::string& line : result.report.model) fmt::print("model   {}\n", line);
    for (const std::string& warning : result.report.warnings) fmt::print(stderr, "warning: {}\n", warning);
  }
  fmt::print("baked   {} -> {} ({} triangles, {} bytes)\n", options.scene, output, result.report.triangles,
             result.bytes.size());
  return kExitOk;
}

int run_bake(const BakeOptions& options) {
  if (options.schema) {
    fmt::print("{}", schema_markdown());
    return kExitOk;
  }
  if (!options.dump.empty()) return dump_image(options.dump);
  if (options.scene.empty()) throw std::runtime_error("bake: name a scene, --dump IMAGE or --schema (see --help)");
  return bake(options);
}

}  // namespace

void add_bake_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* command = app.add_subcommand("bake", "Compile a scene into the image that the controller runs");
  auto* scene = command->add_option("SCENE", options->scene, "scene file (.toml)");
  command->add_option("-o,--output", options->output, "image to write; default: the scene's name with .pal, here")
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
  auto* dump = command->add_option("--dump", options->dump, "print the contents of an image instead")->excludes(scene);
  command->add_flag("--schema", options->schema, "print all keys of a scene file, as Markdown, instead")
      ->excludes(scene)
      ->excludes(dump);
  command->footer(
      "Examples:\n"
      "  palpate bake config/scenes/ellipsoid_mallet.toml -o mallet.pal --report\n"
      "  palpate bake config/scenes/tools_on_cylinder.toml --with config/scenes/tools/cone_45.toml -o cone.pal\n"
      "  palpate bake config/scenes/tools_on_cylinder.toml --set body.material.youngs_modulus_Pa=1e6\n"
      "  palpate bake --dump mallet.pal\n"
      "  palpate bake --schema > scene_keys.md");
  command->callback([options, &exit_code] { exit_code = run_bake(*options); });
}

}  // namespace palpate
