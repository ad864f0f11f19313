// The loader's checks as the baker uses them: a scene that `run` would refuse is refused when it is baked.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "config/bake/image_writer.h"
#include "config/scene/scene.h"
#include "rt_core/image.h"

namespace palpate {

// Views of what has been compiled so far; valid while `image` lives unchanged.
Model model_of(const ImageContents& image);
// A copy of an image's contents, to bake on.
ImageContents contents_of(const Model& model);

// Throws the ConfigError of the scene's key that stands behind what the loader refuses; nothing for kNone.
void refuse(const SceneDesc& scene, const ImageResult& result);

// Which hands hold what: params.held_part with its grip, and for two tools whose the pieces are.
void set_hands(const SceneDesc& scene, ImageContents& image);

// Opens the bytes as `run` would.
void check_bytes(const SceneDesc& scene, std::span<const std::byte> bytes);

}  // namespace palpate
