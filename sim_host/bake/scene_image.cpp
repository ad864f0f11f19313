#include "sim_host/bake/scene_image.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "config/bake/compile.h"
#include "sim_host/bake/certificate_text.h"
#include "sim_host/bake/default_path.h"
#include "sim_host/bake/image_file.h"

namespace palpate {

SceneImage prepare_scene(const std::string& scene, const std::string& image, const std::string& record,
                         const SceneOverlays& overlays) {
  const std::filesystem::path source(scene);
  if (source.extension() != ".toml") {
    if (!overlays.file.empty() || !overlays.setting.empty())
      throw std::runtime_error(scene + ": is an image, and --with and --set change a scene; name the .toml");
    return {scene, std::nullopt};
  }
  SceneImage result{image, load_scene(scene, overlays)};
  if (image.empty()) {
    result.image_path = (std::filesystem::path(record).parent_path() / source.stem()).string() + ".pal";
  }
  const CompileResult compiled = compile_scene(*result.scene);
  for (const std::string& line : compiled.report.model) fmt::print("model   {}\n", line);
  for (const std::string& warning : compiled.report.warnings) fmt::print(stderr, "warning: {}\n", warning);
  std::string error;
  if (!save_image(result.image_path, compiled.bytes, error)) throw std::runtime_error(error);
  fmt::print("baked   {} -> {}\n", scene, result.image_path);
  const ImageFile written(result.image_path);
  if (is_certified(written.bytes())) fmt::print("{}", certificate_text(written.bytes()));
  if (add_default_path(*result.scene, written.model()))
    fmt::print("        the scene has no [path]: the hand presses the body's highest point and slides along x\n");
  return result;
}

}  // namespace palpate
