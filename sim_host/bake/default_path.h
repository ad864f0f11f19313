// What the simulated hand does in a scene that does not say: it lowers the tool on the middle of the body's top,
// presses, slides along x and lifts. So that a first scene of one's own can be pressed and run before its motion is
// written.
#pragma once

#include "config/scene/scene.h"
#include "rt_core/model.h"

namespace palpate {

// Gives `scene`, baked as `model`, that motion if it has none; true when it did. Rigid tools only: how fingers close is
// the scene's to say.
bool add_default_path(SceneDesc& scene, const Model& model);
// That motion for an image, which holds none. Throws std::runtime_error for a tool with joints.
PathDesc path_of_image(const Model& model);

}  // namespace palpate
