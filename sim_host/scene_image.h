// From what the user named (a scene or an image) to an image file, and what a simulated device needs to know of it.
#pragma once

#include <optional>
#include <string>

#include "config/scene.h"

namespace palpate {

struct SceneImage {
  std::string image_path;          // absolute
  std::optional<SceneDesc> scene;  // known only when the user named a .toml
};

// `scene`: path of a .pal image (used as it is) or of a .toml scene, which is baked to `image`, or beside `record`, or
// into the current folder as NAME.pal. Throws std::runtime_error.
SceneImage prepare_scene(const std::string& scene, const std::string& image, const std::string& record);

// "auto" becomes can:IFACE when a CAN interface is up, else "loopback"; says which on stdout. Other names are checked.
std::string choose_device(const std::string& device);

}  // namespace palpate
