// Condensation to the surface: the compliance table against direct solves, its symmetry and definiteness, its limits.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "config/fem/condense.h"
#include "config/fem/linear_body.h"
#include "config/fem/tet_procedural.h"
#include "tests/fem/expect_error.h"

namespace palpate {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST(Condense, TableEqualsDirectSolvesAndIsSymmetricAndDefinite) {
  const TetMesh mesh = make_clip_mesh(1);
  const Supports supports = clip_supports(mesh);
  const CondensedBody body = condense(mesh, {2e9, 0.35}, supports, "clip");
  const std::size_t n = body.node.size(), size = 3 * n;
  ASSERT_EQ(body.compliance_mpN.size(), size * size);
  ASSERT_EQ(body.surface.vertex_m.size(), n);

  const LinearBody direct(mesh, {2e9, 0.35}, supports, "clip");
  std::mt19937 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    const std::size_t j = random() % n, axis = random() % 3;
    std::vector<Vec3> force(mesh.node_m.size());
    (axis == 0   ? force[static_cast<std::size_t>(body.node[j])].x
     : axis == 1 ? force[static_cast<std::size_t>(body.node[j])].y
                 : force[static_cast<std::size_t>(body.node[j])].z) = 1;
    const std::vector<Vec3> u = direct.solve_m(force);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 expected = u[static_cast<std::size_t>(body.node[i])];
      const double* row = &body.compliance_mpN[3 * i * size + 3 * j + axis];
      // 1e-12 of the largest entry (1.4e-4 m/N at a tip).
      EXPECT_LT(norm(Vec3{row[0], row[size], row[2 * size]} - expected), 1e-16);
    }
  }

  const Eigen::Map<const RowMajor> c(body.compliance_mpN.data(), static_cast<Eigen::Index>(size),
                                     static_cast<Eigen::Index>(size));
  EXPECT_EQ((c - c.transpose()).cwiseAbs().maxCoeff(), 0.0);
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < size; ++i) {
    if (body.held[i / 3] == 0)
      free.push_back(static_cast<Eigen::Index>(i));
    else
      EXPECT_EQ(c.row(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff(), 0.0);
  }
  EXPECT_LT(free.size(), size);
  const Eigen::MatrixXd moving = c(free, free);
  EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(moving).info(), Eigen::Success);
}

TEST(Condense, BodyTooLargeForItsTableIsRefusedWithTheNumbers) {
  const TetMesh mesh = make_box_tets({0.04, 0.04, 0.04}, {2, 2, 2});
  CondenseLimits limits;
  limits.surface_nodes = 37;
  const std::string text = test::refusal_by([&] {
    condense(mesh, {1e6, 0.3}, hold_where(mesh, [](Vec3 p) { return p.y == 0; }), "block", {}, limits);
  });
  EXPECT_SAYS(text, "block: the mesh has 98 surface nodes");
  EXPECT_SAYS(text, "allowed 37 nodes");
  EXPECT_SAYS(text, "Coarsen");
}

TEST(Condense, ProgressRunsToTheEnd) {
  const TetMesh mesh = make_box_tets({0.04, 0.04, 0.04}, {2, 2, 2});
  std::vector<std::string> finished;
  double last = 0;
  std::string last_what;
  condense(mesh, {1e6, 0.3}, hold_where(mesh, [](Vec3 p) { return p.y == 0; }), "block",
           [&](const char* what, double fraction) {
             if (last_what == what) {
               EXPECT_GE(fraction, last);
             }
             last = fraction;
             last_what = what;
             if (fraction == 1) finished.push_back(what);
           });
  EXPECT_EQ(finished, (std::vector<std::string>{"stiffness", "factor", "compliance"}));
}

}  // namespace
}  // namespace palpate
