#include <gtest/gtest.h>

#include <limits>

#include "rt_core/skeleton/straight_beam.h"
#include "sim_host/view/anchors.h"
#include "tests/deform/deform_scene.h"

namespace palpate {
namespace {

using palpate::kPi;

constexpr BeamMaterial kRubber{3e6, 0.47};

BeamSection circle(double r) { return {kPi * r * r, kPi * r * r * r * r / 4, r}; }

StraightBeam beam_along_x(double length_m, double radius_m, BeamTheory theory, double min_length_m = 0) {
  return make_straight_beam(kRubber, circle(radius_m), {0, 0, 0}, {length_m, 0, 0}, {0, 0, 1}, theory, min_length_m);
}

TEST(StraightBeam, EulerBernoulliMatchesTheTextbookCantilever) {
  const double l = 0.04, r = 3e-3;
  const StraightBeam beam = beam_along_x(l, r, BeamTheory::kEulerBernoulli);
  const Vec3 tip = beam_tip_displacement(beam, {2, 0.5, -0.25});
  const double ei = 3e6 * kPi * r * r * r * r / 4;
  EXPECT_NEAR(tip.x, 2 * l / (3e6 * kPi * r * r), 1e-15);
  EXPECT_NEAR(tip.y / (0.5 * l * l * l / (3 * ei)), 1, 1e-14);
  EXPECT_NEAR(tip.z / (-0.25 * l * l * l / (3 * ei)), 1, 1e-14);
}

// Timoshenko: shear adds F l / (kappa G S), kappa = 6(1+nu)/(7+6nu); a slender beam must not notice it.
TEST(StraightBeam, TimoshenkoAddsShearAndFadesForSlenderBeams) {
  const double l = 0.04, r = 6e-3, nu = 0.47;
  const double g = 3e6 / (2 * (1 + nu)), kappa = 6 * (1 + nu) / (7 + 6 * nu);
  const double bending = l * l * l / (3 * 3e6 * kPi * r * r * r * r / 4), shear = l / (kappa * g * kPi * r * r);
  EXPECT_NEAR(beam_along_x(l, r, BeamTheory::kTimoshenko).bending_N_per_m * (bending + shear), 1, 1e-14);
  const double thin = beam_along_x(1.0, 1e-2, BeamTheory::kTimoshenko).bending_N_per_m /
                      beam_along_x(1.0, 1e-2, BeamTheory::kEulerBernoulli).bending_N_per_m;
  // 1 - thin = 3 (r/2l)^2 (7+6nu)/3 = 2.455e-4
  EXPECT_NEAR(1 - thin, 0.25e-4 * (7 + 6 * nu), 1e-7);
}

TEST(StraightBeam, ForceAndTipDisplacementAreInverse) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3 contact = deform_test::random_vector(random, 0.05);
    const StraightBeam beam =
        make_straight_beam(kRubber, circle(4e-3), {}, contact, {0, 0, 1}, BeamTheory::kTimoshenko, 8e-3);
    const Vec3 d = deform_test::random_vector(random, 1e-3);
    EXPECT_LT(norm(beam_tip_displacement(beam, beam_force(beam, d)) - d), 1e-15 * 1e3 * norm(d));
    const Vec3 e = deform_test::random_vector(random, 1e-3);  // K_i is symmetric
    EXPECT_NEAR(dot(e, beam_force(beam, d)), dot(d, beam_force(beam, e)), 1e-18);
    EXPECT_GT(dot(d, beam_force(beam, d)), 0);
  }
}

TEST(StraightBeam, ContactAtTheAnchorStaysFiniteAndUsesTheFallbackAxis) {
  const StraightBeam beam = make_straight_beam(kRubber, circle(5e-3), {0.01, 0.02, 0.03}, {0.01, 0.02, 0.03}, {0, 1, 0},
                                               BeamTheory::kTimoshenko, 10e-3);
  EXPECT_EQ(beam.axis, (Vec3{0, 1, 0}));
  EXPECT_EQ(beam.length_m, 0);
  EXPECT_NEAR(beam.axial_N_per_m, 3e6 * kPi * 25e-6 / 10e-3, 1e-8);
  EXPECT_TRUE(beam.bending_N_per_m > 0 && beam.bending_N_per_m < beam.axial_N_per_m * 10);
}

TEST(StraightBeam, BadInputGivesNoStiffness) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 far{0.03, 0, 0};
  const auto stiffness = [&](BeamMaterial m, BeamSection s, Vec3 contact, double guard) {
    const StraightBeam b = make_straight_beam(m, s, {}, contact, {0, 0, 1}, BeamTheory::kTimoshenko, guard);
    return b.axial_N_per_m + b.bending_N_per_m;
  };
  EXPECT_GT(stiffness(kRubber, circle(1e-3), far, 0), 0);
  EXPECT_EQ(stiffness({0, 0.3}, circle(1e-3), far, 0), 0);
  EXPECT_EQ(stiffness({nan, 0.3}, circle(1e-3), far, 0), 0);
  EXPECT_EQ(stiffness({3e6, -1}, circle(1e-3), far, 0), 0);
  EXPECT_EQ(stiffness(kRubber, {0, 1e-12, 1e-3}, far, 0), 0);
  EXPECT_EQ(stiffness(kRubber, circle(1e-3), {nan, 0, 0}, 2e-3), 0);
  EXPECT_EQ(stiffness(kRubber, circle(1e-3), {}, 0), 0);  // no length and no guard
  EXPECT_EQ(beam_tip_displacement(StraightBeam{}, {1, 2, 3}), Vec3{});
  EXPECT_EQ(straight_beam_stress(StraightBeam{}, BeamSection{}, 0.3, {1, 2, 3}).axial_Pa, 0);
}

TEST(StraightBeam, BendingNeverVanishesBesideTheAxialStiffness) {
  // l/r = 1e4 would give k_b/k_a = 3 r^2/(4 l^2) = 7.5e-9.
  const StraightBeam beam = beam_along_x(1.0, 1e-4, BeamTheory::kEulerBernoulli);
  EXPECT_NEAR(beam.bending_N_per_m / beam.axial_N_per_m, 1e-6, 1e-18);
}

TEST(StraightBeam, StressesAtTheClamp) {
  const double l = 0.04, r = 6e-3, nu = 0.47;
  const StraightBeam beam = beam_along_x(l, r, BeamTheory::kTimoshenko);
  const BeamStress stress = straight_beam_stress(beam, circle(r), nu, {-2, 0.3, 0.4});
  EXPECT_NEAR(stress.axial_Pa, -2 / (kPi * r * r), 1e-9);
  EXPECT_NEAR(stress.bending_Pa, 0.5 * l * 4 / (kPi * r * r * r), 1e-8);
  EXPECT_NEAR(stress.shear_Pa, (3 + 2 * nu) / (2 * (1 + nu)) * 0.5 / (kPi * r * r), 1e-9);
}

// Shear stresses over a circular section by Saint-Venant's flexure (transverse force along y, coordinates from the
// centre), with the bending function of the circle, phi = (3+2nu) r^2 y/4 + (1+2nu)(y^3 - 3 y z^2)/12.
struct SectionShear {
  double xy_Pa, xz_Pa;
};
SectionShear section_shear(const BeamSection& section, double nu, double force_N, double y, double z) {
  const double scale = force_N / (2 * (1 + nu) * section.inertia_m4), r2 = section.radius_m * section.radius_m;
  const double phi_y = (3 + 2 * nu) * r2 / 4 + (1 + 2 * nu) * (y * y - z * z) / 4;
  const double phi_z = -(1 + 2 * nu) * y * z / 2;
  return {scale * (phi_y + nu * z * z - (1 + nu) * y * y), scale * phi_z};
}

// The shear field whose centre is reported must carry exactly the transverse force and leave the rim free of traction,
// for any nu.
TEST(StraightBeam, SectionShearIsInEquilibrium) {
  const double r = 6e-3, force = 1.7;
  for (const double nu : {0.0, 0.3, 0.47, 0.5}) {
    double sum_y = 0, sum_z = 0, rim = 0, divergence = 0;
    constexpr int kRings = 200, kSpokes = 64;  // midpoint in r: error 1/(8 kRings^2) of a cubic, 3e-6
    for (int i = 0; i < kRings; ++i) {
      const double rho = r * (i + 0.5) / kRings;
      for (int j = 0; j < kSpokes; ++j) {
        const double angle = 2 * kPi * (j + 0.5) / kSpokes;
        const double area = rho * (r / kRings) * (2 * kPi / kSpokes);
        const SectionShear t = section_shear(circle(r), nu, force, rho * std::cos(angle), rho * std::sin(angle));
        sum_y += t.xy_Pa * area;
        sum_z += t.xz_Pa * area;
      }
    }
    const double mean = force / (kPi * r * r);
    for (int j = 0; j < kSpokes; ++j) {
      const double c = std::cos(2 * kPi * j / kSpokes), s = std::sin(2 * kPi * j / kSpokes);
      const SectionShear t = section_shear(circle(r), nu, force, r * c, r * s);
      rim = std::max(rim, std::fabs(t.xy_Pa * c + t.xz_Pa * s) / mean);
      // d tau_xy/dy + d tau_xz/dz = -d sigma_x/dx = -F y / I
      const double y = 0.5 * r * c, z = 0.5 * r * s, h = 1e-3 * r;
      const double dy =
          (section_shear(circle(r), nu, force, y + h, z).xy_Pa - section_shear(circle(r), nu, force, y - h, z).xy_Pa) /
          (2 * h);
      const double dz =
          (section_shear(circle(r), nu, force, y, z + h).xz_Pa - section_shear(circle(r), nu, force, y, z - h).xz_Pa) /
          (2 * h);
      const double expected = -force * y / (kPi * r * r * r * r / 4);
      divergence = std::max(divergence, std::fabs(dy + dz - expected) * r / mean);
    }
    EXPECT_NEAR(sum_y / force, 1, 1e-5) << nu;
    EXPECT_NEAR(sum_z / force, 0, 1e-12) << nu;
    EXPECT_LT(rim, 1e-13) << nu;
    EXPECT_LT(divergence, 1e-9) << nu;
    const StraightBeam beam = beam_along_x(0.04, r, BeamTheory::kTimoshenko);
    EXPECT_NEAR(straight_beam_stress(beam, circle(r), nu, {0, force, 0}).shear_Pa,
                section_shear(circle(r), nu, force, 0, 0).xy_Pa, 1e-12 * mean);
  }
}

// The deflection line v(x) = F/(EI) (l x^2/2 - x^3/6), u(x) = F x/(ES), at x = s.
TEST(StraightBeam, ReleasedDisplacementLiesOnTheDeflectionLine) {
  const double l = 0.04, r = 3e-3, s = 5e-3;
  const StraightBeam beam = beam_along_x(l, r, BeamTheory::kEulerBernoulli);
  const Vec3 force{0.7, -0.2, 0.1};
  const Vec3 d = released_displacement(beam, beam_tip_displacement(beam, force), s);
  const double ei = 3e6 * kPi * r * r * r * r / 4, line = (l * s * s / 2 - s * s * s / 6) / ei;
  EXPECT_NEAR(d.x / (0.7 * s / (3e6 * kPi * r * r)), 1, 1e-13);
  EXPECT_NEAR(d.y / (-0.2 * line), 1, 1e-13);
  EXPECT_NEAR(d.z / (0.1 * line), 1, 1e-13);
}

TEST(StraightBeam, ReleaseLengthLimits) {
  const StraightBeam beam = beam_along_x(0.04, 3e-3, BeamTheory::kTimoshenko);
  const Vec3 tip{1e-3, -2e-3, 3e-3};
  EXPECT_EQ(released_displacement(beam, tip, 0), Vec3{});
  EXPECT_EQ(released_displacement(beam, tip, -1), Vec3{});
  EXPECT_EQ(released_displacement(beam, tip, std::numeric_limits<double>::quiet_NaN()), Vec3{});
  EXPECT_LT(norm(released_displacement(beam, tip, 0.04) - tip), 1e-18);  // whole beam released: moves with the tip
  EXPECT_LT(norm(released_displacement(beam, tip, 1.0) - tip), 1e-18);
  // Axial part of a rigid circular foot on a half space: s/(E S) = (1 - nu^2)/(2 E r).
  const double s = kPi * 3e-3 * (1 - 0.47 * 0.47) / 2;
  const Vec3 push = released_displacement(beam, beam_tip_displacement(beam, {1, 0, 0}), s);
  EXPECT_NEAR(push.x * 2 * 3e6 * 3e-3 / (1 - 0.47 * 0.47), 1, 1e-13);
}

}  // namespace
}  // namespace palpate
