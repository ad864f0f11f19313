// Bodies and motions that break contact solvers: dragged at high stiffness, nearly incompressible, meshed by slivers,
// let go at full depth. In every tick: finite, nobody pulls, friction within its cone, exchanges within their cap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/nodal/nodal_scene.h"

namespace palpate::test {
namespace {

constexpr double kTop_m = 0.024;
constexpr double kRadius_m = 0.010;

PieceDesc plate() {
  PieceDesc piece;
  piece.shape = PieceShape::kBox;
  piece.size_m = {0.060, 0.010, 0.060};
  piece.margin_m = 1e-3;
  piece.points = 8;
  return piece;
}

Supports on_its_base(const TetMesh& mesh) {
  return hold_where(mesh, [](Vec3 x) { return x.y < 1e-9; });
}
TetMesh block_mesh(std::int32_t cells = 3) { return make_box_tets({0.024, kTop_m, 0.024}, {cells, cells, cells}); }
CondensedBody block(double young_Pa, double poisson, std::int32_t cells = 3) {
  const TetMesh mesh = block_mesh(cells);
  return condense(mesh, {young_Pa, poisson}, on_its_base(mesh), "block");
}
NodalSceneOptions options_of(double young_Pa, double poisson, double mu) {
  NodalSceneOptions options;
  options.young_Pa = young_Pa;
  options.poisson = poisson;
  options.mu = mu;
  return options;
}

// What every tick must keep.
class Watch {
 public:
  explicit Watch(double mu) : mu_(mu) {}
  void see(const NodalScene& scene) {
    const Output& o = scene.output();
    const ContactProblem& p = problem_of(scene.scratch());
    ASSERT_TRUE(is_finite(o.device_w.force_N) && is_finite(o.contact_w.force_N) && std::isfinite(o.residual_m));
    for (std::int32_t i = 0; i < p.count; ++i) {
      const Push& push = p.node[i].push;
      ASSERT_GE(push.normal_N, 0);
      ASSERT_LE(std::hypot(push.tangent_N[0], push.tangent_N[1]), mu_ * push.normal_N * (1 + 1e-9) + 1e-15);
      slipped += push.slips && push.normal_N > 0 ? 1 : 0;
      stuck += !push.slips && push.normal_N > 0 ? 1 : 0;
    }
    // Before and after friction.
    ASSERT_LE(p.normal.pivots, (mu_ > 0 ? 2 : 1) * kMaxPivots);
    pivots = std::max(pivots, p.normal.pivots);
    residual_m = std::max(residual_m, o.residual_m);
    force_N = std::max(force_N, norm(o.contact_w.force_N));
    status |= o.status;
    ASSERT_EQ(o.fault, 0u);
  }
  int pivots = 0, slipped = 0, stuck = 0;
  double residual_m = 0, force_N = 0;
  std::uint64_t status = 0;

 private:
  double mu_;
};

// 3 mm down and 1 mm sideways at 10 mm/s; the force at depth before sliding.
double press_and_slide(NodalScene& scene, Watch& watch, double rest_m) {
  for (int k = 1; k <= 300; ++k) {
    scene.tick_at({0, rest_m - 1e-5 * k, 0});
    watch.see(scene);
  }
  const double deep_N = scene.output().contact_w.force_N.y;
  for (int k = 1; k <= 100; ++k) {
    scene.tick_at({1e-5 * k, rest_m - 0.003, 0});
    watch.see(scene);
  }
  return deep_N;
}
void expect_calm(const Watch& watch, double mu) {
  EXPECT_EQ(watch.status & (Status::kNotConverged | Status::kContactsDropped), 0u);
  EXPECT_LT(watch.residual_m, mu > 0 ? 15e-6 : 1e-12);
}

// A handle below the surface drags the tool to and fro through the virtual coupling.
struct Drag {
  const char* name;
  double young_Pa, coupling_N_per_m, mu, depth_m, reach_m;
  int cycle_ticks;
  bool is_plate;
};

TEST(HardCases, StickSlipAtHighStiffness) {
  const Drag drags[] = {
      {"plastic, ball", 2e9, 1500, 0.8, 0.004, 0.006, 1000, false},
      {"plastic, ball, fast", 2e9, 1500, 0.8, 0.004, 0.006, 100, false},
      {"steel, ball, stiff coupling", 2e11, 1e5, 0.8, 0.0005, 0.002, 1000, false},
      {"steel, plate", 2e11, 1500, 0.8, 0.004, 0.006, 1000, true},
      {"steel, plate, stiff coupling", 2e11, 1e5, 0.8, 0.0005, 0.002, 200, true},
      {"rubber, ball, stiff coupling", 2e5, 1e5, 0.8, 0.003, 0.004, 1000, false},
  };
  for (const Drag& drag : drags) {
    SCOPED_TRACE(drag.name);
    NodalSceneOptions options = options_of(drag.young_Pa, 0.35, drag.mu);
    options.coupling_N_per_m = drag.coupling_N_per_m;
    options.coupling_Nm_per_rad = 3e-4 * drag.coupling_N_per_m;
    NodalScene scene(block(drag.young_Pa, 0.35), {drag.is_plate ? plate() : sphere_piece(kRadius_m)}, options);
    const double rest = kTop_m + (drag.is_plate ? 0.005 : kRadius_m);
    Watch watch(drag.mu);
    Vec3 at{0, rest + 0.001, 0}, last_N;
    double work_J = 0, least_J = 0, swing_N = 0;
    const auto go = [&](Vec3 to) {
      const Output& o = scene.tick_at(to, Drive::kDevice);
      watch.see(scene);
      work_J -= 0.5 * dot(o.device_w.force_N + last_N, to - at);  // what the hand puts in
      least_J = std::min(least_J, work_J);
      swing_N = std::max(swing_N, norm(o.device_w.force_N - last_N));
      last_N = o.device_w.force_N;
      at = to;
    };
    scene.tick_at(at, Drive::kDevice);
    const int down = 200;
    for (int k = 1; k <= down; ++k) go({0, rest + 0.001 - (0.001 + drag.depth_m) * k / down, 0});
    const double pressed_J = work_J;
    swing_N = 0;  // the first touch apart
    for (int k = 1; k <= 3 * drag.cycle_ticks; ++k)
      go({drag.reach_m * std::sin(2 * kPi * k / drag.cycle_ticks), rest - drag.depth_m, 0});
    const double dragged_J = work_J - pressed_J;
    for (int k = 1; k <= down; ++k) go({0, rest - drag.depth_m + (0.001 + drag.depth_m) * k / down, 0});
    std::printf("%-29s %6.2f N at most, %d active sets, residual %.1e m, dragging takes %.2f mJ\n", drag.name,
                watch.force_N, watch.pivots, watch.residual_m, 1e3 * dragged_J);
    // Normals tilt by up to 0.2 rad where a ball sinks between nodes 4 mm apart; a plate's do not.
    const double steepest = std::tan(std::atan(drag.mu) + (drag.is_plate ? 0 : 0.2));
    EXPECT_LT(watch.force_N, 1.01 * drag.coupling_N_per_m * drag.depth_m * std::hypot(1, steepest));
    // From tick to tick the force follows the handle: no chatter between stick and slip.
    const double handle_step_m = drag.reach_m * 2 * kPi / drag.cycle_ticks;
    EXPECT_LT(swing_N, 2 * drag.coupling_N_per_m * handle_step_m);
    EXPECT_GE(least_J, -1e-9);  // never more out than in
    EXPECT_GT(dragged_J, 0);
    EXPECT_EQ(watch.status & (Status::kNotConverged | Status::kContactsDropped), 0u);
    EXPECT_LT(watch.residual_m, 15e-6);  // what friction's cone cuts off; an encoder's step is 30 um
    EXPECT_GT(watch.slipped, 50);
    EXPECT_GT(watch.stuck, 50);
  }
}

// The second layer of nodes lies this share of an edge below the top: so flat are the elements that the tool touches.
TetMesh sliver_mesh(double share) {
  TetMesh mesh = block_mesh(4);
  keep_middle_nodes(mesh, std::vector<char>(mesh.tet.size(), 0));
  for (Vec3& p : mesh.node_m)
    if (std::abs(p.y - 0.75 * kTop_m) < 1e-6) p.y = kTop_m * (1 - 0.25 * share);
  add_middle_nodes(mesh);
  check_tet_mesh(mesh, "slivers");
  return mesh;
}

TEST(HardCases, Slivers) {
  double regular_N[2] = {};
  for (const double share : {1.0, 1e-2, 1e-4}) {
    const TetMesh mesh = sliver_mesh(share);
    const CondensedBody body = condense(mesh, {2e5, 0.45}, on_its_base(mesh), "slivers");
    for (const double mu : {0.0, 0.5}) {
      NodalScene scene(body, {sphere_piece(kRadius_m)}, options_of(2e5, 0.45, mu));
      Watch watch(mu);
      const double deep_N = press_and_slide(scene, watch, kTop_m + kRadius_m);
      std::printf("slivers of height %.0e of an edge, mu %.1f: %.3f N, %d active sets, residual %.1e m\n", share, mu,
                  deep_N, watch.pivots, watch.residual_m);
      expect_calm(watch, mu);
      double& regular = regular_N[mu > 0 ? 1 : 0];
      if (share == 1) regular = deep_N;
      // The layer below is 12 mm thick instead of 6: 4 and 7 % stiffer.
      EXPECT_NEAR(deep_N / regular, 1, 0.1);
    }
  }
}

// From 0.495 to 0.499999 the block must not lock: the force stays.
TEST(HardCases, NearlyIncompressible) {
  double softer_N[2][2] = {};
  for (const double nu : {0.495, 0.4999, 0.499999}) {
    const CondensedBody body = block(2e5, nu);
    for (const double mu : {0.0, 0.5})
      for (const bool flat : {false, true}) {
        NodalScene scene(body, {flat ? plate() : sphere_piece(kRadius_m)}, options_of(2e5, nu, mu));
        Watch watch(mu);
        const double deep_N = press_and_slide(scene, watch, kTop_m + (flat ? 0.005 : kRadius_m));
        std::printf("nu %g, mu %.1f, %s: %.3f N, %d active sets, residual %.1e m\n", nu, mu, flat ? "plate" : "ball",
                    deep_N, watch.pivots, watch.residual_m);
        expect_calm(watch, mu);
        double& softer = softer_N[mu > 0 ? 1 : 0][flat ? 1 : 0];
        if (nu == 0.495) softer = deep_N;
        EXPECT_NEAR(deep_N / softer, 1, 0.01);
      }
  }
}

// Gone in one tick from full depth: nothing stays behind. Back in one tick: without friction the same force, with
// friction a sound one (how the nodes came to stick differs).
struct Release {
  const char* name;
  bool is_clip, is_plate;
  double mu;
};
void release_and_return(const Release& c) {
  SCOPED_TRACE(c.name);
  const TetMesh clip = make_clip_mesh(1);
  NodalScene scene(c.is_clip ? condense(clip, {2e9, 0}, clip_supports(clip), "clip") : block(2e5, 0.45),
                   {c.is_clip    ? cylinder_piece(0.010, 0.040, 0.001)
                    : c.is_plate ? plate()
                                 : sphere_piece(kRadius_m)},
                   options_of(c.is_clip ? 2e9 : 2e5, c.is_clip ? 0 : 0.45, c.mu));
  const Vec3 from{0, c.is_clip ? 0.0142 : kTop_m + (c.is_plate ? 0.005 : kRadius_m), 0};
  const Vec3 to = from - Vec3{0, 0.003, 0};
  Watch watch(c.mu);
  for (int k = 1; k <= 300; ++k) {
    scene.tick_at(from + (k / 300.0) * (to - from));
    watch.see(scene);
  }
  const double deep_N = norm(scene.settle_at(to, 20).contact_w.force_N);
  scene.tick_at({0.5, 0.5, 0.5});
  watch.see(scene);
  EXPECT_EQ(scene.output().contact_w.force_N, (Vec3{}));
  EXPECT_EQ(scene.output().contacts, 0);
  EXPECT_EQ(scene.state().nodal.count, 0);
  Watch after(c.mu);
  for (int k = 0; k < 20; ++k) {
    scene.tick_at(to);
    after.see(scene);
    // Fifty nodes that come to stick 3 mm deep at once need three ticks.
    if (k >= 3) {
      EXPECT_LT(scene.output().residual_m, 30e-6);
    }
  }
  const double back_N = norm(scene.output().contact_w.force_N);
  std::printf("%-14s %.3f N, back %.3f N, %d active sets, residual %.1e m\n", c.name, deep_N, back_N, after.pivots,
              after.residual_m);
  EXPECT_GT(back_N, 1);
  EXPECT_LT(back_N, 1.1 * deep_N);
  if (c.mu == 0) {
    EXPECT_NEAR(back_N, deep_N, 1e-6 * deep_N);
    expect_calm(after, 0);
  }
  expect_calm(watch, c.mu);
  EXPECT_LT(scene.output().residual_m, 1e-6);
}

TEST(HardCases, ReleaseAtFullDepthAndReturn) {
  for (const Release& c : {Release{"ball", false, false, 0},
                           {"ball, mu 0.5", false, false, 0.5},
                           {"plate", false, true, 0},
                           {"plate, mu 0.5", false, true, 0.5},
                           {"clip", true, false, 0},
                           {"clip, mu 0.2", true, false, 0.2}})
    release_and_return(c);
}

}  // namespace
}  // namespace palpate::test
