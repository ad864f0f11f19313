#include "config/body/support_rim.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "config/body/body_card.h"
#include "config/body/edge_cut.h"
#include "config/body/supports.h"
#include "config/index.h"

namespace palpate {

namespace {

// Shares of an edge, from its held corner: a rim nearer to a corner than the first is at it; nearer than the second
// takes a corner there instead of cutting slivers off.
constexpr double kAtCorner = 0.02, kMoves = 0.35;
constexpr double kLeastArea = 0.2;  // of a facet, after one of its corners was moved
constexpr int kBisections = 40;     // 1e-12 of an edge
constexpr double kSmoothCos = 0.8;  // between neighbouring facets: corners of sharper edges stay where they are
// Shares of an edge between free corners where it is asked whether it goes through the region. With no corner on such
// an edge, the facets beside it were cut to and fro ever nearer to it without an end (2026-11-28).
constexpr int kLooks = 8;
// What is cut no more: edges so short, of the mean, and those of facets so low over them. As what is cut leaves parts
// of a fiftieth at least, cutting ends whatever the region.
constexpr double kShortest = 0.02, kLowest = 1e-3;

// The rim of regions that hold the same components.
class Rim {
 public:
  using Inside = std::function<bool(Vec3)>;
  Rim(Inside inside, SurfaceMesh& mesh) : inside_(std::move(inside)), mesh_(mesh) {
    const auto sides = triangles_at_edges(mesh);
    for (const auto& [edge, triangles] : sides)
      shortest_m_ += kShortest * length_m(edge) / static_cast<double>(sides.size());
  }

  void lay() {
    move_corners();
    while (cut_edges()) {
    }
  }

 private:
  struct Crossing {
    double share = 0;  // of the edge, from its held end
    Vec3 point_m;      // held
  };
  // Between a held and a free corner.
  Crossing crossing(std::int32_t held, std::int32_t free) const {
    return crossing(mesh_.vertex_m[at(held)], mesh_.vertex_m[at(free)], 0);
  }
  // From a to b beyond the share `from`, where it is held.
  Crossing crossing(Vec3 a, Vec3 b, double from) const {
    Crossing out{from, a + from * (b - a)};
    double end = 1;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (out.share + end);
      const Vec3 p = a + middle * (b - a);
      if (inside_(p)) {
        out = {middle, p};
      } else {
        end = middle;
      }
    }
    return out;
  }
  bool is_held(std::int32_t v) const { return inside_(mesh_.vertex_m[at(v)]); }

  // Each corner by the least move that takes it to the rim, if that is a short one.
  void move_corners() {
    const std::vector<char> is_sharp = sharp_corners();
    std::map<std::int32_t, Crossing> best;
    const auto offer = [&](std::int32_t v, double share, Vec3 point_m) {
      if (is_sharp[at(v)] != 0 || share > kMoves) return;
      const auto [entry, is_new] = best.try_emplace(v, Crossing{share, point_m});
      if (!is_new && share < entry->second.share) entry->second = {share, point_m};
    };
    for (const Corners& t : mesh_.triangle)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = t[k], b = t[(k + 1) % 3];
        if (!is_held(a) || is_held(b)) continue;
        const Crossing at_rim = crossing(a, b);
        offer(a, at_rim.share, at_rim.point_m);
        offer(b, 1 - at_rim.share, at_rim.point_m);
      }
    const std::vector<std::vector<std::size_t>> facets = facets_of_corners();
    for (const auto& [v, to] : best) move(v, to.point_m, facets[at(v)]);
  }
  // Unless a facet would turn over, or nearly.
  void move(std::int32_t v, Vec3 to, const std::vector<std::size_t>& facets) {
    std::vector<Vec3> before;
    for (const std::size_t t : facets) before.push_back(triangle_cross(mesh_, t));
    const Vec3 from = mesh_.vertex_m[at(v)];
    mesh_.vertex_m[at(v)] = to;
    for (std::size_t i = 0; i < facets.size(); ++i)
      if (dot(triangle_cross(mesh_, facets[i]), before[i]) < kLeastArea * squared_norm(before[i])) {
        mesh_.vertex_m[at(v)] = from;
        return;
      }
  }
  std::vector<std::vector<std::size_t>> facets_of_corners() const {
    std::vector<std::vector<std::size_t>> facets(mesh_.vertex_m.size());
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t)
      for (const std::int32_t v : mesh_.triangle[t]) facets[at(v)].push_back(t);
    return facets;
  }

  std::vector<char> sharp_corners() const {
    std::vector<char> is_sharp(mesh_.vertex_m.size());
    const std::vector<Corners> across = triangle_adjacency(mesh_);
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        if (across[t][k] < 0) continue;
        const Vec3 a = triangle_cross(mesh_, t), b = triangle_cross(mesh_, at(across[t][k]));
        if (dot(a, b) >= kSmoothCos * norm(a) * norm(b)) continue;
        is_sharp[at(mesh_.triangle[t][k])] = is_sharp[at(mesh_.triangle[t][(k + 1) % 3])] = 1;
      }
    return is_sharp;
  }

  double length_m(MeshEdge edge) const {
    return norm(mesh_.vertex_m[at(edge.second)] - mesh_.vertex_m[at(edge.first)]);
  }
  // Where the edge leaves the region, unless that is at one of its corners.
  std::optional<Crossing> leaves(MeshEdge edge) const {
    const Vec3 a = mesh_.vertex_m[at(edge.first)], b = mesh_.vertex_m[at(edge.second)];
    const bool first = inside_(a), second = inside_(b);
    if (first && second) return std::nullopt;
    if (first || second) {
      const Crossing rim = first ? crossing(a, b, 0) : crossing(b, a, 0);
      return rim.share < kAtCorner || rim.share > 1 - kAtCorner ? std::nullopt : std::optional(rim);
    }
    for (int i = 1; i < kLooks; ++i) {
      const double share = static_cast<double>(i) / kLooks;
      if (inside_(a + share * (b - a))) return crossing(a, b, share);
    }
    return std::nullopt;
  }
  bool is_worth_cutting(MeshEdge edge, const std::vector<std::size_t>& triangles) const {
    const double length = length_m(edge);
    return length > shortest_m_ && std::ranges::all_of(triangles, [&](std::size_t t) {
             return norm(triangle_cross(mesh_, t)) > kLowest * length * length;
           });
  }

  // At most one cut a triangle; whether any was made. Every cut takes a crossing away: the new corner is at the rim.
  bool cut_edges() {
    const auto sides = triangles_at_edges(mesh_);
    std::vector<char> is_cut(mesh_.triangle.size());
    bool any = false;
    for (const auto& [edge, triangles] : sides) {
      if (std::ranges::any_of(triangles, [&](std::size_t t) { return is_cut[t] != 0; })) continue;  // the next time
      const std::optional<Crossing> rim = leaves(edge);
      if (!rim || !is_worth_cutting(edge, triangles)) continue;
      any = true;
      for (const std::size_t t : triangles) is_cut[t] = 1;
      cut_edge(mesh_, edge, triangles, rim->point_m);
    }
    return any;
  }

  Inside inside_;
  SurfaceMesh& mesh_;
  double shortest_m_ = 0;
};

}  // namespace

void lay_support_rims(const SceneDesc& scene, SurfaceMesh& mesh) {
  if (card_of(scene.body.shape).supports != nullptr) return;  // its supports are not regions
  const std::vector<FixedDesc> regions = held_regions(scene);
  // Rims of what is held alike are laid as one.
  const auto alike = [](const FixedDesc& a, const FixedDesc& b) {
    return a.holds == b.holds && (a.stiffness_N_per_m3 == b.stiffness_N_per_m3 ||
                                  (is_auto(a.stiffness_N_per_m3) && is_auto(b.stiffness_N_per_m3)));
  };
  std::vector<std::function<bool(Vec3)>> has;
  for (std::size_t i = 0; i < regions.size(); ++i) has.push_back(region_on(scene, i, mesh));
  std::vector<FixedDesc> laid;
  for (const FixedDesc& one : regions) {
    if (std::ranges::any_of(laid, [&](const FixedDesc& other) { return alike(one, other); })) continue;
    laid.push_back(one);
    const auto inside = [&](Vec3 x) {
      for (std::size_t i = 0; i < regions.size(); ++i)
        if (alike(regions[i], one) && has[i](x)) return true;
      return false;
    };
    Rim(inside, mesh).lay();
  }
}

}  // namespace palpate
