#include "rt_core/contact/elastic/part_search.h"

#include "rt_core/math.h"
#include "rt_core/surface/foot_search.h"

namespace palpate {

namespace {

// Facets that a foot comes down over in a tick.
constexpr std::int32_t kMostDown = 16;
constexpr Real kLeast_m6 = 1e-60;
// Corner normals of a part are as long as one another (config/bake/surface_parts.cpp) but for rounding; squared.
constexpr Real kAsLong = 1e-13;

const Triangle& triangle_of(const Model& model, std::int32_t t) PALPATE_RT {
  return model.triangle[static_cast<std::size_t>(t)];
}
Vec3 vertex(const Model& model, std::int32_t v) PALPATE_RT { return model.vertex_m[static_cast<std::size_t>(v)]; }
Vec3 middle(const Model& model, std::int32_t triangle) PALPATE_RT {
  const std::int32_t* v = triangle_of(model, triangle).vertex;
  return (1.0 / 3) * (vertex(model, v[0]) + vertex(model, v[1]) + vertex(model, v[2]));
}
Real length2(const Model& model, std::int32_t triangle) PALPATE_RT {
  return squared_norm(model.corner_normal[static_cast<std::size_t>(triangle)].normal[0]);
}

// A facet from a place: how far, squared, and the cosine by which it looks there.
struct Seen {
  std::int32_t triangle;
  Real square_m2, facing;

  Seen(const Model& model, std::int32_t t, Vec3 place) PALPATE_RT : triangle(t) {
    const std::int32_t* v = triangle_of(model, t).vertex;
    const Vec3 a = vertex(model, v[0]), out = place - middle(model, t),
               up = cross(vertex(model, v[1]) - a, vertex(model, v[2]) - a);
    square_m2 = squared_norm(out);
    facing = dot(out, up) / square_root(max_of(square_m2 * squared_norm(up), kLeast_m6));
  }
  bool is_better_than(const Seen& other) const PALPATE_RT {
    return other.facing < 0 ? facing > other.facing : facing >= 0 && square_m2 < other.square_m2;
  }
};

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
  Seen best(model, triangle, place_m);
  for (const std::int32_t seed : seeds.triangle) {  // bound: kPartSeeds
    const Seen there(model, seed, place_m);
    if (there.is_better_than(best)) best = there;
  }
  for (std::int32_t i = 0; i < kMostDown; ++i) {  // bound: kMostDown x 3
    const std::int32_t here = best.triangle;
    for (int edge = 0; edge < 3; ++edge) {
      const std::int32_t next = foot::across(model, here, edge);
      if (next < 0) continue;
      const Seen beside(model, next, place_m);
      if (beside.is_better_than(best)) best = beside;
    }
    if (best.triangle == here) return {here, true};
  }
  return {best.triangle, false};
}

}  // namespace palpate
