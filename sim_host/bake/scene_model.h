// A model to work on, from whatever the user named: a scene (.toml), compiled in memory, or a baked image (.pal).
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/bake/opened_image.h"
#include "config/scene/scene.h"
#include "sim_host/bake/image_file.h"

namespace palpate {

class SceneModel {
 public:
  // Throws ConfigError or std::runtime_error, naming the file and what is wrong with it. Overlays are for a .toml only.
  explicit SceneModel(const std::string& path, const SceneOverlays& overlays = {});
  explicit SceneModel(const SceneDesc& scene);
  const Model& model() const { return file_ ? file_->model() : opened_->model(); }
  // The whole image.
  std::span<const std::byte> bytes() const;
  // The description, known only for a .toml.
  const std::optional<SceneDesc>& scene() const { return scene_; }

 private:
  void compile();
  std::optional<SceneDesc> scene_;
  std::unique_ptr<ImageFile> file_;      // one of
  std::unique_ptr<OpenedImage> opened_;  // the two
};

}  // namespace palpate
