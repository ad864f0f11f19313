// Linear elasticity on tetrahedra: patch test, worked elements, balance of reactions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "config/fem/linear_body.h"
#include "config/fem/tet_element.h"
#include "config/fem/tet_procedural.h"

namespace palpate {
namespace {

TetMesh unit_tet(bool quadratic) {
  TetMesh mesh;
  mesh.node_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Tet tet;
  for (std::size_t k = 0; k < 4; ++k) tet.node[k] = static_cast<std::int32_t>(k);
  mesh.tet = {tet};
  if (quadratic) {
    // Middle nodes in the element's own order.
    for (std::size_t e = 0; e < 6; ++e) {
      mesh.tet[0].node[4 + e] = static_cast<std::int32_t>(4 + e);
      mesh.node_m.push_back(0.5 * (mesh.node_m[static_cast<std::size_t>(kTetEdge[e][0])] +
                                   mesh.node_m[static_cast<std::size_t>(kTetEdge[e][1])]));
    }
  }
  return mesh;
}

// A box of 2 x 2 x 2 cells whose inner nodes are displaced at random: no element has a special shape. `order` 1, 2, or
// 0 for a mesh whose lower part is quadratic and whose upper part is linear.
TetMesh distorted_box(int order) {
  TetMesh mesh = make_box_tets({0.04, 0.05, 0.06}, {2, 2, 2});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.003, 0.003);
  TetMesh linear;
  for (const Tet& tet : mesh.tet) {
    Tet corners;
    for (std::size_t k = 0; k < 4; ++k) corners.node[k] = tet.node[k];
    linear.tet.push_back(corners);
  }
  linear.node_m.assign(mesh.node_m.begin(), mesh.node_m.begin() + 27);
  for (Vec3& p : linear.node_m)
    if (std::abs(p.x) < 0.01 && std::abs(p.y - 0.025) < 0.01 && std::abs(p.z) < 0.01)
      p += Vec3{shift(random), shift(random), shift(random)};
  if (order == 2) add_middle_nodes(linear);
  if (order == 0)
    add_middle_nodes(linear, elements_near(
                                 linear, [](Vec3 p) { return p.y < 0.001; }, 1));
  return linear;
}

// The surface follows a linear field; the nodes inside must find it.
void patch_test(const TetMesh& mesh, double poisson) {
  const auto field = [](Vec3 p) {
    return Vec3{1e-3 * p.x + 2e-4 * p.y - 3e-4 * p.z, -5e-4 * p.x + 7e-4 * p.z, 4e-4 * p.x - 9e-4 * p.y + 6e-4 * p.z};
  };
  Supports supports(mesh.node_m.size(), 0);
  std::vector<Vec3> held(mesh.node_m.size());
  for (const std::int32_t i : surface_of(mesh).node) {
    supports[static_cast<std::size_t>(i)] = kHoldAll;
    held[static_cast<std::size_t>(i)] = field(mesh.node_m[static_cast<std::size_t>(i)]);
  }
  const LinearBody body(mesh, {3e6, poisson}, supports, "box");
  const std::vector<Vec3> u = body.solve_m(std::vector<Vec3>(mesh.node_m.size()), held);
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_LT(norm(u[i] - field(mesh.node_m[i])), 1e-10 * 6e-5) << "node " << i;  // 6e-5 m: the field's size
}

TEST(PatchTest, LinearFieldIsExactForEveryOrder) {
  for (const int order : {1, 2, 0}) {
    SCOPED_TRACE(order);
    patch_test(distorted_box(order), 0.3);
  }
}
TEST(PatchTest, HoldsWithMeanDilatation) { patch_test(distorted_box(2), 0.4999); }

// An inner node pushed almost onto a face: elements with a height of 1e-5 of their edges must not spoil the solution.
TEST(PatchTest, HoldsWithSlivers) {
  TetMesh mesh = distorted_box(1);
  mesh.node_m[13] = 1e-5 * mesh.node_m[13];  // the inner node; the middle of the bottom is the origin
  add_middle_nodes(mesh);
  check_tet_mesh(mesh, "slivers");
  double least = 1;
  for (const Tet& tet : mesh.tet) least = std::min(least, corner_volume_m3(mesh, tet) / std::pow(0.03, 3));
  EXPECT_LT(least, 1e-5);
  patch_test(mesh, 0.3);
}

TEST(Element, WorkedValuesOfTheUnitTetrahedron) {
  const FemMaterial material{1, 0.25};
  const TetMesh linear = unit_tet(false), quadratic = unit_tet(true);
  const TetStiffness k4 = tet_stiffness(linear, linear.tet[0], material);
  EXPECT_NEAR(k4(0, 0), 1.0 / 3, 1e-15);
  EXPECT_NEAR(k4(3, 3), 0.2, 1e-15);
  EXPECT_NEAR(k4(3, 7), 1.0 / 15, 1e-15);
  EXPECT_NEAR(k4.trace(), 2.0, 1e-14);
  const TetStiffness k10 = tet_stiffness(quadratic, quadratic.tet[0], material);
  EXPECT_NEAR(k10(0, 0), 0.2, 1e-14);
  EXPECT_NEAR(k10(12, 12), 8.0 / 15, 1e-14);
  EXPECT_NEAR(k10(0, 12), -0.186666666666667, 1e-14);
  EXPECT_NEAR(k10.trace(), 9.2, 1e-13);
  const Eigen::SelfAdjointEigenSolver<TetStiffness> eigen(k10);
  EXPECT_EQ((eigen.eigenvalues().array().abs() < 1e-13).count(), 6);
  EXPECT_NEAR(eigen.eigenvalues()(29), 2.230513, 1e-6);
}

// Holding the middle nodes in the middle must give back the linear element (T' K10 T = K4).
TEST(Element, QuadraticReducesToLinear) {
  const FemMaterial material{1, 0.25};
  const TetMesh linear = unit_tet(false), quadratic = unit_tet(true);
  Eigen::Matrix<double, 30, 30> t = Eigen::Matrix<double, 30, 30>::Zero();
  for (Eigen::Index a = 0; a < 12; ++a) t(a, a) = 1;
  for (std::size_t e = 0; e < 6; ++e)
    for (Eigen::Index a = 0; a < 3; ++a)
      for (const std::int32_t corner : kTetEdge[e]) t(12 + 3 * static_cast<Eigen::Index>(e) + a, 3 * corner + a) = 0.5;
  const TetStiffness reduced = t.transpose() * tet_stiffness(quadratic, quadratic.tet[0], material) * t;
  EXPECT_LT((reduced - tet_stiffness(linear, linear.tet[0], material)).cwiseAbs().maxCoeff(), 1e-15);
}

// One element on its face z = 0, unit load along -z on the opposite corner.
TEST(Element, LoadedCornerOfLinearTransitionAndQuadratic) {
  const FemMaterial material{1, 0.25};
  const auto corner_of = [&](TetMesh mesh, std::vector<std::size_t> dropped) {
    for (const std::size_t e : dropped) mesh.tet[0].node[4 + e] = -1;
    Supports supports = hold_where(mesh, [](Vec3 p) { return p.z == 0; });
    for (const std::size_t e : dropped) supports[4 + e] = kHoldAll;  // loose nodes
    std::vector<Vec3> force(mesh.node_m.size());
    force[3] = {0, 0, -1};
    return LinearBody(mesh, material, supports, "tet").solve_m(force);
  };
  const auto t10 = corner_of(unit_tet(true), {});
  EXPECT_NEAR(t10[3].x, -26.221498, 1e-6);
  EXPECT_NEAR(t10[3].z, -32.280130, 1e-6);
  EXPECT_NEAR(t10[7].x, -7.166124, 1e-6);
  EXPECT_NEAR(t10[7].z, -15.570033, 1e-6);
  const auto mixed = corner_of(unit_tet(true), {4, 5});  // edges 1-3 and 2-3 stay straight
  EXPECT_NEAR(mixed[3].x, 0.275482, 1e-6);
  EXPECT_NEAR(mixed[3].z, -5.344353, 1e-6);
  EXPECT_NEAR(mixed[7].x, -0.378788, 1e-6);
  EXPECT_NEAR(mixed[7].z, -2.396694, 1e-6);
  const auto t4 = corner_of(unit_tet(false), {});
  EXPECT_NEAR(t4[3].x, 0, 1e-12);
  EXPECT_NEAR(t4[3].z, -5, 1e-12);
}

// Supports carry exactly the load: six sums, of a curved clip.
TEST(LinearBody, ReactionsBalanceTheLoad) {
  const TetMesh mesh = make_clip_mesh(1);
  const Supports supports = clip_supports(mesh);
  const LinearBody body(mesh, {2e9, 0.35}, supports, "clip");
  std::vector<Vec3> force(mesh.node_m.size());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> component(-1, 1);
  Vec3 load, load_moment;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (supports[i] != 0) continue;
    force[i] = {component(random), component(random), component(random)};
    load += force[i];
    load_moment += cross(mesh.node_m[i], force[i]);
  }
  const std::vector<Vec3> f = body.forces_N(body.solve_m(force));
  Vec3 reaction, moment;
  for (std::size_t i = 0; i < f.size(); ++i)
    if (supports[i] != 0) {
      reaction += f[i];
      moment += cross(mesh.node_m[i], f[i]);
    } else {
      EXPECT_LT(norm(f[i] - force[i]), 1e-8) << "node " << i;  // equilibrium: condition number 1e6 times rounding
    }
  EXPECT_LT(norm(reaction + load), 1e-9 * norm(load));
  EXPECT_LT(norm(moment + load_moment), 1e-9 * norm(load_moment) + 1e-11);
}

// Degree 5 over the parent tetrahedron: integral of l0^a l1^b l2^c l3^d is a! b! c! d! 3! / (a + b + c + d + 3)!.
TEST(Quadrature, RulesIntegrateTheirDegree) {
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  for (const auto& [rule, degree] : {std::pair{&tet_rule_4(), 2}, std::pair{&tet_rule_14(), 5}})
    for (int a = 0; a <= degree; ++a)
      for (int b = 0; a + b <= degree; ++b)
        for (int c = 0; a + b + c <= degree; ++c) {
          double sum = 0;
          for (const TetPoint& p : *rule)
            sum += p.weight * std::pow(p.lambda[0], a) * std::pow(p.lambda[1], b) * std::pow(p.lambda[2], c);
          EXPECT_NEAR(sum, factorial(a) * factorial(b) * factorial(c) * 6 / factorial(a + b + c + 3), 1e-15);
        }
}

}  // namespace
}  // namespace palpate
