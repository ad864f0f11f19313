#include "config/bake/facet_foot.h"

#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

class FacetFinder {
 public:
  explicit FacetFinder(const elastic::Surface<3>& surface) : surface_(surface) {}
  FacetFoot find(Vec3 p) const {
    constexpr double kPlace[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
    constexpr std::size_t kPart[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    double best = kHuge;
    const elastic::Surface<3>::Facet* best_facet = nullptr;
    elastic::FacetPlace place;
    for (const auto& facet : surface_.facets())
      for (const auto& part : kPart) {
        Vec3 corner[3];
        for (std::size_t k = 0; k < 3; ++k) corner[k] = elastic::vec(surface_.rest(facet.nodes[part[k]]));
        const Vec3 q = closest_on_triangle(p, corner[0], corner[1], corner[2]).point;
        const double distance = norm(q - p);
        if (!(distance < best)) continue;
        best = distance;
        best_facet = &facet;
        const Vec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], n = cross(e1, e2);
        const double b = dot(cross(q - corner[0], e2), n) / squared_norm(n),
                     c = dot(cross(e1, q - corner[0]), n) / squared_norm(n);
        for (int d = 0; d < 2; ++d)
          place[d] = (1 - b - c) * kPlace[part[0]][d] + b * kPlace[part[1]][d] + c * kPlace[part[2]][d];
      }
    return {best_facet->nodes, elastic::facet_shape(6, place)};
  }

 private:
  const elastic::Surface<3>& surface_;
};

}  // namespace

std::vector<FacetFoot> facet_feet(const elastic::Surface<3>& surface, std::span<const Vec3> places) {
  const FacetFinder finder(surface);
  std::vector<FacetFoot> feet;
  for (const Vec3 p : places) feet.push_back(finder.find(p));
  return feet;
}

}  // namespace palpate
