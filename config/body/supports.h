// What holds a body: the entries of body.fixed, together. Without any, the base of FixedDesc's default.
#pragma once

#include <string>

#include "config/fem/material.h"
#include "config/scene/scene.h"

namespace palpate {

// The regions that hold the body: the scene's, or the default base.
std::vector<FixedDesc> held_regions(const SceneDesc& scene);

// Whether an entry's region has point `x_w` of a body whose lowest point is at `lowest_m`.
bool in_region(const FixedDesc& entry, Vec3 x_w, double lowest_m);
// The same for all entries of the scene, whatever components they hold.
bool is_fixed(const SceneDesc& scene, Vec3 x_w, double lowest_m);

// Height of the base, for what knows only bodies that stand on it where their shape is made. Throws ConfigError for
// others, naming `who`.
double standing_base_m(const SceneDesc& scene, const std::string& who);

// What of the mesh is held: as the body's shape says, or by the scene's entries. Throws ConfigError when an entry holds
// no node, or when nothing is left to move; whether the body can still move as a whole is check_supports' to say.
Supports supports_of(const SceneDesc& scene, const TetMesh& mesh);

}  // namespace palpate
