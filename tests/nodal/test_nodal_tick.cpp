// Whole ticks of the nodal back-end: balance, complementarity, friction, the virtual coupling, and the hard cases.
#include <gtest/gtest.h>
#include <limits>

#include <cmath>
#include <cstdio>

#include "config/fem/strain_gauges.h"
#include "tests/nodal/nodal_scene.h"

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PieceDesc box_piece(Vec3 size_m) {
  PieceDesc piece;
  piece.shape = PieceShape::kBox;
  piece.size_m = size_m;
  piece.margin_m = 1e-3;
  piece.points = 8;
  return piece;
}

// A block of 24 mm standing on y = 0, held there.
CondensedBody block(double poisson = 0.45, std::array<std::int32_t, 3> cells = {3, 3, 3}, double height_m = 0.024) {
  const TetMesh mesh = make_box_tets({0.024, height_m, 0.024}, cells);
  return condense(mesh, {2e5, poisson}, hold_where(mesh, [](Vec3 x) { return x.y < 1e-9; }), "block");
}
NodalSceneOptions soft(double mu = 0) {
  NodalSceneOptions options;
  options.young_Pa = 2e5;
  options.mu = mu;
  return options;
}
constexpr double kTop_m = 0.024;
// Height of a sphere of 10 mm whose lowest point is `depth` below the block's top.
Vec3 sphere_at(double depth_m, double x_m = 0) { return {x_m, kTop_m + 0.010 - depth_m, 0}; }

// What holds after every tick: nobody pulls, friction stays in its cone, gaps are closed, totals add up.
void expect_sound(const NodalScene& scene, double mu, double residual_m = 15e-6) {
  const ContactProblem& p = problem_of(scene.scratch());
  const Output& output = scene.output();
  Vec3 force, torque;
  double product = 0;
  for (std::int32_t i = 0; i < p.count; ++i) {
    const ContactNode& node = p.node[i];
    EXPECT_GE(node.push.normal_N, 0);
    EXPECT_LE(std::hypot(node.push.tangent_N[0], node.push.tangent_N[1]), mu * node.push.normal_N * (1 + 1e-9) + 1e-15);
    if (mu == 0) product += std::abs(node.push.normal_N * p.normal.gap_m[i]);
    force += push_w(node);
    torque += cross(node.arm_w, push_w(node));
  }
  EXPECT_LT(product, 1e-9);  // N m
  EXPECT_LT(output.residual_m, mu == 0 ? 1e-9 : residual_m);
  EXPECT_LT(norm(force + output.contact_w.force_N), 1e-9 * (1 + norm(force)));  // action and reaction
  EXPECT_LT(norm(torque + output.contact_w.torque_Nm), 1e-9 * (1 + norm(torque)));
  EXPECT_EQ(output.fault, 0u);
}

TEST(NodalTick, PressesWithoutPullOrPenetration) {
  NodalScene scene(block(), {sphere_piece(0.010)}, soft());
  double last = 0;
  for (int k = 1; k <= 40; ++k) {
    scene.tick_at(sphere_at(1e-4 * k));
    expect_sound(scene, 0);
    EXPECT_GE(scene.output().contact_w.force_N.y, last);      // harder as it goes deeper
    EXPECT_LE(problem_of(scene.scratch()).normal.pivots, 3);  // three steps warm
    last = scene.output().contact_w.force_N.y;
  }
  EXPECT_GT(last, 1.0);
  EXPECT_EQ(scene.output().regions, 1);
  EXPECT_GT(scene.output().energy_J, 0);
}

// Force is the slope of the stored energy: what goes in comes back.
TEST(NodalTick, FrictionlessPressReturnsItsWork) {
  NodalScene scene(block(), {sphere_piece(0.010)}, soft());
  double work = 0, largest = 0, last = 0;
  const auto go = [&](double from, double to) {
    scene.tick_at(sphere_at(to));
    const double force = scene.output().contact_w.force_N.y;
    work += 0.5 * (force + last) * (to - from);
    last = force;
    if (to >= 0.004) {
      EXPECT_NEAR(scene.output().energy_J, work, 0.03 * work);  // normals turn a little with the far field: 2.3 %
      largest = work;
    }
  };
  for (int k = 0; k < 400; ++k) go(1e-5 * k, 1e-5 * (k + 1));
  for (int k = 400; k > 0; --k) go(1e-5 * k, 1e-5 * (k - 1));
  EXPECT_LT(std::abs(work), 1e-3 * largest);
}

TEST(NodalTick, FlatPunchOnSixtyRedundantNodes) {
  for (const double mu : {0.0, 0.5}) {
    NodalScene scene(block(0.45, {4, 2, 4}), {box_piece({0.060, 0.010, 0.060})}, soft(mu));
    int most = 0, pivots = 0;
    for (int k = 1; k <= 20; ++k) {
      scene.tick_at({0, kTop_m + 0.005 - 1e-4 * k, 0});
      expect_sound(scene, mu);
      most = std::max(most, problem_of(scene.scratch()).count);
      if (k > 1) pivots = std::max(pivots, problem_of(scene.scratch()).normal.pivots);
    }
    EXPECT_GE(most, 60);
    EXPECT_LE(pivots, mu == 0 ? 4 : 5);  // the edge of a flat face opens and closes; after friction once more
    EXPECT_GT(scene.output().contact_w.force_N.y, 1);
    EXPECT_EQ(scene.output().status & Status::kNotConverged, 0u);
  }
}

TEST(NodalTick, NearlyIncompressibleAndSliverBodies) {
  const CondensedBody bodies[] = {block(0.4999), block(0.3, {12, 1, 12}, 0.0004)};  // cells of 2 x 0.4 mm
  const double heights[] = {kTop_m, 0.0004};
  for (int b = 0; b < 2; ++b) {
    NodalScene scene(bodies[b], {sphere_piece(0.010)}, soft(0.3));
    for (int k = 1; k <= 20; ++k) {
      scene.tick_at({0, heights[b] + 0.010 - 1e-5 * k, 0});
      expect_sound(scene, 0.3);
    }
    EXPECT_GT(scene.output().contact_w.force_N.y, 0);
  }
}

TEST(NodalTick, ReleaseAtFullDepthLeavesNothing) {
  NodalScene scene(block(), {sphere_piece(0.010)}, soft(0.5));
  scene.move(sphere_at(0), sphere_at(0.005, 0.002), 20);
  EXPECT_GT(norm(scene.output().contact_w.force_N), 1);
  scene.tick_at({0.5, 0.5, 0.5});
  EXPECT_EQ(scene.output().contact_w.force_N, (Vec3{}));
  EXPECT_EQ(scene.output().contacts, 0);
  EXPECT_EQ(scene.state().nodal.count, 0);
  scene.tick_at(sphere_at(0.005));  // and back at full depth in one tick: 1 % of it is left
  expect_sound(scene, 0.5, 5e-5);
  scene.settle_at(sphere_at(0.005));
  expect_sound(scene, 0.5, 1e-6);
}

// Dragged to and fro at a high friction coefficient: sticks, slips, never gains energy, stays in the cone.
TEST(NodalTick, StickSlipDissipates) {
  NodalScene scene(block(), {sphere_piece(0.010)}, soft(0.8));
  scene.move(sphere_at(0), sphere_at(0.003), 30);
  Vec3 last = scene.output().contact_w.force_N, at = sphere_at(0.003);
  double work = 0;
  int slipped = 0;
  for (int k = 0; k < 400; ++k) {
    const double phase = 2 * 3.14159265358979 * k / 200;
    const Vec3 to = sphere_at(0.003, 0.003 * std::sin(phase));
    scene.tick_at(to);
    expect_sound(scene, 0.8);
    const Vec3 force = scene.output().contact_w.force_N;
    work -= 0.5 * dot(force + last, to - at);
    last = force;
    at = to;
    for (std::int32_t i = 0; i < problem_of(scene.scratch()).count; ++i)
      slipped += problem_of(scene.scratch()).node[i].push.slips ? 1 : 0;
  }
  EXPECT_GT(slipped, 100);
  EXPECT_GT(work, 0);
}

// A node that sticks stays where it is on the tool, however long it is shaken.
TEST(NodalTick, StickingDoesNotDrift) {
  NodalScene scene(block(), {sphere_piece(0.010)}, soft(2.0));
  scene.move(sphere_at(0), sphere_at(0.002), 40);
  scene.move(sphere_at(0.002), sphere_at(0.002, 1e-4), 10);
  const double before = scene.settle_at(sphere_at(0.002, 1e-4), 20).contact_w.force_N.x;
  for (int k = 0; k < 500; ++k) scene.tick_at(sphere_at(0.002, 1e-4 + (k % 2 == 0 ? 3e-5 : -3e-5)));
  const double after = scene.settle_at(sphere_at(0.002, 1e-4), 20).contact_w.force_N.x;
  EXPECT_NEAR(after, before, 0.01 * std::abs(before));
}

TEST(NodalTick, VanishingFrictionIsTheFrictionlessProblem) {
  NodalScene without(block(), {sphere_piece(0.010)}, soft()), with(block(), {sphere_piece(0.010)}, soft(1e-9));
  for (int k = 1; k <= 20; ++k) {
    const Vec3 a = without.tick_at(sphere_at(1e-4 * k)).contact_w.force_N;
    const Vec3 b = with.tick_at(sphere_at(1e-4 * k)).contact_w.force_N;
    EXPECT_LT(norm(a - b), 1e-6 * (1 + norm(a)));
  }
}

// The handle 3 mm inside: what the contact pushes is what the coupling carries, in the same tick.
TEST(NodalTick, CouplingBalancesInTheSameTick) {
  NodalScene scene(block(), {sphere_piece(0.010)}, soft(0.5));
  scene.tick_at(sphere_at(-0.002), Drive::kDevice);
  for (int k = 0; k <= 200; ++k) {
    scene.tick_at(sphere_at(-0.002 + 2.5e-5 * k, 1e-5 * k), Drive::kDevice);
    if (k < 100) continue;
    const Output& o = scene.output();
    expect_sound(scene, 0.5);
    EXPECT_LT(norm(o.device_w.force_N - o.contact_w.force_N), 1e-6 * norm(o.contact_w.force_N));
  }
  const Output& o = scene.output();
  const double lag = norm(scene.state().safety.tool_corrected_w.position_m - scene.state().device_w.position_m);
  EXPECT_NEAR(lag * scene.model().params.coupling_N_per_m, norm(o.device_w.force_N), 1e-6);
}

// The clip's force falls by 2.3 N/mm; a coupling of 1.3 N/mm cannot hold it, and the tool jumps: no faster than
// allowed, to the seat, with every number finite.
TEST(NodalTick, SnapThroughASoftCouplingIsBounded) {
  const TetMesh mesh = make_clip_mesh(1);
  NodalSceneOptions options;
  options.young_Pa = 2e9;
  options.poisson = 0;
  options.coupling_N_per_m = 1330;
  NodalScene scene(condense(mesh, {2e9, 0}, clip_supports(mesh), "clip"), {cylinder_piece(0.010, 0.040, 0.001)},
                   options);
  Vec3 tool{0, 0.016, 0};
  scene.tick_at(tool, Drive::kDevice);
  double fastest = 0, largest = 0;
  for (int k = 0; k <= 2000; ++k) {
    const double y = 0.016 - 1e-5 * k;  // 10 mm/s
    const Output& o = scene.tick_at({0, std::max(y, 0.0), 0}, Drive::kDevice);
    const Vec3 now = scene.state().safety.tool_corrected_w.position_m;
    if (k > 0) fastest = std::max(fastest, norm(now - tool));
    tool = now;
    largest = std::max(largest, o.device_w.force_N.y);
    ASSERT_TRUE(is_finite(o.device_w.force_N));
    EXPECT_EQ(o.fault, 0u);
  }
  EXPECT_LE(fastest, 0.5e-3 + 1e-5 + 1e-12);
  EXPECT_GT(fastest, 1e-4);  // it did jump
  EXPECT_NEAR(largest, 7.05, 0.5);
  EXPECT_NEAR(tool.y, 0, 5e-4);
}

// Beyond the linear range a tick says so, with the strain reached.
TEST(NodalTick, StrainBeyondTheLinearRangeIsReported) {
  const TetMesh mesh = make_box_tets({0.024, kTop_m, 0.024}, {3, 3, 3});
  const Supports base = hold_where(mesh, [](Vec3 x) { return x.y < 1e-9; });
  const CondensedBody body = condense(mesh, {2e5, 0.45}, base, "block");
  NodalSceneOptions options = soft();
  const LinearBody solver(mesh, {2e5, 0.45}, base, "block");
  for (const double e : place_strain_gauges(solver, mesh, body, kMaxStrainGauges).strain_1pN)
    options.strain_gauge.push_back(static_cast<float>(e));
  options.strain_limit = 0.02;
  NodalScene scene(body, {box_piece({0.060, 0.010, 0.060})}, options);
  bool below = false, beyond = false;
  for (int k = 1; k <= 60; ++k) {
    const Output& o = scene.tick_at({0, kTop_m + 0.005 - 5e-5 * k, 0});
    const bool says = (o.status & Status::kStrainBeyondLinear) != 0;
    EXPECT_EQ(says, o.strain > 0.02) << k;
    (says ? beyond : below) = true;
    // A plate on the whole face: the mean strain is the approach over the height, the largest no less than half of it.
    EXPECT_GT(o.strain, 0.5 * 5e-5 * k / kTop_m);
  }
  EXPECT_TRUE(below);
  EXPECT_TRUE(beyond);
}

// A face of 169 nodes under a plate: the problem fills tick by tick, says each time that it leaves out nodes that
// penetrate, and never holds more than its capacity.
TEST(NodalTick, DroppedNodesAreReported) {
  NodalScene scene(block(0.45, {6, 2, 6}), {box_piece({0.060, 0.010, 0.060})}, soft());
  int most = 0;
  for (int k = 0; k < 10; ++k) {
    scene.tick_at({0, kTop_m + 0.004, 0});
    EXPECT_NE(scene.output().status & Status::kContactsDropped, 0u) << k;
    EXPECT_LE(problem_of(scene.scratch()).count, kMaxContacts);
    most = std::max(most, problem_of(scene.scratch()).count);
  }
  EXPECT_GT(most, kMaxContacts - 8);
}

// More near nodes than a problem holds, but few that push: all those are found, and no other one penetrates by more
// than a thirtieth of an encoder's step. The gaps of all nodes, from the whole compliance.
TEST(NodalTick, LeavesOutOnlyNodesThatDoNotPenetrate) {
  NodalSceneOptions options = soft();
  options.carry = NodalCarry::kRest;
  NodalScene scene(block(0.45, {6, 2, 6}), {sphere_piece(0.010)}, options);
  scene.params().contact_margin_m = 0.012;
  scene.reopen();
  int near = 0;
  for (int k = 1; k <= 60; ++k) {
    const Vec3 tool = sphere_at(5e-5 * k);
    scene.tick_at(tool);
    if (k % 10 != 0) continue;
    scene.settle_at(tool, 3);
    EXPECT_EQ(scene.output().status & Status::kContactsDropped, 0u) << k;
    const ContactProblem& p = problem_of(scene.scratch());
    EXPECT_LT(p.count, kMaxContacts);
    near = 0;
    const Model& model = scene.model();
    const auto n = static_cast<std::size_t>(model.sizes.n_vertex);
    for (std::size_t v = 0; v < n; ++v) {
      const Vec3 x = model.vertex_m[v];
      near += norm(x - tool) - 0.010 < 0.012 && x.y > 0.023 ? 1 : 0;
      if (norm(x - tool) > 0.020 || x.y < 0.023) continue;
      Real u[3] = {};
      for (std::int32_t i = 0; i < p.count; ++i) {
        const Vec3 force = push_w(p.node[i]);
        const Real f[3] = {force.x, force.y, force.z};
        for (std::size_t a = 0; a < 3; ++a) {
          const double* row =
              model.compliance_f64.data() + (3 * static_cast<std::size_t>(p.node[i].vertex) + a) * 3 * n;
          for (std::size_t b = 0; b < 3; ++b) u[b] += f[a] * row[3 * v + b];
        }
      }
      const Vec3 normal = unit_or(x - tool, {});
      EXPECT_GT(norm(x - tool) - 0.010 + dot(normal, {u[0], u[1], u[2]}), -1e-6) << k << " vertex " << v;
    }
  }
  EXPECT_GT(near, kMaxContacts);
  EXPECT_GT(scene.output().contact_w.force_N.y, 1);
}

TEST(NodalTick, NotANumberFaultsAndRecovers) {
  NodalScene scene(block(), {sphere_piece(0.010)}, soft(0.5));
  scene.move(sphere_at(0), sphere_at(0.002), 10);
  scene.tick_at({kNan, 0, 0});  // refused by sense: the last pose is kept
  EXPECT_NE(scene.output().status & Status::kInputRejected, 0u);
  EXPECT_TRUE(is_finite(scene.output().contact_w.force_N));
  scene.state().nodal.contact[0].force_w.x = kNan;  // corrupted memory
  scene.tick_at(sphere_at(0.002));
  scene.tick_at(sphere_at(0.002));
  EXPECT_TRUE(is_finite(scene.output().device_w.force_N));
}

// Far below an encoder's step: two sweeps of a cold press say that they have not converged, pivoting never does.
TEST(NodalTick, SweepsThatDoNotConvergeAreReported) {
  for (const bool sweeps : {false, true}) {
    NodalScene scene(block(), {sphere_piece(0.010)}, soft());
    if (sweeps) {
      scene.params().nodal_solver = NodalSolver::kGaussSeidel;
      scene.params().nodal_sweeps = 2;
      scene.reopen();
    }
    scene.tick_at(sphere_at(3e-3));
    EXPECT_EQ((scene.output().status & Status::kNotConverged) != 0, sweeps);
    EXPECT_EQ(scene.output().residual_m > 1e-7, sweeps);
  }
}

// Back at full depth in one tick, friction leaves more than an encoder's step: that tick says so, a resting one does
// not.
TEST(NodalTick, FrictionThatDoesNotConvergeIsReported) {
  NodalScene scene(block(0.45, {4, 2, 4}), {box_piece({0.060, 0.010, 0.060})}, soft(0.5));
  scene.tick_at({0, kTop_m + 0.005 - 0.003, 0});
  EXPECT_GT(scene.output().residual_m, 30e-6);
  EXPECT_LT(problem_of(scene.scratch()).normal.residual_m, 1e-7);
  EXPECT_NE(scene.output().status & Status::kNotConverged, 0u);
  scene.settle_at({0, kTop_m + 0.005 - 0.003, 0}, 20);
  EXPECT_EQ(scene.output().status & Status::kNotConverged, 0u);
}

TEST(NodalTick, GaussSeidelApproachesTheExactSolver) {
  NodalScene exact(block(), {sphere_piece(0.010)}, soft());
  double before = 1;
  for (const int sweeps : {2, 5, 10, 20}) {
    NodalScene approximate(block(), {sphere_piece(0.010)}, soft());
    approximate.params().nodal_solver = NodalSolver::kGaussSeidel;
    approximate.params().nodal_sweeps = sweeps;
    approximate.reopen();
    exact.restart();
    double worst = 0;
    for (int k = 1; k <= 40; ++k) {
      const double a = exact.tick_at(sphere_at(1e-4 * k)).contact_w.force_N.y;
      const double b = approximate.tick_at(sphere_at(1e-4 * k)).contact_w.force_N.y;
      if (k > 10) worst = std::max(worst, std::abs(b - a) / a);
    }
    std::printf("Gauss-Seidel warm-started, %2d sweeps a tick: force at most %.1e off\n", sweeps, worst);
    EXPECT_LT(worst, before);
    before = worst;
  }
  EXPECT_LT(before, 1e-4);
}

}  // namespace
}  // namespace palpate::test
