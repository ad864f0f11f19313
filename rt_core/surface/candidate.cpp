#include "rt_core/surface/candidate.h"

namespace palpate {

namespace {

// Squared distance of the closest point from the border of its feature, at least; kHuge for a vertex, which has none.
// Also notes the vertices of the feature.
double border_distance2(const Surface& surface, Candidate& best) PALPATE_RT {
  const Triangle& t = surface.triangle[best.triangle];
  const auto code = static_cast<std::int32_t>(best.at.feature);
  const double inset2 = best.at.inset * best.at.inset;
  if (best.at.feature >= Feature::kVertex0) {
    best.shared[0] = best.shared[1] = t.vertex[code - 4];
    return kHuge;
  }
  if (best.at.feature != Feature::kFace) {
    best.shared[0] = t.vertex[code - 1];
    best.shared[1] = t.vertex[code % 3];
    return inset2 * squared_norm(surface.vertex[best.shared[1]] - surface.vertex[best.shared[0]]);
  }
  best.shared[0] = best.shared[1] = -1;
  const Vec3 a = surface.vertex[t.vertex[0]], b = surface.vertex[t.vertex[1]], c = surface.vertex[t.vertex[2]];
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const double longest2 = max_of(max_of(squared_norm(ab), squared_norm(bc)), squared_norm(ca));
  // The least weight times the least altitude, which is twice the area over the longest side.
  return longest2 > 0 ? inset2 * squared_norm(cross(ab, ca)) / longest2 : 0.0;
}

}  // namespace

void raise_ceiling(const Surface& surface, Vec3 p, Candidate& best) PALPATE_RT {
  const double rounding = distance2_rounding(best);
  const bool usable = border_distance2(surface, best) > max_of(4 * rounding + 1e-16, 1e-10 * best.distance2);
  best.outward = usable ? p - best.at.point : Vec3{};
  best.ceiling = usable ? dot(best.at.point, best.outward) + rounding : -1.0;
}

void measure(const Surface& surface, const Vec3& p, std::int32_t index, Candidate& best) PALPATE_RT {
  if (keep_nearer(surface, p, index, best)) raise_ceiling(surface, p, best);
}

}  // namespace palpate
