#include "config/bake/sharp_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

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
  struct Met {
    std::array<Vec3, 2> at_ends;
    Side side;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Met> met;  // of every edge by its ends the side met first
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const std::int32_t a = triangles[i].vertex[k], b = triangles[i].vertex[next];
      const Vec3 from = vertex_m[at(a)], to = vertex_m[at(b)], third = vertex_m[at(triangles[i].vertex[(k + 2) % 3])];
      const Vec3 along = unit_or(to - from, {});
      const Vec3 inwards = third - from - dot(third - from, along) * along;
      const Side here{unit_or(normal[i].normal[k] + normal[i].normal[next], {}), unit_or(-inwards, {}),
                      dot(normal[i].normal[k], normal[i].normal[next]) > kFlat};
      std::array<Vec3, 2> at_ends{normal[i].normal[k], normal[i].normal[next]};
      if (a > b) std::swap(at_ends[0], at_ends[1]);
      const auto [other, is_first] = met.try_emplace(std::minmax(a, b), Met{at_ends, here});
      if (is_first || other->second.at_ends == at_ends || (held[at(a)] && held[at(b)])) continue;
      const Side& there = other->second.side;
      const double turn = std::acos(std::clamp(dot(here.normal, there.normal), -1.0, 1.0));
      if (!(dot(here.across, there.normal) > 0)) continue;  // hollow
      segments_.push_back({from,
                           to,
                           {here.normal, there.normal},
                           {here.across, there.across},
                           {here.is_flat, there.is_flat},
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
