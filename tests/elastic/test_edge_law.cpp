// Beside a sharp edge of the body: how far the edge is, and what it takes from a ball's force.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "config/bake/edge_fits.h"
#include "config/body/procedural.h"
#include "config/response/corner_normals.h"

namespace palpate::test {
namespace {

constexpr double kRight = 0.5 * std::numbers::pi;

elastic::BallLaw ball(double poisson_ratio) { return {12e-3, 3e5, false, poisson_ratio, 0, {}}; }

// Forces of large-strain elements over those in the middle of the same block, 100 x 60 x 100 mm (2026-11-28): four
// deviations of the fit's 1.1 % RMS at most.
TEST(EdgeLaw, IsThatOfElementsOnABlock) {
  struct Met {
    double poisson_ratio, distance_mm, depth_mm, share;
  };
  for (const Met& m : {Met{0.45, 0, 1.2, 0.414},
                       {0.45, 0, 4, 0.457},
                       {0.45, 2, 1.2, 0.558},
                       {0.45, 4, 1.2, 0.671},
                       {0.45, 4, 4, 0.626},
                       {0.45, 8, 1.2, 0.812},
                       {0.45, 8, 4, 0.747},
                       {0.45, 16, 4, 0.887},
                       {0.2, 0, 4, 0.489},
                       {0.2, 2, 1.2, 0.622},
                       {0.2, 4, 4, 0.669},
                       {0.2, 16, 4, 0.913}})
    EXPECT_NEAR(elastic::edge_share({1e-3 * m.distance_mm, kRight}, ball(m.poisson_ratio), 1e-3 * m.depth_mm) / m.share,
                1, 0.045)
        << m.poisson_ratio << ' ' << m.distance_mm << ' ' << m.depth_mm;
}

TEST(EdgeLaw, TakesLessFartherOffAndFromBlunterEdges) {
  for (const double poisson_ratio : {0.0, 0.3, 0.4999})
    for (const double depth_m : {0.1e-3, 1e-3, 6e-3}) {
      double last = 0;
      for (double distance_m = 0; distance_m < 40e-3; distance_m += 1e-3) {
        const double share = elastic::edge_share({distance_m, kRight}, ball(poisson_ratio), depth_m);
        EXPECT_GT(share, last);
        EXPECT_LT(share, 1);
        last = share;
      }
      EXPECT_GT(last, 0.94);
      last = 0;
      for (double opening = 0.3; opening < 3.2; opening += 0.1) {
        const double share = elastic::edge_share({1e-3, opening}, ball(poisson_ratio), depth_m);
        EXPECT_GE(share, last) << opening;
        last = share;
      }
      EXPECT_EQ(elastic::edge_share({0, std::numbers::pi}, ball(poisson_ratio), depth_m), 1);
    }
}

// What the tick has of it is within a tenth of it from a third of the depth on, which large strain's growth leaves.
TEST(EdgeLaw, TheTicksFormIsNearToIt) {
  const elastic::BallLaw law = ball(0.4);
  const double depth_m = 4e-3, factor = 4.0 / 3 * law.modulus_Pa * std::sqrt(law.radius_m);
  for (const double distance_m : {0.0, 2e-3, 5e-3, 10e-3}) {
    const elastic::SharpEdge edge{distance_m, kRight};
    const elastic::EdgeFit fit = fit_edge(edge, 1.0, law, depth_m, elastic::EdgeForm::kScaled);
    for (double depth = depth_m / 3; depth <= depth_m; depth += depth_m / 6) {
      const double wanted = factor * std::pow(depth, 1.5) * elastic::edge_share(edge, law, depth);
      const double needed = std::pow(wanted / (fit.scale * factor), 2.0 / 3) + fit.give_mpN * wanted;
      EXPECT_NEAR(needed / depth, 1, 0.07) << distance_m << ' ' << depth;  // 0.1 of the force
    }
  }
}

TEST(EdgeLaw, WhatElementsTellIsLeftToThem) {
  const elastic::SharpEdge edge{8e-3, kRight};
  const elastic::EdgeFit fit = fit_edge(edge, 8e-3, ball(0.4), 4e-3, elastic::EdgeForm::kScaled);
  EXPECT_EQ(fit.scale, 1);
  EXPECT_EQ(fit.give_mpN, 0);
  EXPECT_GT(fit_edge(edge, 9e-3, ball(0.4), 4e-3, elastic::EdgeForm::kGiveAlone).give_mpN, 0);
}

SharpEdges edges_of(const SurfaceMesh& mesh, bool is_held = false) {
  BodyDesc body;
  body.shape = BodyShape::kMesh;
  const std::vector<Triangle> triangle = linked_triangles(mesh);
  const std::vector<bool> held(mesh.vertex_m.size(), is_held);
  return {mesh.vertex_m, corner_normals(body, mesh.vertex_m, triangle), triangle, held};
}

TEST(SharpEdges, OfABoxAreAsFarAsTheyAre) {
  const SharpEdges box = edges_of(make_box({0.06, 0.03, 0.04}, 2000));  // its top is 30 mm up
  const auto distance_m = [&](Vec3 place, Vec3 outward) {
    const auto edge = box.about(place, outward, 0.01, 0.02);
    return edge ? edge->distance_m : -1;
  };
  EXPECT_NEAR(distance_m({0.028, 0.03, 0.001}, {0, 1, 0}), 2e-3, 1e-9);
  EXPECT_NEAR(box.about({0.028, 0.03, 0.001}, {0, 1, 0}, 0.01, 0)->opening_rad, kRight, 1e-9);
  EXPECT_NEAR(distance_m({0.027, 0.03, 0.016}, {0, 1, 0}), 3e-3, 1e-9);
  EXPECT_EQ(distance_m({0.03, 0.03, 0}, unit_or({1, 1, 0}, {})), 0);  // on one, with the normal between its faces
  EXPECT_EQ(distance_m({0.03, 0.03, 0.02}, unit_or({1, 1, 1}, {})), 0);
  EXPECT_TRUE(box.about({0.03, 0.03, 0.02}, unit_or({1, 1, 1}, {}), 0.01, 0)->is_corner);
  EXPECT_EQ(distance_m({0, 0.03, 0}, {0, 1, 0}), -1);
  EXPECT_NEAR(distance_m({0.03, 0.026, 0}, {1, 0, 0}), 4e-3, 1e-9);
  // Its side is 30 mm high: narrow for a ball of 16.
  EXPECT_FALSE(box.about({0.03, 0.026, 0}, {1, 0, 0}, 0.01, 0.032).has_value());
}

TEST(SharpEdges, RoundHollowAndHeldOnesAreNone) {
  const SharpEdges ball = edges_of(make_ellipsoid({0.03, 0.03, 0.03}, 2000));
  EXPECT_FALSE(ball.about({0, 0.06, 0}, {0, 1, 0}, 1, 0).has_value());
  EXPECT_FALSE(edges_of(make_box({0.06, 0.03, 0.04}, 2000), true).about({0.028, 0.03, 0}, {0, 1, 0}, 0.01, 0));
  SurfaceMesh hollow = make_box({0.06, 0.03, 0.04}, 2000);  // inside out: a box's room
  for (auto& corners : hollow.triangle) std::swap(corners[1], corners[2]);
  EXPECT_FALSE(edges_of(hollow).about({0.028, 0.03, 0}, {0, -1, 0}, 0.01, 0));
}

}  // namespace
}  // namespace palpate::test
