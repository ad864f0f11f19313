// Bodies whose surface touches in parts (BodyCard::part): every piece of the tool touches each part in one place.
#pragma once

#include "config/bake/image_writer.h"
#include "config/scene/scene.h"

namespace palpate {

// Gives every piece that touches one point for each part of the body's surface, which begins where the scene's path
// does, and ends the smooth surface where a part does. Nothing on bodies without parts. Throws ConfigError where the
// points are too many.
void touch_by_parts(const SceneDesc& scene, ImageContents& image);
// The triangles of the part in which that one is.
std::vector<std::int32_t> part_of(const Model& model, std::int32_t triangle);

}  // namespace palpate
