// The closest-point query against brute force over all triangles, and its behaviour at the edges of its domain.
#include "rt_core/surface/closest_point.h"

#include <gtest/gtest.h>

#include <limits>

#include "rt_core/surface/four_queries.h"
#include "rt_core/surface/ring_proof.h"
#include "tests/collide/edge_crossings.h"
#include "tests/collide/meshes.h"

namespace palpate::test {
namespace {

struct Brute {
  double distance2 = 1e300;
  int triangle = -1;
  Vec3 closest;
};

Brute brute_force(const Model& model, Vec3 p) {
  Brute best;
  for (std::size_t t = 0; t < model.triangle.size(); ++t) {
    const auto at = [&](int k) { return model.vertex_m[static_cast<std::size_t>(model.triangle[t].vertex[k])]; };
    const Vec3 c = closest_on_triangle(p, at(0), at(1), at(2)).point;
    const double d2 = squared_norm(p - c);
    if (d2 < best.distance2) best = {d2, static_cast<int>(t), c};
  }
  return best;
}

// Solid angle of the whole surface seen from p over 4 pi (van Oosterom & Strackee 1983): 1 inside, 0 outside. An oracle
// for the sign that shares nothing with pseudo-normals.
double winding_number(const Model& model, Vec3 p) {
  double sum = 0;
  for (const Triangle& t : model.triangle) {
    const auto at = [&](int k) { return model.vertex_m[static_cast<std::size_t>(t.vertex[k])] - p; };
    const Vec3 a = at(0), b = at(1), c = at(2);
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * 3.14159265358979323846);
}

Mesh named(const std::string& name) {
  if (name == "box") return box({0.03, 0.02, 0.01});
  if (name == "torus") return torus(0.04, 0.012, 48, 24);
  if (name == "offset") return ellipsoid({0.05, 0.035, 0.03}, 10, {3.7, -5.3, 9.1});
  return ellipsoid({0.05, 0.035, 0.03}, 14);
}

class ClosestPoint : public testing::TestWithParam<std::string> {
 protected:
  Body body = make_body(named(GetParam()));
  Vec3 centre = GetParam() == "offset" ? Vec3{3.7, -5.3, 9.1} : Vec3{};
};

// The answer must be the brute-force one, to the bit, whatever the warm start.
void expect_exact(const Model& model, Vec3 p, std::mt19937_64& rng) {
  const Brute oracle = brute_force(model, p);
  std::uniform_int_distribution<int> any(0, static_cast<int>(model.triangle.size()) - 1);
  for (const int warm : {-1, oracle.triangle, any(rng), 1 << 30}) {
    const SurfacePoint s = closest_surface_point(model, p, 1e12, warm);
    ASSERT_TRUE(s.found);
    if (s.truncated) continue;  // near the medial axis: allowed there, counted by the caller's own checks
    ASSERT_EQ(s.triangle, oracle.triangle) << "warm start " << warm;
    ASSERT_EQ(s.closest_w, oracle.closest);
    ASSERT_EQ(abs_of(s.signed_distance_m), square_root(oracle.distance2));
    ASSERT_NEAR(norm(s.normal_w), 1, 1e-12);
  }
}

TEST_P(ClosestPoint, MatchesBruteForceEverywhere) {
  std::mt19937_64 rng(7);
  int truncated = 0;
  for (int i = 0; i < 1500; ++i) {
    const Vec3 p = centre + random_vec(rng, i % 3 == 0 ? 0.06 : i % 3 == 1 ? 0.03 : 0.3);
    expect_exact(body.model, p, rng);
    truncated += closest_surface_point(body.model, p, 1e12, -1).truncated ? 1 : 0;
  }
  EXPECT_LE(truncated, 15);  // 1 %: points that fall next to the medial axis
}

// From a bound: the same answer, or none and nothing nearer than the bound.
TEST_P(ClosestPoint, ABoundFindsTheSameOrNothing) {
  std::mt19937_64 rng(11);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = centre + random_vec(rng, i % 2 == 0 ? 0.06 : 0.3);
    const Brute oracle = brute_force(body.model, p);
    const double distance = square_root(oracle.distance2);
    const SurfacePoint wider = nearer_surface_point(body.model, p, 1.001 * distance, kMaxSearched);
    if (wider.truncated) continue;
    ASSERT_TRUE(wider.found);
    ASSERT_EQ(wider.triangle, oracle.triangle);
    ASSERT_EQ(wider.closest_w, oracle.closest);
    const SurfacePoint narrower = nearer_surface_point(body.model, p, 0.999 * distance, kMaxSearched);
    ASSERT_FALSE(narrower.found);
    ASSERT_LE(narrower.lower_bound_m, distance);
    if (narrower.truncated) continue;
    ASSERT_GE(narrower.lower_bound_m, 0.998 * distance);
  }
}

TEST_P(ClosestPoint, MatchesBruteForceNextToFacesEdgesAndVertices) {
  std::mt19937_64 rng(8);
  std::uniform_int_distribution<std::size_t> any(0, body.model.triangle.size() - 1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 1500; ++i) {
    const Triangle& t = body.model.triangle[any(rng)];
    const auto at = [&](int k) { return body.model.vertex_m[static_cast<std::size_t>(t.vertex[k])]; };
    const double a = i % 3 == 0 ? 1.0 : u(rng), b = i % 3 == 2 ? (1 - a) * u(rng) : 1 - a;  // vertex, edge, face
    const Vec3 on = a * at(0) + b * at(1) + (1 - a - b) * at(2);
    const double offset[] = {0, 1e-12, 1e-7, 1e-4, 3e-3};
    expect_exact(body.model, on + offset[i % 5] * random_unit(rng), rng);
  }
}

// Four together: what they settle is what each has alone, to the bit; the others are left.
TEST_P(ClosestPoint, FourSettleTheSame) {
  std::mt19937_64 rng(12);
  std::uniform_int_distribution<int> any(0, static_cast<int>(body.model.triangle.size()) - 1);
  int settled = 0, on_edges = 0;
  for (int i = 0; i < 2000; ++i) {
    FourQueries query;
    for (int k = 0; k < 4; ++k) {
      query.p[k] = centre + random_vec(rng, i % 2 == 0 ? 0.06 : 0.09);
      const std::int32_t nearest = brute_force(body.model, query.p[k]).triangle;
      const std::int32_t across = body.model.triangle[static_cast<std::size_t>(nearest)].adjacent[i % 3];
      query.warm_triangle[k] = i % 7 == 0 ? any(rng) : i % 7 == 1 ? across : i % 31 == 2 ? -1 : nearest;
    }
    const std::int32_t count = 1 + i % 4;
    const FourSettled four = settle_four(body.model, query, count);
    ASSERT_LT(four.settled, 1u << count);
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count); ++k) {
      if ((four.settled >> k & 1) == 0) continue;
      ASSERT_NO_FATAL_FAILURE(expect_as_alone(body, query, four, k));
      settled += 1;
      on_edges += settled_point(four, k).feature == Feature::kFace ? 0 : 1;
    }
  }
  // Of 5,000, half of them outside or more, over the faces and edges of bodies that are convex there.
  EXPECT_GT(settled, 500);
  EXPECT_GT(on_edges, 50);
}

TEST_P(ClosestPoint, FourSettleWhatCameOverAnEdge) {
  const EdgeCrossings crossings = cross_edges(body);
  EXPECT_GT(crossings.settled, 1500);  // of 16,000; 1,961 on the torus, half of whose edges lie in its hollow
}

TEST_P(ClosestPoint, SignAgreesWithTheWindingNumber) {
  std::mt19937_64 rng(9);
  int inside = 0;
  for (int i = 0; i < 1500; ++i) {
    const Vec3 p = centre + random_vec(rng, 0.05);
    const SurfacePoint s = closest_surface_point(body.model, p, 1e12, -1);
    if (abs_of(s.signed_distance_m) < 1e-9) continue;
    const bool oracle = winding_number(body.model, p) > 0.5;
    ASSERT_EQ(s.signed_distance_m < 0, oracle);
    ASSERT_NEAR(dot(s.normal_w, p - s.closest_w), s.signed_distance_m, 1e-12 + 1e-15 * norm(p));
    inside += oracle ? 1 : 0;
  }
  EXPECT_GT(inside, 30);  // both sides were tried
}

TEST_P(ClosestPoint, SignIsRightAroundEveryVertex) {
  // Where a face normal alone gives the wrong side: the closest feature is the vertex, seen from all directions.
  std::mt19937_64 rng(10);
  for (std::size_t v = 0; v < body.model.vertex_m.size(); v += 1 + body.model.vertex_m.size() / 60) {
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = body.model.vertex_m[v] + 2e-4 * random_unit(rng);
      const SurfacePoint s = closest_surface_point(body.model, p, 1e12, -1);
      if (abs_of(s.signed_distance_m) < 1e-8) continue;
      ASSERT_EQ(s.signed_distance_m<0, winding_number(body.model, p)> 0.5) << "vertex " << v;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, ClosestPoint, testing::Values("ellipsoid", "box", "torus", "offset"),
                         [](const auto& param) { return param.param; });

TEST(ClosestPointLimits, PointOnTheSurfaceGetsThePseudoNormal) {
  const Body body = make_body(box({0.03, 0.02, 0.01}));
  const SurfacePoint face = closest_surface_point(body.model, {0.001, 0.002, 0.01}, 1e12, -1);
  EXPECT_NEAR(face.signed_distance_m, 0, 1e-16);  // rounding of the face point
  EXPECT_EQ(face.normal_w, (Vec3{0, 0, 1}));
  const SurfacePoint edge = closest_surface_point(body.model, {0.03, 0.002, 0.01}, 1e12, -1);
  EXPECT_NEAR(edge.normal_w.x, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(edge.normal_w.z, std::sqrt(0.5), 1e-15);
  const SurfacePoint corner = closest_surface_point(body.model, {0.03, 0.02, 0.01}, 1e12, -1);
  EXPECT_NEAR(dot(corner.normal_w, Vec3{1, 1, 1}), std::sqrt(3.0), 1e-12);  // three right angles: the diagonal
}

TEST(ClosestPointLimits, SearchRadiusIsInclusiveAndBoundsTheAnswer) {
  const Body body = make_body(box({0.03, 0.02, 0.01}));
  const Vec3 p{0, 0, 0.0625};  // 0.0525 above the face
  EXPECT_FALSE(closest_surface_point(body.model, p, 0.0524, -1).found);
  EXPECT_FALSE(closest_surface_point(body.model, p, 0.0524, 3).found);
  EXPECT_TRUE(closest_surface_point(body.model, p, 0.0526, -1).found);
  EXPECT_LE(closest_surface_point(body.model, p, 0.0524, -1).lower_bound_m, 0.0525);
  EXPECT_FALSE(closest_surface_point(body.model, p, std::numeric_limits<double>::quiet_NaN(), -1).truncated);
}

TEST(ClosestPointLimits, BadPointsAreNotFound) {
  const Body body = make_body(box({0.03, 0.02, 0.01}));
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e13, -1e300}) {
    EXPECT_FALSE(closest_surface_point(body.model, {bad, 0, 0}, 1e12, 0).found) << bad;
    EXPECT_FALSE(closest_surface_point(body.model, {0, bad, 0}, 1e12, -1).found) << bad;
    EXPECT_FALSE(closest_surface_point(body.model, {0, 0, bad}, 1e12, -1).found) << bad;
  }
  const SurfacePoint far = closest_surface_point(body.model, {1e11, 0, 0}, 1e12, -1);
  EXPECT_TRUE(far.found);
  EXPECT_NEAR(far.signed_distance_m, 1e11, 1);
}

TEST(ClosestPointLimits, MedialAxisIsCappedFlaggedAndStillInside) {
  const Body body = make_body(ellipsoid({0.03, 0.03, 0.03}, 60));  // 28,800 triangles, all equally far from the centre
  const SurfacePoint s = closest_surface_point(body.model, {}, 1e12, -1);
  ASSERT_TRUE(s.found);
  EXPECT_TRUE(s.truncated);
  EXPECT_LE(s.nodes, kMaxSearched);
  EXPECT_NEAR(s.signed_distance_m, -0.03, 1e-4);
  EXPECT_LE(s.lower_bound_m, -s.signed_distance_m);
}

// A point `height` above a random place of the test ellipsoid.
Vec3 above_ellipsoid(std::mt19937_64& rng, double height) {
  const Vec3 u = random_unit(rng);
  return Vec3{0.05 * u.x, 0.035 * u.y, 0.03 * u.z} + height * unit_or({u.x / 0.05, u.y / 0.035, u.z / 0.03}, {});
}

TEST(ClosestPointLimits, SearchesGrowOnlyWithTheDepthOfTheTree) {
  // Inside the body no certificate holds, so the hierarchy is searched. Nodes opened 3 mm deep, measured 2026-11-21: 8
  // at 2,888 and 12 at 28,800 triangles.
  const auto mean_nodes = [](int n) {
    const Body body = make_body(ellipsoid({0.05, 0.035, 0.03}, n));
    std::mt19937_64 rng(11);
    double sum = 0;
    for (int i = 0; i < 400; ++i) sum += closest_surface_point(body.model, above_ellipsoid(rng, -3e-3), 1e12, -1).nodes;
    return sum / 400;
  };
  const double small = mean_nodes(19), large = mean_nodes(60);
  RecordProperty("nodes", std::to_string(small) + " " + std::to_string(large));
  EXPECT_GT(small, 1);
  EXPECT_LT(small, 25);
  EXPECT_LT(large, small + 12);  // ten times the triangles: log4(10) = 1.7 levels, a few nodes each
}

TEST(ClosestPointLimits, QueriesOutsideAConvexBodyNeedNoSearch) {
  // The certificates' purpose: at any mesh size a warm query proves its answer on the spot. 0.1 mm is a tick at 0.1
  // m/s.
  for (const int n : {19, 60}) {
    const Body body = make_body(ellipsoid({0.05, 0.035, 0.03}, n));
    std::mt19937_64 rng(12);
    int opened = 0, cold = 0;
    for (int i = 0; i < 400; ++i) {
      const Vec3 p = above_ellipsoid(rng, i % 2 == 0 ? 1e-3 : 5e-3);
      const int warm = closest_surface_point(body.model, p, 1e12, -1).triangle;
      opened += closest_surface_point(body.model, p + 1e-4 * random_unit(rng), 1e12, warm).nodes > 0 ? 1 : 0;
      cold += closest_surface_point(body.model, p, 1e12, -1).nodes > 0 ? 1 : 0;
    }
    EXPECT_LE(opened, 4) << n;  // 1 %
    EXPECT_LE(cold, 40) << n;   // a cold query still finds the neighbourhood straight down, nine times in ten
  }
}

// Whether a triangle lies in or below the planes of another and of what is across its edges.
bool lies_below(const Model& model, const Triangle& t, const Triangle& other) {
  const auto corner = [&](const Triangle& of, int k) { return model.vertex_m[static_cast<std::size_t>(of.vertex[k])]; };
  const auto is_below = [&](const Triangle& plane) {
    const Vec3 a = corner(plane, 0), normal = unit_or(cross(corner(plane, 1) - a, corner(plane, 2) - a), {});
    double highest = -1e300;
    for (int k = 0; k < 3; ++k) highest = std::max(highest, dot(corner(other, k) - a, normal));
    return highest < 1e-14;
  };
  bool below = is_below(t);
  for (const std::int32_t across : t.adjacent)
    below = below && is_below(model.triangle[static_cast<std::size_t>(across)]);
  return below;
}

TEST_P(ClosestPoint, ClearanceCertificatesHold) {
  // No triangle outside the ring comes nearer to the clearance point than stated; by planes, none that rises above
  // them.
  std::mt19937_64 rng(13);
  std::uniform_int_distribution<std::size_t> any(0, body.model.triangle.size() - 1);
  int certified = 0;
  for (int i = 0; i < 300; ++i) {
    const std::size_t index = any(rng);
    const Triangle& t = body.model.triangle[index];
    if (t.clear_radius_m == 0) continue;
    ++certified;
    const auto at = [&](const Triangle& of, int k) {
      return body.model.vertex_m[static_cast<std::size_t>(of.vertex[k])];
    };
    const Vec3 centroid = (1.0 / 3.0) * (at(t, 0) + at(t, 1) + at(t, 2));
    const Vec3 clear = centroid + double(t.clear_scale_per_m) * cross(at(t, 1) - at(t, 0), at(t, 2) - at(t, 0));
    EXPECT_LT(norm(clear - centroid), double(t.clear_radius_m));
    for (const Triangle& other : body.model.triangle) {
      int common = 0;
      for (const int a : t.vertex)
        for (const int b : other.vertex) common += a == b ? 1 : 0;
      if (common > 0 || (ring_proof::is_by_planes(t) && lies_below(body.model, t, other))) continue;
      const Vec3 c = closest_on_triangle(clear, at(other, 0), at(other, 1), at(other, 2)).point;
      ASSERT_GE(norm(clear - c), double(t.clear_radius_m));
    }
  }
  if (GetParam() != "box") {  // all of a box's triangles are in every ring, or nearly so
    EXPECT_GT(certified, 150);
  }
}

TEST(ClosestPointLimits, AThinBodyIsNotConfusedWithItsOtherSide) {
  // A plate 10 um thick, warm started on the wrong side: the certificate and the dismissal by plane must not hide the
  // near side.
  const Body body = make_body(ellipsoid({0.05, 0.035, 5e-6}, 20));
  std::mt19937_64 rng(14);
  std::uniform_int_distribution<int> any(0, static_cast<int>(body.model.triangle.size()) - 1);
  for (int i = 0; i < 2000; ++i) {
    Vec3 p = random_vec(rng, 0.03);
    p.z = i % 2 == 0 ? 1e-2 * p.z : p.z;
    const Brute oracle = brute_force(body.model, p);
    const SurfacePoint s = closest_surface_point(body.model, p, 1e12, any(rng));
    ASSERT_EQ(s.triangle, oracle.triangle);
    ASSERT_EQ(s.closest_w, oracle.closest);
  }
}

}  // namespace
}  // namespace palpate::test
