// Profiles of surfaces of revolution: corners, smooth stretches between them, resampling.
#include <algorithm>
#include <cmath>

#include "config/body/procedural.h"

namespace palpate {

namespace {

struct Flat {
  double r, h;
};
double distance(ProfilePoint a, ProfilePoint b) { return std::hypot(a.radius_m - b.radius_m, a.height_m - b.height_m); }

// Centripetal Catmull-Rom point between b and c at parameter u in [0,1] (Barry & Goldman 1988 pyramid).
ProfilePoint curve_point(ProfilePoint a, ProfilePoint b, ProfilePoint c, ProfilePoint d, double u) {
  const double t0 = 0, t1 = t0 + std::sqrt(distance(a, b)), t2 = t1 + std::sqrt(distance(b, c)),
               t3 = t2 + std::sqrt(distance(c, d));
  const double t = t1 + u * (t2 - t1);
  const auto mix = [](ProfilePoint p, ProfilePoint q, double from, double to, double x) {
    const double w = (x - from) / (to - from);
    return ProfilePoint{p.radius_m + w * (q.radius_m - p.radius_m), p.height_m + w * (q.height_m - p.height_m)};
  };
  const ProfilePoint ab = mix(a, b, t0, t1, t), bc = mix(b, c, t1, t2, t), cd = mix(c, d, t2, t3, t);
  return mix(mix(ab, bc, t0, t2, t), mix(bc, cd, t1, t3, t), t1, t2, t);
}

// The point beyond `b` that continues from `a` straight on: end condition of the curve.
ProfilePoint beyond(ProfilePoint a, ProfilePoint b) {
  return {2 * b.radius_m - a.radius_m, 2 * b.height_m - a.height_m};
}

// The point beyond the pole `b`: the mirror image of `a`, so that the surface is smooth there, unless the profile meets
// its mirror image at a corner (a cone's apex).
ProfilePoint beyond_pole(ProfilePoint a, ProfilePoint b) {
  const double turn = 2 * std::atan2(std::abs(b.height_m - a.height_m), std::abs(b.radius_m - a.radius_m));
  return turn > kCornerAngle_rad ? beyond(a, b) : ProfilePoint{-a.radius_m, a.height_m};
}

std::vector<ProfilePoint> closed_to_axis(const std::vector<ProfilePoint>& profile) {
  std::vector<ProfilePoint> closed = profile;
  if (closed.front().radius_m > 0) closed.insert(closed.begin(), {0, closed.front().height_m});
  if (closed.back().radius_m > 0) closed.push_back({0, closed.back().height_m});
  double lowest = closed[0].height_m;
  for (const ProfilePoint& p : closed) lowest = std::min(lowest, p.height_m);
  for (ProfilePoint& p : closed) p.height_m -= lowest;
  return closed;
}

}  // namespace

std::vector<std::size_t> profile_corners(const std::vector<ProfilePoint>& p) {
  std::vector<std::size_t> corner;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const Flat u{p[i].radius_m - p[i - 1].radius_m, p[i].height_m - p[i - 1].height_m};
    const Flat v{p[i + 1].radius_m - p[i].radius_m, p[i + 1].height_m - p[i].height_m};
    if (std::abs(std::atan2(u.r * v.h - u.h * v.r, u.r * v.r + u.h * v.h)) > kCornerAngle_rad) corner.push_back(i);
  }
  return corner;
}

std::vector<ProfilePoint> refine_profile(const std::vector<ProfilePoint>& profile, double spacing_m) {
  const std::vector<ProfilePoint> p = closed_to_axis(profile);
  const std::vector<std::size_t> corner = profile_corners(p);
  const auto sharp = [&](std::size_t i) { return std::binary_search(corner.begin(), corner.end(), i); };
  std::vector<ProfilePoint> out{p[0]};
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const ProfilePoint before = i == 0 ? beyond_pole(p[1], p[0]) : sharp(i) ? beyond(p[i + 1], p[i]) : p[i - 1];
    const ProfilePoint after = i + 2 == p.size() ? beyond_pole(p[i], p[i + 1])
                               : sharp(i + 1)    ? beyond(p[i], p[i + 1])
                                                 : p[i + 2];
    const auto steps = static_cast<std::int32_t>(std::max(1.0, std::round(distance(p[i], p[i + 1]) / spacing_m)));
    for (std::int32_t k = 1; k < steps; ++k) {
      ProfilePoint q = curve_point(before, p[i], p[i + 1], after, static_cast<double>(k) / steps);
      q.radius_m = std::max(q.radius_m, 0.0);
      out.push_back(q);
    }
    out.push_back(p[i + 1]);
  }
  return out;
}

}  // namespace palpate
