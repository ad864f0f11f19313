#include "sim_host/bake/scene_model.h"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

#include "config/bake/compile.h"
#include "config/scene/progress.h"
#include "rt_core/image.h"
#include "sim_host/bake/default_path.h"

namespace palpate {

SceneModel::SceneModel(const std::string& path, const SceneOverlays& overlays) {
  if (!path.ends_with(".toml")) {
    if (!overlays.file.empty() || !overlays.setting.empty())
      throw std::runtime_error(path + ": --with and --set change a scene (.toml), and this is a baked image");
    file_ = std::make_unique<ImageFile>(path);
    return;
  }
  scene_ = load_scene(path, overlays);
  if (!scene_->default_model.empty()) fmt::print(stderr, "model   {}\n", scene_->default_model);
  compile();
}

SceneModel::SceneModel(const SceneDesc& scene) : scene_(scene) { compile(); }

std::span<const std::byte> SceneModel::bytes() const { return file_ ? file_->bytes() : opened_->bytes(); }

void SceneModel::compile() {
  // Presses by elements take a minute: palpate bake does them once.
  const BakeRun run{isatty(STDERR_FILENO) != 0 ? progress_bar(stderr) : Progress{}};
  opened_ = std::make_unique<OpenedImage>(compile_scene(*scene_, run).bytes);
  const ImageResult& result = opened_->result();
  if (result.error != ImageError::kNone) {
    throw std::runtime_error(fmt::format("{}: the compiled scene fails its own check: {}: {}", scene_->name,
                                         result.field, describe(result.error)));
  }
  add_default_path(*scene_, opened_->model());
}

}  // namespace palpate
