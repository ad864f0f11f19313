// How the slopes of a place's numbers change along the surface: told at the vertices, the same from both sides of an
// edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "config/bake/vertex_slopes.h"
#include "config/elastic/fixed_random.h"
#include "rt_core/contact/elastic/elastic_work.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

// On uneven triangles of a plane that lies askew.
TEST(PlaceBends, OfAParabolaAreItsOwn) {
  constexpr int kSide = 6;
  const Vec3 along = unit_or({1, 0.2, -0.4}, {}), normal = unit_or(cross(along, {0.3, 1, 0.1}), {});
  const Vec3 across = cross(normal, along);
  const double a = 3, b = -1.5, c = 0.7;  // of a x^2 / 2 + b x y + c y^2 / 2
  elastic::FixedRandom random(3);
  std::vector<Vec3> vertex_m, slope;
  std::vector<double> value;
  std::vector<Triangle> triangles;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j) {
      const double x = 1e-3 * (i + 0.3 * random.symmetric()), y = 1e-3 * (j + 0.3 * random.symmetric());
      vertex_m.push_back(x * along + y * across);
      value.push_back(0.5 * a * x * x + b * x * y + 0.5 * c * y * y);
      slope.push_back((a * x + b * y) * along + (b * x + c * y) * across);
      if (i == kSide || j == kSide) continue;
      const int at = i * (kSide + 1) + j, next = at + kSide + 1;
      for (const auto& [second, third] : {std::pair{next, next + 1}, std::pair{next + 1, at + 1}}) {
        Triangle t{};
        t.vertex[0] = at;
        t.vertex[1] = second;
        t.vertex[2] = third;
        triangles.push_back(t);
      }
    }
  const auto bends = vertex_bends(vertex_m, triangles, value, slope);
  const auto twice = [](const Bend& h, Vec3 u, Vec3 v) {
    return h[0] * u.x * v.x + h[1] * (u.x * v.y + u.y * v.x) + h[2] * (u.x * v.z + u.z * v.x) + h[3] * u.y * v.y +
           h[4] * (u.y * v.z + u.z * v.y) + h[5] * u.z * v.z;
  };
  for (int i = 1; i < kSide; ++i)
    for (int j = 1; j < kSide; ++j) {
      const Bend& h = bends[static_cast<std::size_t>(i * (kSide + 1) + j)];
      const double off = 0.03 * a;  // what keeps it small where nothing tells of it
      EXPECT_NEAR(twice(h, along, along), a, off);
      EXPECT_NEAR(twice(h, along, across), b, off);
      EXPECT_NEAR(twice(h, across, across), c, off);
      EXPECT_NEAR(twice(h, normal, normal), 0, off);
    }
}

// A torus on uneven triangles with the normals of the smooth one: principal curvatures 1 / r and cos / (R + r cos).
TEST(PlaceBends, ATorusCurvesAsItDoes) {
  constexpr int kAround = 48, kTube = 20;
  constexpr double kRing_m = 0.03, kTube_m = 0.01, kTurn = 2 * std::numbers::pi;
  elastic::FixedRandom random(5);
  std::vector<Vec3> vertex_m, outward;
  std::vector<double> cosine;
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kTube; ++j) {
      const double u = kTurn * (i + 0.2 * random.symmetric()) / kAround,
                   v = kTurn * (j + 0.2 * random.symmetric()) / kTube;
      const Vec3 out{std::cos(u), 0, std::sin(u)};
      outward.push_back(std::cos(v) * out + std::sin(v) * Vec3{0, 1, 0});
      vertex_m.push_back(kRing_m * out + kTube_m * outward.back());
      cosine.push_back(std::cos(v));
    }
  std::vector<Triangle> triangles;
  std::vector<CornerNormals> normals;
  const auto number = [](int i, int j) { return (i % kAround) * kTube + j % kTube; };
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kTube; ++j)
      for (const int half : {0, 1}) {
        Triangle t{};
        CornerNormals n{};
        const int corner[3] = {number(i, j), half ? number(i + 1, j + 1) : number(i, j + 1),
                               half ? number(i + 1, j) : number(i + 1, j + 1)};
        for (int k = 0; k < 3; ++k) {
          t.vertex[k] = corner[k];
          n.normal[k] = outward[static_cast<std::size_t>(corner[k])];
        }
        triangles.push_back(t);
        normals.push_back(n);
      }
  const std::vector<Bend> form = vertex_curvatures(vertex_m, normals, triangles);
  double worst = 0;  // of the tube's
  for (std::size_t v = 0; v < form.size(); ++v) {
    const auto [larger, smaller] = principal_curvatures(form[v]);
    worst = std::max(worst, std::abs(kTube_m * larger - 1));
    worst = std::max(worst, std::abs(kTube_m * (smaller - cosine[v] / (kRing_m + kTube_m * cosine[v]))));
  }
  std::printf("  principal curvatures within %.3f of the tube's\n", worst);
  EXPECT_LT(worst, 0.08);
}

// By it what a place asks of the modes fades. From one cubic to the next it jumped by as much as it is, and a ring
// whose rod stood on a vertex turned to and fro with that (tests/scenes/test_elastic_scenes.cpp).
TEST(PlaceBends, AreTheSameFromBothSidesOfAnEdge) {
  const BakedScene scene(elastic_scene(arch(10), 35, 12, 15, 4));
  Bench bench(scene.model());
  const Vec3 from{-8e-3, 0.083, -6e-3}, to{8e-3, 0.083, 6e-3};
  move_to(bench, from + Vec3{0, 5e-3, 0}, from);
  const ElasticRow& row = work_of(*bench.scratch).row_of(0);
  const auto bends = [&](int which) {  // of all modes
    double sum = 0;
    for (int a = 0; a < scene.model().params.elastic_soft; ++a) {
      const double s = row.slide[0][a], t = row.slide[1][a];
      sum +=
          row.number_bend[0][which] * s * s + 2 * row.number_bend[1][which] * s * t + row.number_bend[2][which] * t * t;
    }
    return sum;
  };
  constexpr int kSteps = 20000;  // of a micron
  double before[4] = {}, most[4] = {}, jump[4] = {};
  int triangle = -1, crossed = 0;
  for (int i = 1; i <= kSteps; ++i) {
    bench.tick_at({from + (static_cast<double>(i) / kSteps) * (to - from), {}}, {});
    ASSERT_TRUE(row.has_slide);
    const bool crosses = row.foot.triangle != triangle && triangle >= 0;
    crossed += crosses ? 1 : 0;
    for (int which = 0; which < 4; ++which) {
      const double now = bends(which);
      most[which] = std::max(most[which], std::abs(now));
      if (crosses) jump[which] = std::max(jump[which], std::abs(now - before[which]));
      before[which] = now;
    }
    triangle = row.foot.triangle;
  }
  EXPECT_GE(crossed, 8);
  for (int which = 0; which < 4; ++which) {
    std::printf("  number %d: largest %.3e, largest jump %.3e\n", which, most[which], jump[which]);
    // 0.15 % (2026-11-26): the slides themselves jump with the curvature of the smooth surface, and a micron is passed.
    EXPECT_LE(jump[which], 0.01 * most[which]) << which;
  }
}

}  // namespace
}  // namespace palpate::test
