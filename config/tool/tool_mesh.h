// Tool pieces from meshes: each becomes the convex hulls that make it up.
#pragma once

#include "config/scene/scene.h"

namespace palpate {

// Most corners of a hull.
inline constexpr std::size_t kMostHullCorners = 64;

// Replaces every piece of shape "mesh" by hulls: one where the mesh is convex, else those into which the program
// palpate-mesh cuts it. The first takes the piece's place, the others go to the end of the list. Throws ConfigError for
// meshes that are not one closed surface, too many parts or corners, and where the program is missing.
void cut_tool_meshes(SceneDesc& scene);

}  // namespace palpate
