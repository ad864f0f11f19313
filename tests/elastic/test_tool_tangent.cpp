// The tangent stiffness of a tool against a body whose modes give way under it: against a dense elimination, and
// against the force that the tool's motion changes.
#include "rt_core/contact/elastic/tool_tangent.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <string>

#include "rt_core/tool/virtual_coupling.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

Matrix6 matrix_of(const ContactStiffness& stiffness) {
  Real entry[36];
  store(stiffness, entry);
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(entry);
}

// Random springs between the twists of one tool or two and so many modes.
void matches_a_dense_elimination(std::int32_t soft, std::int32_t hands) {
  std::mt19937_64 random(static_cast<std::uint64_t>(10 * soft + hands));
  std::uniform_real_distribution<double> draw(-1, 1);
  const Eigen::Index size = soft + 6 * hands;
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(size, size), modes = Eigen::MatrixXd::Identity(soft, soft);
  for (Eigen::Index i = 0; i < soft; ++i)
    for (Eigen::Index j = 0; j < i; ++j) modes(i, j) = modes(j, i) = 0.2 * draw(random);
  joint.topLeftCorner(soft, soft) = modes;
  ToolTangent tangent;
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = modes;
  tangent.begin(static_cast<std::int32_t>(size), soft, rows.data());
  for (int s = 0; s < 5; ++s) {
    const std::int32_t twist = soft + 6 * (s % hands);
    const Vec3 direction = unit_or({draw(random), draw(random), draw(random)}, {}), arm{draw(random), 0.3, -0.2};
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(size);
    for (Eigen::Index a = 0; a < soft; ++a) slope[a] = draw(random);
    const Vec3 turn = cross(arm, direction);
    slope.segment(twist, 6) << direction.x, direction.y, direction.z, turn.x, turn.y, turn.z;
    const double stiffness = 10 + 9 * draw(random);
    joint += stiffness * slope * slope.transpose();
    ToolTangent::Spring spring;
    aim(
        static_cast<std::int32_t>(size), soft, twist, direction, arm, [&](std::int32_t a) { return -slope[a]; },
        spring);
    tangent.add(static_cast<std::int32_t>(size), stiffness, spring);
  }
  const Eigen::MatrixXd mm = joint.topLeftCorner(soft, soft), mt = joint.topRightCorner(soft, size - soft);
  const Eigen::MatrixXd left = joint.bottomRightCorner(size - soft, size - soft) - mt.transpose() * mm.llt().solve(mt);
  tangent.eliminate(static_cast<std::int32_t>(size), soft);
  for (std::int32_t hand = 0; hand < hands; ++hand) {
    const Matrix6 found = matrix_of(tangent.from(soft + 6 * hand));
    EXPECT_LT((found - left.block(6 * hand, 6 * hand, 6, 6)).norm(), 1e-12 * left.norm()) << soft << " " << hands;
  }
  Eigen::VectorXd further = Eigen::VectorXd::LinSpaced(soft, -0.5, 1.0);
  ToolTangent::Spring spring{};
  for (Eigen::Index a = 0; a < soft; ++a) spring.slope[a] = further[a];
  EXPECT_NEAR(tangent.yield_m_per_N(soft, spring), further.dot(mm.llt().solve(further)), 1e-12);
}

TEST(ToolTangent, IsTheSchurComplementOfItsModes) {
  for (const std::int32_t soft : {1, 2, 3, 4, 7, kMaxSoftModes})
    for (const std::int32_t hands : {1, 2}) matches_a_dense_elimination(soft, hands);
}

// A slender post of 10 x 60 x 10 mm between the two balls of a fork, which presses 0.2 mm into either side near its top
// and sticks there: it sways, leans and twists with the fork.
std::string forked_post() {
  std::string scene =
      elastic_scene("shape = \"box\"\nsize_mm = [10, 60, 10]\ntriangles = 2400\n", 8, 5, 4, 4, "presliding");
  const std::string piece = "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 4.000000\n";
  const auto ball = [&](const char* x) { return piece + "position_mm = [" + x + ", 0, 0]\n"; };
  scene.replace(scene.find("max_depth_mm = 6"), 16, "max_depth_mm = 2");
  scene.replace(scene.find("[[tool"), 0, "mu_ref = 20\n");
  scene.replace(scene.find(piece), piece.size(), ball("8.8") + ball("-8.8"));
  return scene;
}

// Wrench at a pose held until it stands, from a state that is not changed.
Eigen::Vector<double, 6> held_at(const Model& model, const State& from, const Pose& at) {
  Bench bench(model);
  copy_state(from, *bench.state);
  for (int i = 0; i < 8; ++i) bench.tick_at(at, {});
  const Wrench& w = bench.output.contact_w;
  return {w.force_N.x, w.force_N.y, w.force_N.z, w.torque_Nm.x, w.torque_Nm.y, w.torque_Nm.z};
}

// Told over felt, along x, y, z and about x, y, z (2026-11-26): 1.000, 0.999, 1.003, 1.000, 1.044, 0.931. What is left
// is how the forces turn with the places' normals. Contacts one by one, each in series with what the modes give under
// it alone, were 1.92, 0.77, 5.83, 0.77, 0.57 and 0.87 of it.
TEST(ToolTangent, IsWhatAForkFeelsOfASlenderPost) {
  const BakedScene scene(parse_scene(forked_post(), "post.toml"));
  Bench bench(scene.model());
  const Vec3 at{0, 0.05, 0};
  for (int i = 0; i < 40; ++i) bench.tick_at({at, {}}, {});
  ASSERT_EQ(bench.output.regions, 2);
  const Matrix6 told = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(bench.state->contact_stiffness);
  for (int d = 0; d < 6; ++d) {
    const double step = d < 3 ? 5e-6 : 1e-3;
    Eigen::Vector<double, 6> felt = Eigen::Vector<double, 6>::Zero();
    for (const double side : {-1.0, 1.0}) {
      Pose pose{at, {}};
      double way[6] = {};
      way[d] = side * step;
      pose = moved(pose, {{way[0], way[1], way[2]}, {way[3], way[4], way[5]}});
      felt -= side / (2 * step) * held_at(scene.model(), *bench.state, pose);
    }
    RecordProperty("told_over_felt_" + std::to_string(d), std::to_string(told(d, d) / felt[d]));
    EXPECT_NEAR(told(d, d) / felt[d], 1, 0.1) << d;
  }
}

}  // namespace
}  // namespace palpate::test
