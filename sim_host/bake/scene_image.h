// From what the user named (a scene or an image) to an image file, and what a simulated device needs to know of it.
#pragma once

#include <optional>
#include <string>

#include "config/scene/scene.h"

namespace palpate {

struct SceneImage {
  std::string image_path;
  std::optional<SceneDesc> scene;  // known only when the user named a .toml
};

// `scene`: path of a .pal image (used as it is) or of a .toml scene, which is baked to `image`; when that is empty, to
// NAME.pal in the folder of `record` (the current folder when that is empty too). Throws std::runtime_error.
// `overlays` are laid over the scene; an image takes none.
SceneImage prepare_scene(const std::string& scene, const std::string& image, const std::string& record,
                         const SceneOverlays& overlays = {});

}  // namespace palpate
