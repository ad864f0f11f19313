// Worked numbers of Mahvash & Hayward 2002: Table 1, interpolation over a triangle, curves, layers, friction, series.
#include <array>
#include <vector>

#include "config/response/layer_contact.h"
#include "config/response/table_bake.h"
#include "config/response/tip_bake.h"
#include "rt_core/contact/friction.h"
#include "rt_core/contact/region_solve.h"
#include "rt_core/contact/regions.h"
#include "rt_core/contact/tips/travel.h"
#include "rt_core/surface/smooth_foot.h"
#include "tests/published/worked.h"

namespace palpate::test {
namespace {

constexpr double kRubber_Pa = 3.45e6;  // E* of their rubber

struct BakedTip {
  std::vector<FactorKnot> factor;
  TipLaw law;
  explicit BakedTip(const Indenter& indenter, double modulus_Pa = kRubber_Pa, double depth_max_m = 0.006,
                    double c0_m_per_N = 0, double c1_m_per_N2 = 0)
      : law(make_tip_law({indenter, modulus_Pa, {}, depth_max_m, c0_m_per_N, c1_m_per_N2}, factor)) {}
  LocalLaw local() const { return {&law, law.first_factor < 0 ? nullptr : &factor[0]}; }
  LawPoint at(double depth_m) const { return local_at(local(), depth_m); }
};

// Table 1 with the tools of section 4.
TEST(MahvashHayward2002, TableOne) {
  const BakedTip flat({TipProfile::kFlat, 1.6e-3, 0}), large({TipProfile::kParabola, 6.35e-3, 0}),
      small({TipProfile::kParabola, 1.6e-3, 0});
  expect_worked(flat.at(0.5e-3).force_N, 5.52);
  expect_worked(large.at(1e-3).force_N, 11.59163491488582);
  expect_worked(large.at(3e-3).force_N, 60.23190184611474);
  expect_worked(small.at(1e-3).force_N, 5.818590894709818);
  expect_worked(small.at(1.8e-3).force_N, 14.05162595573907);  // "around 14 N", Fig. 8
  const double cone_N[] = {1.268056459470122, 2.196338214668156, 3.804169378410365};
  for (int k = 0; k < 3; ++k) {
    const BakedTip cone({TipProfile::kCone, 0, std::tan((30 + 15 * k) * kPi / 180)});
    expect_worked(cone.at(1e-3).force_N, cone_N[k]);
  }
}

// The curves of the overlay laws/mahvash_hayward_2002.toml are Table 1's parabola for the sphere of 12.7 mm, on their
// rubber and on one half as stiff.
TEST(MahvashHayward2002, CurvesOfTheOverlayAreTableOne) {
  const std::string folder = std::string(PALPATE_SOURCE_DIR) + "/config/scenes/laws/";
  const std::vector<ForceCurve> curves = read_curves(folder + "mahvash_hayward_2002.csv", false);
  ASSERT_EQ(curves.size(), 2u);
  for (std::size_t place = 0; place < 2; ++place) {
    const double modulus_Pa = place == 0 ? kRubber_Pa : 0.5 * kRubber_Pa;
    ASSERT_EQ(curves[place].depth_m.size(), 16u);
    for (std::size_t i = 0; i < 16; ++i) {
      const double depth_m = curves[place].depth_m[i];
      EXPECT_NEAR(curves[place].force_N[i], 4.0 / 3 * std::sqrt(6.35e-3) * modulus_Pa * depth_m * std::sqrt(depth_m),
                  1e-9);
    }
  }
}

// A true sphere of 6.35 mm (Segedin 1957): force, and contact radius as half the stiffness over E*.
TEST(MahvashHayward2002, TrueSphere) {
  const BakedTip sphere({TipProfile::kSphere, 6.35e-3, 0});
  const LayerContact half_space({}, 6e-3);
  const double exact[3][2] = {{2.453630054078472, 11.40878167030091},
                              {3.375923115609747, 31.75040327196495},
                              {4.019429766127407, 57.37556049077521}};
  for (int d = 0; d < 3; ++d) {
    const double depth = 1e-3 * (d + 1);
    expect_worked(sphere.at(depth).force_N, exact[d][1]);
    const LayerState state = half_space.at_depth({TipProfile::kSphere, 6.35e-3, 0}, depth);
    expect_worked(1e3 * state.stiffness_m / 2, exact[d][0]);
    expect_worked(kRubber_Pa * state.force_m2, exact[d][1]);
  }
}

// --- Interpolation, eqs. 3 and 4
// ---------------------------------------------------------------------------------------------------------

// One triangle of 10 mm with the smooth normals given, mm.
struct OneTriangle {
  std::vector<Vec3> vertex{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  std::vector<Triangle> triangle = std::vector<Triangle>(1);
  std::vector<CornerNormals> normal;
  Model model;
  explicit OneTriangle(Vec3 second) : normal{{{{0, 0, 1}, second, {0, 0, 1}}}} {
    for (int k = 0; k < 3; ++k) {
      triangle[0].vertex[k] = k;
      triangle[0].adjacent[k] = -1;
    }
    model.vertex_m = vertex;
    model.triangle = triangle;
    model.corner_normal = normal;
  }
};
TableLaw law_of(const CurveTable& table, const double (&weight)[3], bool root) {
  TableLaw law;
  law.knot = table.knot.data();
  law.knots = static_cast<std::int32_t>(table.knot.size());
  law.root = root;
  for (std::size_t k = 0; k < 3; ++k) {
    law.curve[k] = table.row[k].data();
    law.weight[k] = weight[k];
  }
  return law;
}

// X = (2, 3, 0): area coordinates 0.5, 0.2, 0.3; 5, 6 and 7 N at the corners are 5.8 N.
TEST(MahvashHayward2002, AreaCoordinates) {
  const OneTriangle flat({0, 0, 1});
  double weight[3];
  facet_weights(flat.model, 0, {2, 3, 0}, weight);
  for (int k = 0; k < 3; ++k) expect_worked(weight[k], k == 0 ? 0.5 : k == 1 ? 0.2 : 0.3);
  const CurveTable table =
      tabulate({{false, {}, {0, 1}, {0, 5}}, {false, {}, {0, 1}, {0, 6}}, {false, {}, {0, 1}, {0, 7}}});
  expect_worked(table_at(law_of(table, weight, false), 1).force_N, 5.8);
}

// f_A = 3 d, f_B = 4 d, f_C = 3 d^1.5 with their integrals, exact as cubics of sqrt(d).
CurveTable three_curves() {
  CurveTable table{{0, 1, 2}, std::vector<std::vector<ResponseKnot>>(3)};
  for (const double s : table.knot) {
    table.row[0].push_back({3 * s * s, 6 * s, 1.5 * std::pow(s, 4)});
    table.row[1].push_back({4 * s * s, 8 * s, 2 * std::pow(s, 4)});
    table.row[2].push_back({3 * s * s * s, 9 * s * s, 1.2 * std::pow(s, 5)});
  }
  return table;
}
// Depth along the interpolated normal, t |N|, without the facet's sag.
double depth_mm(const OneTriangle& surface, const SmoothFoot& foot, Vec3 tip) {
  Vec3 x;
  for (std::size_t k = 0; k < 3; ++k) x += foot.weight[k] * surface.vertex[k];
  return norm(x - tip);
}

// The second corner's normal turned to (0.6, 0, 0.8), tip at (3, 2, -2) mm.
TEST(MahvashHayward2002, TiltedTriangle) {
  const OneTriangle tilted({0.6, 0, 0.8});
  const Vec3 tip{3, 2, -2};
  const SmoothFoot foot = smooth_foot(tilted.model, tip, 0);
  ASSERT_EQ(foot.state, FootState::kFound);
  expect_worked(foot.weight[1], 0.3443828879868421);
  expect_worked(foot.weight[2], 0.2);
  const double depth = depth_mm(tilted, foot, tip);
  expect_worked(depth, 2.04865421059906);
  expect_worked(-foot.height_m, 2.726004153945113, "with half the facet's sag, 0.6773499");
  // Eq. 3, sum n_i f_i U_i.
  const CurveTable table = three_curves();
  const TableLaw law = law_of(table, foot.weight, true);
  const CornerForces corner = table_forces(law, depth);
  Vec3 force;
  for (int k = 0; k < 3; ++k) force += foot.weight[k] * corner.force_N[k] * tilted.normal[0].normal[k];
  expect_worked(force, {1.69325148847802, 0, 6.817232482109866});
  // The potential of the same curves, and the force that is its slope.
  const auto potential = [&](Vec3 p) {
    const SmoothFoot at = smooth_foot(tilted.model, p, 0);
    const CornerEnergies energy = table_energies(law, depth_mm(tilted, at, p));
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += at.weight[k] * energy.energy_J[k];
    return sum;
  };
  expect_worked(potential(tip), 7.200792178055969);
  const auto slope = [&](Vec3 e) {  // sixth order
    const auto difference = [&](double h) { return potential(tip + h * e) - potential(tip - h * e); };
    return (45 * difference(0.01) - 9 * difference(0.02) + difference(0.03)) / (60 * 0.01);
  };
  const Vec3 conservative{-slope({1, 0, 0}), -slope({0, 1, 0}), -slope({0, 0, 1})};
  expect_worked(conservative, {-0.5004616337209241, -0.09131565896220584, 7.672283476288205});
}

// One facet of a round bar of 20 mm, pressed 2 mm deep at its edge and in its middle: by eq. 3 as printed, t |N| along
// sum n_i U_i, the force dips by 36, 9.3, 2.3 and 0.6 %; with the sag and the unit normal by less than 0.6 to 0.001 %.
TEST(MahvashHayward2002, FacetsOfARoundBar) {
  const struct {
    double degrees, printed_dip, dip_below;
  } rows[] = {{30, 0.363, 0.006}, {15, 0.0934, 4.5e-4}, {7.5, 0.0235, 3e-5}, {3.75, 0.00589, 1e-5}};
  for (const auto& row : rows) {
    const double half = 0.5 * row.degrees * kPi / 180, x = 20 * std::sin(half), z = 20 * std::cos(half);
    OneTriangle facet({0, 0, 1});
    const Vec3 right{std::sin(half), 0, std::cos(half)}, left{-std::sin(half), 0, std::cos(half)};
    const Vec3 corner[3] = {{-x, -30, z}, {x, -30, z}, {-x, 30, z}}, out[3] = {left, right, left};
    for (std::size_t k = 0; k < 3; ++k) {
      facet.vertex[k] = corner[k];
      facet.normal[0].normal[k] = out[k];
    }
    const auto at = [&](double angle) {
      const Vec3 tip{18 * std::sin(angle), -15, 18 * std::cos(angle)};
      const SmoothFoot foot = smooth_foot(facet.model, tip, 0);
      EXPECT_EQ(foot.state, FootState::kFound);
      Vec3 normal;
      for (std::size_t k = 0; k < 3; ++k) normal += foot.weight[k] * out[k];
      return std::array<double, 2>{depth_mm(facet, foot, tip) * norm(normal), -foot.height_m};
    };
    const auto edge = at(-half * (1 - 1e-9)), middle = at(0);
    expect_worked(middle[0], (z - 18) * std::cos(half));  // the middle of the chord, its normal that much shorter
    EXPECT_NEAR(1 - middle[0] / edge[0], row.printed_dip, 6e-4);
    EXPECT_LT(std::abs(1 - middle[1] / edge[1]), row.dip_below);
  }
}

// Springs of 2 and 4 N/mm at corners 10 mm apart hold 4 mJ more at the one than at the other, 2 mm deep: what a slide
// between them gives away unless the energy's slope pulls back by 0.4 N.
TEST(MahvashHayward2002, SlopeOfTheEnergyBetweenCorners) {
  const OneTriangle flat({0, 0, 1});
  const SmoothFoot foot = smooth_foot(flat.model, {2, 3, -2}, 0);
  const CurveTable table =
      tabulate({{false, {}, {0, 4}, {0, 8}}, {false, {}, {0, 4}, {0, 16}}, {false, {}, {0, 4}, {0, 8}}});
  const CornerEnergies energy = table_energies(law_of(table, foot.weight, false), -foot.height_m);
  expect_worked(energy.energy_J[1] - energy.energy_J[0], 4);
  Vec3 pull;
  for (int k = 0; k < 3; ++k) pull += -energy.energy_J[k] * foot.gradient_per_m[k];
  expect_worked(pull, {-0.4, 0, 0});
}

// Monotone cubics (Fritsch & Carlson 1980) through two sets of samples.
TEST(MahvashHayward2002, CurvesThroughSamples) {
  const CurveTable table = tabulate({{false, {}, {0, 1, 2, 4}, {0, 1, 4, 10}}});
  const double slope[] = {0, 1.5, 3, 3};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(table.row[0][k].slope, slope[k], 1e-12);
  TableLaw law;
  law.knot = table.knot.data();
  law.knots = 4;
  for (auto& curve : law.curve) curve = table.row[0].data();
  law.weight[0] = 1;
  expect_worked(table_at(law, 0.5).force_N, 0.3125);
  expect_worked(table_at(law, 1.5).force_N, 2.3125);
  expect_worked(table_at(law, 3).force_N, 7);
  expect_worked(table_energies(law, 3).energy_J[0], 8.25);
  const CurveTable second = tabulate({{false, {}, {0, 0.5, 1, 2, 3}, {0, 1.2, 3.5, 9.7, 17.9}}});
  const double exact[] = {1.3, 3.154285714285714, 5.195951417004049, 7.061111111111111, 9.2};
  for (std::size_t k = 0; k < 5; ++k) expect_worked(second.row[0][k].slope, exact[k]);
}

// --- Layers, section 4.3
// ---------------------------------------------------------------------------------------------------------

// F/(2 a E* d) of a flat punch on a layer of thickness h, a/h from 0.05 to 2 (dual integral equations solved by 200
// points, four decimals: half a unit of the last).
TEST(MahvashHayward2002, PunchOnALayer) {
  const double ratio[9] = {0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1, 1.5, 2};
  const struct {
    double nu;
    LayerBase base;
    double factor[9];
  } rows[] = {{0.3, LayerBase::kBonded, {1.0458, 1.0954, 1.2066, 1.3328, 1.6240, 2.0388, 2.4835, 3.4090, 4.3532}},
              {0.45, LayerBase::kBonded, {1.0545, 1.1146, 1.2523, 1.4141, 1.8063, 2.4043, 3.0914, 4.6576, 6.4206}},
              {0.49, LayerBase::kBonded, {1.0584, 1.1234, 1.2741, 1.4541, 1.9028, 2.6179, 3.4840, 5.6322, 8.3370}},
              {0.5, LayerBase::kBonded, {1.0596, 1.1260, 1.2806, 1.4662, 1.9329, 2.6878, 3.6187, 6.0030, 9.1495}},
              {0.3, LayerBase::kSlip, {1.0386, 1.0799, 1.1710, 1.2730, 1.5061, 1.8386, 2.1986, 2.9546, 3.7276}},
              {0.5, LayerBase::kSlip, {1.0386, 1.0799, 1.1710, 1.2730, 1.5061, 1.8386, 2.1986, 2.9546, 3.7276}}};
  for (const auto& row : rows) {
    const LayerContact contact({1.0, row.nu, row.base}, 2.0);
    for (int k = 0; k < 9; ++k) {
      const double a = ratio[k];
      EXPECT_NEAR(contact.at_radius({TipProfile::kFlat, a, 0}, a).force_m2 / (2 * a), row.factor[k], 0.5001e-4)
          << row.nu << ' ' << a;
    }
  }
}

double sphere_factor(const LayerContact& contact, double chi) {
  const double radius = 2, depth = chi * chi / radius;
  return contact.at_depth({TipProfile::kParabola, radius, 0}, depth).force_m2 /
         (4.0 / 3 * std::sqrt(radius) * std::pow(depth, 1.5));
}

// The factor of a sphere, chi = sqrt(R d)/h: polynomials good to 8e-4 up to chi = 1, and single values.
TEST(MahvashHayward2002, SphereOnALayer) {
  const struct {
    double nu;
    LayerBase base;
    double c[4];
  } rows[] = {{0.30, LayerBase::kBonded, {.8635, .9954, .5139, -.4546}},
              {0.35, LayerBase::kBonded, {.9032, 1.0624, .7120, -.5622}},
              {0.40, LayerBase::kBonded, {.9573, 1.1316, 1.0649, -.7262}},
              {0.45, LayerBase::kBonded, {1.0332, 1.1880, 1.6977, -.9469}},
              {0.49, LayerBase::kBonded, {1.1157, 1.2306, 2.4574, -1.0078}},
              {0.50, LayerBase::kBonded, {1.1387, 1.2584, 2.6377, -.9215}},
              {0.30, LayerBase::kSlip, {.7399, .6607, .4024, -.2990}}};
  for (const auto& row : rows) {
    const LayerContact contact({1.0, row.nu, row.base}, 2.0);
    for (int i = 1; i <= 20; ++i) {
      const double x = 0.05 * i, fit = 1 + x * (row.c[0] + x * (row.c[1] + x * (row.c[2] + x * row.c[3])));
      EXPECT_NEAR(sphere_factor(contact, x) / fit, 1, 8.5e-4) << row.nu << ' ' << x;
    }
  }
  const LayerContact rubber({1.0, 0.45, LayerBase::kBonded}, 2.0), tight({1.0, 0.49, LayerBase::kBonded}, 2.0),
      incompressible({1.0, 0.5, LayerBase::kBonded}, 2.0), slip({1.0, 0.45, LayerBase::kSlip}, 2.0);
  EXPECT_NEAR(sphere_factor(rubber, 0.3), 1.4543, 0.5001e-4);
  EXPECT_NEAR(sphere_factor(rubber, 0.5), 1.9671, 0.5001e-4);
  EXPECT_NEAR(sphere_factor(rubber, 1), 3.9741, 0.5001e-4);
  EXPECT_NEAR(sphere_factor(tight, 1), 4.7979, 0.5001e-4);
  EXPECT_NEAR(sphere_factor(incompressible, 1), 5.115, 0.5001e-3);
  EXPECT_NEAR(sphere_factor(slip, 1), 2.5045, 0.5001e-4);
  // "Even a thick block counts": 6.35 mm, 3 mm deep into 60 mm, 8 % more.
  EXPECT_NEAR(sphere_factor(rubber, std::sqrt(6.35 * 3) / 60), 1.08, 0.005);
}

// F/(pi E* r) under a point force, r = 10 mm.
TEST(MahvashHayward2002, PointForceFarAway) {
  const double scale = far_field_scale_m2_per_N(kRubber_Pa * (1 - 0.49 * 0.49), 0.49);
  expect_worked(1e3 * far_field_compliance_m_per_N(scale, 1e-9, {0.01, 0, 0}, {0, 0, 1}, {}, {0, 0, 1}),
                0.009226373512573643);
}

// --- Friction, section 3.3
// ---------------------------------------------------------------------------------------------------------

TEST(MahvashHayward2002, PreslidingInTheTangentPlane) {
  Vec3 z;
  for (const Vec3 step : {Vec3{0.5, 0, 0}, Vec3{0, 0.3, 0}, Vec3{-0.1, 0.05, 0}}) z = preslide(z, step, 0.2).stretch_w;
  expect_worked(z, {-0.01785465817641739, 0.199201433683102, 0});
  expect_worked(preslide({0.1, 0.1, 0}, {0.3, 0, 0}, 0.2).stretch_w, {0.1970488517289189, 0.03423083452553458, 0});
}

// f_t = -(mu f_n/z_max) z returns mu (10 - 1) z^2/(2 z_max) of the loop {shift at 1 N, press to 10 N, shift back}.
TEST(MahvashHayward2002, ThePublishedFormReturnsEnergy) {
  FrictionParameters p;
  p.law = FrictionLaw::kPreslidingPaper;
  p.k_N = p.mu_dynamic = 0.5;
  p.beta = 1;
  p.slip_m = 0.2e-3;
  FrictionMemory memory;
  double work_J = 0, last_N = 0;
  const auto move = [&](double force_N, double step_m) {
    FrictionLoad load;
    load.normal_w = {0, 0, 1};
    load.force_N = force_N;
    load.tangent_N_per_m = 1e4;
    load.step_w = {step_m, 0, 0};
    const double now_N = friction_step(p, load, memory).force_w.x;
    work_J += 0.5 * (now_N + last_N) * step_m;
    last_N = now_N;
  };
  move(1, 0);
  for (int i = 0; i < 10; ++i) move(1, 0.015e-3);
  move(10, 0);
  for (int i = 0; i < 10; ++i) move(10, -0.015e-3);
  expect_worked(work_J, 2.53125e-4);
  ModelParams params{};
  params.poisson_ratio = 0.45;
  expect_worked(friction_parameters(params).mindlin_ratio, 0.7096774193548387);
}

// --- Global deformation, section 2: travel = local(F) + c0 F + c1 F^2
// ---------------------------------------------------------------------------------------------------------

TEST(MahvashHayward2002, TipInSeriesWithTheBody) {
  const BakedTip tube({TipProfile::kParabola, 7.1082e-3, 0}, 3.76176e6, 0.02, 0.080256e-3, 5.266e-7);
  const BakedTip ellipsoid({TipProfile::kParabola, 8.4211e-3, 0}, 3e6 / (1 - 0.45 * 0.45), 0.02, 1.105e-6, 2.702e-9);
  const struct {
    const BakedTip& tip;
    double depth_mm, force_N, stiffness_N_per_mm;
  } rows[] = {{tube, 2, 12.21270514978334, 6.920277852201765},
              {tube, 4, 25.99709710818219, 6.775940747912748},
              {tube, 8, 51.57923431353202, 6.010761004522372},
              {ellipsoid, 2, 39.69125808317054, 29.32211898225644},
              {ellipsoid, 8, 295.2654187311297, 51.29541261514281}};
  for (const auto& row : rows) {
    const Tip tip{row.tip.local(), {}, TipKind::kPower, 1e-3 * row.depth_mm};
    const TipRegion region{&tip, 1, {row.tip.law.c0_m_per_N, row.tip.law.c1_m_per_N2, row.tip.law.force_max_N}};
    const LawPoint load = region_at(region, solve_travel(region).shift_m);
    expect_worked(load.force_N, row.force_N);
    const double give = 1 / load.tangent_N_per_m + far_slope_m_per_N(region.far, load.force_N);
    expect_worked(1e-3 / give, row.stiffness_N_per_mm);
  }
}

// Two springs of 2 N/mm that lean on one another to second order, and the curvature of their energy, mm/N.
TEST(MahvashHayward2002, TwoTipsToSecondOrder) {
  const BakedTip spring({TipProfile::kFlat, 1e-3, 0}, 1e6, 0.01);
  const Tip tip[2] = {{spring.local(), {}, TipKind::kPower, 2e-3}, {spring.local(), {}, TipKind::kPower, 1e-3}};
  const TipRegion region[2] = {{&tip[0], 1, {}}, {&tip[1], 1, {}}};
  const Real c[4] = {0, 1e-4, 1e-4, 0}, h[4] = {0, 5e-5, 2e-5, 0};
  const TipLaws laws{region, {c, h}, 2};
  RegionSystem solve;
  EXPECT_FALSE(solve_regions(laws, 2, solve).singular);
  expect_worked(solve.force_N[0], 3.712369800514449);
  expect_worked(solve.force_N[1], 0.4949448330614118);
  const double a = 0.5 + 1e3 * laws.curvature(solve.force_N, 0, 0), d = 0.5 + 1e3 * laws.curvature(solve.force_N, 1, 1),
               b = 1e3 * laws.curvature(solve.force_N, 0, 1), root = std::hypot(0.5 * (a - d), b);
  expect_worked(0.5 * (a + d) - root, 0.2529453130137595);
  expect_worked(0.5 * (a + d) + root, 0.8460493246496001);
}

}  // namespace
}  // namespace palpate::test
