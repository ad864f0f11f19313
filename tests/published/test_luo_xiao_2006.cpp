// Worked numbers of Luo & Xiao 2006: contact force, friction, region, beam skeleton, interpolation.
#include <vector>

#include "config/bake/contact_fit.h"
#include "rt_core/contact/friction.h"
#include "rt_core/contact/points/point_laws.h"
#include "rt_core/skeleton/skeleton.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/displacement_angle.h"
#include "tests/deform/deform_scene.h"
#include "tests/published/worked.h"

namespace palpate::test {
namespace {

CubicLaw duffing(double mass_kg, DuffingCoefficient coefficient) {
  DuffingDesc object;
  object.mass_kg = mass_kg;
  object.omega0 = 0.2;
  object.beta0sq_eps = 0.4;
  object.coefficient = coefficient;
  const ContactCoefficients c = duffing_paper_coefficients(object);
  return {c.k1_N_per_m, c.k3_N_per_m3, kHuge};
}
const CubicLaw kPrinted = duffing(1, DuffingCoefficient::kPaper);

// Eq. 3, m (w0^2 D + 3/4 b0^2 eps D^3), with section VII's m = 1, w0 = 0.2, b0^2 eps = 0.4, millimetres and newtons.
TEST(LuoXiao2006, ForceOfEquationThree) {
  const double force_N[5] = {0.34, 2.48, 8.22, 19.36, 37.7};
  for (int i = 0; i < 5; ++i) expect_worked(law_force_N(kPrinted, 1e-3 * (i + 1)), force_N[i]);
  expect_worked(law_tangent_N_per_m(kPrinted, 4.36e-3), 17148.64);
  expect_worked(law_energy_J(kPrinted, 4.357727104419092e-3), 0.02742569225778521);
  // Without the term (9/64) eps^2 b0^4 a^4 / w0^2, which "high order terms omitted" leaves out: with it 901 N.
  expect_worked(law_force_N(kPrinted, 4.35e-3), 24.8678625);
  expect_worked(law_force_N(kPrinted, 4.35e-3) + 9.0 / 64 * 0.4 * 0.4 / 0.04 * std::pow(4.35, 5), 900.9983871679687);
  // The same triple read as SI units.
  expect_worked(law_force_N({0.04, 0.3, kHuge}, 4.36e-3), 1.744248645568e-4);
  // A static force on the oscillator of eq. 1: coefficient 1 for 3/4.
  expect_worked(law_depth_m(duffing(1, DuffingCoefficient::kStatic), 25), 3.960103168823507e-3);
  // A finger part of 0.1 kg (Cui & Xiao 2008).
  expect_worked(duffing(0.1, DuffingCoefficient::kPaper).k1_N_per_m, 4);
  expect_worked(duffing(0.1, DuffingCoefficient::kPaper).k3_N_per_m3, 3e7);
}

TEST(LuoXiao2006, DepthOfAForce) {
  const double rows[][2] = {{1e-6, 2.49999998828125e-8}, {1e-3, 2.48844301989412e-5}, {0.01, 1.9467015955123876e-4},
                            {0.1, 6.294605751665613e-4}, {1, 1.464053019236961e-3},   {8.5, 3.034012854410961e-3},
                            {10, 3.204488111562214e-3},  {25, 4.357727104419092e-3},  {1000, 1.493504056434064e-2},
                            {4, 2.352519648291785e-3},   {2.5, 2.00547964366735e-3},  {7.6, 2.921823346999086e-3}};
  for (const auto& row : rows) expect_worked(law_depth_m(kPrinted, row[0]), row[1]);
}

// Steepness at the figures' 25 N, the damping that sampling at 1 ms asks for (k T / 2, Colgate & Schenkel 1997), and
// where the law is as steep as a PHANToM Premium can hold, 3.5 N/mm.
TEST(LuoXiao2006, SteepnessAgainstDevices) {
  const double tangent = law_tangent_N_per_m(kPrinted, law_depth_m(kPrinted, 25));
  expect_worked(tangent, 17130.80696492992);
  expect_worked(0.5e-3 * tangent, 8.56540348246496);
  expect_worked(law_tangent_N_per_m(kPrinted, 1.960725489313699e-3), 3500);
  expect_worked(law_force_N(kPrinted, 1.960725489313699e-3), 2.339799083914347);
}

// The cubic with the value and slope of Hertz' law at a depth, E = 3 MPa, nu = 0.47, sphere of 20 mm, 4 mm.
TEST(LuoXiao2006, CubicOfHertz) {
  const ContactCoefficients fit = hertz_coefficients(3e6, 0.47, 0.02, 4e-3);
  expect_worked(fit.k1_N_per_m, 34440.78517519892);
  expect_worked(fit.k3_N_per_m3, 717516357.8166441);
  expect_worked(law_force_N({fit.k1_N_per_m, fit.k3_N_per_m3, kHuge}, 4e-3), 183.6841876010609);
}

// --- Friction, section IV.B
// ---------------------------------------------------------------------------------------------------------

FrictionParameters friction(FrictionLaw law, double k, double mu) {
  FrictionParameters p;
  p.law = law;
  p.k_N = k;
  p.beta = 0.75;
  p.mu_dynamic = mu;
  p.contact = kPrinted;
  return p;
}
FrictionLoad under(double normal_N, double step_m) {
  FrictionLoad load;
  load.normal_w = {0, 0, 1};
  load.step_w = {step_m, 0, 0};
  load.force_N = normal_N;
  load.depth_m = law_depth_m(kPrinted, normal_N);
  load.tangent_N_per_m = law_tangent_N_per_m(kPrinted, load.depth_m);
  return load;
}

// K = 10, beta = 0.75: K |F_cn|^beta as a coefficient at 1, 5 and 25 N, and K were it for grams or millinewtons.
TEST(LuoXiao2006, LargestFriction) {
  const FrictionParameters p = friction(FrictionLaw::kPaper, 10, 0.5);
  expect_worked(static_limit_N(p, 1), 10);
  expect_worked(static_limit_N(p, 5) / 5, 6.68740304976422);
  expect_worked(static_limit_N(p, 25) / 25, 4.472135954999579);
  expect_worked(static_limit_N(p, 9.80665e-3) / 9.80665e-3 * 9.80665e-3 / std::pow(9.80665e-3, 0.5), 3.146879903051016);
  expect_worked(static_limit_N(p, 1e-3) / std::pow(1e-3, 0.5), 1.778279410038923);
  const FrictionParameters q = friction(FrictionLaw::kPaper, 0.8 * std::pow(5, 0.25), 0.5);
  expect_worked(q.k_N, 1.196279024976976);
  expect_worked(static_limit_N(q, 6.581793068761734), 4.915759826773901);
  expect_worked(sliding_limit_N(q, 6.581793068761734), 3.290896534380867);
}

struct FrictionRow {
  double x_mm;
  FrictionMode mode;
  double force_N, origin_mm;
};
void expect_rows(const FrictionParameters& p, const std::vector<FrictionRow>& rows) {
  FrictionMemory memory;
  friction_step(p, under(5, 0), memory);
  double x_mm = 0;
  for (const FrictionRow& row : rows) {
    const FrictionForce f = friction_step(p, under(5, 1e-3 * (row.x_mm - x_mm)), memory);
    x_mm = row.x_mm;
    EXPECT_EQ(memory.mode, row.mode) << x_mm;
    EXPECT_NEAR(f.force_w.x, row.force_N, 1e-9 * std::abs(row.force_N)) << x_mm;
    EXPECT_NEAR(x_mm - 1e3 * memory.stretch_w.x, row.origin_mm, 1e-9) << x_mm;
  }
}

// The printed rule: on slip the origin moves by the whole step, so it slides again only from another break; f_max 4,
// mu_D F 2.5 N under 5 N. Polynomials of the stretch: 1.8, 1.3, -0.7, -1.7 mm.
TEST(LuoXiao2006, FrictionTableOfThePrintedRule) {
  expect_rows(friction(FrictionLaw::kPaper, 0.8 * std::pow(5, 0.25), 0.5), {{1.0, FrictionMode::kStick, -0.34, 0},
                                                                            {2.0, FrictionMode::kStick, -2.48, 0},
                                                                            {2.3, FrictionMode::kStick, -3.7421, 0},
                                                                            {2.4, FrictionMode::kSlip, -2.5, 0.1},
                                                                            {3.0, FrictionMode::kSlip, -2.5, 0.7},
                                                                            {4.0, FrictionMode::kSlip, -2.5, 1.7},
                                                                            {3.5, FrictionMode::kStick, -1.8216, 1.7},
                                                                            {3.0, FrictionMode::kStick, -0.7111, 1.7},
                                                                            {1.0, FrictionMode::kStick, 0.1309, 1.7},
                                                                            {0.0, FrictionMode::kStick, 1.5419, 1.7}});
}

// The corrected rule, the return map: the stretch kept is the one that carries the sliding force.
TEST(LuoXiao2006, FrictionTableOfTheReturnMap) {
  expect_rows(friction(FrictionLaw::kReturnMap, 0.8 * std::pow(5, 0.25), 0.5),
              {{1.0, FrictionMode::kStick, -0.34, 0},
               {2.0, FrictionMode::kStick, -2.48, 0},
               {2.3, FrictionMode::kStick, -3.7421, 0},
               {2.4, FrictionMode::kSlip, -2.5, 0.39452035633265},
               {3.0, FrictionMode::kSlip, -2.5, 0.99452035633265},
               {4.0, FrictionMode::kSlip, -2.5, 1.99452035633265},
               {3.5, FrictionMode::kStick, -1.083856049301299, 1.99452035633265},
               {3.0, FrictionMode::kStick, -0.3451779382529056, 1.99452035633265},
               {1.0, FrictionMode::kStick, 0.3348761094375924, 1.99452035633265},
               {0.0, FrictionMode::kStick, 2.460108095380996, 1.99452035633265}});
}

// A displacement of 4 mm at 30 degrees from the normal: parts by themselves (point contact) and as one (region).
TEST(LuoXiao2006, SkewedDeformation) {
  FrictionParameters p = friction(FrictionLaw::kReturnMap, 100, 0.5);
  const double force_N[2][2] = {{12.60932987910143, 2.48}, {16.76625181726673, 9.68}};
  for (const TangentialLaw law : {TangentialLaw::kSeparable, TangentialLaw::kRadial}) {
    p.tangential = law;
    FrictionLoad load = under(12.60932987910143, 2e-3);
    FrictionMemory memory{{}, 0, FrictionMode::kStick};
    const FrictionForce f = friction_step(p, load, memory);
    expect_worked(load.force_N + f.normal_gain_N, force_N[law == TangentialLaw::kRadial][0]);
    expect_worked(-f.force_w.x, force_N[law == TangentialLaw::kRadial][1]);
  }
}

// Mindlin's ratio 2 (1 - nu)/(2 - nu), and what its plain spring k_t(D) s gives away between 1 and 3 mm of depth.
TEST(LuoXiao2006, PlainTangentialSpringGivesEnergy) {
  ModelParams params{};
  params.poisson_ratio = 0.47;
  const double ratio = friction_parameters(params).mindlin_ratio;
  expect_worked(ratio, 0.6928104575163399);
  const double rise = law_tangent_N_per_m(kPrinted, 3e-3) - law_tangent_N_per_m(kPrinted, 1e-3);
  expect_worked(0.5 * ratio * rise * 0.3e-3 * 0.3e-3, 2.244705882352941e-4);
}

// --- Region, section IV.C
// ---------------------------------------------------------------------------------------------------------

TEST(LuoXiao2006, RegionOfFourPoints) {
  const Vec3 up{0, 0, 1}, at[4] = {{}, {2e-3, 0, 0}, {2e-3, 2e-3, 0}, {0, 2e-3, 0}};
  std::vector<Contact> contact(4);
  const std::vector<std::int32_t> index{0, 1, 2, 3};
  for (std::size_t i = 0; i < 4; ++i) {
    contact[i].position_w = at[i];
    contact[i].normal_w = up;
    contact[i].depth_m = 1e-3 * static_cast<double>(i + 1);
    contact[i].weight = 1;
  }
  RegionRows rows{contact.data(), index.data(), 4};
  weigh_contacts(ContactWeight::kPaper, rows);
  const RegionLoad load = region_load(PointLaws{kPrinted, &rows, nullptr, 1}, 0, rows, 0, {});
  const double force_N[4] = {0.085, 0.62, 2.055, 4.84};
  for (std::size_t i = 0; i < 4; ++i) expect_worked(contact[i].force_N, force_N[i]);
  expect_worked(load.force_N, 7.6);
  expect_worked(region_centre(rows, up).position_w, {0.7039473684210526e-3, 1.814473684210526e-3, 0});
  rows.geometric = true;
  expect_worked(region_centre(rows, up).position_w, {1e-3, 1e-3, 0});
}

// --- Skeleton, section V
// ---------------------------------------------------------------------------------------------------------

struct Five {
  std::vector<Anchor> anchor;
  Skeleton skeleton;
  explicit Five(BeamTheory theory) {
    for (const Vec3 p : {Vec3{0.04, 0, 0}, Vec3{-0.04, 0, 0}, Vec3{0, 0.03, 0}, Vec3{0, -0.03, 0}, Vec3{0, 0, -0.02}})
      anchor.push_back(deform_test::make_anchor(p, 6e-3));
    build_skeleton({{3e6, 0.47}, theory, false}, anchor, {}, {0, 0, 0.02}, skeleton);
    EXPECT_TRUE(distribute_by_stiffness({1, 0, -10}, skeleton));
  }
  Vec3 diagonal() const {
    Vec3 sum;
    for (std::int32_t i = 0; i < skeleton.count; ++i)
      sum += Vec3{beam_force(skeleton.beam[i], {1, 0, 0}).x, beam_force(skeleton.beam[i], {0, 1, 0}).y,
                  beam_force(skeleton.beam[i], {0, 0, 1}).z};
    return sum;
  }
  Vec3 moved(std::int32_t i) const { return anchor_displacement(skeleton, anchor[static_cast<std::size_t>(i)], i); }
};

// Beams of Bernoulli and Euler, eqs. 4 and 5, sharing by stiffness.
TEST(LuoXiao2006, FiveAnchorsEulerBernoulli) {
  const Five five(BeamTheory::kEulerBernoulli);
  const Skeleton& s = five.skeleton;
  expect_worked(five.diagonal(), {12713.87540934129, 13497.85629329111, 17742.44340859004});
  expect_worked(s.displacement_w, {7.865422365750636e-5, 0, -5.636202280435895e-4});
  expect_worked(s.force_w[0], {2.166337025973577, 0, -1.136867557036736});
  expect_worked(s.force_w[1], {-1.208340492060645, 0, -0.6659251971488041});
  expect_worked(s.force_w[2], {0.01537249684801461, 2.397074173554019, -1.708205646328165});
  expect_worked(s.force_w[3], {0.01537249684801461, -2.397074173554019, -1.708205646328165});
  expect_worked(s.force_w[4], {0.0112584723910395, 0, -4.780795953158131});
  expect_worked(0.5 * dot({1, 0, -10}, s.displacement_w), 2.857428252046701e-3);
  const double axial_N = dot(s.beam[0].axis, s.force_w[0]);
  expect_worked(axial_N, -2.44605336869031);
  expect_worked(norm(s.force_w[0] - axial_N * s.beam[0].axis), 0.04802988512897517);
  const BeamStress stress = straight_beam_stress(s.beam[0], section_of(five.anchor[0]), 0.47, s.force_w[0]);
  expect_worked(stress.axial_Pa, -21627.86026075807);
  expect_worked(stress.bending_Pa, 12661.43451830897);
  expect_worked(five.anchor[0].release_length_m, 7.342844509235424e-3);
  expect_worked(five.moved(0), {3.933159082967988e-5, 0, -3.970681466173324e-5});
  expect_worked(five.moved(4), {3.732497487816609e-6, 0, -1.034643924195972e-4});
}

TEST(LuoXiao2006, FiveAnchorsTimoshenko) {
  const Five five(BeamTheory::kTimoshenko);
  expect_worked(five.diagonal(), {12679.76613941815, 13474.03836210879, 17718.28173808806});
  expect_worked(five.skeleton.displacement_w, {7.886580785518243e-5, 0, -5.643888130813229e-4});
  expect_worked(five.moved(0), {3.939972684133696e-5, 0, -3.97662178200448e-5});
}

// Eqs. 6 to 8: the ratio of the two free scales (forces: Skeleton.PaperIsThePrintedLawAndTheGuardedOneIsNot).
TEST(LuoXiao2006, FiveAnchorsByTheRatios) {
  Five five(BeamTheory::kEulerBernoulli);
  ASSERT_TRUE(distribute_by_ratios(3e6, {1, 0, -10}, five.skeleton));
  expect_worked(five.skeleton.beta_Pa / five.skeleton.alpha_Pa, 110.36705505118);
}

// --- Shape, section V.A
// ---------------------------------------------------------------------------------------------------------

// Magnitudes and angles to the normal mixed by w = 0.6, 0.4: 161.565 and 90 degrees give 132.939.
TEST(LuoXiao2006, DisplacementAngle) {
  const PatchCorner corner[3] = {{{1, 0, -3}, {0, 0, 1}, 0.6}, {{0, .5, -1}, {1, 0, 0}, 0.4}, {}};
  const Vec3 n{.6, 0, .8}, d = displacement_by_angle(corner, n);
  expect_worked(norm(d), 2.344580191600986);
  expect_worked(std::acos(dot(d, n) / norm(d)) * 180 / kPi, 132.9390307062468);
  expect_worked(d, {0.4064313355523291, 0.1895466536358745, -2.301291357135012});
  const PatchCorner first[3] = {{{1, 0, -3}, {0, 0, 1}, 1}, {}, {}};
  expect_worked(std::acos(dot(displacement_by_angle(first, {0, 0, 1}), {0, 0, 1}) / std::sqrt(10)) * 180 / kPi,
                161.565051177078);
}

}  // namespace
}  // namespace palpate::test
