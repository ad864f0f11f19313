// Rules between the keys that say what hands hold and how they move. Called by check_scene().
#pragma once

#include "config/scene/scene.h"

namespace palpate {

// [device] and whose the tool's pieces are. Throws ConfigError.
void check_hands(const SceneDesc& scene);
// [path]. Throws ConfigError.
void check_paths(const SceneDesc& scene);

}  // namespace palpate
