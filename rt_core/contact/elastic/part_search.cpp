#include "rt_core/contact/elastic/part_search.h"

#include "rt_core/math.h"
#include "rt_core/surface/foot_search.h"
#include "rt_core/surface/triangle.h"

namespace palpate {

namespace {

constexpr Real kMiddle = 1e-3;
// Corner normals of a part are as long as one another (config/bake/surface_parts.cpp) but for rounding; squared.
constexpr Real kAsLong = 1e-13;

Vec3 middle(const foot::RestCorners& at) PALPATE_RT { return (1.0 / 3) * (at.v[0] + at.v[1] + at.v[2]); }
Vec3 middle(const Model& model, std::int32_t triangle) PALPATE_RT { return middle({model, triangle}); }
Real length2(const Model& model, std::int32_t triangle) PALPATE_RT {
  return squared_norm(model.corner_normal[static_cast<std::size_t>(triangle)].normal[0]);
}

// A facet from a place: how far, squared, and the cosine by which it looks there. Its middle counts a little: it
// decides about those that share what is nearest. Alone it left a foot on a needle whose neighbours' middles are
// farther along.
struct Seen {
  std::int32_t triangle = -1;
  Real square_m2 = 0, facing = -2;
  bool is_above = false;  // of its inside
};

// Looks at a facet as far as it takes to see that it is no better than `best`. Returns whether it is, as `there` tells.
bool improves(const Model& model, std::int32_t triangle, Vec3 place, const Seen& best, Seen& there) PALPATE_RT {
  const foot::RestCorners at(model, triangle);
  const Vec3 out = place - middle(at), up = cross(at.v[1] - at.v[0], at.v[2] - at.v[0]);
  if (best.facing >= 0 && dot(out, up) < 0) return false;
  const Real facing = best.facing < 0 ? looks_to(out, up) : 0.0;
  if (best.facing < 0 && !(facing > best.facing)) return false;
  const TrianglePoint nearest = closest_on_triangle(place, at.v[0], at.v[1], at.v[2]);
  const Real square_m2 = squared_norm(place - nearest.point) + kMiddle * squared_norm(out);
  if (best.facing >= 0 && !(square_m2 < best.square_m2)) return false;
  there = {triangle, square_m2, best.facing < 0 ? facing : looks_to(out, up),
           dot(out, up) >= 0 && nearest.feature == Feature::kFace};
  return best.facing < 0 || there.facing >= 0;
}

void take(const Model& model, std::int32_t triangle, Vec3 place, Seen& best, std::int32_t& looked) PALPATE_RT {
  if (triangle == best.triangle) return;
  looked += 1;
  Seen there;
  if (improves(model, triangle, place, best, there)) best = there;
}

// The same across an edge, if the part goes on there: asked only of one that is better, since it takes as much.
void take_across(const Model& model, std::int32_t from, int edge, Vec3 place, Seen& best,
                 std::int32_t& looked) PALPATE_RT {
  const std::int32_t next = model.triangle[static_cast<std::size_t>(from)].adjacent[edge];
  if (next < 0 || next == best.triangle) return;
  looked += 1;
  Seen there;
  if (improves(model, next, place, best, there) && foot::across(model, from, edge) >= 0) best = there;
}

}  // namespace

PartSeeds spread_over_part(const Model& model, std::int32_t begins_at) noexcept {
  PartSeeds seeds;
  const Real length = length2(model, begins_at);
  for (std::int32_t i = 0; i < kPartSeeds; ++i) {
    seeds.triangle[i] = begins_at;
    Real most = 0;
    for (std::int32_t t = 0; i > 0 && t < static_cast<std::int32_t>(model.triangle.size()); ++t) {
      if (abs_of(length2(model, t) - length) > kAsLong) continue;
      Real least = kHuge;
      for (std::int32_t k = 0; k < i; ++k)
        least = min_of(least, squared_norm(middle(model, t) - middle(model, seeds.triangle[k])));
      if (!(least > most)) continue;
      most = least;
      seeds.triangle[i] = t;
    }
  }
  return seeds;
}

PartPlace come_down(const Model& model, const PartSeeds& seeds, Vec3 place_m, std::int32_t triangle) PALPATE_RT {
  Seen best;
  std::int32_t looked = 0;
  take(model, triangle, place_m, best, looked);
  for (const std::int32_t seed : seeds.triangle) take(model, seed, place_m, best, looked);  // bound: kPartSeeds
  if (best.triangle < 0) return {triangle, false, looked};                                  // the place is no number
  for (std::int32_t i = 0; i < kMostDown; ++i) {                                            // bound: kMostDown x 9
    const std::int32_t here = best.triangle;
    if (best.is_above) return {here, true, looked};
    for (int edge = 0; edge < 3; ++edge) take_across(model, here, edge, place_m, best, looked);
    // A corner may be what is nearest of those beside, too, and not of those beyond them.
    for (int edge = 0; edge < 3 && best.triangle == here; ++edge) {
      const std::int32_t beside = foot::across(model, here, edge);
      for (int beyond = 0; beyond < 3 && beside >= 0; ++beyond)
        take_across(model, beside, beyond, place_m, best, looked);
    }
    if (best.triangle == here) return {here, true, looked};
  }
  return {best.triangle, false, looked};
}

}  // namespace palpate
