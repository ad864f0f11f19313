#include "config/bake/facet_foot.h"

#include <algorithm>

#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

constexpr double kPlace[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
constexpr std::size_t kPart[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};

// A quadratic facet as the four triangles between its nodes, and a ball about them.
struct Patch {
  Vec3 corner[4][3];
  Vec3 centre;
  double radius_m = 0;
};
Patch patch_of(const elastic::Surface<3>& surface, const elastic::Surface<3>::Facet& facet) {
  Patch patch;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) patch.corner[i][k] = elastic::vec(surface.rest(facet.nodes[kPart[i][k]]));
  patch.centre = (1.0 / 3) * (patch.corner[3][0] + patch.corner[3][1] + patch.corner[3][2]);
  for (const auto& part : patch.corner)
    for (const Vec3 p : part) patch.radius_m = std::max(patch.radius_m, norm(p - patch.centre));
  return patch;
}

class FacetFinder {
 public:
  explicit FacetFinder(const elastic::Surface<3>& surface) : surface_(surface) {
    for (const auto& facet : surface.facets()) patch_.push_back(patch_of(surface, facet));
  }

  // The first of the nearest. Places that follow one another lie close together: nothing farther than the last one's
  // facet is looked at, a little more for what rounding makes of a patch's ball.
  FacetFoot find(Vec3 p) {
    double best = kHuge;
    const double enough = 1.001 * distance_to(patch_[last_], p);
    elastic::FacetPlace place;
    for (std::size_t f = 0; f < patch_.size(); ++f) {
      const double within = std::min(best, enough) + 1.001 * patch_[f].radius_m;
      if (squared_norm(patch_[f].centre - p) > within * within) continue;
      for (std::size_t part = 0; part < 4; ++part) {
        const Vec3(&corner)[3] = patch_[f].corner[part];
        const Vec3 q = closest_on_triangle(p, corner[0], corner[1], corner[2]).point;
        const double distance = norm(q - p);
        if (!(distance < best)) continue;
        best = distance;
        last_ = f;
        place = place_in(corner, kPart[part], q);
      }
    }
    return {surface_.facets()[last_].nodes, elastic::facet_shape(6, place)};
  }

 private:
  static double distance_to(const Patch& patch, Vec3 p) {
    double least = kHuge;
    for (const auto& corner : patch.corner)
      least = std::min(least, norm(closest_on_triangle(p, corner[0], corner[1], corner[2]).point - p));
    return least;
  }
  static elastic::FacetPlace place_in(const Vec3 (&corner)[3], const std::size_t (&part)[3], Vec3 q) {
    const Vec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], n = cross(e1, e2);
    const double b = dot(cross(q - corner[0], e2), n) / squared_norm(n),
                 c = dot(cross(e1, q - corner[0]), n) / squared_norm(n);
    elastic::FacetPlace place;
    for (int d = 0; d < 2; ++d)
      place[d] = (1 - b - c) * kPlace[part[0]][d] + b * kPlace[part[1]][d] + c * kPlace[part[2]][d];
    return place;
  }

  const elastic::Surface<3>& surface_;
  std::vector<Patch> patch_;
  std::size_t last_ = 0;  // facet found
};

}  // namespace

std::vector<FacetFoot> facet_feet(const elastic::Surface<3>& surface, std::span<const Vec3> places) {
  FacetFinder finder(surface);
  std::vector<FacetFoot> feet;
  for (const Vec3 p : places) feet.push_back(finder.find(p));
  return feet;
}

}  // namespace palpate
