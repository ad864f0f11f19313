// How far the smooth surface of an elastic body stands off a facet: its slopes, and that it has no kink at an edge.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "config/elastic/fixed_random.h"
#include "rt_core/surface/facet_sag.h"

namespace palpate::test {
namespace {

using Weights = std::array<Real, 3>;

// A triangle of some shape with normals that are no surface's.
struct Facet {
  foot::Corners corners;
  Vec3 rest[3];

  explicit Facet(elastic::FixedRandom& random) {
    const auto any = [&] { return Vec3{random.symmetric(), random.symmetric(), random.symmetric()}; };
    const Vec3 place[3] = {{0, 0, 0}, {4e-3, 0, 0}, {1e-3, 3e-3, 0}};
    for (int k = 0; k < 3; ++k) {
      corners.v[k] = place[k] + 5e-4 * any();
      corners.u[k] = unit_or(Vec3{0, 0, 1} + 0.3 * any(), {});
    }
    for (int k = 0; k < 3; ++k) rest[k] = corners.v[k];
  }
  FacetSag at(const Weights& w) const {
    const Real weight[3] = {w[0], w[1], w[2]};
    return {corners, rest, weight};
  }
  Vec3 edge_m(int k) const { return corners.v[(k + 1) % 3] - corners.v[k]; }
};

TEST(FacetSag, SlopesAreItsOwn) {
  elastic::FixedRandom random(4);
  constexpr Real kStep = 1e-6;
  for (int i = 0; i < 50; ++i) {
    Facet facet(random);
    const Weights w{0.2 + 0.1 * random.symmetric(), 0.3 + 0.2 * random.symmetric(), 0};
    const Weights inside{w[0], w[1], 1 - w[0] - w[1]};
    const FacetSag sag = facet.at(inside);
    for (int k = 1; k < 3; ++k) {
      Weights up = inside, down = inside;
      for (const auto& [to, sign] : {std::pair{&up, 1.0}, std::pair{&down, -1.0}}) {
        (*to)[static_cast<std::size_t>(k)] += sign * kStep;
        (*to)[0] -= sign * kStep;
      }
      EXPECT_NEAR((facet.at(up).value_m - facet.at(down).value_m) / (2 * kStep), sag.slope_m()[k] - sag.slope_m()[0],
                  1e-9);
    }
    for (int k = 0; k < 3; ++k)
      for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        const auto corner = static_cast<std::uint32_t>(k);
        const auto moved = [&](Real by_place, Real by_normal) {
          Facet other = facet;
          other.corners.v[k] += by_place * axis;
          other.corners.u[k] += by_normal * axis;
          return other.at(inside).value_m;
        };
        EXPECT_NEAR((moved(kStep, 0) - moved(-kStep, 0)) / (2 * kStep), dot(sag.by_place()[corner], axis), 1e-7);
        EXPECT_NEAR((moved(0, kStep) - moved(0, -kStep)) / (2 * kStep), dot(sag.by_normal()[corner], axis), 1e-9);
      }
  }
}

// Along an edge it is what the edge's two ends say, and across it rises as the mixed normals ask: so does the facet on
// the other side, and there is no kink.
TEST(FacetSag, HasTheNormalsOfTheEdgesEnds) {
  elastic::FixedRandom random(9);
  for (int i = 0; i < 50; ++i) {
    const Facet facet(random);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, far = (k + 2) % 3;
      const Vec3 edge = facet.edge_m(k), to = facet.corners.v[far] - facet.corners.v[k];
      const Real way = dot(to, edge) / squared_norm(edge);
      const Vec3 across = to - way * edge;  // as area coordinates: far + 1, next - way, k - (1 - way)
      for (const Real part : {0.1, 0.37, 0.5, 0.82}) {
        Weights w{};
        w[static_cast<std::size_t>(k)] = 1 - part;
        w[static_cast<std::size_t>(next)] = part;
        const FacetSag sag = facet.at(w);
        const Double4 slope = sag.slope_m();
        const Vec3 mixed = (1 - part) * facet.corners.u[k] + part * facet.corners.u[next];
        const Real first = -dot(facet.corners.u[k], edge), last = dot(facet.corners.u[next], edge);
        EXPECT_NEAR(sag.value_m, part * (1 - part) * ((1 - part) * first + part * last), 1e-15);
        const Real rises = slope[far] - way * slope[next] - (1 - way) * slope[k];
        EXPECT_NEAR(rises, -dot(mixed, across), 1e-14);
      }
    }
  }
}

// The normals of a ball: a parabola's sag, and within 1 % of the ball's own.
TEST(FacetSag, OfABallIsTheBalls) {
  constexpr Real kRadius = 0.02;
  foot::Corners corners;
  const Vec3 place[3] = {{1e-3, 0, 2e-3}, {-2e-3, 0, 1e-3}, {1e-3, 0, -2e-3}};
  for (int k = 0; k < 3; ++k) {
    corners.u[k] = unit_or(place[k] + Vec3{0, kRadius, 0}, {});
    corners.v[k] = kRadius * corners.u[k];
  }
  const Vec3 rest[3] = {corners.v[0], corners.v[1], corners.v[2]};
  const Real weight[3] = {0.2, 0.3, 0.5};
  const Vec3 flat = weight[0] * corners.v[0] + weight[1] * corners.v[1] + weight[2] * corners.v[2];
  const Real sag = kRadius - norm(flat);
  EXPECT_NEAR(FacetSag(corners, rest, weight).value_m, sag, 0.01 * sag);
}

}  // namespace
}  // namespace palpate::test
