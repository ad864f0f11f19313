// Builds the 4-wide hierarchy the closest-point query descends. Runs when a scene is baked; may allocate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/model.h"

namespace palpate {

struct BvhBuild {
  std::vector<BvhNode> node;            // root first, children after their parent
  std::vector<Triangle> triangle;       // reordered so that each leaf is contiguous; adjacency renumbered
  std::vector<std::int32_t> old_index;  // old_index[new triangle] = its index in the input
  std::int32_t depth = 0;               // levels of inner nodes; 1 when the root's children are all leaves
  std::int32_t stack_high_water = 0;    // most traversal stack entries any descent can need: 3 * depth
};

// Surface-area-heuristic hierarchy over a closed triangle surface. Always ends: a split that makes no progress, and
// every split below level kBvhSahLevels, is by median, so depth <= kBvhSahLevels + log4(n) + 1, which fits
// kMaxTraversalStack for every mesh the image can hold. Vertex indices must be in range; adjacency may be -1 (kept;
// there are then no clearance certificates there). A million triangles take about 12 s, 10 of them for the
// certificates.
BvhBuild build_bvh(std::span<const Vec3> vertex_m, std::span<const Triangle> triangle);

inline constexpr std::int32_t kBvhSahLevels = 8;
// Fewer triangles per leaf mean tighter boxes and cones and fewer exact tests, at the price of memory.
inline constexpr std::int32_t kBvhLeafTriangles = 2;

}  // namespace palpate
