// Queries over fans of needles, flat tops and slivers: the brute-force answer to the bit, and what they look at does
// not grow with the number of triangles that meet.
#include <gtest/gtest.h>

#include "rt_core/image_check.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/ring_proof.h"
#include "tests/collide/edge_crossings.h"
#include "tests/collide/revolved.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 0.02, kHeight = 0.03;

// A lid whose triangles all meet in a place of its rim, and one of strips across: what programs for drawing make of a
// flat face. Between them a wall of slivers.
Mesh slivered_prism(int around) {
  Mesh mesh;
  for (const double y : {0.0, kHeight})
    for (int i = 0; i < around; ++i) {
      const double a = 6.283185307179586 * (i + 0.25) / around;
      mesh.vertex.push_back({kRadius * std::sin(a), y, kRadius * std::cos(a)});
    }
  for (int i = 0; i < around; ++i) {
    const int j = (i + 1) % around;
    mesh.triangle.push_back({{i, j, around + j}, {}});
    mesh.triangle.push_back({{i, around + j, around + i}, {}});
  }
  for (int i = 1; i + 1 < around; ++i) mesh.triangle.push_back({{around, around + i, around + i + 1}, {}});
  for (int low = 0, high = around - 1; high - low > 1;) {
    mesh.triangle.push_back({{high, low + 1, low}, {}});
    low += 1;
    if (high - low < 2) break;
    mesh.triangle.push_back({{high, high - 1, low}, {}});
    high -= 1;
  }
  return mesh;
}

Mesh shape(const std::string& name) {
  constexpr Vec3 kTurn{0.3, -0.2, 0.5};
  if (name == "cylinder") return standing_cylinder(kRadius, kHeight, 80);
  if (name == "turned") return standing_cylinder(kRadius, kHeight, 80, kTurn);
  if (name == "needles") return standing_cylinder(kRadius, kHeight, 700);
  if (name == "few") return standing_cylinder(kRadius, kHeight, 9, {0, 0.4, 0});
  if (name == "rings") {
    return revolved({{0, 0},
                     {0.007, 0},
                     {0.015, 0},
                     {kRadius, 0},
                     {kRadius, 0.01},
                     {kRadius, 0.02},
                     {kRadius, kHeight},
                     {0.015, kHeight},
                     {0.007, kHeight},
                     {0, kHeight}},
                    64);
  }
  // A flat bottom in a recess of the top, a step outside: surface that rises above the planes of both.
  const std::vector<ProfileCorner> dish = {{0, 0},           {0.02, 0},        {0.02, 0.01},   {0.014, 0.01},
                                           {0.014, kHeight}, {0.011, kHeight}, {0.011, 0.022}, {0, 0.022}};
  if (name == "dish") return revolved(dish, 100);
  if (name == "turned dish") return revolved(dish, 100, kTurn);
  if (name == "cone") return revolved({{0, 0}, {kRadius, 0}, {0, kHeight}}, 90);
  if (name == "knife") return revolved({{0, 0}, {kRadius, 1e-3}, {0, 2e-3}}, 60, kTurn);
  return slivered_prism(120);
}

struct Nearest {
  double distance2 = 1e300;
  int triangle = -1;
  Vec3 closest;
};
Nearest brute_force(const Model& model, Vec3 p) {
  Nearest best;
  for (std::size_t t = 0; t < model.triangle.size(); ++t) {
    const auto at = [&](int k) { return model.vertex_m[static_cast<std::size_t>(model.triangle[t].vertex[k])]; };
    const Vec3 c = closest_on_triangle(p, at(0), at(1), at(2)).point;
    const double distance2 = squared_norm(p - c);
    if (distance2 < best.distance2) best = {distance2, static_cast<int>(t), c};
  }
  return best;
}

class Fans : public testing::TestWithParam<std::string> {
 protected:
  void expect_exact(Vec3 p) {
    const Nearest oracle = brute_force(body.model, p);
    const int count = static_cast<int>(body.model.triangle.size());
    for (const int warm : {-1, oracle.triangle, std::uniform_int_distribution<int>(0, count - 1)(rng)}) {
      // Without a cap: what a capped search misses is not the matter here.
      const SurfacePoint s = closest_surface_point(body.model, p, 1e12, warm, 1 << 20);
      ASSERT_TRUE(s.found && !s.truncated);
      ASSERT_EQ(s.triangle, oracle.triangle) << "warm start " << warm << " at " << p.x << " " << p.y << " " << p.z;
      ASSERT_EQ(s.closest_w, oracle.closest);
      ASSERT_EQ(abs_of(s.signed_distance_m), square_root(oracle.distance2));
      by_planes += s.nodes == 0 && ring_proof::is_by_planes(body.model.triangle[static_cast<std::size_t>(s.triangle)]);
    }
  }
  // Of few triangles the rings prove enough, and planes at a knife's edge prove nothing.
  bool has_planes() const { return GetParam() != "few" && GetParam() != "knife"; }
  Body body = make_body(shape(GetParam()));
  std::mt19937_64 rng{71};
  int by_planes = 0;  // answers that a certificate by planes gave
};

TEST_P(Fans, MatchBruteForceEverywhere) {
  for (int i = 0; i < 1000; ++i) expect_exact(random_vec(rng, i % 2 == 0 ? 0.04 : 0.2));
  EXPECT_TRUE(by_planes > 50 || !has_planes()) << by_planes;
}

// Over faces, edges and vertices, beside them by what rounding can do and by more, from very near to a tip's radius.
TEST_P(Fans, MatchBruteForceNextToFacesEdgesAndVertices) {
  std::uniform_int_distribution<std::size_t> any(0, body.model.triangle.size() - 1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 3000; ++i) {
    const Triangle& t = body.model.triangle[any(rng)];
    const auto at = [&](int k) { return body.model.vertex_m[static_cast<std::size_t>(t.vertex[k % 3])]; };
    const double a = i % 3 == 0 ? 1.0 : u(rng), b = i % 3 == 2 ? (1 - a) * u(rng) : 1 - a;  // vertex, edge, face
    const int k = i / 3 % 3;
    const Vec3 on = a * at(k) + b * at(k + 1) + (1 - a - b) * at(k + 2);
    const Vec3 normal = unit_or(cross(at(1) - at(0), at(2) - at(0)), {});
    const double height[] = {0, 1e-9, 1e-6, 1e-3, 6e-3, 0.05}, aside[] = {0, 1e-13, 1e-11, 3e-10, 2e-9, 1e-7, 1e-5};
    expect_exact(on + height[i % 6] * normal + aside[i % 7] * random_unit(rng));
  }
  EXPECT_TRUE(by_planes > 50 || !has_planes()) << by_planes;
}

TEST_P(Fans, FourSettleWhatCameOverAnEdge) {
  const EdgeCrossings crossings = cross_edges(body);
  EXPECT_TRUE(crossings.settled > 1500 || GetParam() == "knife") << crossings.settled;  // 1,746 to 9,541 of 16,000
  EXPECT_TRUE(crossings.again > 500 || !has_planes()) << crossings.again;               // 694 to 4,184
}

// Where all needles of a fan meet, to the bit and off it.
TEST_P(Fans, MatchBruteForceOverTheirMiddle) {
  const auto count = static_cast<std::size_t>(body.model.vertex_m.size());
  for (const std::size_t hub : {std::size_t{0}, count - 1}) {
    for (int i = 0; i < 300; ++i) {
      const double height[] = {1e-8, 1e-5, 1e-3, 6e-3, 0.05};
      const double aside[] = {0, 1e-14, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4};
      const Vec3 normal = body.normal[hub], off = random_unit(rng);
      expect_exact(body.model.vertex_m[hub] + height[i % 5] * normal + aside[i % 9] * off);
      expect_exact(body.model.vertex_m[hub] + height[i % 5] * normal + aside[i % 9] * tangential_part(off, normal));
    }
  }
}

// Nothing that rises above the four planes comes nearer to the clearance point than stated.
TEST_P(Fans, ClearanceByPlanesHolds) {
  int certified = 0;
  for (std::size_t index = 0; index < body.model.triangle.size(); index += 3) {
    const Triangle& t = body.model.triangle[index];
    if (!ring_proof::is_by_planes(t)) continue;
    ++certified;
    const auto at = [&](const Triangle& of, int k) {
      return body.model.vertex_m[static_cast<std::size_t>(of.vertex[k])];
    };
    const auto normal_of = [&](const Triangle& of) { return cross(at(of, 1) - at(of, 0), at(of, 2) - at(of, 0)); };
    const Vec3 clear =
        (1.0 / 3.0) * (at(t, 0) + at(t, 1) + at(t, 2)) + static_cast<double>(t.clear_scale_per_m) * normal_of(t);
    std::vector<const Triangle*> plane = {&t};
    for (const int across : t.adjacent) plane.push_back(&body.model.triangle[static_cast<std::size_t>(across)]);
    for (const Triangle& other : body.model.triangle) {
      bool rises = false;
      for (const Triangle* p : plane)
        for (int k = 0; k < 3; ++k) rises |= dot(at(other, k) - at(*p, 0), unit_or(normal_of(*p), {})) > 1e-15;
      if (!rises) continue;
      const Vec3 c = closest_on_triangle(clear, at(other, 0), at(other, 1), at(other, 2)).point;
      ASSERT_GE(norm(clear - c), static_cast<double>(t.clear_radius_m));
    }
  }
  EXPECT_TRUE(certified > 10 || !has_planes()) << certified;
}

INSTANTIATE_TEST_SUITE_P(Bodies, Fans,
                         testing::Values("cylinder", "turned", "needles", "few", "rings", "dish", "turned dish", "cone",
                                         "knife", "slivers"));

// What an image says of a fan is checked before a query goes by it.
TEST(FansImage, AFirstTriangleThatIsNoneIsRefused) {
  Body body = make_body(standing_cylinder(kRadius, kHeight, 80));
  ASSERT_STRNE(check_arrays(body.model).field, "triangle.ring_convex");
  const std::int32_t good = body.bvh.triangle[5].ring_convex;
  for (const std::int32_t bad : {-1, ring_proof::kByPlanes | 320 << ring_proof::kFirstIndex, INT32_MIN}) {
    body.bvh.triangle[5].ring_convex = bad;
    EXPECT_STREQ(check_arrays(body.model).field, "triangle.ring_convex");
  }
  body.bvh.triangle[5].ring_convex = good;
  EXPECT_STRNE(check_arrays(body.model).field, "triangle.ring_convex");
}

// A tip goes over a flat top by 20 um a tick, through the middle of its fan and off it: what a tick looks at.
std::int32_t most_looked(int around, double beside) {
  const Body body = make_body(standing_cylinder(kRadius, kHeight, around));
  std::int32_t most = 0;
  int warm = -1;
  for (int i = -400; i <= 400; ++i) {
    const Vec3 p{2e-5 * i, kHeight + 6e-3, beside};
    const SurfacePoint s = closest_surface_point(body.model, p, 1e12, warm);
    EXPECT_TRUE(s.found && !s.truncated);
    EXPECT_EQ(s.closest_w.y, kHeight);
    warm = s.triangle;
    if (i > -400) most = std::max(most, s.looked);
  }
  return most;
}

TEST(FansWork, IsIndependentOfHowManyNeedlesMeet) {
  for (const int around : {12, 20, 80, 500}) {
    const std::int32_t through = most_looked(around, 0), beside = most_looked(around, 3e-4);
    RecordProperty("looked_" + std::to_string(around), std::to_string(through) + " " + std::to_string(beside));
    // Through the middle half of the needles are passed, at an eighth of a triangle each.
    EXPECT_LE(through, 20 + around / 16) << around;
    EXPECT_LE(beside, 10) << around;
  }
  // Half of so many are not passed in a tick, but beside the middle no tick needs that.
  EXPECT_LE(most_looked(1280, 3e-4), 25);
}

// At rest over the middle: one triangle.
TEST(FansWork, OverTheMiddleIsOneTriangle) {
  for (const int around : {80, 1280}) {
    const Body body = make_body(standing_cylinder(kRadius, kHeight, around));
    const Vec3 p{0, kHeight + 6e-3, 0};
    const int warm = closest_surface_point(body.model, p, 1e12, -1).triangle;
    const SurfacePoint s = closest_surface_point(body.model, p, 1e12, warm);
    EXPECT_LE(s.looked, 2) << around;
    EXPECT_EQ(s.nodes, 0) << around;
  }
}

}  // namespace
}  // namespace palpate::test
