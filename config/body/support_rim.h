// The rim of what is held, as edges of the surface. Nodes are held or not: where a region ends within an element, the
// body is held somewhere between two rows of nodes, and a column whose clamp is half an edge off is wrong by three
// times that share of its length.
#pragma once

#include "config/body/mesh.h"
#include "config/scene/scene.h"

namespace palpate {

// Moves corners and cuts edges of the surface where the regions of body.fixed end, so that each rim runs along edges.
// New corners lie on the facets, just within their region.
void lay_support_rims(const SceneDesc& scene, SurfaceMesh& mesh);

}  // namespace palpate
