// The options by which a command changes a scene before it is baked.
#pragma once

#include <CLI/CLI.hpp>

#include "config/scene/scene.h"

namespace palpate {

inline void add_overlay_options(CLI::App& command, SceneOverlays& overlays) {
  command.add_option("--with", overlays.file, "lay a file with some of the scene's tables over it; repeatable");
  command.add_option("--set", overlays.setting, "KEY=VALUE: set one key of the scene; repeatable");
}

}  // namespace palpate
