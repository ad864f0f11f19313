// Where the regions of body.fixed end inside the body. Nodes are held or not: between a held and a free row of them the
// clamp ends somewhere, half an edge off on average, and under a place pressed above it that is a share of what gives.
#pragma once

#include <functional>
#include <vector>

#include "config/scene/scene.h"
#include "rt_core/model.h"

namespace palpate {

// Nodes that the elements shall have there: on the regions' borders inside the body of surface `body`, about
// `spacing_m(place)` apart from one another and no nearer than half of it to the surface, which has corners of its own
// at their rims (support_rim.h). Nothing where what is held is of the surface alone. `lowest_m`: of the nodes to be,
// from where a base's height counts.
std::vector<Vec3> support_walls(const SceneDesc& scene, const Model& body, double lowest_m,
                                const std::function<double(Vec3)>& spacing_m);

}  // namespace palpate
