// The dent under a tip against the half space's own integral, and against the tip that makes it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim_host/report/reference_curve.h"
#include "sim_host/view/neighbourhood.h"
#include "sim_host/view/surface_bend.h"
#include "sim_host/view/surface_shape.h"
#include "tests/deform/deform_scene.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

constexpr TipShape kShapes[] = {TipShape::kBall, TipShape::kCone, TipShape::kFlat};

// Height of the tip below the surface at x contact radii as Abel's transform sees it, over the depth (Sneddon 1965).
double seen(TipShape shape, double x) {
  return shape == TipShape::kBall ? 1 - x * x : shape == TipShape::kCone ? 1 - x : 1;
}

// u(r) = 2/pi int_0^min(1,r) g(x)/sqrt(r^2 - x^2) dx, x = r sin(t): midpoints, of a smooth function.
double by_integral(TipShape shape, double rho) {
  const double end = rho > 1 ? std::asin(1 / rho) : 0.5 * kPi;
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += seen(shape, rho * std::sin(end * (i + 0.5) / kSteps));
  return 2 / kPi * end / kSteps * sum;
}

TEST(ContactProfile, IsSneddonsIntegralInsideAndOutside) {
  for (const TipShape shape : kShapes)
    for (const double rho : {0.0, 0.3, 0.9, 1.0, 1.0001, 1.3, 2.0, 7.0, 300.0, 2000.0})
      EXPECT_NEAR(contact_profile(shape, rho), by_integral(shape, rho), 3e-7) << rho;
}

// Johnson 1985, table of section 3.4: half the depth at a ball's edge, 1 - 2/pi at a cone's.
TEST(ContactProfile, AtTheCentreAndTheEdge) {
  for (const TipShape shape : kShapes) EXPECT_EQ(contact_profile(shape, 0), 1);
  EXPECT_DOUBLE_EQ(contact_profile(TipShape::kBall, 1), 0.5);
  EXPECT_DOUBLE_EQ(contact_profile(TipShape::kCone, 1), 1 - 2 / kPi);
  EXPECT_DOUBLE_EQ(contact_profile(TipShape::kFlat, 1), 1);
}

// Value and, under a ball and a cone, slope: the surface leaves the tip along it.
TEST(ContactProfile, IsContinuousAtTheEdge) {
  for (const TipShape shape : kShapes) {
    const double h = 1e-8, inside = contact_profile(shape, 1 - h), outside = contact_profile(shape, 1 + h);
    EXPECT_NEAR(inside, outside, shape == TipShape::kFlat ? 2e-4 : 3e-8);  // a flat end's corner: like sqrt(h)
    if (shape == TipShape::kFlat) continue;
    const double d = 1e-5, in = (contact_profile(shape, 1) - contact_profile(shape, 1 - d)) / d,
                 out = (contact_profile(shape, 1 + d) - contact_profile(shape, 1)) / d;
    EXPECT_NEAR(in, out, 0.01 * std::abs(in));  // outside the slope changes like sqrt(d)
  }
}

// Far away every tip is its force: F / (pi E* r), F = 4/3 E* a d, E* a d and 2 E* a d.
TEST(ContactProfile, FarAwayOnlyTheForceCounts) {
  const double force[] = {4.0 / 3, 1, 2};
  for (std::size_t i = 0; i < 3; ++i)
    for (const double rho : {100.0, 999.0, 1001.0, 1e6})
      EXPECT_NEAR(contact_profile(kShapes[i], rho) * kPi * rho / force[i], 1, 1e-4) << rho;
}

// The pressures are those of the same contacts: over the whole contact they are the force, and the displacement that
// they make in the middle, by Boussinesq, is the depth: w(0) = 2 (1 - nu^2)/E int p dr, and F/(E* a d) as above.
TEST(ContactProfile, ThePressureIsTheForceAndMakesTheDepth) {
  const double force[] = {4.0 / 3, 1, 2};  // over E* a d
  for (std::size_t i = 0; i < 3; ++i) {
    double whole = 0, depth = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {  // r = sin t: bounded at a flat end's edge, and midpoints miss a cone's point
      const double t = 0.5 * kPi * (k + 0.5) / kSteps, r = std::sin(t), dr = 0.5 * kPi / kSteps * std::cos(t);
      const double p = contact_pressure(kShapes[i], r);
      whole += 2 * p * r * dr;
      depth += 2 * p * dr;
    }
    EXPECT_NEAR(whole, 1, 1e-6);
    EXPECT_NEAR(depth * force[i] / kPi, 1, 2e-4);
    EXPECT_EQ(contact_pressure(kShapes[i], 1), 0);
    EXPECT_EQ(contact_pressure(kShapes[i], 2.5), 0);
  }
}

// Under an axisymmetric pressure the surface of a half space moves in by (1 - 2 nu) (1 + nu) / (E r) times the integral
// of p r dr up to there (Timoshenko & Goodier 1970, section 139), and the pressure is the ball's: 4/3 E* a d in all.
TEST(ContactProfile, TheSurfaceIsDrawnInAsThePressureAsks) {
  for (const double nu : {0.0, 0.3, 0.49, 0.5})
    for (const double rho : {0.01, 0.3, 0.8, 1.0, 1.7, 6.0}) {
      double pushed = 0;
      constexpr int kSteps = 4000;
      const double end = std::min(rho, 1.0);
      for (int k = 0; k < kSteps; ++k) {
        const double r = end * (k + 0.5) / kSteps;
        pushed += contact_pressure(TipShape::kBall, r) * r * end / kSteps;
      }
      const double moved = (1 - 2 * nu) / (1 - nu) / rho * 4 / (3 * kPi) * pushed;
      // Of the contact's depth; F / (E* a) is 4/3 of it.
      EXPECT_NEAR(4.0 / 3 * contact_drawn_in_by_force(nu) * contact_drawn_in(rho), moved, 1e-6) << nu << " " << rho;
    }
  EXPECT_EQ(contact_drawn_in(0), 0);
}

// The accuracy case `block`, a ball half as deep as its radius on what is nearly half a space: where large-strain
// elements see the surface go along itself, Hertz' inward draw taken off. The form is within 0.007 of force / (E*
// ball's radius) there, an eighth of its largest (2026-11-26); a third of that for the block's far field.
TEST(ContactProfile, ADeepBallSpreadsTheSurfaceAsElementsDo) {
  const std::string path = PALPATE_SOURCE_DIR "/tests/accuracy/block.reference.csv";
  const ReferenceCurve reference = read_reference(path);
  constexpr double kNu = 0.49, kModulus = 2.62166e6 / (1 - kNu * kNu);  // block.toml
  const double ball_m = reference.press.radius_m, unit_m = norm(reference.force_N.back()) / (kModulus * ball_m);
  const double hertz_m = std::cbrt(0.75 * unit_m * ball_m * ball_m);
  const double drawn_m = contact_drawn_in_by_force(kNu) * unit_m * ball_m / hertz_m;
  int seen = 0;
  for (const elastic::MovedPlace& place : reference.surface.place) {
    const Vec3 from = tangential_part(place.rest_m - reference.press.place_m, reference.press.normal);
    const double r = norm(from), rho = r / hertz_m;
    if (rho > 2 || norm(place.displacement_m) < 0.05 * reference.surface.depth_m) continue;
    const double spread_m = dot(place.displacement_m, from) / r + drawn_m * contact_drawn_in(rho);
    EXPECT_NEAR(spread_m / unit_m, contact_spread(rho, kNu), 0.01) << rho;
    ++seen;
  }
  EXPECT_GT(seen, 30);
}

// A ball on a plane: inside the edge the dented surface is the ball's paraboloid, and beyond it lies outside the ball.
TEST(ContactProfile, TheDentedSurfaceLiesOnTheBall) {
  const double ball_m = 6e-3, depth_m = 1e-3;
  const ContactEllipse edge = ball_contact(depth_m, ball_m, {});
  EXPECT_DOUBLE_EQ(edge.across_m, std::sqrt(depth_m * ball_m));
  EXPECT_DOUBLE_EQ(edge.along_m, edge.across_m);
  for (double r = 0; r < 0.02; r += 1e-4) {
    const double dent = depth_m * contact_profile(TipShape::kBall, edge.radii({r, 0, 0}));
    const double tip = depth_m - r * r / (2 * ball_m);
    if (r < edge.across_m) {
      EXPECT_NEAR(dent, tip, 1e-15);
    }
    EXPECT_GE(dent, tip - 1e-15);
  }
}

// On a cylinder lengthwise: every point inside the edge is on the ball in both directions.
TEST(ContactProfile, OnABentSurfaceTheEdgeIsAnEllipse) {
  const double ball_m = 8e-3, body_m = 24e-3, depth_m = 1e-3;
  const ContactEllipse edge = ball_contact(depth_m, ball_m, {{0, 0, 1}, 1 / body_m, 0});
  for (const Vec3 p : {Vec3{1e-3, 0, 0}, Vec3{0, 0, 2e-3}, Vec3{1e-3, 0, 1e-3}}) {
    ASSERT_LT(edge.radii(p), 1);
    const double body = p.x * p.x / (2 * body_m), tip = (p.x * p.x + p.z * p.z) / (2 * ball_m);
    EXPECT_NEAR(depth_m * contact_profile(TipShape::kBall, edge.radii(p)), depth_m - tip - body, 1e-15);
  }
  EXPECT_NEAR(ball_contact(depth_m, ball_m, {{1, 0, 0}, 0, -1}).along_m, std::sqrt(depth_m * ball_m),
              1e-4);  // a hollow of 1 m
  EXPECT_DOUBLE_EQ(ball_contact(depth_m, ball_m, {{1, 0, 0}, 0, -1 / ball_m}).along_m,
                   2 * std::sqrt(depth_m * ball_m));  // a fit: bounded
}

TEST(ContactProfile, FadesWithoutAKink) {
  EXPECT_EQ(fade_out(1, 1, 2), 1);
  EXPECT_EQ(fade_out(1.5, 1, 2), 0.5);
  EXPECT_EQ(fade_out(2, 1, 2), 0);
  EXPECT_EQ(fade_out(3, 3, 3), 0);
  EXPECT_NEAR(fade_out(1 + 1e-4, 1, 2), 1, 4e-8);
  EXPECT_NEAR(fade_out(2 - 1e-4, 1, 2), 0, 4e-8);
}

// An ellipsoid of half axes 40, 30, 25 mm: at (0, 0, 25) its curvatures are 25/40^2 and 25/30^2 per mm.
TEST(SurfaceBend, OfAnEllipsoid) {
  deform_test::Scene scene;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) {
      const Vec3 p = deform_test::ellipsoid_point(1e-3 + 0.5 * i / 60, 2 * kPi * j / 60);
      scene.vertices.push_back(p);
      scene.normals.push_back(unit_or({p.x / 1.6e-3, p.y / 0.9e-3, p.z / 0.625e-3}, {}));
    }
  scene.bind();
  const SurfaceBend bend = surface_bend(scene.model, {0, 0, 25e-3}, {0, 0, 1}, 5e-3);
  EXPECT_NEAR(bend.most_1_per_m, 25e-3 / 0.9e-3, 0.02 * 28);  // its fourth order, 5 mm out
  EXPECT_NEAR(bend.least_1_per_m, 25e-3 / 1.6e-3, 0.02 * 16);
  EXPECT_NEAR(std::abs(bend.along.x), 1, 1e-6);
  EXPECT_EQ(surface_bend(scene.model, {0, 0, 25e-3}, {0, 0, 1}, 1e-6).most_1_per_m, 0);  // too few
}

}  // namespace
}  // namespace palpate
