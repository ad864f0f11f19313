// Patches of the displacement-angle interpolation: which three anchors a surface vertex lies between.
#pragma once

#include <vector>

#include "config/body/anchors.h"

namespace palpate {

// The anchors' directions from `centre_m` are triangulated by their convex hull; a vertex belongs to the triangle its
// own direction meets, with the barycentric weights of that point (sum 1, none negative). Directions no triangle
// covers (anchors on one side only) get the three nearest anchors weighted by inverse distance. Needs 3 anchors.
std::vector<PatchWeight> make_patches(const std::vector<Vec3>& vertex_m, const std::vector<AnchorPoint>& anchors,
                                      Vec3 centre_m);

}  // namespace palpate
