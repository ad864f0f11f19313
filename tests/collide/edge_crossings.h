// Queries of points that have come over an edge of their triangle since their last tick.
#pragma once

#include <gtest/gtest.h>

#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/four_queries.h"
#include "tests/collide/meshes.h"

namespace palpate::test {

// A point over the triangle across edge `e` of triangle `from`: `past` of the way from the edge to that one's middle.
inline Vec3 beyond_edge(const Model& model, std::size_t from, int e, double past, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> u(0, 1);
  const auto corner = [&](std::size_t t, int c) {
    return model.vertex_m[static_cast<std::size_t>(model.triangle[t].vertex[c])];
  };
  const auto across = static_cast<std::size_t>(model.triangle[from].adjacent[e]);
  const Vec3 a = corner(across, 0), b = corner(across, 1), c = corner(across, 2), begin = corner(from, e);
  const Vec3 on = begin + (0.2 + 0.6 * u(rng)) * (corner(from, (e + 1) % 3) - begin);
  return on + past * ((1.0 / 3) * (a + b + c) - on) + 3e-3 * u(rng) * unit_or(cross(b - a, c - a), {});
}

// What four together settle is what each has alone, to the bit.
inline void expect_as_alone(const Body& body, const FourQueries& query, const FourSettled& four, std::uint32_t k) {
  const SurfacePoint one = closest_surface_point(body.model, query.p[k], kHuge, query.warm_triangle[k]);
  const SurfacePoint of_four = settled_point(four, k);
  ASSERT_TRUE(one.found && of_four.found);
  ASSERT_EQ(one.triangle, of_four.triangle);
  ASSERT_EQ(one.closest_w, of_four.closest_w);
  ASSERT_EQ(one.normal_w, of_four.normal_w);
  ASSERT_EQ(one.signed_distance_m, of_four.signed_distance_m);
  ASSERT_EQ(one.lower_bound_m, of_four.lower_bound_m);
  ASSERT_EQ(one.looked, of_four.looked);
}

// Points settled over the face across the edge, and those of them so near it that both sides were measured again.
struct EdgeCrossings {
  int settled = 0, again = 0;
};

// 16,000 points, four together, past the edge by what rounding leaves and by up to the triangle's width: what is
// settled is what each has alone, to the bit.
inline EdgeCrossings cross_edges(const Body& body) {
  constexpr double kPast[] = {1e-9, 1e-5, 5e-4, 0.02, 0.9};
  std::mt19937_64 rng(13);
  std::uniform_int_distribution<std::size_t> any(0, body.model.triangle.size() - 1);
  EdgeCrossings crossings;
  for (int i = 0; i < 4000; ++i) {
    FourQueries query;
    for (int k = 0; k < 4; ++k) {
      const std::size_t from = any(rng);
      query.p[k] = beyond_edge(body.model, from, (i + k) % 3, kPast[i % 5], rng);
      query.warm_triangle[k] = static_cast<std::int32_t>(from);
    }
    const FourSettled four = settle_four(body.model, query, 4);
    for (std::uint32_t k = 0; k < 4; ++k) {
      if ((four.settled >> k & 1) == 0) continue;
      SCOPED_TRACE(kPast[i % 5]);
      expect_as_alone(body, query, four, k);
      const SurfacePoint of_four = settled_point(four, k);
      crossings.settled += of_four.triangle != query.warm_triangle[k] && of_four.feature == Feature::kFace ? 1 : 0;
      crossings.again += (four.again >> k & 1) != 0 ? 1 : 0;
    }
  }
  return crossings;
}

}  // namespace palpate::test
