// The reference scenes on coarse meshes against large-strain forces computed elsewhere (an independent Q9 / T6 /
// CalculiX study published with the scenes, good to 0.5 % after its own erratum; clip 0.05 N). Finer meshes: the
// report.
#include <gtest/gtest.h>

#include <cmath>

#include "config/fem/pair_fit.h"
#include "config/scene/config_error.h"
#include "tests/strain/arm_series.h"
#include "tests/strain/plane_scenes.h"

namespace palpate::fem {
namespace {

struct Row {
  double depth_mm, force_N;
};

PressCurve press(const PressBody& body, const RigidTool& tool, StrainLaw law, const std::vector<Row>& rows,
                 const PressMeshing& meshing) {
  std::vector<double> depths;
  for (const Row& row : rows) depths.push_back(1e-3 * row.depth_mm);
  return press_axisymmetric(body, tool, law, depths, meshing);
}

void expect_forces(const PressCurve& curve, const std::vector<Row>& rows, double share) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_NEAR(curve.points[i].force_N / rows[i].force_N, 1, share) << rows[i].depth_mm << " mm";
}

TEST(ReferenceScenes, SphereOnTheRubberBlock) {
  const PressMeshing meshing = {6e-3, 12, 1.25};
  const std::vector<Row> large = {{1, 11.573}, {2, 32.303}, {3, 58.363}},
                         linear = {{1, 11.836}, {2, 33.407}, {3, 60.968}};
  const PressCurve curve = press(rubber_block(), ball(6.35e-3), StrainLaw::kNeoHookean, large, meshing);
  expect_forces(curve, large, 0.01);  // 12 elements over 6 mm: the contact's edge moves by 0.5 mm
  expect_forces(press(rubber_block(), ball(6.35e-3), StrainLaw::kLinear, linear, meshing), linear, 0.01);
  // Work of the press: Simpson on three depths from 1 to 3 mm.
  const auto& p = curve.points;
  const double work = 1e-3 / 3 * (p[0].force_N + 4 * p[1].force_N + p[2].force_N);
  EXPECT_NEAR(work / (p[2].energy_J - p[0].energy_J), 1, 0.005);
  EXPECT_NEAR(1e3 * p[2].energy_J / 71.006, 1, 0.005);
}

TEST(ReferenceScenes, FlatPunchOnALayer) {
  const std::vector<Row> rows = {{0.2, 1.2961}, {0.48, 3.2643}};
  expect_forces(press(layer(3.2e-3), punch(1.6e-3, 0.2e-3), StrainLaw::kNeoHookean, rows, {2e-3, 10, 1.25}), rows,
                0.015);
}

TEST(ReferenceScenes, SphereOnTheEllipsoid) {
  const std::vector<Row> rows = {{2, 39.671}, {4, 109.78}, {6, 197.67}};
  const PressMeshing meshing = default_meshing(ellipsoid(), ball(0.01), 6e-3, 8);
  expect_forces(press(ellipsoid(), ball(0.01), StrainLaw::kNeoHookean, rows, meshing), rows, 0.01);
}

TEST(ReferenceScenes, ThickRingBetweenPlates) {
  // 1 mm is left out: two contact points of this mesh carry it.
  const Row stress[] = {{4, 3.1874}, {8, 6.0475}, {12, 8.6689}, {16, 11.258}};
  const Row strain[] = {{4, 3.9951}, {8, 7.5769}, {12, 10.852}, {16, 14.091}};
  const Row linear[] = {{4, 3.4638}, {8, 7.1430}, {12, 11.276}, {16, 17.141}};
  RingBetweenPlates a(24, Kinematics::kPlaneStress, StrainLaw::kNeoHookean);
  RingBetweenPlates b(24, Kinematics::kPlaneStrain, StrainLaw::kNeoHookean);
  RingBetweenPlates c(24, Kinematics::kPlaneStress, StrainLaw::kLinear);
  for (const Row& row : stress) EXPECT_NEAR(a.force_N(1e-3 * row.depth_mm) / row.force_N, 1, 0.003) << row.depth_mm;
  for (const Row& row : strain) EXPECT_NEAR(b.force_N(1e-3 * row.depth_mm) / row.force_N, 1, 0.003) << row.depth_mm;
  for (const Row& row : linear) EXPECT_NEAR(c.force_N(1e-3 * row.depth_mm) / row.force_N, 1, 0.005) << row.depth_mm;
}

TEST(ReferenceScenes, SnapClipOnItsTube) {
  EXPECT_NEAR(1e3 * clip_first_contact_m(), 14.14133, 1e-5);
  ClipOnTube clip(1e-3);
  // 2.5 % of the peak: one element through half the thickness, the tip a polygon of 0.25 mm.
  for (const Row& row : {Row{1, 4.361}, {3, 6.534}, {5, 4.630}, {7, 0.795}, {10, -5.719}, {11.5, -7.351}, {13, -5.505}})
    EXPECT_NEAR(clip.insert(1e-3 * row.depth_mm).force_N, row.force_N, 0.16) << row.depth_mm;
}

// Exact layer factors (Hayes' integral equation): F / F_Hertz at contact radius over height sqrt(R d) / h = 0.5.
TEST(ReferenceScenes, SphereOnAThinLayerFollowsTheExactFactorUpToNearIncompressibility) {
  for (const auto& [nu, factor] : {std::pair{0.45, 1.96710}, {0.49, 2.10969}}) {
    PressBody body;
    body.outer_radius_m = 0.03;
    body.height_m = 0.003;
    body.youngs_modulus_Pa = 1e6;
    body.poisson_ratio = nu;
    const double depth = 0.075e-3, hertz = 4.0 / 3 * 1e6 / (1 - nu * nu) * std::sqrt(0.03) * std::pow(depth, 1.5);
    const PressCurve curve = press_axisymmetric(body, ball(0.03), StrainLaw::kLinear, {depth}, {2.4e-3, 24, 1.25});
    EXPECT_NEAR(curve.points[0].force_N / hertz / factor, 1, 0.01) << nu;
  }
}

TEST(ReferenceScenes, APressThroughTheWholeLayerSaysHowFarItGot) {
  try {
    press_axisymmetric(layer(1e-3), ball(5e-3), StrainLaw::kNeoHookean, {0.1e-3, 1.2e-3}, {2e-3, 3, 1.5});
    FAIL() << "the tool stands below the rigid base";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("the last was at 0.1"), std::string::npos) << error.what();
  }
}

TEST(ReferenceScenes, TheSupportCarriesWhatTheToolPresses) {
  RingUnderFingers ring(1.5e-3, StrainLaw::kNeoHookean);
  ring.press(1e-3, 1e-3);
  const PressState<2> state = ring.solver.load({}, {});
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(state.support_reaction_N[i], state.force_on_tool_N[0][i] + state.force_on_tool_N[1][i],
                1e-6 * std::abs(state.force_on_tool_N[0][1]));
}

// Series laws of thin-walled bodies, whose walls turn.
TEST(SeriesLawOfWalls, StaysWithinTwoPerCentOnTheRingBetweenPlates) {
  const DepthOfForce none = [](double) { return 0.0; };  // c0 from a travel so small that the contact is a line
  RingBetweenPlates linear(24, Kinematics::kPlaneStress, StrainLaw::kLinear);
  RingBetweenPlates large(24, Kinematics::kPlaneStress, StrainLaw::kNeoHookean);
  const SeriesCoefficients c = fit_series(none, {2e-3, linear.force_N(2e-3)}, {8e-3, large.force_N(8e-3)}, 12);
  for (const Row& row : {Row{4, 3.1874}, {8, 6.0475}, {12, 8.6689}, {16, 11.258}})
    EXPECT_NEAR(series_force_N(none, c, 1e-3 * row.depth_mm) / row.force_N, 1, 0.02) << row.depth_mm;
}

TEST(SeriesLawOfWalls, AnArmsSecondOrderGivesTheWholeSnap) {
  const ArmSeries arm = bake_clip_arm(1e-3);
  const Point<2> rest = {kClipTipCentreRadius_m * std::cos(kClipArmEnd_rad),
                         kClipTipCentreRadius_m * std::sin(kClipArmEnd_rad)};
  // 2 % of the peak, over the whole insertion: peak, zero, pull-in and seat.
  for (const Row& row : {Row{0.5, 2.589},
                         {1, 4.361},
                         {2, 6.170},
                         {3, 6.534},
                         {4, 5.965},
                         {5, 4.630},
                         {6, 2.899},
                         {7, 0.795},
                         {8, -1.467},
                         {10, -5.719},
                         {11.5, -7.351},
                         {12, -7.232},
                         {13, -5.505},
                         {14, -0.944}}) {
    const Point<2> tube = {0, clip_first_contact_m() - 1e-3 * row.depth_mm};
    const Point<2> force = arm_force_from_disc_N(arm, rest, tube, kClipTubeRadius_m + kClipTipRadius_m);
    EXPECT_NEAR(-2 * force[1], row.force_N, 0.02 * 7.35) << row.depth_mm;
  }
  const Point<2> clear = {0, clip_first_contact_m() + 1e-6};
  EXPECT_EQ(arm_force_from_disc_N(arm, rest, clear, kClipTubeRadius_m + kClipTipRadius_m)[0], 0);
}

// U* quadratic, worked by hand elsewhere: U_i*' = F / 2, c = 0.1, h12 = 0.05, h21 = 0.02, d = (2, 1).
TEST(PairCoupling, WorkedExampleAndItsFit) {
  const DepthOfForce half = [](double f) { return 0.5 * f; };
  const PairCoupling k = {0.1, 0.05, 0.02};
  const PairState s = solve_pair(half, half, k, 2, 1);
  EXPECT_NEAR(s.first_N, 3.7123698, 1e-6);
  EXPECT_NEAR(s.second_N, 0.49494483, 1e-6);
  const std::vector<PairState> states = {s, solve_pair(half, half, k, 2, 2)};
  const PairCoupling fit = fit_pair(0.1, half, half, states);
  EXPECT_NEAR(fit_pair({}, half, half, states).c_m_per_N, 0.1, 1e-7);
  EXPECT_NEAR(fit.h12_m_per_N2, k.h12_m_per_N2, 1e-8);
  EXPECT_NEAR(fit.h21_m_per_N2, k.h21_m_per_N2, 1e-8);
  // A contact pushed open by the other one carries nothing.
  EXPECT_EQ(solve_pair(half, half, {0.4, 0, 0}, 2, 0.1).second_N, 0);
  EXPECT_THROW(fit_pair(0.1, half, half, {s}), ConfigError);
}

}  // namespace
}  // namespace palpate::fem
