// At which nodes of its surface an elastic body's self terms are taken.
#pragma once

#include <vector>

#include "config/bake/sharp_edges.h"
#include "config/elastic/surface.h"

namespace palpate {

// Samples on another face say nothing about this one: cosine of their outlooks.
inline constexpr double kFacing = 0.5;

// Free surface nodes at least `spacing_m` and an element's edge apart, the first ones that are. Those nearer to a sharp
// edge than `reach_m`, whose patches the edge cuts, only far from all others; on an edge last (narrow faces excepted,
// SharpEdges::about). `fixed`: of every node's components.
std::vector<int> sample_nodes(const elastic::Surface<3>& surface, const std::vector<bool>& fixed, double spacing_m,
                              const SharpEdges& edges, double reach_m, double narrow_m);

}  // namespace palpate
