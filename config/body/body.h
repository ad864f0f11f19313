// The elastic body's surface, as the scene describes it.
#pragma once

#include <string>
#include <vector>

#include "config/body/mesh.h"
#include "config/scene/scene.h"

namespace palpate {

// Made or read, and checked: closed, manifold, oriented outward. Throws ConfigError. Adds warnings.
SurfaceMesh make_body(const SceneDesc& scene, std::vector<std::string>& warnings);

}  // namespace palpate
