#include "config/beams/section_curve.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

constexpr int kSamples = 12;

// Points on or near the plane count as above it: a vertex is never cut, so every triangle is cut in two edges or none.
bool is_above(const Model& surface, std::int32_t vertex, Vec3 origin, Vec3 normal) {
  return dot(surface.vertex_m[static_cast<std::size_t>(vertex)] - origin, normal) >= -1e-12;
}

struct Cut {
  bool through[3];  // edge k joins vertices on both sides
};
Cut cut_of(const Model& surface, std::int32_t triangle, Vec3 origin, Vec3 normal) {
  const Triangle& t = surface.triangle[static_cast<std::size_t>(triangle)];
  bool above[3];
  for (int k = 0; k < 3; ++k) above[k] = is_above(surface, t.vertex[k], origin, normal);
  return {{above[0] != above[1], above[1] != above[2], above[2] != above[0]}};
}

Vec3 crossing(const Model& surface, std::int32_t triangle, int edge, Vec3 origin, Vec3 normal) {
  const Triangle& t = surface.triangle[static_cast<std::size_t>(triangle)];
  std::int32_t i = t.vertex[edge], j = t.vertex[(edge + 1) % 3];
  if (i > j) std::swap(i, j);  // the same bits from both sides of the edge
  const Vec3 p = surface.vertex_m[static_cast<std::size_t>(i)], q = surface.vertex_m[static_cast<std::size_t>(j)];
  const double dp = dot(p - origin, normal), dq = dot(q - origin, normal);
  const double fraction = dp == dq ? 0.5 : std::clamp(dp / (dp - dq), 0.0, 1.0);
  return p + fraction * (q - p);
}

// A triangle around `vertex` that the plane cuts, or -1.
std::int32_t cut_at_vertex(const Model& surface, std::int32_t first, std::int32_t vertex, Vec3 origin, Vec3 normal) {
  std::int32_t triangle = first;
  for (int turn = 0; turn < 64; ++turn) {
    const Cut cut = cut_of(surface, triangle, origin, normal);
    if (cut.through[0] || cut.through[1] || cut.through[2]) return triangle;
    const Triangle& t = surface.triangle[static_cast<std::size_t>(triangle)];
    const int k = t.vertex[0] == vertex ? 0 : t.vertex[1] == vertex ? 1 : 2;
    triangle = t.adjacent[k];
    if (triangle == first || triangle < 0) break;
  }
  return -1;
}

// Walks along a loop: arc length parameter and interpolation.
class LoopRuler {
 public:
  explicit LoopRuler(const std::vector<Vec3>& point) : point_(point) {
    at_.push_back(0);
    for (std::size_t i = 0; i < point.size(); ++i)
      at_.push_back(at_.back() + norm(point[(i + 1) % point.size()] - point[i]));
  }
  double length() const { return at_.back(); }
  double at(std::size_t i) const { return at_[i]; }
  Vec3 operator()(double s) const {
    s = std::fmod(std::fmod(s, length()) + length(), length());
    const auto next = std::upper_bound(at_.begin(), at_.end(), s);
    const auto i = std::min(static_cast<std::size_t>(next - at_.begin()) - 1, point_.size() - 1);
    const double span = at_[i + 1] - at_[i];
    const double f = span > 0 ? (s - at_[i]) / span : 0;
    return point_[i] + f * (point_[(i + 1) % point_.size()] - point_[i]);
  }

 private:
  const std::vector<Vec3>& point_;
  std::vector<double> at_;
};

// Arc length of the loop's point nearest to p, and the distance.
std::pair<double, double> nearest_on(const SectionLoop& loop, const LoopRuler& ruler, Vec3 p) {
  double best = kHuge, at = 0;
  for (std::size_t i = 0; i < loop.point.size(); ++i) {
    const Vec3 a = loop.point[i], d = loop.point[(i + 1) % loop.point.size()] - a;
    const double length2 = squared_norm(d);
    const double f = length2 > 0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0;
    const double distance = norm(p - (a + f * d));
    if (distance < best) {
      best = distance;
      at = ruler.at(i) + f * std::sqrt(length2);
    }
  }
  return {at, best};
}

}  // namespace

SectionLoop trace_section(const Model& surface, const std::vector<std::int32_t>& first_triangle, std::int32_t vertex,
                          Vec3 normal) {
  SectionLoop loop;
  const Vec3 origin = surface.vertex_m[static_cast<std::size_t>(vertex)];
  const std::int32_t first =
      cut_at_vertex(surface, first_triangle[static_cast<std::size_t>(vertex)], vertex, origin, normal);
  if (first < 0) return loop;
  std::int32_t triangle = first;
  int entered = -1;
  for (std::size_t steps = 0; steps < surface.triangle.size(); ++steps) {
    const Cut cut = cut_of(surface, triangle, origin, normal);
    int leave = -1;
    for (int k = 0; k < 3; ++k)
      if (cut.through[k] && k != entered) leave = k;
    if (leave < 0) return {};
    loop.point.push_back(crossing(surface, triangle, leave, origin, normal));
    const std::int32_t next = surface.triangle[static_cast<std::size_t>(triangle)].adjacent[leave];
    if (next < 0) return {};
    const Triangle& n = surface.triangle[static_cast<std::size_t>(next)];
    for (int k = 0; k < 3; ++k)
      if (n.adjacent[k] == triangle) entered = k;
    triangle = next;
    if (triangle == first) break;
  }
  double nearest = kHuge;
  for (std::size_t i = 0; i < loop.point.size(); ++i) {
    const double d = squared_norm(loop.point[i] - origin);
    if (d < nearest) {
      nearest = d;
      loop.start = i;
    }
  }
  return loop;
}

SectionCurves curves_between(const SectionLoop& loop, Vec3 to, double spacing_m, double tolerance_m, Vec3 normal,
                             Vec3 outward) {
  SectionCurves curves;
  if (loop.point.size() < 4) return curves;
  const LoopRuler ruler(loop.point);
  const auto [end, gap] = nearest_on(loop, ruler, to);
  curves.reaches = gap <= tolerance_m;
  if (!curves.reaches) return curves;
  const double start = ruler.at(loop.start);
  // Which way the loop turns when it is followed with the body to one side.
  const Vec3 ahead = ruler(start + spacing_m) - ruler(start - spacing_m);
  const double sense = dot(cross(ahead, normal), outward) >= 0 ? 1 : -1;
  for (int way = 0; way < 2; ++way) {
    SectionCurve& curve = curves.way[way];
    double length = way == 0 ? end - start : start - end;
    if (length < 0) length += ruler.length();
    curve.length_m = length;
    const double step = std::max(spacing_m, length / kSamples);
    const double direction = way == 0 ? 1 : -1;
    curve.least_curvature_per_m = kHuge;
    for (int i = 0; i <= kSamples; ++i) {
      const double s = start + direction * length * i / kSamples;
      const Vec3 a = ruler(s - step), b = ruler(s), c = ruler(s + step);
      const double product = norm(b - a) * norm(c - b) * norm(c - a);
      const double k = product > 0 ? sense * 2 * dot(cross(b - a, c - b), normal) / product : 0;
      curve.least_curvature_per_m = std::min(curve.least_curvature_per_m, k);
      if (i == 0) curve.start_curvature_per_m = k;
      if (i == kSamples) curve.end_curvature_per_m = k;
    }
    curve.middle_m = ruler(start + direction * 0.5 * length);
  }
  return curves;
}

}  // namespace palpate
