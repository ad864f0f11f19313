// Worked numbers of Duriez, Andriot & Kheddar 2003: elements, transition element, condensation, Signorini's problem,
// and the friction and coupling that came later. One quadratic tetrahedron with E = 1, nu = 1/4 is all fractions.
#include <Eigen/Dense>
#include <cstring>
#include <memory>
#include <vector>

#include "config/fem/condense.h"
#include "config/fem/tet_element.h"
#include "rt_core/contact/nodes/friction_block.h"
#include "rt_core/contact/nodes/pivoting.h"
#include "rt_core/tool/virtual_coupling.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/press/press.h"
#include "sim_host/tick_memory.h"
#include "tests/published/worked.h"
#include "tests/support/roomy.h"

namespace palpate::test {
namespace {

const FemMaterial kUnit{1, 0.25};

TetMesh unit_tet(bool quadratic) {
  TetMesh mesh;
  mesh.node_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tet.resize(1);
  for (std::size_t k = 0; k < 4; ++k) mesh.tet[0].node[k] = static_cast<std::int32_t>(k);
  for (std::size_t e = 0; quadratic && e < 6; ++e) {
    mesh.tet[0].node[4 + e] = static_cast<std::int32_t>(4 + e);
    mesh.node_m.push_back(0.5 * (mesh.node_m[static_cast<std::size_t>(kTetEdge[e][0])] +
                                 mesh.node_m[static_cast<std::size_t>(kTetEdge[e][1])]));
  }
  return mesh;
}
bool at_foot(Vec3 p) { return p.z == 0; }

TEST(Duriez2003, StiffnessOfTheUnitTetrahedron) {
  const TetMesh linear = unit_tet(false), quadratic = unit_tet(true);
  const TetStiffness k4 = tet_stiffness(linear, linear.tet[0], kUnit);
  expect_worked(k4(0, 0), 1.0 / 3);
  expect_worked(k4(3, 3), 1.0 / 5);
  expect_worked(k4(3, 7), 1.0 / 15);
  expect_worked(k4.trace(), 2);
  const TetStiffness k10 = tet_stiffness(quadratic, quadratic.tet[0], kUnit);
  expect_worked(k10(0, 0), 1.0 / 5);
  expect_worked(k10(12, 12), 8.0 / 15);
  expect_worked(k10(0, 12), -14.0 / 75);
  expect_worked(k10.trace(), 46.0 / 5);
  expect_worked(Eigen::SelfAdjointEigenSolver<TetStiffness>(k10).eigenvalues()(29), 2.230513013671124);
  expect_worked(tet_rule_4()[0].lambda[0], 0.5854101966249685);
  expect_worked(tet_rule_4()[0].lambda[1], 0.1381966011250105);
}

// Section 3.2: a unit load on the corner over a held face, all edges quadratic; and with only the edge 0-3 free, the
// transition element.
TEST(Duriez2003, LoadedCornerAndTransitionElement) {
  const auto moved = [](TetMesh mesh, const std::vector<std::size_t>& straight) {
    Supports supports = hold_where(mesh, at_foot);
    for (const std::size_t e : straight) {
      mesh.tet[0].node[4 + e] = -1;
      supports[4 + e] = kHoldAll;  // loose nodes
    }
    std::vector<Vec3> force(mesh.node_m.size());
    force[3] = {0, 0, -1};
    return LinearBody(mesh, kUnit, supports, "tet").solve_m(force);
  };
  const std::vector<Vec3> all = moved(unit_tet(true), {}), one = moved(unit_tet(true), {4, 5});
  expect_worked(all[3], {-8050.0 / 307, -8050.0 / 307, -9910.0 / 307});
  expect_worked(all[7], {-2200.0 / 307, -2200.0 / 307, -4780.0 / 307});
  expect_worked(0.5 * (all[0] + all[3]), {-4025.0 / 307, -4025.0 / 307, -4955.0 / 307}, "what averaging would tell");
  expect_worked(one[3], {100.0 / 363, 100.0 / 363, -1940.0 / 363});
  expect_worked(one[7], {-25.0 / 66, -25.0 / 66, -290.0 / 121});
  expect_worked(moved(unit_tet(false), {})[3], {0, 0, -5});
}

// Section 3.1: the condensed body's compliance is the inverse of the Schur complement.
TEST(Duriez2003, SchurComplement) {
  const TetMesh mesh = unit_tet(true);
  const CondensedBody body = condense(mesh, kUnit, hold_where(mesh, at_foot), "tet");
  std::size_t corner = 0;
  while (body.node[corner] != 3) ++corner;
  const std::size_t width = 3 * body.node.size();
  Eigen::Matrix3d c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      c(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          body.compliance_mpN[(3 * corner + i) * width + 3 * corner + j];
  const Eigen::Matrix3d s = c.inverse();
  expect_worked(s(2, 2), 7251.0 / 149630);
  // The Schur complement itself, from the element's stiffness: corner 3 kept, the free middle nodes 03, 13, 23 out.
  const TetStiffness k = tet_stiffness(mesh, mesh.tet[0], kUnit);
  const Eigen::Matrix<double, 9, 9> kii = k.block<9, 9>(21, 21);
  const Eigen::Matrix<double, 3, 9> ksi = k.block<3, 9>(9, 21);
  const Eigen::Matrix3d schur = k.block<3, 3>(9, 9) - ksi * kii.inverse() * ksi.transpose();
  expect_worked(schur(2, 2), 7251.0 / 149630);
  EXPECT_LT((c * schur - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-11);
}

// The table of 686 nodes, as theirs, in single precision: half of the doubles, 16.9 MB.
TEST(Duriez2003, SizeOfTheTable) {
  expect_worked(static_cast<double>(compliance_bytes(686) / 2), 16941456);
  expect_worked(static_cast<double>(compliance_bytes(1181) / 2), 50211396);
  expect_worked(static_cast<double>(compliance_bytes(2000) / 2), 144e6);
}

// --- Signorini's problem, section 4
// ---------------------------------------------------------------------------------------------------------

using Matrix = std::vector<std::vector<double>>;
std::unique_ptr<NormalProblem> problem(const Matrix& m, const std::vector<double>& gap) {
  auto p = std::make_unique<NormalProblem>();
  std::memset(static_cast<void*>(p.get()), 0xAB, sizeof *p);
  p->n = static_cast<std::int32_t>(gap.size());
  for (std::size_t i = 0; i < gap.size(); ++i) {
    for (std::size_t j = 0; j < gap.size(); ++j) p->compliance[i][j] = m[i][j];
    p->free_gap_m[i] = gap[i];
    p->push_N[i] = 0;
  }
  return p;
}
void expect_pushes(const NormalProblem& p, const std::vector<double>& push) {
  for (std::size_t i = 0; i < push.size(); ++i) EXPECT_NEAR(p.push_N[i], push[i], 1e-9 * push[0]) << i;
}

TEST(Duriez2003, Complementarity) {
  const Matrix three{{4, 1, .5}, {1, 3, 1}, {.5, 1, 2}};
  auto p = problem(three, {-1, -.5, .2});
  solve_pivoting(*p);
  expect_pushes(*p, {5.0 / 22, 1.0 / 11, 0});
  expect_worked(p->gap_m[2], 8.9 / 22);
  p = problem({{4, 2}, {2, 3}}, {-2, -.5});
  solve_pivoting(*p);
  expect_pushes(*p, {0.5, 0});
  for (const int sweeps : {1, 2}) {
    p = problem(three, {-1, -.5, .2});
    solve_sweeping(*p, sweeps);
    expect_pushes(*p,
                  sweeps == 1 ? std::vector<double>{0.25, 1.0 / 12, 0} : std::vector<double>{11.0 / 48, 13.0 / 144, 0});
  }
  // Redundant contacts, the diagonal 1e-6 larger.
  p = problem({{4 * (1 + 1e-6), 4, 1}, {4, 4 * (1 + 1e-6), 1}, {1, 1, 3 * (1 + 1e-6)}}, {-1, -1, -.5});
  solve_pivoting(*p);
  expect_pushes(*p, {0.1136363140496059, 0.1136363140496059, 0.09090903305789632});
}

// The printed form: push by its x component, F = F_x (1, b/a, c/a), F_x >= 0, for planes a x + b y + c z + d >= 0.
// Where all a are positive it is the same problem with each column scaled by 1/a: our pushes, times a, solve it.
TEST(Duriez2003, PushByItsXComponentWhereItIsDefined) {
  const Eigen::Vector3d normal[3] = {{0.6, 0, 0.8}, {0.48, 0.6, 0.64}, {0.8, -0.6, 0}};
  Eigen::Matrix<double, 9, 9> half;
  for (Eigen::Index i = 0; i < 9; ++i)
    for (Eigen::Index j = 0; j < 9; ++j)
      half(i, j) = std::sin(1.0 + 3.7 * static_cast<double>(i) + 1.3 * static_cast<double>(j * j));
  const Eigen::Matrix<double, 9, 9> c = half * half.transpose() + 0.5 * Eigen::Matrix<double, 9, 9>::Identity();
  const double gap[3] = {-1, -0.6, 0.1};
  Matrix m(3, std::vector<double>(3));
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j)
      m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          normal[i].dot(c.block<3, 3>(3 * i, 3 * j) * normal[j]);
  auto p = problem(m, {gap[0], gap[1], gap[2]});
  solve_pivoting(*p);
  int pushing = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    double printed_gap = gap[i];
    for (Eigen::Index j = 0; j < 3; ++j) {
      const double fx = normal[j].x() * p->push_N[j];
      const Eigen::Vector3d along{1, normal[j].y() / normal[j].x(), normal[j].z() / normal[j].x()};
      printed_gap += normal[i].dot(c.block<3, 3>(3 * i, 3 * j) * along) * fx;
    }
    const double fx = normal[i].x() * p->push_N[i];
    EXPECT_GE(fx, 0);
    EXPECT_GE(printed_gap, -1e-12);
    EXPECT_NEAR(fx * printed_gap, 0, 1e-12);
    pushing += fx > 0;
  }
  EXPECT_GT(pushing, 0);
}

// Why no scene can choose the printed form: on the clip of section 5 it would pull one arm. Its normals point to both
// sides, across the tube, and along the way in they turn round; no axis has a > 0 for all pushes of the snap.
TEST(Duriez2003, OnTheClipThePrintedFormPullsAnArm) {
  const SceneModel scene(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/snap_in_paper.toml",
                         {{}, {"friction.law=none"}});
  std::vector<TimedPose> poses;
  for (int i = 0; i <= 280; ++i) poses.push_back({1e-3 * i, {{0, 14.5e-3 - 5e-5 * i, 0}, {}}, {}});
  int pushes = 0, positive[3] = {};
  const auto state = make_state(scene.model());
  press(scene.model(), poses, {}, *state, nullptr, [&](const PressRow&, const State&, const Scratch& scratch) {
    for (std::int32_t i = 0; i < scratch.contact_count; ++i) {
      const Contact& c = scratch.contact[i];
      if (!(c.force_N > 0)) continue;
      pushes += 1;
      const double n[3] = {c.normal_w.x, c.normal_w.y, c.normal_w.z};
      for (int k = 0; k < 3; ++k) positive[k] += n[k] > 1e-12;
    }
  });
  std::printf("  %d pushes; a > 0 along x %d, y %d, z %d\n", pushes, positive[0], positive[1], positive[2]);
  ASSERT_GT(pushes, 1000);
  for (const int count : positive) EXPECT_LT(count, 0.6 * pushes);
}

// --- Coupling and friction
// ---------------------------------------------------------------------------------------------------------

// A contact of 0.2 mm/N met 1 mm deep through a coupling of 2 N/mm and 500 N mm/rad, at a lever of 0 and 10 mm: one
// solution is the balance, push 10/7 and 10/9 N.
TEST(Duriez2003, PushThroughTheVirtualCoupling) {
  Model model;
  model.params.coupling_N_per_m = 2000;
  model.params.coupling_Nm_per_rad = 0.5;
  for (const double lever_m : {0.0, 0.01}) {
    const StatePtr state = roomy_state();
    reset(*state);
    const double jacobian[6] = {0, 0, -1, 0, lever_m, 0};
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) state->contact_stiffness[6 * i + j] = 5000 * jacobian[i] * jacobian[j];
    Twist offset;
    std::int32_t landings = 0;
    ASSERT_TRUE(correct(model, *state, {{0, 0, 5}, {0, -5 * lever_m, 0}}, {}, offset, landings, nullptr));
    const Vec3 push = 2000 * offset.translation_m, torque = 0.5 * offset.rotation_rad;
    expect_worked(push, {0, 0, lever_m > 0 ? 10.0 / 9 : 10.0 / 7});
    expect_worked(offset.translation_m, {0, 0, lever_m > 0 ? 1e-2 / 18 : 1e-2 / 14});
    if (lever_m > 0) {
      expect_worked(torque, {0, -0.1 / 9, 0});
      expect_worked(offset.rotation_rad, {0, -0.2 / 9, 0});
    } else {
      expect_worked(1e-3 - offset.translation_m.z, 2e-3 / 7);  // where the surface is
    }
  }
}

// Coulomb's law for one contact (Jourdan, Alart & Jean 1998): sticks, slips twice, open; mu = 0.5.
TEST(Duriez2003, FrictionOfOneContact) {
  const double w[3][3] = {{2, .3, -.1}, {.3, 1.5, .05}, {-.1, .05, 1.4}};
  const struct {
    double free[3], push[3], slip[2];
  } rows[] = {{{-1, .1, .05}, {0.526228091829178, -0.1721797087138978, 0.008022710441866206}, {0, 0}},
              {{-1, .8, -.4},
               {0.542485603887863, -0.243202107209531, 0.1201057561286661},
               {0.6039478081584956, -0.2982606071691304}},
              {{-1, .3, 0},
               {0.5422620721676243, -0.267955509769158, 0.04137491404501154},
               {0.06281410269880081, -0.009699103042204173}},
              {{.2, 1, 0}, {0, 0, 0}, {1, 0}}};
  for (const auto& row : rows) {
    const FrictionBlock block = make_friction_block(w, 0.5);
    const double c = block.cosine, s = block.sine;
    const Push push =
        solve_friction(block, 0.5, {row.free[0], c * row.free[1] + s * row.free[2], c * row.free[2] - s * row.free[1]});
    const double r[3] = {push.normal_N, c * push.tangent_N[0] - s * push.tangent_N[1],
                         s * push.tangent_N[0] + c * push.tangent_N[1]};
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(r[i], row.push[i], 1e-9 * row.push[0]) << i;
    for (int i = 1; i < 3; ++i) {
      const double u = row.free[i] + w[i][0] * r[0] + w[i][1] * r[1] + w[i][2] * r[2];
      EXPECT_NEAR(u, row.slip[i - 1], 2e-9) << i;
    }
  }
}

}  // namespace
}  // namespace palpate::test
