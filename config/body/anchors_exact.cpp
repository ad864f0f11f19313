// Exact anchors of parametric shapes.
#include <algorithm>
#include <cmath>

#include "config/body/body_card.h"

namespace palpate {

// On an ellipsoid the Gaussian curvature 1/(a^2 b^2 c^2 Q^2), Q = x^2/a^4 + y^2/b^4 + z^2/c^4, is critical exactly at
// the ends of the axes. Spheroids have a critical circle, of which four points are kept, and spheres are constant: the
// same six points.
std::vector<AnchorPoint> axis_end_anchors(Vec3 half) {
  std::vector<AnchorPoint> anchors;
  const Vec3 centre{0, half.y, 0};
  const Vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double length[3] = {half.x, half.y, half.z};
  for (std::size_t a = 0; a < 3; ++a)
    for (const double s : {1.0, -1.0}) anchors.push_back({centre + (s * length[a]) * axis[a], s * axis[a], length[a]});
  return anchors;
}

// Four points of a circle about the y axis; `slope` is the outward normal (radial, axial) of the profile.
static void add_circle(std::vector<AnchorPoint>& anchors, double radius, double height, double slope_r,
                       double slope_h) {
  const Vec3 direction[4] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
  for (const Vec3& d : direction)
    anchors.push_back({radius * d + Vec3{0, height, 0}, unit_or(slope_r * d + Vec3{0, slope_h, 0}, d), radius});
}

std::vector<AnchorPoint> box_corner_anchors(Vec3 size) {
  std::vector<AnchorPoint> anchors;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5})
        anchors.push_back({{x * size.x, (y + 0.5) * size.y, z * size.z}, unit_or({x, y, z}, {}), norm(size)});
  return anchors;
}

// Signed curvature at the inner points of a polyline, by the circle through three neighbours.
static std::vector<double> polyline_curvature(const std::vector<ProfilePoint>& p) {
  std::vector<double> k(p.size(), 0.0);
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const double ur = p[i].radius_m - p[i - 1].radius_m, uh = p[i].height_m - p[i - 1].height_m;
    const double vr = p[i + 1].radius_m - p[i].radius_m, vh = p[i + 1].height_m - p[i].height_m;
    const double chord = std::hypot(ur + vr, uh + vh);
    k[i] = 2 * (ur * vh - uh * vr) / (std::hypot(ur, uh) * std::hypot(vr, vh) * chord);
  }
  if (p.size() > 2) {
    k.front() = k[1];
    k.back() = k[p.size() - 2];
  }
  return k;
}

// Extrema of `f` that stand out by `least` from the last opposite one, and its changes of sign; indices, increasing.
static std::vector<std::size_t> notable(const std::vector<double>& f, double least) {
  std::vector<std::size_t> found;
  std::size_t high = 0, low = 0;
  int direction = 0;  // 1: looking for a maximum, -1: for a minimum, 0: either
  for (std::size_t i = 1; i < f.size(); ++i) {
    if (f[i] > f[high]) high = i;
    if (f[i] < f[low]) low = i;
    if (direction >= 0 && f[high] - f[i] > least) {
      if (direction == 1) found.push_back(high);
      direction = -1;
      low = i;
    } else if (direction <= 0 && f[i] - f[low] > least) {
      if (direction == -1) found.push_back(low);
      direction = 1;
      high = i;
    }
    const double lower = std::min(f[i - 1], f[i]), upper = std::max(f[i - 1], f[i]);
    if (lower < -0.1 * least && upper >= -0.1 * least && upper > 0) found.push_back(i);
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Anchors of one smooth stretch [first, last] of the refined profile.
static void add_stretch(std::vector<AnchorPoint>& anchors, const std::vector<ProfilePoint>& p, std::size_t first,
                        std::size_t last, double apart_m) {
  std::vector<ProfilePoint> stretch(p.begin() + static_cast<std::ptrdiff_t>(first),
                                    p.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  std::vector<double> k = polyline_curvature(stretch);
  // The curve through the given points has curvature steps at them: smooth over about a tenth of the profile.
  for (int pass = 0; pass < 200; ++pass) {
    std::vector<double> next = k;
    for (std::size_t i = 1; i + 1 < k.size(); ++i) next[i] = 0.25 * (k[i - 1] + 2 * k[i] + k[i + 1]);
    k = std::move(next);
  }
  const auto [low, high] = std::minmax_element(k.begin(), k.end());
  const double range = *high - *low;
  if (!(range * apart_m > 0.05)) return;  // nearly constant curvature: a line or an arc
  for (const std::size_t i : notable(k, 0.1 * range)) {
    const ProfilePoint q = stretch[i];
    if (i == 0 || i + 1 >= stretch.size() || q.radius_m < 0.3 * apart_m) continue;
    const bool near = std::any_of(anchors.begin(), anchors.end(), [&](const AnchorPoint& a) {
      return norm(a.position_m - Vec3{q.radius_m, q.height_m, 0}) < 0.5 * apart_m;
    });
    if (near) continue;
    add_circle(anchors, q.radius_m, q.height_m, stretch[i + 1].height_m - stretch[i - 1].height_m,
               -(stretch[i + 1].radius_m - stretch[i - 1].radius_m));
  }
}

std::vector<AnchorPoint> revolution_anchors(const std::vector<ProfilePoint>& profile) {
  double widest = 0, length = 0;
  const std::vector<ProfilePoint> raw = refine_profile(profile, kHuge);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    widest = std::max(widest, raw[i].radius_m);
    if (i > 0) length += std::hypot(raw[i].radius_m - raw[i - 1].radius_m, raw[i].height_m - raw[i - 1].height_m);
  }
  const std::vector<ProfilePoint> p = refine_profile(profile, length / 400);
  const double height = raw.back().height_m - raw.front().height_m;
  std::vector<AnchorPoint> anchors;
  std::vector<std::size_t> cut{0};
  for (const std::size_t i : profile_corners(p)) {
    cut.push_back(i);
    const double ur = p[i].radius_m - p[i - 1].radius_m, uh = p[i].height_m - p[i - 1].height_m;
    const double vr = p[i + 1].radius_m - p[i].radius_m, vh = p[i + 1].height_m - p[i].height_m;
    const double u = std::hypot(ur, uh), v = std::hypot(vr, vh);
    add_circle(anchors, p[i].radius_m, p[i].height_m, uh / u + vh / v, -(ur / u + vr / v));
  }
  cut.push_back(p.size() - 1);
  for (std::size_t s = 0; s + 1 < cut.size(); ++s)
    add_stretch(anchors, p, cut[s], cut[s + 1], (2 * widest + height) / 6);
  // A pole is curved unless it is the middle of a flat disc.
  const auto flat = [](ProfilePoint a, ProfilePoint b) {
    return std::abs(a.height_m - b.height_m) < 1e-6 * std::abs(a.radius_m - b.radius_m);
  };
  if (!flat(raw[0], raw[1])) anchors.push_back({{0, p.front().height_m, 0}, {0, -1, 0}, widest});
  if (!flat(raw[raw.size() - 2], raw.back())) anchors.push_back({{0, p.back().height_m, 0}, {0, 1, 0}, widest});
  return anchors;
}

// Bodies with a hole, by the rules for surfaces of revolution: corners of the profile, extrema of its curvature and
// poles, four points to a circle. Outer points before inner ones.
std::vector<AnchorPoint> half_shell_anchors(const BodyDesc& body) {
  const Vec3 outer = body.half_axes_m, w{body.wall_m, body.wall_m, body.wall_m}, inner = outer - w;
  std::vector<AnchorPoint> anchors;
  const auto add = [&](Vec3 half, double side) {
    anchors.push_back({{0, half.y, 0}, {0, side, 0}, half.y});
    const Vec3 direction[4] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
    for (const Vec3& d : direction)  // the rim: its ellipse is most and least curved at the axes
      anchors.push_back({{half.x * d.x, 0, half.z * d.z}, unit_or(side * d + Vec3{0, -1, 0}, d), half.x});
  };
  const auto add_middle = [&](Vec3 half, double side) {
    // No curvature asks for these; without them half of the wall is farther from any anchor than its own height.
    const Vec3 direction[4] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
    const double c = square_root(0.5);
    for (const Vec3& d : direction) {
      const Vec3 p{c * half.x * d.x, c * half.y, c * half.z * d.z};
      const Vec3 n{p.x / (half.x * half.x), p.y / (half.y * half.y), p.z / (half.z * half.z)};
      anchors.push_back({p, side * unit_or(n, d), 0.5 * half.x});
    }
  };
  add(outer, 1);
  add(inner, -1);
  add_middle(outer, 1);
  add_middle(inner, -1);
  return anchors;
}

// Points and normals given upright about the y axis and centred there, put where the body stands.
static std::vector<AnchorPoint> turned(std::vector<AnchorPoint> anchors, BodyAxis axis, double lift_m) {
  for (AnchorPoint& a : anchors) {
    if (axis == BodyAxis::kZ) {  // y -> z, as a right-handed turn: (x, y, z) -> (z, x, y)
      a.position_m = {a.position_m.z, a.position_m.x, a.position_m.y};
      a.normal = {a.normal.z, a.normal.x, a.normal.y};
    }
    a.position_m.y += lift_m;
  }
  return anchors;
}

std::vector<AnchorPoint> ring_anchors(const BodyDesc& body) {
  const double tube = 0.5 * body.wall_m, centre = body.radius_m - tube;
  std::vector<AnchorPoint> anchors;
  add_circle(anchors, body.radius_m, 0, 1, 0);  // where the Gaussian curvature is largest,
  add_circle(anchors, centre, tube, 0, 1);      // zero,
  add_circle(anchors, centre, -tube, 0, -1);
  add_circle(anchors, centre - tube, 0, -1, 0);  // and least
  return turned(std::move(anchors), body.axis, body.axis == BodyAxis::kZ ? body.radius_m : tube);
}

std::vector<AnchorPoint> hollow_cylinder_anchors(const BodyDesc& body) {
  const double inner = body.radius_m - body.wall_m, half = 0.5 * body.height_m;
  std::vector<AnchorPoint> anchors;
  for (const double radius : {body.radius_m, inner})
    for (const double s : {1.0, -1.0}) add_circle(anchors, radius, s * half, radius == inner ? -1 : 1, s);
  return turned(std::move(anchors), body.axis, body.axis == BodyAxis::kZ ? body.radius_m : half);
}

std::vector<AnchorPoint> cylinder_anchors(double radius_m, double height_m) {
  std::vector<AnchorPoint> anchors;
  add_circle(anchors, radius_m, 0, 1, -1);
  add_circle(anchors, radius_m, height_m, 1, 1);
  return anchors;
}

}  // namespace palpate
