// Tables pressed by finite elements at bake time: the fit, the curves, the places, and their error against presses they
// were not made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "config/response/press_table.h"
#include "config/scene/config_error.h"
#include "rt_core/contact/tips/tip_law.h"

namespace palpate {
namespace {

SceneDesc scene_of(const std::string& body, const std::string& contact, const std::string& piece) {
  return parse_scene("name = \"s\"\n" + body +
                         "[skeleton]\nlaw = \"none\"\n[friction]\nlaw = \"none\"\n[contact]\nlaw = \"table\"\n" +
                         contact + "[contact.table]\nsource = \"fem\"\n" + piece,
                     "s.toml");
}
std::string ball(double radius_mm) {
  return "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = " + std::to_string(radius_mm) + "\n";
}

double force_at(const CurveTable& table, std::size_t row, double depth_m) {
  TableLaw law;
  law.knot = table.knot.data();
  law.knots = static_cast<std::int32_t>(table.knot.size());
  for (auto& curve : law.curve) curve = table.row[row].data();
  law.weight[0] = 1;
  law.root = true;
  return table_at(law, depth_m).force_N;
}

struct Row {
  double depth_mm, force_N;
};
double largest_error(const CurveTable& table, std::span<const Row> rows) {
  double worst = 0;
  for (const Row& row : rows)
    worst = std::max(worst, std::abs(force_at(table, 0, 1e-3 * row.depth_mm) / row.force_N - 1));
  return worst;
}

std::vector<double> root_knots(double depth_m, int count = 33) {
  std::vector<double> knot;
  for (int k = 0; k < count; ++k) knot.push_back(std::sqrt(depth_m) * k / (count - 1));
  return knot;
}

// Forces made with known coefficients give them back.
TEST(PressTable, FitReturnsTheCoefficientsOfAnExactSeries) {
  const OwnedLaw law = make_owned_law({{TipProfile::kParabola, 6e-3, 0}, 3e6, {}, 4e-3, 0, 0});
  const double c0 = 2e-5, c1 = -3e-8, c2 = 4e-10;
  std::vector<fem::LoadPoint> press;
  for (const double e : {0.5e-3, 1e-3, 1.7e-3, 2.5e-3, 3.6e-3}) {
    const double f = local_at(law.local(), e).force_N;
    press.push_back({e + (c0 + (c1 + c2 * f) * f) * f, f});
  }
  const FarSeries far = fit_far_series(law.local(), press);
  EXPECT_NEAR(far.c0_m_per_N, c0, 1e-7 * c0);
  EXPECT_NEAR(far.c1_m_per_N2, c1, -1e-6 * c1);
  EXPECT_NEAR(far.c2_m_per_N3, c2, 1e-6 * c2);
  const std::vector<double> knot = root_knots(5e-3);
  const CurveTable table{knot, {press_row(law.local(), far, 0, knot)}};
  for (const fem::LoadPoint& p : press) EXPECT_NEAR(force_at(table, 0, p.depth_m), p.force_N, 1e-4 * p.force_N);
}

// Random tips, layers, curvatures and far fields: zero at zero, never falling, C1, and the energy is that of the force.
TEST(PressTable, RandomCurvesAreMonotoneSmoothAndConservative) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  int made = 0, refused = 0;
  for (int trial = 0; trial < 40; ++trial) {
    TipDesc tip;
    tip.indenter.profile = static_cast<TipProfile>(trial % 4);
    tip.indenter.radius_m = 1e-3 * std::pow(20.0, unit(random));
    tip.indenter.tan_half_angle = std::tan(0.3 + 1.1 * unit(random));
    tip.modulus_Pa = std::pow(10.0, 3 + 4 * unit(random));
    tip.depth_max_m = tip.indenter.radius_m * (0.1 + 0.9 * unit(random));
    if (unit(random) < 0.5)
      tip.layer = {tip.depth_max_m * (1.2 + 10 * unit(random)), 0.5 * unit(random),
                   unit(random) < 0.5 ? LayerBase::kBonded : LayerBase::kSlip};
    const OwnedLaw law = make_owned_law(tip);
    const double soft = tip.depth_max_m / law.tip.force_max_N;
    FarSeries far{soft * (unit(random) - 0.3), 0, 0, law.tip.force_max_N};
    far.c1_m_per_N2 = 0.3 * soft * (unit(random) - 0.5) / law.tip.force_max_N;
    far.c2_m_per_N3 = 0.2 * soft * (unit(random) - 0.5) / law.tip.force_max_N / law.tip.force_max_N;
    const std::vector<double> knot = root_knots(tip.depth_max_m);
    CurveTable table{knot, {}};
    try {
      table.row.push_back(press_row(law.local(), far, 0, knot));
    } catch (const ConfigError&) {
      ++refused;
      continue;
    }
    ++made;
    TableLaw tick{knot.data(), {&table.row[0][0], &table.row[0][0], &table.row[0][0]}, {1, 0, 0}, 33, true};
    EXPECT_EQ(table_at(tick, 0).force_N, 0);
    const double top = table_at(tick, tip.depth_max_m).force_N;
    double last = 0;
    for (int i = 1; i <= 400; ++i) {
      const double e = 1.1 * tip.depth_max_m * i / 400, h = 1e-6 * tip.depth_max_m;
      const LawPoint here = table_at(tick, e);
      EXPECT_GE(here.force_N, last);
      last = here.force_N;
      const double slope = (table_at(tick, e + h).force_N - table_at(tick, e - h).force_N) / (2 * h);
      EXPECT_NEAR(slope, here.tangent_N_per_m, 1e-3 * top / tip.depth_max_m) << trial;
      const double work = (table_energies(tick, e + h).energy_J[0] - table_energies(tick, e - h).energy_J[0]) / (2 * h);
      EXPECT_NEAR(work, here.force_N, 1e-6 * top) << trial;
    }
    // C1 at the knots: the tangent from either side.
    for (std::size_t k = 1; k + 1 < knot.size(); ++k) {
      const double e = knot[k] * knot[k], h = 1e-9 * e;
      EXPECT_NEAR(table_at(tick, e - h).tangent_N_per_m, table_at(tick, e + h).tangent_N_per_m,
                  1e-5 * top / tip.depth_max_m);
    }
  }
  EXPECT_GT(made, 30);
  std::printf("  %d curves, %d refused\n", made, refused);
}

TEST(PressTable, RefusesAFarFieldThatPullsTheBodyAway) {
  const OwnedLaw law = make_owned_law({{TipProfile::kParabola, 6e-3, 0}, 3e6, {}, 4e-3, 0, 0});
  EXPECT_THROW(press_row(law.local(), {}, -0.9 * 4e-3 / law.tip.force_max_N, root_knots(4e-3)), ConfigError);
}

// Rubber block of 60 mm under a sphere of 6.35 mm. Published large-strain forces, good to 0.5 %, at depths of which
// only the last was pressed for the table.
TEST(PressTable, RubberBlockAgainstPublishedForces) {
  const SceneDesc scene = scene_of(
      "[body]\nshape = \"cylinder\"\nradius_mm = 60\nheight_mm = 60\n[body.material]\nyoungs_modulus_Pa = 2.62166e6\n"
      "poisson_ratio = 0.49\n",
      "max_depth_mm = 3\n", ball(6.35));
  const PressTable made = press_table(scene, {{0, 0.06, 0}, {0.03, 0.06, 0}, {0.06, 0.03, 0}});
  const Row rows[] = {{0.25, 1.4558}, {0.5, 4.1091}, {1, 11.573}, {2, 32.303}, {3, 58.363}};
  const double worst = largest_error(made.table, rows);
  std::printf("  block: largest error %.2f %%, misfit %.2f %%\n", 100 * worst, 100 * made.top.misfit);
  EXPECT_LT(worst, 0.02);
}

// Ellipsoid of revolution of 40 x 30 mm under a sphere of 10 mm, to 0.8 of it: as above.
TEST(PressTable, EllipsoidAgainstPublishedForces) {
  const SceneDesc scene = scene_of(
      "[body]\nshape = \"ellipsoid\"\nhalf_axes_mm = [40, 30, 40]\n[body.material]\nyoungs_modulus_Pa = 3e6\n"
      "poisson_ratio = 0.45\n[body.fixed]\nbase_height_mm = 6\n",
      "max_depth_mm = 7.4\n", ball(10));
  std::vector<Vec3> vertex;
  for (int i = 0; i <= 8; ++i)
    vertex.push_back({0.04 * std::sin(M_PI * i / 8), 0.03 * (1 + std::cos(M_PI * i / 8)), 0});
  const PressTable made = press_table(scene, vertex);
  const Row rows[] = {{1, 14.208}, {2, 39.671}, {4, 109.78}, {6, 197.67}};
  const double worst = largest_error(made.table, rows);
  std::printf("  ellipsoid: largest error %.2f %%, misfit %.2f %%\n", 100 * worst, 100 * made.top.misfit);
  EXPECT_LT(worst, 0.02);
  // Pressed from the side the body leans over on its foot, and gives more than its pole: stiff half axes of 40 mm under
  // a foot of 24 mm radius. Its foot itself cannot give.
  ASSERT_EQ(made.places.place.size(), 9u);
  EXPECT_GT(made.compliance.m_per_N[4], made.compliance.m_per_N[0] + 5e-6);
  EXPECT_LT(made.compliance.m_per_N[8], 0.2 * made.compliance.m_per_N[0]);
}

// Tissue 10 mm deep under a sphere of 6.35 mm to 4 mm, against a press on a finer mesh at other depths.
TEST(PressTable, LayerAgainstAFinerPress) {
  const SceneDesc scene = scene_of(
      "[body]\nshape = \"box\"\nsize_mm = [120, 10, 120]\n[body.material]\nyoungs_modulus_Pa = 2e4\n"
      "poisson_ratio = 0.49\n[body.fixed]\nbase_height_mm = 0.1\n",
      "max_depth_mm = 4\n", ball(6.35));
  const PressTable made = press_table(scene, {{0, 0.01, 0}, {0.06, 0.01, 0.06}});
  const fem::PressBody body = pressed_body(scene, "contact.table.source");
  const fem::RigidTool tool = pressed_tool(scene.piece[0], tip_indenter(scene.piece[0]), 4e-3);
  const std::vector<double> depths{1.3e-3, 3.1e-3};
  const fem::PressCurve finer =
      fem::press_axisymmetric(body, tool, fem::StrainLaw::kNeoHookean, depths, press_meshing(body, tool, 4e-3, 15));
  double worst = 0;
  for (const fem::PressPoint& p : finer.points)
    worst = std::max(worst, std::abs(force_at(made.table, 0, p.depth_m) / p.force_N - 1));
  std::printf("  layer: largest error %.2f %%, misfit %.2f %%\n", 100 * worst, 100 * made.top.misfit);
  EXPECT_LT(worst, 0.02);
}

// On a thick body the patch load finds nearly the half space's compliance; near an edge of its top it is softer.
TEST(PressTable, PlacesOfABlock) {
  const SceneDesc scene = scene_of(
      "[body]\nshape = \"box\"\nsize_mm = [80, 80, 80]\n[body.material]\nyoungs_modulus_Pa = 1e6\npoisson_ratio = 0.3\n"
      "[body.fixed]\nbase_height_mm = 0.1\n",
      "max_depth_mm = 3\n", ball(6));
  const std::vector<Vec3> vertex{{0, 0.08, 0},       {0.02, 0.08, 0.01},  {-0.02, 0.08, -0.01}, {0.04, 0.08, 0},
                                 {0.04, 0.04, 0.01}, {-0.04, 0.04, 0.01}, {0.01, 0, 0.01}};
  const PressPlaces places = press_places(scene, vertex);
  EXPECT_EQ(places.of_vertex, (std::vector<std::int32_t>{0, 1, 1, 2, 3, 3, 4}));
  EXPECT_FALSE(places.place[3].pressed_face);
  const PlaceCompliance compliance = place_compliance(scene, places.place, 4e-3, {});
  const double half_space = half_space_patch_m_per_N(1e6 / 0.91, compliance.patch_m);
  EXPECT_NEAR(compliance.m_per_N[0] / half_space, 1, 0.15);
  EXPECT_GT(compliance.m_per_N[2], 1.4 * compliance.m_per_N[0]);
  EXPECT_LT(compliance.m_per_N[1], 1.3 * compliance.m_per_N[0]);
}

// A ball of 8 mm on a block of 60 x 30 x 60 mm, in the middle, 15 and 8 mm from an edge. The shares of the middle's
// force are those of contact solved directly at each place (linear, quadratic tetrahedra of 1.6 mm under the ball,
// every node there free to touch; 2026-11-21): 27.704 N in the middle at 3 mm.
TEST(PressTable, PlacesTowardsAnEdgeAgainstDirectPresses) {
  const SceneDesc scene = scene_of(
      "[body]\nshape = \"box\"\nsize_mm = [60, 30, 60]\n[body.material]\nyoungs_modulus_Pa = 1e6\npoisson_ratio = "
      "0.45\n"
      "[body.fixed]\nbase_height_mm = 0.01\n",
      "max_depth_mm = 4\n", ball(8));
  const std::vector<PressPlace> place{
      {{0, 0.03, 0}, {0, 1, 0}}, {{0.015, 0.03, 0}, {0, 1, 0}}, {{0.022, 0.03, 0}, {0, 1, 0}}};
  const PlaceCompliance compliance = place_compliance(scene, place, 5.7e-3, {});
  const OwnedLaw law = make_owned_law(
      {{TipProfile::kSphere, 8e-3, 0}, 1e6 / (1 - 0.45 * 0.45), {0.03, 0.45, LayerBase::kBonded}, 4e-3, 0, 0});
  CurveTable table{root_knots(4e-3), {}};
  for (const double c : compliance.m_per_N)
    table.row.push_back(press_row(law.local(), {}, c - compliance.m_per_N[0], table.knot));
  EXPECT_NEAR(force_at(table, 0, 3e-3) / 27.704, 1, 0.02);
  const double share[3][2] = {{1, 1}, {0.9673, 0.9533}, {0.8671, 0.8262}};
  for (std::size_t i = 1; i < 3; ++i)
    for (int d = 0; d < 2; ++d) {
      const double depth = 1.5e-3 * (d + 1), here = force_at(table, i, depth) / force_at(table, 0, depth);
      std::printf("  %g mm from the edge, %g mm deep: %.4f of the middle's force, directly %.4f\n",
                  30 - 1e3 * place[i].position_m.x, 1e3 * depth, here, share[i][d]);
      // 8 mm is 1.3 times the width of the load that stands for the contact.
      EXPECT_NEAR(here / share[i][d], 1, i == 1 ? 0.01 : 0.03);
    }
}

std::string message(const SceneDesc& scene) {
  try {
    press_table(scene, {{0, 0, 0}});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}
void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

TEST(PressTable, RefusalsNameKeyReasonAndRemedy) {
  const std::string block = "[body]\nshape = \"box\"\nsize_mm = [60, 10, 60]\n";
  expect_words(message(scene_of("[body]\nshape = \"cylinder\"\naxis = \"x\"\nradius_mm = 30\nheight_mm = 60\n",
                                "max_depth_mm = 2\n", ball(5))),
               {"contact.table.source", "standing cylinder", "measure presses"});
  expect_words(message(scene_of(block, "max_depth_mm = 2\n", ball(5) + ball(6))), {"tool.piece[1]", "another shape"});
  expect_words(message(scene_of(block, "max_depth_mm = 12\n", ball(20))), {"contact.max_depth_mm", "height of 10 mm"});
  expect_words(message(scene_of(block, "max_depth_mm = 8\n", ball(5))), {"contact.max_depth_mm", "effective radius"});
}

// A needle folds the elements under its point: how far the press came is in the text.
TEST(PressTable, APressThatFindsNoEquilibriumSaysHowFarItCame) {
  fem::PressBody body;
  body.outer_radius_m = 0.03;
  body.height_m = 0.01;
  body.youngs_modulus_Pa = 1e5;
  body.poisson_ratio = 0.45;
  fem::RigidTool needle;
  needle.shape = fem::RigidShape::kCone;
  needle.half_apex_rad = 0.2;
  needle.fillet_m = 2e-4;
  const OwnedLaw law = make_owned_law({{TipProfile::kCone, 0, std::tan(0.2)}, 1e5, {}, 6e-3, 0, 0});
  const int coarse[] = {3};
  try {
    press_series(body, needle, law.local(), 6e-3, coarse);
    ADD_FAILURE() << "accepted";
  } catch (const ConfigError& error) {
    expect_words(error.what(), {"no equilibrium at depth 2.4", "the last was at 0.0"});
  }
}

TEST(PressTable, SceneChecksItsKeys) {
  const auto refused = [](const std::string& contact, const std::string& table) {
    try {
      parse_scene(
          "name = \"s\"\n[body]\nshape = \"box\"\nsize_mm = [60, 10, 60]\n[friction]\nlaw = \"none\"\n[contact]\nlaw = "
          "\"table\"\n" +
              contact + "[contact.table]\n" + table + ball(5),
          "s.toml");
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused("", "source = \"fem\"\n"), "accepted");
  EXPECT_EQ(refused("[contact.layer]\nthickness_mm = 10\nbase = \"slip\"\n", "source = \"fem\"\n"), "accepted");
  expect_words(refused("", "source = \"fem\"\nfile = \"a.csv\"\n"), {"contact.table.file", "no effect"});
  expect_words(refused("", ""), {"contact.table.file: missing", "source = \"fem\""});
  expect_words(refused("[contact.layer]\nthickness_mm = 9\n", "source = \"fem\"\n"),
               {"contact.layer.thickness_mm", "9 mm", "10 mm high", "make them equal"});
  expect_words(refused("[contact.series]\nc0_mm_per_N = 1\n", "source = \"fem\"\n"), {"contact.series", "no effect"});
}

}  // namespace
}  // namespace palpate
