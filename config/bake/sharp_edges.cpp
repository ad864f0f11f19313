#include "config/bake/sharp_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/bake/creases.h"
#include "config/index.h"
#include "rt_core/vec.h"

namespace palpate {

namespace {

constexpr double kSameFace = 0.6, kOneOfBoth = 0.2;  // on an edge the vertices' normals are between its faces
constexpr double kAcross = 0.9;
constexpr double kOpposite = 0.5, kCorner = 0.5;
// Of the edge's length: on it. A round rim's nodes lie off its chords.
constexpr double kOnEdge = 0.1;

constexpr double kFlat = 1 - 1e-4;  // cosine of the turn from end to end: 0.8 degrees

struct Side {
  Vec3 normal, across;  // unit; `across`: in the face, away from it
  bool is_flat;
};

Vec3 nearest_on(Vec3 from, Vec3 to, Vec3 p) {
  const Vec3 edge = to - from;
  const double along = dot(p - from, edge) / std::max(squared_norm(edge), 1e-300);
  return from + std::clamp(along, 0.0, 1.0) * edge;
}

}  // namespace

SharpEdges::SharpEdges(std::span<const Vec3> vertex_m, std::span<const CornerNormals> normal,
                       std::span<const Triangle> triangles, const std::vector<bool>& held) {
  const auto face = [&](const Crease::Side& side) {
    const CornerNormals& n = normal[side.triangle];
    const auto corner = [&](std::size_t k) {
      return vertex_m[at(triangles[side.triangle].vertex[(side.corner + k) % 3])];
    };
    const Vec3 along = unit_or(corner(1) - corner(0), {}), third = corner(2) - corner(0);
    const std::size_t next = (side.corner + 1) % 3;
    return Side{unit_or(n.normal[side.corner] + n.normal[next], {}), unit_or(-(third - dot(third, along) * along), {}),
                dot(n.normal[side.corner], n.normal[next]) > kFlat};
  };
  for (const Crease& crease : creases(normal, triangles)) {
    if (held[at(crease.vertex[0])] && held[at(crease.vertex[1])]) continue;
    const Side one = face(crease.side[1]), other = face(crease.side[0]);
    if (!(dot(one.across, other.normal) > 0)) continue;  // hollow
    const Triangle& t = triangles[crease.side[1].triangle];
    const std::size_t k = crease.side[1].corner;
    const Vec3 from = vertex_m[at(t.vertex[k])], to = vertex_m[at(t.vertex[(k + 1) % 3])];
    const double turn = std::acos(std::clamp(dot(one.normal, other.normal), -1.0, 1.0));
    segments_.push_back({from,
                         to,
                         {one.normal, other.normal},
                         {one.across, other.across},
                         {one.is_flat, other.is_flat},
                         std::numbers::pi - turn,
                         0.5 * (from.x + to.x)});
    longest_m_ = std::max(longest_m_, norm(to - from));
  }
  std::ranges::sort(segments_, {}, &Segment::middle_x_m);
}

std::optional<elastic::SharpEdge> SharpEdges::about(Vec3 place_m, Vec3 outward, double within_m,
                                                    double narrow_m) const {
  struct Found {
    elastic::SharpEdge edge;
    Vec3 out;  // across it
  };
  std::vector<Found> found;
  bool is_corner = false;
  Vec3 meets;
  const double look_m = std::max(within_m, narrow_m), reach = look_m + 0.5 * longest_m_;
  const auto first = std::ranges::lower_bound(segments_, place_m.x - reach, {}, &Segment::middle_x_m);
  for (auto s = first; s != segments_.end() && s->middle_x_m <= place_m.x + reach; ++s) {
    const Vec3 to_edge = nearest_on(s->from_m, s->to_m, place_m) - place_m;
    const double distance = norm(to_edge), length = norm(s->to_m - s->from_m);
    if (distance > look_m) continue;
    const bool is_on_it = distance <= kOnEdge * length;
    if (is_on_it) {
      const Vec3 along = (1 / length) * (s->to_m - s->from_m);
      is_corner = is_corner || (norm(meets) > 0 && std::abs(dot(meets, along)) < kCorner);
      meets = along;
    }
    for (int side = 0; side < 2; ++side) {
      if (!s->is_flat[side] || dot(s->normal[side], outward) < (is_on_it ? kOneOfBoth : kSameFace)) continue;
      if (!is_on_it && dot(to_edge, s->out[side]) < kAcross * distance) continue;
      found.push_back({{is_on_it ? 0 : distance, s->opening_rad, length}, s->out[side]});
    }
  }
  const auto nearest = std::ranges::min_element(found, {}, [](const Found& f) { return f.edge.distance_m; });
  if (nearest == found.end() || nearest->edge.distance_m > within_m) return {};
  const auto is_opposite = [&](const Found& f) {
    return dot(f.out, nearest->out) < -kOpposite && f.edge.distance_m + nearest->edge.distance_m <= narrow_m;
  };
  if (std::ranges::any_of(found, is_opposite)) return {};
  nearest->edge.is_corner = is_corner;
  return nearest->edge;
}

}  // namespace palpate
