#include <gtest/gtest.h>

#include <limits>

#include "rt_core/skeleton/skeleton.h"
#include "sim_host/view/anchors.h"
#include "tests/deform/deform_scene.h"

namespace palpate {
namespace {

using deform_test::make_anchor;
using deform_test::wide;

// The worked example: five anchors, p = (0,0,20) mm, F = (1,0,-10) N, sections of radius 6 mm.
struct Example {
  std::vector<Anchor> anchors;
  Vec3 contact{0, 0, 0.02};
  Vec3 force{1, 0, -10};
  Example() {
    for (const Vec3 p : {Vec3{0.04, 0, 0}, Vec3{-0.04, 0, 0}, Vec3{0, 0.03, 0}, Vec3{0, -0.03, 0}, Vec3{0, 0, -0.02}}) {
      anchors.push_back(make_anchor(p, 6e-3));
    }
  }
};

Skeleton build(const Example& example, BeamTheory theory, bool guard = false) {
  Skeleton skeleton;
  build_skeleton({{3e6, 0.47}, theory, guard}, example.anchors, {}, example.contact, skeleton);
  return skeleton;
}

Vec3 sum_of_forces(const Skeleton& skeleton) {
  Vec3 sum;
  for (int i = 0; i < skeleton.count; ++i) sum += skeleton.force_w[i];
  return sum;
}

Vec3 diagonal(const Skeleton& s) {
  Vec3 sum;
  for (int i = 0; i < s.count; ++i) {
    sum += Vec3{beam_force(s.beam[i], {1, 0, 0}).x, beam_force(s.beam[i], {0, 1, 0}).y,
                beam_force(s.beam[i], {0, 0, 1}).z};
  }
  return sum;
}

void expect_near(Vec3 actual, Vec3 expected, double tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

TEST(Skeleton, WorkedExampleEulerBernoulli) {
  const Example example;
  Skeleton s = build(example, BeamTheory::kEulerBernoulli);
  const Vec3 k = diagonal(s);
  expect_near(k, {12713.87540934, 13497.85629329, 17742.44340859}, 6e-9);
  ASSERT_TRUE(distribute_by_stiffness(example.force, s));
  expect_near(s.displacement_w, {7.86542237e-5, 0, -5.63620228e-4}, 6e-13);
  expect_near(s.force_w[0], {2.166337, 0, -1.136868}, 6e-7);
  expect_near(s.force_w[1], {-1.208340, 0, -0.665925}, 6e-7);
  expect_near(s.force_w[2], {0.015372, 2.397074, -1.708206}, 6e-7);
  expect_near(s.force_w[3], {0.015372, -2.397074, -1.708206}, 6e-7);
  expect_near(s.force_w[4], {0.011258, 0, -4.780796}, 6e-7);
  EXPECT_NEAR(0.5 * dot(example.force, s.displacement_w), 2.857428252e-3, 6e-13);

  const BeamStress stress = straight_beam_stress(
      s.beam[0], {example.anchors[0].section_area_m2, example.anchors[0].section_inertia_m4, 6e-3}, 0.47, s.force_w[0]);
  const double axial_N = dot(s.beam[0].axis, s.force_w[0]);
  EXPECT_NEAR(axial_N, -2.446053, 6e-7);
  EXPECT_NEAR(norm(s.force_w[0] - axial_N * s.beam[0].axis), 0.048030, 6e-7);
  EXPECT_NEAR(stress.axial_Pa, -21627.86, 6e-3);
  EXPECT_NEAR(stress.bending_Pa, 12661.43, 6e-3);
  EXPECT_NEAR(example.anchors[0].release_length_m, 7.3428445e-3, 6e-11);
  expect_near(anchor_displacement(s, example.anchors[0], 0), {0.039332e-3, 0, -0.039707e-3}, 6e-10);
  expect_near(anchor_displacement(s, example.anchors[4], 4), {0.003732e-3, 0, -0.103464e-3}, 6e-10);
}

TEST(Skeleton, WorkedExampleTimoshenko) {
  const Example example;
  Skeleton s = build(example, BeamTheory::kTimoshenko);
  expect_near(diagonal(s), {12679.76613942, 13474.03836211, 17718.28173809}, 6e-9);
  ASSERT_TRUE(distribute_by_stiffness(example.force, s));
  expect_near(anchor_displacement(s, example.anchors[0], 0), {0.039400e-3, 0, -0.039766e-3}, 6e-10);
}

TEST(Skeleton, WorkedExamplePaperRatios) {
  const Example example;
  Skeleton s = build(example, BeamTheory::kEulerBernoulli);
  ASSERT_TRUE(distribute_by_ratios(3e6, example.force, s));
  EXPECT_FALSE(s.minimum_norm);
  EXPECT_NEAR(s.beta_Pa / s.alpha_Pa, 110.367, 6e-4);
  // F lies in the plane of the two columns here, so (8) holds.
  EXPECT_LT(norm(sum_of_forces(s) - example.force), 1e-12);
}

// `paper` is the printed law: beams of their own length. Forces by 40-digit arithmetic (mpmath, 2026-11-23), the
// printed length and the guarded one.
TEST(Skeleton, PaperIsThePrintedLawAndTheGuardedOneIsNot) {
  Example example;
  Model model;
  model.params.youngs_modulus_Pa = 3e6;
  model.params.poisson_ratio = 0.47;
  model.anchor = example.anchors;
  const struct {
    SkeletonLaw law;
    double ratio;
    Vec3 force[5];
  } worked[] = {{SkeletonLaw::kPaper,
                 110.36705505118,
                 {{0.663762543043694, 0, -1.40708082591557},
                  {-0.253876861258302, 0, -1.31531688548537},
                  {0.215970998153296, 0.307772771990046, -2.36489182952632},
                  {0.215970998153296, -0.307772771990046, -2.36489182952632},
                  {0.158172321908016, 0, -2.54781862954642}}},
                {SkeletonLaw::kPaperGuarded,
                 122.9194143086,
                 {{0.648710438748216, 0, -1.4443313847486},
                  {-0.235986579275215, 0, -1.35586168294626},
                  {0.213290521834785, 0.300524596212114, -2.33325494915592},
                  {0.213290521834785, -0.300524596212114, -2.33325494915592},
                  {0.160695096857429, 0, -2.53329703399329}}}};
  for (const auto& row : worked) {
    model.params.skeleton_law = row.law;
    Skeleton s;
    ASSERT_TRUE(solve_skeleton(model, {}, example.contact, example.force, s));
    EXPECT_NEAR(s.beta_Pa / s.alpha_Pa / row.ratio, 1, 1e-9);
    for (std::size_t i = 0; i < 5; ++i) expect_near(s.force_w[i], row.force[i], 1e-9);
  }
}

// At an anchor I/l^3 has no bound: down to kLeastLength_m the nearest beam takes the force, all finite; nearer the
// printed law says that it is singular. The guarded one goes on.
TEST(Skeleton, ThePrintedLawSaysWhereItIsSingular) {
  Example example;
  Model model;
  model.params.youngs_modulus_Pa = 3e6;
  model.params.poisson_ratio = 0.47;
  model.anchor = example.anchors;
  for (const double apart : {1e-3, 1e-6, 2 * kLeastLength_m, 0.5 * kLeastLength_m, 0.0}) {
    example.contact = Vec3{0.04 - apart, 0, 0};
    Skeleton s;
    model.params.skeleton_law = SkeletonLaw::kPaper;
    EXPECT_EQ(solve_skeleton(model, {}, example.contact, example.force, s), apart > kLeastLength_m);
    EXPECT_EQ(s.degenerate, apart <= kLeastLength_m);
    for (int i = 0; i < s.count; ++i) EXPECT_LE(norm(s.force_w[i]), 30 * norm(example.force)) << apart;
    EXPECT_TRUE(is_finite(sum_of_forces(s)));
    model.params.skeleton_law = SkeletonLaw::kPaperGuarded;
    EXPECT_TRUE(solve_skeleton(model, {}, example.contact, example.force, s));
    EXPECT_TRUE(is_finite(sum_of_forces(s)));
  }
}

// The stiffness law against dense elimination in long double, with the stiffness matrix written from rotations.
TEST(Skeleton, StiffnessLawAgreesWithDenseSolve) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Anchor> anchors;
    for (int i = 0; i < 3 + trial % 12; ++i) {
      anchors.push_back(make_anchor(deform_test::random_vector(random, 0.05), 2e-3 + 1e-4 * i));
    }
    const Vec3 contact = deform_test::random_vector(random, 0.05), force = deform_test::random_vector(random, 10);
    Skeleton s;
    build_skeleton({{3e6, 0.47}, BeamTheory::kTimoshenko, true}, anchors, {}, contact, s);
    ASSERT_TRUE(distribute_by_stiffness(force, s));

    deform_test::Dense k(3, deform_test::Row(3, 0));
    for (const Anchor& a : anchors) {
      const long double l = deform_test::distance(a.position_m, contact), r = wide(a.section_radius_m);
      const long double le = std::sqrt(l * l + 4 * r * r), e = 3e6L, nu = wide(0.47);
      const long double g = e / (2 * (1 + nu)), kappa = 6 * (1 + nu) / (7 + 6 * nu);
      const long double area = wide(a.section_area_m2), inertia = wide(a.section_inertia_m4);
      const long double ka = e * area / le;
      const long double kb = 1 / (le * le * le / (3 * e * inertia) + le / (kappa * g * area));
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const Vec3 span = contact - a.position_m;
          const long double xx = wide(deform_test::component(span, i)) / l * wide(deform_test::component(span, j)) / l;
          k[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] += (i == j ? kb : 0) + (ka - kb) * xx;
        }
      }
    }
    const deform_test::Row d = deform_test::solve_dense(k, {wide(force.x), wide(force.y), wide(force.z)});
    const Vec3 oracle{static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2])};
    EXPECT_LT(norm(s.displacement_w - oracle), 1e-12 * norm(oracle));
  }
}

TEST(Skeleton, ForcesSumAndEnergyBalances) {
  std::mt19937_64 random(3);
  double worst_sum = 0, worst_energy = 0;
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<Anchor> anchors;
    for (int i = 0; i < 1 + trial % 32; ++i) {
      anchors.push_back(make_anchor(deform_test::random_vector(random, 0.05), 3e-3));
    }
    const Vec3 contact = deform_test::random_vector(random, 0.05), force = deform_test::random_vector(random, 10);
    Skeleton s;
    build_skeleton({{3e6, 0.47}, BeamTheory::kTimoshenko, true}, anchors, {}, contact, s);
    ASSERT_TRUE(distribute_by_stiffness(force, s));
    worst_sum = std::max(worst_sum, norm(sum_of_forces(s) - force) / norm(force));
    double energy = 0;
    for (int i = 0; i < s.count; ++i) energy += 0.5 * dot(s.displacement_w, s.force_w[i]);
    const double work = 0.5 * dot(force, s.displacement_w);
    EXPECT_GT(work, 0);
    worst_energy = std::max(worst_energy, std::fabs(energy - work) / work);
  }
  EXPECT_LT(worst_sum, 1e-12);
  EXPECT_LT(worst_energy, 1e-12);
}

// Mirrored anchors: a push along the axis gives mirrored shares.
TEST(Skeleton, SymmetricLoadsGiveSymmetricShares) {
  Example example;
  example.force = {0, 0, -10};
  for (const bool paper : {false, true}) {
    Skeleton s = build(example, paper ? BeamTheory::kEulerBernoulli : BeamTheory::kTimoshenko, true);
    ASSERT_TRUE(paper ? distribute_by_ratios(3e6, example.force, s) : distribute_by_stiffness(example.force, s));
    EXPECT_EQ(s.minimum_norm, paper);  // the ratios are singular for a force on a symmetry axis
    EXPECT_NEAR(s.force_w[0].z, s.force_w[1].z, 1e-14);
    EXPECT_NEAR(s.force_w[0].x, -s.force_w[1].x, 1e-14);
    EXPECT_NEAR(s.force_w[2].y, -s.force_w[3].y, 1e-14);
    EXPECT_LT(norm(sum_of_forces(s) - example.force), 1e-12);
    EXPECT_GT(anchor_displacement(s, example.anchors[0], 0).x, 0);  // sides bulge outward
    EXPECT_LT(anchor_displacement(s, example.anchors[0], 0).z, 0);  // and go down
  }
}

// The minimum-norm solution is the pseudo-inverse's: among all (alpha, beta) that fit equally well, the shortest.
TEST(Skeleton, PaperRatiosTakeTheLeastNormWhereSingular) {
  Example example;
  example.force = {0, 0, -10};
  Skeleton s = build(example, BeamTheory::kEulerBernoulli);
  ASSERT_TRUE(distribute_by_ratios(3e6, example.force, s));
  double a = 0, b = 0;  // (A D).D and (B D).D
  for (int i = 0; i < s.count; ++i) {
    const double c = s.beam[i].axis.z;
    a += s.beam[i].axial_N_per_m / 3e6 * c * c;
    b += s.beam[i].bending_N_per_m / 9e6 * (1 - c * c);
  }
  EXPECT_NEAR(s.alpha_Pa / (10 * a / (a * a + b * b)), 1, 1e-12);
  EXPECT_NEAR(s.beta_Pa / (10 * b / (a * a + b * b)), 1, 1e-12);
}

// In space the three equations overdetermine the two scales: least squares means the residual is normal to both
// columns.
TEST(Skeleton, PaperRatiosAreLeastSquaresInSpace) {
  std::mt19937_64 random(5);
  int unbalanced = 0;
  for (int trial = 0; trial < 50; ++trial) {
    Example example;
    example.contact = deform_test::random_vector(random, 0.02);
    example.force = deform_test::random_vector(random, 10);
    Skeleton s = build(example, BeamTheory::kEulerBernoulli, true);
    ASSERT_TRUE(distribute_by_ratios(3e6, example.force, s));
    if (s.minimum_norm) continue;
    const Vec3 direction = unit_or(example.force, {});
    Vec3 u, v;
    for (int i = 0; i < s.count; ++i) {
      const Vec3 along = dot(s.beam[i].axis, direction) * s.beam[i].axis;
      u += s.beam[i].axial_N_per_m * along;
      v += s.beam[i].bending_N_per_m * (direction - along);
    }
    const Vec3 residual = example.force - sum_of_forces(s);
    EXPECT_LT(std::fabs(dot(residual, u)), 1e-10 * norm(u) * norm(example.force));
    EXPECT_LT(std::fabs(dot(residual, v)), 1e-10 * norm(v) * norm(example.force));
    unbalanced += norm(residual) > 1e-3 * norm(example.force) ? 1 : 0;
  }
  EXPECT_GT(unbalanced, 10);  // the paper's law does lose force; the stiffness law never does
}

// alpha = E, beta = 3E would be the stiffness law: for one beam, whose force lies in the columns' plane, both agree
// only if the displacement is along the force; the ratios put it there by assumption.
TEST(Skeleton, PaperRatiosBalanceASingleBeam) {
  Example example;
  example.anchors.resize(1);
  Skeleton s = build(example, BeamTheory::kEulerBernoulli);
  ASSERT_TRUE(distribute_by_ratios(3e6, example.force, s));
  EXPECT_LT(norm(s.force_w[0] - example.force), 1e-12);
}

TEST(Skeleton, RotatingTheSceneRotatesTheAnswer) {
  std::mt19937_64 random(17);
  const Example example;
  for (const bool paper : {false, true}) {
    const BeamTheory theory = paper ? BeamTheory::kEulerBernoulli : BeamTheory::kTimoshenko;
    Skeleton rest = build(example, theory, true);
    ASSERT_TRUE(paper ? distribute_by_ratios(3e6, example.force, rest) : distribute_by_stiffness(example.force, rest));
    for (int trial = 0; trial < 50; ++trial) {
      const Pose pose{deform_test::random_vector(random, 0.1), deform_test::random_rotation(random)};
      Example turned;
      for (std::size_t i = 0; i < turned.anchors.size(); ++i) {
        turned.anchors[i].position_m = transform(pose, example.anchors[i].position_m);
      }
      turned.contact = transform(pose, example.contact);
      turned.force = rotate(pose.orientation, example.force);
      Skeleton s = build(turned, theory, true);
      ASSERT_TRUE(paper ? distribute_by_ratios(3e6, turned.force, s) : distribute_by_stiffness(turned.force, s));
      for (int i = 0; i < s.count; ++i) {
        // 1e-10: positions are rounded at 0.1 m, beams are 0.03 m, the paper's columns amplify by about 100.
        EXPECT_LT(norm(s.force_w[i] - rotate(pose.orientation, rest.force_w[i])), 1e-10);
      }
    }
  }
}

TEST(Skeleton, FixedAnchorsCarryLoadButKeepStill) {
  Example example;
  example.anchors[4].fixed = 1;
  Skeleton s = build(example, BeamTheory::kTimoshenko, true);
  ASSERT_TRUE(distribute_by_stiffness(example.force, s));
  EXPECT_EQ(anchor_displacement(s, example.anchors[4], 4), Vec3{});
  EXPECT_GT(norm(s.force_w[4]), 1);
  EXPECT_LT(straight_beam_stress(s.beam[4], section_of(example.anchors[4]), 0.47, s.force_w[4]).axial_Pa, -1000);
}

// The kinematic variant: the dent's displacement instead of the skeleton's; the modulus drops out.
TEST(Skeleton, KinematicVariantDoesNotDependOnTheModulus) {
  const Example example;
  const Vec3 dent{0, 0, -4e-3};
  Vec3 first;
  for (const double modulus : {3e6, 7e7}) {
    Skeleton s;
    build_skeleton({{modulus, 0.47}, BeamTheory::kTimoshenko, true}, example.anchors, {}, example.contact, s);
    const Vec3 d = released_displacement(s.beam[0], dent, example.anchors[0].release_length_m);
    if (modulus < 1e7) first = d;
    EXPECT_EQ(d, first);
    EXPECT_LT(d.z, 0);
  }
}

TEST(Skeleton, CollinearBeamsAndContactAtAnAnchorStayRegular) {
  std::vector<Anchor> line;
  for (const double z : {-0.02, -0.01, 0.0, 0.02}) line.push_back(make_anchor({0, 0, z}, 1e-4));
  for (const double contact_z : {0.02, 0.03}) {  // at the last anchor, and beyond it
    Skeleton s;
    build_skeleton({{3e6, 0.47}, BeamTheory::kTimoshenko, true}, line, {}, {0, 0, contact_z}, s);
    ASSERT_TRUE(distribute_by_stiffness({1, 2, -10}, s));
    EXPECT_LT(norm(sum_of_forces(s) - Vec3{1, 2, -10}), 1e-11);
    EXPECT_TRUE(is_finite(s.displacement_w));
  }
}

TEST(Skeleton, DegenerateInputIsFlagged) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Example example;
  Skeleton s = build(example, BeamTheory::kTimoshenko, true);
  EXPECT_FALSE(distribute_by_stiffness({nan, 0, 0}, s));
  EXPECT_TRUE(s.degenerate);
  EXPECT_EQ(sum_of_forces(s), Vec3{});
  EXPECT_FALSE(distribute_by_ratios(3e6, {nan, 0, 0}, s));
  EXPECT_TRUE(s.degenerate);
  EXPECT_FALSE(distribute_by_ratios(0, {1, 0, 0}, s));
  EXPECT_TRUE(distribute_by_stiffness({}, s));  // no force: nothing moves, nothing wrong
  EXPECT_EQ(sum_of_forces(s), Vec3{});
  EXPECT_TRUE(distribute_by_ratios(3e6, {}, s));
  EXPECT_FALSE(s.degenerate);
  EXPECT_EQ(sum_of_forces(s), Vec3{});

  build_skeleton({{3e6, 0.47}, BeamTheory::kTimoshenko, true}, {}, {}, {}, s);
  EXPECT_EQ(s.count, 0);
  EXPECT_FALSE(distribute_by_stiffness({0, 0, 1}, s));
  EXPECT_FALSE(distribute_by_ratios(3e6, {0, 0, 1}, s));
  EXPECT_TRUE(s.degenerate);

  Example flat = example;
  for (Anchor& a : flat.anchors) a.section_area_m2 = 0;
  s = build(flat, BeamTheory::kTimoshenko, true);
  EXPECT_FALSE(distribute_by_stiffness({0, 0, 1}, s));
  EXPECT_TRUE(s.degenerate);
}

TEST(Skeleton, TakesNoMoreThanItsCapacity) {
  std::mt19937_64 random(23);
  std::vector<Anchor> many;
  for (int i = 0; i < kMaxAnchors + 8; ++i) many.push_back(make_anchor(deform_test::random_vector(random, 0.05), 3e-3));
  Skeleton s;
  build_skeleton({{3e6, 0.47}, BeamTheory::kTimoshenko, true}, many, {}, {}, s);
  EXPECT_EQ(s.count, kMaxAnchors);
}

}  // namespace
}  // namespace palpate
