// Worked numbers of the circular-beam paper (2009): stresses, displacements, tip compliance, sharing, choice of the
// arc.
#include "config/beams/beam_rows.h"
#include "config/beams/beam_selection.h"
#include "config/beams/circular_beam.h"
#include "rt_core/skeleton/beam_table.h"
#include "tests/deform/deform_scene.h"
#include "tests/published/worked.h"

namespace palpate::test {
namespace {

const BeamMaterial kRubber{3e6, 0.47};  // its Table 1
// a = 30, b = 40, t = 10 mm.
const ArcSection kArc{30e-3, 40e-3, 10e-3};
constexpr double kMiddle = 35e-3, kSixty = kPi / 3;

// Golovin's constants N and N' and the energy integrals of tip force and couple.
TEST(CircularBeams2009, ConstantsOfTheSection) {
  const ArcFunctions f = arc_functions(kArc, 0.47);
  expect_worked(f.s, 0.2876820724517809);
  expect_worked(f.n_hat * f.q_m2, 1.920518112945232e-5);
  expect_worked(f.n_bar * f.q_m2 * f.q_m2, 1.329678509352603e-8);
  expect_worked(f.t, 520.6928241184036);
  expect_worked(f.j2, 4.168001645399426);
  expect_worked(f.j3_sqrt, -505.1759302115257);
  expect_worked(f.j4_area, 505.385320792456);
}

TEST(CircularBeams2009, TipComplianceAndItsInverse) {
  const struct {
    double degrees, c11, c12_outer, c22_outer, c12_middle, c22_middle;  // mm/N
  } rows[] = {{90, 13.63170625856083, 11.17448104565868, 10.02579637543276, 8.743952218194149, 6.617506056227964},
              {60, 5.506897565339180, 3.519803129314946, 2.512016336176513, 2.304538715582679, 1.208917105183322},
              {30, 0.962995479152238, 0.5375955524843452, 0.4414285256068673, 0.2119664342345026, 0.1155080283601144}};
  for (const auto& row : rows) {
    const double angle = row.degrees * kPi / 180;
    const ArcCompliance outer = arc_tip_compliance(kArc, kRubber, angle, 40e-3);
    const ArcCompliance middle = arc_tip_compliance(kArc, kRubber, angle, kMiddle);
    expect_worked(1e3 * outer.rr_m_per_N, row.c11);
    expect_worked(1e3 * outer.rt_m_per_N, row.c12_outer);
    expect_worked(1e3 * outer.tt_m_per_N, row.c22_outer);
    expect_worked(1e3 * middle.rt_m_per_N, row.c12_middle);
    expect_worked(1e3 * middle.tt_m_per_N, row.c22_middle);
  }
  const ArcCompliance c = arc_tip_compliance(kArc, kRubber, kSixty, 40e-3);
  const double determinant = c.rr_m_per_N * c.tt_m_per_N - c.rt_m_per_N * c.rt_m_per_N;
  expect_worked(c.tt_m_per_N / determinant, 1739.13864236323);
  expect_worked(-c.rt_m_per_N / determinant, -2436.857415115356);
  expect_worked(c.rr_m_per_N / determinant, 3812.578054326949);
  expect_worked(c.zz_m_per_N, 7.346096237430887e-3);
}

// Of F1 = 1 N at the clamp, with the shear that is not printed.
TEST(CircularBeams2009, StressesOfF1) {
  for (const bool printed : {true, false}) {
    const auto at = [&](double r) {
      return printed ? arc_stress_paper(kArc, 1, 0, r, kSixty) : arc_stress(kArc, {-1, 0, 0}, r, kSixty);
    };
    expect_worked(at(30e-3).hoop_Pa, -210435.4995189067);
    expect_worked(at(40e-3).hoop_Pa, 157826.6246391801);
    expect_worked(at(kMiddle).radial_Pa, -12818.0723884382);
    EXPECT_NEAR(at(kMiddle).hoop_Pa, -65.73370455609332, 1e-9 * 12818) << "a difference of terms of that size";
  }
  expect_worked(arc_stress(kArc, {-1, 0, 0}, kMiddle, kSixty).shear_Pa, 7400.517543956903);
}

// Eqs. 2 and 3 with the constants K, L, H of the clamp: u(0) = L, v(0) = K + H r - (Q - (1 + nu) D)/(E t).
TEST(CircularBeams2009, ConstantsOfTheClamp) {
  const double a = 30e-3, b = 40e-3, nu = 0.47, n = 1.920518112945232e-5, et = 3e6 * 10e-3;
  const double big_a = 1 / (2 * n), big_b = -a * a * b * b / (2 * n), big_d = -(a * a + b * b) / n;
  const struct {
    double angle, k, l, h;
  } rows[] = {{kSixty, -7.816796125345529e-3, -5.549857336712264e-3, 0.2418432206307085},
              {kPi / 2, -5.774161567397708e-3, -1.363170625856083e-2, 0}};
  for (const auto& row : rows) {
    double turned[2] = {};
    for (const double r : {a, b}) {
      const PolarVector tip = arc_displacement(kArc, kRubber, row.angle, {-1, 0, 0}, r, 0);
      expect_worked(tip.radial_m, row.l, "L");
      const double q = (5 + nu) * big_a * r * r + (1 + nu) * big_b / (r * r) - (1 - nu) * big_d * std::log(r);
      turned[r > kMiddle] = tip.tangential_m + (q - (1 + nu) * big_d) / et;
    }
    const double h = (turned[1] - turned[0]) / (b - a);
    EXPECT_NEAR(h, row.h, 1e-9 * 0.2418);
    EXPECT_NEAR(turned[0] - a * h, row.k, 1e-9 * std::abs(row.k)) << "K";
  }
  // Taken as printed, a push F2 along +theta moves the tip back.
  EXPECT_NEAR(arc_paper_compliance(kArc, kRubber, kPi / 2, 40e-3).v2_m_per_N, -5.72e-3, 0.005e-3);
}

// Two arcs of 60 degrees from a common top, pressed by 2 N: each as stiff as its exact compliance says.
TEST(CircularBeams2009, TwoArcsShareAPress) {
  const ArcCompliance c = arc_tip_compliance(kArc, kRubber, kSixty, 40e-3);
  const double det = c.rr_m_per_N * c.tt_m_per_N - c.rt_m_per_N * c.rt_m_per_N;
  const double rr = c.tt_m_per_N / det, tt = c.rr_m_per_N / det, rt = -c.rt_m_per_N / det;
  Model model;
  std::vector<Anchor> anchor(2, deform_test::make_anchor({0.04, 0, 0}, 5e-3));
  // r^ is y, theta^ is -x for the one and x for the other.
  const std::vector<BeamStiffness> stiffness{{{tt, -rt, 0, rr, 0, 1 / c.zz_m_per_N}},
                                             {{tt, rt, 0, rr, 0, 1 / c.zz_m_per_N}}};
  model.params.skeleton_law = SkeletonLaw::kCircular;
  model.sizes.n_vertex = 1;
  model.sizes.n_anchor = 2;
  model.anchor = anchor;
  model.beam_stiffness = stiffness;
  BeamTableSkeleton s;
  ASSERT_TRUE(solve_beam_table(model, {{0, 0, 0}, {1, 0, 0}, true}, {0, -2, 0}, s));
  expect_worked(2 * tt, 7625.156108653899);
  expect_worked(2 * rr, 3478.277284726461);
  expect_worked(s.displacement_w, {0, -5.749972863814635e-4, 0});
  expect_worked(s.force_w[0], {-1.401186400989877, -1, 0});
  expect_worked(s.force_w[1], {1.401186400989877, -1, 0});
}

BeamCurve sixty(double tip_radius_m) {
  BeamCurve arc;
  arc.path = BeamPath::kArc;
  arc.tip_m = {tip_radius_m, 0, 0};
  arc.anchor_m = {40e-3 * std::cos(kSixty), 40e-3 * std::sin(kSixty), 0};
  arc.radial = {1, 0, 0};
  arc.tangential = {0, 1, 0};
  arc.up = {0, 0, 1};
  arc.outer_radius_m = 40e-3;
  arc.angle = kSixty;
  arc.length_m = 40e-3 * kSixty;
  return arc;
}

// Displacement of the point 10 mm from the clamp by a force at the tip, mm/N. Four Gauss points: 1e-9.
TEST(CircularBeams2009, ReleasedAnchor) {
  const Eigen::Matrix3d h = 1e3 * release_compliance(sixty(40e-3), {kRubber, 10e-3, 10e-3, 10e-3, false});
  const double exact[2][2] = {{0.4367060572753732, 0.2974487634244875}, {0.4699344763505132, 0.3837971638399098}};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) expect_worked(h(i, j), exact[i][j]);
  expect_worked(h(2, 2), 0.804864010672474);
}

// Thin-ring formulas are no substitute for short thick arcs: their tangential compliance over the exact one.
TEST(CircularBeams2009, ThinFormulasAgainstTheExactCompliance) {
  const double inertia = 10e-3 * 1e-6 / 12, ratio[3] = {0.9231174788347301, 0.7838168302766479, 0.2827718683777458};
  int k = 0;
  for (const double angle : {kPi / 2, kPi / 3, kPi / 6}) {
    const double thin =
        std::pow(kMiddle, 3) / (3e6 * inertia) * (1.5 * angle - 2 * std::sin(angle) + 0.5 * std::sin(2 * angle) / 2);
    expect_worked(thin / arc_tip_compliance(kArc, kRubber, angle, kMiddle).tt_m_per_N, ratio[k++]);
  }
  // Nearly straight, 40 mm long: l^3/(3 E I) + 6 l/(5 G S) is approached as 1/R^2.
  const double l = 40e-3, straight = l * l * l / (9e6 * inertia) + 1.2 * l * 2.94 / (3e6 * 1e-4);
  expect_worked(arc_tip_compliance({0.995, 1.005, 10e-3}, kRubber, l, 1.0).rr_m_per_N / straight, 0.9996547813088464);
  expect_worked(arc_tip_compliance({99.995, 100.005, 10e-3}, kRubber, l / 100, 100).rr_m_per_N / straight,
                0.9999999654721603);
}

// Section III.C: the arc from (0, 25) to (40, 0) mm of an ellipse, b = 1/rho_min + 0.5 mm, rho_min = 15.625 1/m.
TEST(CircularBeams2009, ArcThroughContactAndAnchor) {
  const Vec3 p{0, 25e-3, 0}, a{40e-3, 0, 0}, along = unit_or(a - p, {});
  const BeamCurve arc = arc_through(p, a, {along.y, -along.x, 0}, 1 / 15.625 + 0.5e-3, false);
  expect_worked(norm(a - p), 47.16990566028302e-3);
  expect_worked(arc.outer_radius_m, 64.5e-3);
  expect_worked(arc.angle * 180 / kPi, 42.89618808817025);
  expect_worked(arc.centre_m, {-11.81759812685109e-3, -38.40815700296174e-3, 0});
}

}  // namespace
}  // namespace palpate::test
