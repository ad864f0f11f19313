// The clip in a hand, the tube standing still or in another hand: the same motion of the two to each other is the same
// contact, and the hand at the body feels it the other way round.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/scene/scene.h"
#include "rt_core/tool/held_body.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

constexpr Vec3 kGrip_m{0.002, -0.012, 0.004};

SceneDesc clip_scene(HeldPart holds) {
  SceneDesc scene = load_scene(PALPATE_SOURCE_DIR "/config/scenes/snap_in_paper.toml");
  scene.device.holds = holds;
  if (holds != HeldPart::kTool) scene.device.grip_m = kGrip_m;
  scene.device.local_Hz = 5000;         // so that the stiffness felt is told too
  scene.device.smooth_encoder = false;  // a held body has no encoder of its own to smooth
  return scene;
}

// Hands at the devices, armed in the free.
struct Hands {
  explicit Hands(HeldPart holds) : scene(clip_scene(holds)) { reset(*state); }
  const Output& at(const Pose& tool, const Pose& second_w = {}) {
    Input input;
    input.pose_w = handle_for(scene.model(), tool, second_w);
    input.second_w = second_w;
    input.commands = state->tick == 1 ? Command::kArm : 0;
    tick(scene.model(), *state, *scratch, input, output);
    return output;
  }
  BakedScene scene;
  StatePtr state = make_state(scene.model());
  ScratchPtr scratch = make_scratch(scene.model());
  Output output;
};

// In from 14.5 mm to the seat and half out again, tilting and shifting on the way, at most 5 mm/s.
constexpr int kWayTicks = 6000;
Pose way(int k) {
  const double s = std::min(1.0, k / 3000.0) - std::max(0.0, (k - 3000) / 6000.0);
  const double aside = std::sin(3 * s);
  return {{3e-4 * aside, 0.0145 * (1 - s), 2e-4 * s}, normalised(small_rotation({0.04 * s, 0.05 * aside, -0.03 * s}))};
}
// What the second hand does meanwhile: a walk through the room.
Pose walk(int k) {
  const double t = k / 1000.0;
  return {{0.05 * std::sin(t), 0.03 * std::cos(2 * t), 0.04 * t},
          normalised(small_rotation({0.3 * std::sin(t), 0.1 * t, 0.2}))};
}

// The pose the tick sees, to rounding, and what it means: a point of the tool is where it is in the world, whether it
// goes there by its own handle or by that of the body. From here on both runs take the very same pose: the slips of a
// clip make 1e-2 N in 6,000 ticks of the rounding in a pose (2026-11-23).
void expect_seen(const Pose& meant, const Pose& seen, const Pose& body_w, const Pose& tool_w) {
  EXPECT_LT(norm(seen.position_m - meant.position_m), 1e-16);
  EXPECT_LT(norm(small_rotation_vector(seen.orientation * conjugate(meant.orientation))), 1e-15);
  const Vec3 point{0.01, -0.02, 0.03};
  const Vec3 by_body = transform(body_w, transform(seen, point) - kGrip_m);
  EXPECT_LT(norm(by_body - transform(tool_w, point)), 1e-16);
}

Vec3 times(Vec3 along, Vec3 across, Vec3 v) {
  return {along.x * v.x + across.z * v.y + across.y * v.z, across.z * v.x + along.y * v.y + across.x * v.z,
          across.y * v.x + across.x * v.y + along.z * v.z};
}

// How far one run is from another with the tool in the hand, which is `out` of the body's frame.
struct Apart {
  double force_N = 0, moment_Nm = 0, tool_m = 0, felt_N_per_m = 0, most_N = 0, most_Nm = 0;

  // `body_w`: the wrench on the hand at the body, about its handle at `handle_w_m`; `tool_w_m`: the tool's origin.
  void add(const Output& held, const Output& other, Quat out, Wrench body_w, Vec3 handle_w_m, Vec3 tool_w_m) {
    const Vec3 pull_N = rotate(out, held.device_w.force_N), turn_Nm = rotate(out, held.device_w.torque_Nm);
    keep(pull_N, norm(body_w.force_N + pull_N));
    // Moments of both wrenches about one point, the tool's origin.
    const Vec3 about = body_w.torque_Nm + cross(handle_w_m - tool_w_m, body_w.force_N);
    moment_Nm = std::max(moment_Nm, norm(about + turn_Nm));
    most_Nm = std::max(most_Nm, norm(body_w.torque_Nm));
    tool_m = std::max(tool_m, norm(held.tool_w.position_m - other.tool_w.position_m));
    const Vec3 v{0.3, -0.5, 0.8}, u = rotate(conjugate(out), v);
    const Vec3 felt = rotate(out, times(held.felt_along_N_per_m, held.felt_across_N_per_m, u));
    const Vec3 told = times(other.felt_along_N_per_m, other.felt_across_N_per_m, v);
    felt_N_per_m = std::max(felt_N_per_m, norm(told - felt));
  }
  void keep(Vec3 now_N, double wrong_N) {
    most_N = std::max(most_N, norm(now_N));
    force_N = std::max(force_N, wrong_N);
  }
  void expect_one_contact() const {
    std::printf("largest %.2f N, %.3f N m; apart by %.1e N, %.1e N m, %.1e m, %.1e N/m\n", most_N, most_Nm, force_N,
                moment_Nm, tool_m, felt_N_per_m);
    EXPECT_GT(most_N, 5) << "the snap must be on the way";
    EXPECT_GT(most_Nm, 0.05) << "and its moments";
    EXPECT_LT(force_N, 1e-12);  // rounding of 13 N
    EXPECT_LT(moment_Nm, 1e-13);
    EXPECT_EQ(tool_m, 0);
    EXPECT_LT(felt_N_per_m, 1e-10);
  }
};

TEST(HeldBody, FeelsTheOppositeOfWhatAHeldToolFeels) {
  Hands tool(HeldPart::kTool), body(HeldPart::kBody);
  Apart apart;
  double least_y_N = 0;
  for (int k = 0; k < kWayTicks; ++k) {
    const Pose hand_w = handle_seeing(kGrip_m, way(k)), seen = tool_seen(kGrip_m, hand_w, {});
    expect_seen(way(k), seen, hand_w, {});
    const Output &t = tool.at(seen), &b = body.at(way(k));
    ASSERT_EQ(t.fault | b.fault, 0u) << k;
    ASSERT_EQ(t.status, b.status) << k;
    EXPECT_NEAR(norm(b.handle_w_m - hand_w.position_m), 0, 1e-15);
    EXPECT_EQ(b.second_w, Wrench{});
    apart.add(t, b, hand_w.orientation, b.device_w, hand_w.position_m, {});
    least_y_N = std::min(least_y_N, b.device_w.force_N.y);
  }
  apart.expect_one_contact();
  EXPECT_LT(least_y_N, -5) << "the tube above pushes the clip's mouth down";
}

// Two hands, two devices: however both walk through the room, each feels what the other does, the other way round.
TEST(HeldBody, TwoHandsFeelOneContact) {
  Hands tool(HeldPart::kTool), both(HeldPart::kBoth);
  // Left to the baker, the coupling between two handles is half as stiff: see CompileImage::add_device().
  double& turn_Nm_per_rad = both.scene.model().params.coupling_Nm_per_rad;
  EXPECT_NEAR(turn_Nm_per_rad, 0.5 * tool.scene.model().params.coupling_Nm_per_rad, 1e-9 * turn_Nm_per_rad);
  turn_Nm_per_rad = tool.scene.model().params.coupling_Nm_per_rad;
  Apart apart;
  for (int k = 0; k < kWayTicks; ++k) {
    const Pose second_w = walk(k), tool_w = handle_for(both.scene.model(), way(k), second_w);
    const Pose seen = tool_seen(kGrip_m, second_w, tool_w);
    expect_seen(way(k), seen, second_w, tool_w);
    const Output &t = tool.at(seen), &b = both.at(way(k), second_w);
    ASSERT_EQ(t.fault | b.fault, 0u) << k;
    EXPECT_NEAR(norm(b.handle_w_m - tool_w.position_m), 0, 1e-15);
    EXPECT_NEAR(norm(b.second_handle_w_m - second_w.position_m), 0, 1e-15);
    EXPECT_NEAR(norm(b.device_w.force_N + b.second_w.force_N), 0, 1e-14);
    apart.add(t, b, second_w.orientation, b.second_w, second_w.position_m, tool_w.position_m);
    const Vec3 turn = b.device_w.torque_Nm - rotate(second_w.orientation, t.device_w.torque_Nm);
    EXPECT_NEAR(norm(turn), 0, 1e-9) << k;
  }
  apart.expect_one_contact();
}

// 6 N at an arm of 50 mm are 0.3 N m: more than a device of 0.05 has.
TEST(HeldBody, TorqueAboutTheHandStaysWithinTheDevice) {
  Hands body(HeldPart::kBody);
  ModelParams& p = body.scene.model().params;
  p.grip_x_m = 0.05;
  p.torque_max_Nm = 0.05;
  int clamped = 0;
  for (int k = 0; k < 2000; ++k) {
    const Output& b = body.at({{0, 0.0145 * (1 - k / 3000.0), 0}, {}});
    EXPECT_LE(norm(b.device_w.torque_Nm), 0.05 * (1 + 1e-12)) << k;
    const bool beyond = 0.05 * norm(b.device_w.force_N) > 0.06;
    if (beyond) {
      EXPECT_TRUE((b.status & Status::kTorqueClamped) != 0) << k;
    }
    clamped += beyond ? 1 : 0;
  }
  EXPECT_GT(clamped, 500);
  EXPECT_EQ(body.output.fault, 0u);
}

// A pose that is none, or a jump, of either hand is refused as a held tool's is, and the force goes on.
TEST(HeldBody, RefusesPosesThatAreNone) {
  const double nan = std::nan("");
  const Pose bad[] = {{{nan, 0, 0}, {}}, {{}, {0, 0, 0, 0}}, {{}, {nan, 0, 0, 0}}, {{0.5, 0, 0}, {}}};
  for (const HeldPart holds : {HeldPart::kBody, HeldPart::kBoth}) {
    Hands hands(holds);
    for (int k = 0; k < 1000; ++k) hands.at(way(k));
    for (const bool second : {false, true}) {
      if (second && holds == HeldPart::kBody) continue;
      for (const Pose& pose : bad) {
        const Wrench before = hands.output.device_w;
        Input input;
        input.pose_w = handle_for(hands.scene.model(), way(999));
        (second ? input.second_w : input.pose_w) = pose;
        tick(hands.scene.model(), *hands.state, *hands.scratch, input, hands.output);
        EXPECT_TRUE((hands.output.status & Status::kInputRejected) != 0);
        EXPECT_TRUE(is_finite(hands.output.second_w.torque_Nm) && is_finite(hands.output.device_w.torque_Nm));
        EXPECT_NEAR(norm(hands.output.device_w.force_N - before.force_N), 0, 0.2) << "one tick of a held sample";
        hands.at(way(999));
      }
    }
    EXPECT_EQ(hands.output.fault, 0u);
  }
}

}  // namespace
}  // namespace palpate::test
