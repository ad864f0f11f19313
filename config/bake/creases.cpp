#include "config/bake/creases.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "rt_core/vec.h"

namespace palpate {

std::vector<Crease> creases(std::span<const CornerNormals> normal, std::span<const Triangle> triangles) {
  const auto normals_at = [&](const Crease::Side& side) {  // at the ends, that of the smaller vertex first
    const Triangle& t = triangles[side.triangle];
    const std::size_t next = (side.corner + 1) % 3;
    std::array<Vec3, 2> out{normal[side.triangle].normal[side.corner], normal[side.triangle].normal[next]};
    if (t.vertex[side.corner] > t.vertex[next]) std::swap(out[0], out[1]);
    return out;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Crease::Side> met;  // of every edge the side met first
  std::vector<Crease> out;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t from = triangles[i].vertex[k], to = triangles[i].vertex[(k + 1) % 3];
      const std::int32_t a = std::min(from, to), b = std::max(from, to);
      const Crease::Side here{i, k};
      const auto [first, is_first] = met.try_emplace({a, b}, here);
      if (is_first || normals_at(first->second) == normals_at(here)) continue;
      out.push_back({{a, b}, {first->second, here}});
    }
  return out;
}

}  // namespace palpate
