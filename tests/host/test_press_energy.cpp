// No closed path of tool motion returns energy with the default laws: 300 random loops through the real tick().
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "sim_host/bake/scene_model.h"
#include "sim_host/press/press.h"
#include "sim_host/tick_memory.h"

namespace palpate {
namespace {

constexpr double kTwoPi = 6.28318530717958648;

// A closed loop of the tool: a smooth approach from above, `turns` of a random Lissajous figure that presses, slides
// and turns the tool, and back to the start. Starts and ends out of contact.
std::vector<TimedPose> random_loop(std::mt19937_64& random, Vec3 above, double depth_m, int steps) {
  std::uniform_real_distribution<double> symmetric(-1, 1);
  std::uniform_int_distribution<int> harmonic(1, 3);
  const auto wave = [&](double amplitude) {
    const double a = amplitude * symmetric(random), phase = kTwoPi * symmetric(random);
    const int n = harmonic(random);
    return [a, phase, n](double t) { return a * std::sin(kTwoPi * n * t + phase); };
  };
  // From loops that slide most of the way to loops that stick: both must be seen.
  const double reach = std::pow(10.0, 0.75 * (symmetric(random) - 1));
  const auto x = wave(0.012 * reach), y = wave(0.35 * depth_m), z = wave(0.006 * reach);
  const auto rx = wave(0.12 * reach), ry = wave(0.2 * reach), rz = wave(0.12 * reach);
  const double down = depth_m * (0.7 + 0.3 * symmetric(random));
  std::vector<TimedPose> poses;
  for (int n = 0; n <= steps; ++n) {
    const double t = static_cast<double>(n) / steps;
    // In and out within the first and last fifth, by a smooth step that is zero at both ends of the loop.
    const double u = clamp_to(std::min(t, 1 - t) / 0.2, 0, 1);
    const double in = u * u * (3 - 2 * u);
    const Vec3 shift{in * x(t), 0.003 - in * (0.003 + down + y(t)), in * z(t)};
    poses.push_back({t, {above + shift, small_rotation({in * rx(t), in * ry(t), in * rz(t)})}});
  }
  return poses;
}

struct LoopWork {
  double user_J = 0;         // work done by whoever moves the tool, trapezoidal rule
  double uncertainty_J = 0;  // of that rule
  double moved_J = 0;        // sum of |work| per step
  double force_max_N = 0;
};

// Work of one loop. Per step the trapezoidal rule errs by less than half the change of the force's increment times the
// step: for a smooth force by 1/12 of it, for a jump (slip begins, a point touches) by up to a half.
LoopWork loop_work(const Model& model, const std::vector<TimedPose>& poses, State& state) {
  LoopWork work;
  Wrench last, last_change;
  Pose from;
  press(model, poses, {}, state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
    const Wrench now = row.record.output.contact_w;
    const Pose to = row.record.output.tool_w;
    if (row.record.tick > 0) {
      const Vec3 step = to.position_m - from.position_m;
      const Vec3 turn = small_rotation_vector(to.orientation * conjugate(from.orientation));
      const Wrench change{now.force_N - last.force_N, now.torque_Nm - last.torque_Nm};
      const double done = -0.5 * (dot(now.force_N + last.force_N, step) + dot(now.torque_Nm + last.torque_Nm, turn));
      work.user_J += done;
      work.moved_J += std::abs(done);
      work.uncertainty_J += 0.5 * (norm(change.force_N - last_change.force_N) * norm(step) +
                                   norm(change.torque_Nm - last_change.torque_Nm) * norm(turn));
      last_change = change;
    }
    work.force_max_N = std::max(work.force_max_N, norm(now.force_N));
    last = now;
    from = to;
  });
  return work;
}

struct Totals {
  double lowest_J = 1e9;  // smallest work of the user
  double spent_J = 0, moved_J = 0, uncertainty_J = 0;
  int loaded = 0;
};

Totals run_loops(const Model& model, Vec3 above, double depth_m, int loops, int steps, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto state = make_state(model);
  Totals totals;
  for (int loop = 0; loop < loops; ++loop) {
    const LoopWork work = loop_work(model, random_loop(random, above, depth_m, steps), *state);
    EXPECT_GE(work.user_J, -work.uncertainty_J - 1e-12) << "loop " << loop << " returned energy";
    totals.lowest_J = std::min(totals.lowest_J, work.user_J);
    totals.spent_J += work.user_J;
    totals.moved_J += work.moved_J;
    totals.uncertainty_J += work.uncertainty_J;
    totals.loaded += work.force_max_N > 0.2 ? 1 : 0;
  }
  return totals;
}

std::string scene_path(const std::string& name) {
  return std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml";
}

void report(const Totals& t) {
  std::printf("  spent %.3g J of %.3g J moved, lowest loop %.3g J, uncertainty %.3g J\n", t.spent_J, t.moved_J,
              t.lowest_J, t.uncertainty_J);
}

TEST(PressEnergy, MalletLoopsReturnNoEnergy) {
  const SceneModel scene(scene_path("ellipsoid_mallet_springs"));
  const Totals totals = run_loops(scene.model(), {0, 0.0725, 0}, 0.004, 200, 1500, 1);
  report(totals);
  EXPECT_GT(totals.loaded, 190);
  EXPECT_GT(totals.spent_J, 0);
  EXPECT_LT(totals.uncertainty_J, 0.05 * totals.moved_J);  // else the test could not see a leak
}

TEST(PressEnergy, CompassLoopsReturnNoEnergy) {
  // The heart and the compass with the corrected laws; the printed ones do return energy.
  SceneOverlays corrected;
  corrected.setting = {"contact.weight=winkler",
                       "contact.equivalent_point=pressure",
                       "contact.duffing.coefficient=static",
                       "friction.law=return_map",
                       "friction.k=1",
                       "friction.mu_dynamic=0.5",
                       "coupling.law=coupled",
                       "coupling.radius_mm=3",
                       "skeleton.law=stiffness"};
  const SceneModel scene(load_scene(scene_path("heart_compass_paper"), corrected));
  const Vec3 start = scene.scene()->path.point.front().position_m;
  // Lowered until the first tip just touches: the loops' depths start there.
  const auto state = make_state(scene.model());
  std::vector<TimedPose> fall;
  for (int n = 0; n < 4000; ++n) fall.push_back({0, {start - Vec3{0, 2e-5 * n, 0}, {}}});
  Vec3 touch = start;
  bool touched = false;
  press(scene.model(), fall, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
    if (!touched) touch = row.record.output.tool_w.position_m;
    touched = touched || row.record.output.contacts > 0;
  });
  ASSERT_TRUE(touched);
  const Totals totals = run_loops(scene.model(), touch, 0.003, 100, 1500, 2);
  report(totals);
  EXPECT_GT(totals.loaded, 90);
  EXPECT_LT(totals.uncertainty_J, 0.05 * totals.moved_J);
}

// Without friction a loop must give back exactly what it took: the contact is a potential.
TEST(PressEnergy, FrictionlessLoopsAreConservative) {
  SceneDesc scene = load_scene(scene_path("ellipsoid_mallet_springs"));
  scene.friction.law = FrictionLaw::kNone;
  const SceneModel model(scene);
  std::mt19937_64 random(3);
  const auto state = make_state(model.model());
  for (int loop = 0; loop < 20; ++loop) {
    const LoopWork work = loop_work(model.model(), random_loop(random, {0, 0.0725, 0}, 0.004, 4000), *state);
    EXPECT_LT(std::abs(work.user_J), work.uncertainty_J + 1e-12);
    EXPECT_LT(work.uncertainty_J, 0.05 * work.moved_J);
  }
}

}  // namespace
}  // namespace palpate
