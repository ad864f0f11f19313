// Two jaws on a rubber block: motion of the joints, their limits and stops, symmetry, and what hostile commands do.
#include <gtest/gtest.h>

#include <limits>

#include "config/scene/config_error.h"
#include "rt_core/image_check.h"
#include "rt_core/tool/articulate.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

const char* const kGripper = R"(
name = "gripper"
[body]
shape = "box"
size_mm = [40, 60, 40]
triangles = 1200
[body.material]
youngs_modulus_Pa = 3e6
poisson_ratio = 0.47
[contact]
law = "cubic"
reference_area_mm2 = 200
max_depth_mm = 6
cluster_distance_mm = 8
[contact.cubic]
k1_N_per_m = 200
k3_N_per_m3 = 5e7
[gripper]
closing_s = 0.2
stop_force_N = 3
[[tool.piece]]
shape = "capsule"
position_mm = [-23, 0, 0]
radius_mm = 7
length_mm = 34
points = 5
slide_mm = [-20, 0, 0]
[[tool.piece]]
shape = "capsule"
position_mm = [23, 0, 0]
radius_mm = 7
length_mm = 34
points = 5
slide_mm = [20, 0, 0]
[[tool.piece]]
shape = "box"
position_mm = [0, 60, 0]
size_mm = [80, 10, 20]
points = 0
)";

const Pose kAround{{0, 0.03, 0}, {}};

double place_x(const Model& model, const State& state, std::int32_t piece) {
  return transform(carrier_w(model, state, piece), model.piece[static_cast<std::size_t>(piece)].pose_tool.position_m).x;
}

TEST(Gripper, JawsStandOpenAndCloseAtABoundedSpeed) {
  BakedScene scene{std::string(kGripper)};
  scene.model().params.stop_force_N = 1e6;
  Bench bench(scene.model());
  const Pose away{{0, 0.5, 0}, {}};
  bench.tick_at(away, {});
  EXPECT_NEAR(place_x(bench.model, *bench.state, 0), -0.043, 1e-12);
  EXPECT_NEAR(place_x(bench.model, *bench.state, 1), 0.043, 1e-12);
  double before = 0.043;
  int ticks = 0;
  for (; ticks < 1000 && before > 0.023 + 1e-12; ++ticks) {
    bench.tick_at(away, closing_all(1));
    const double now = place_x(bench.model, *bench.state, 1);
    ASSERT_LE(before - now, 0.020 / 200 + 1e-12);  // 20 mm in 0.2 s at 1 kHz
    before = now;
  }
  EXPECT_EQ(ticks, 200);
  EXPECT_EQ(bench.output.status, 0u);
}

TEST(Gripper, OppositeJawsPushEquallyAndTheSumVanishes) {
  BakedScene scene{std::string(kGripper)};
  Bench bench(scene.model());
  double largest = 0;
  for (int i = 0; i < 500; ++i) {
    bench.tick_at(kAround, closing_all(1));
    Vec3 force[2];
    for (std::int32_t k = 0; k < 2; ++k) force[k] = bench.state->articulation.piece_force_tool_N[k];
    ASSERT_NEAR(force[0].x + force[1].x, 0, 1e-9) << "tick " << i;
    ASSERT_LE(norm(bench.output.contact_w.force_N), 1e-9);
    ASSERT_LE(norm(bench.output.contact_w.torque_Nm), 1e-9);
    largest = std::max(largest, force[1].x);
  }
  EXPECT_EQ(bench.output.regions, 2);
  EXPECT_GT(largest, 1.0);
}

// One step of a jaw is 0.1 mm; at 6 kN/m (the tangent at 3 N, all points) that is 0.6 N.
TEST(Gripper, AJawStopsAtTheStopForceAndHoldsWithoutChatter) {
  BakedScene scene{std::string(kGripper)};
  Bench bench(scene.model());
  for (int i = 0; i < 600; ++i) bench.tick_at(kAround, closing_all(1));
  EXPECT_TRUE((bench.output.status & Status::kJointStopped) != 0);
  const double held = bench.state->articulation.piece_force_tool_N[1].x;
  EXPECT_GT(held, 2.9);
  EXPECT_LT(held, 3.7);
  for (int i = 0; i < 200; ++i) {
    bench.tick_at(kAround, closing_all(1));
    ASSERT_NEAR(bench.state->articulation.piece_force_tool_N[1].x, held, 1e-6 * held);
  }
}

TEST(Gripper, OpeningReturnsTheBodyToRestExactly) {
  BakedScene scene{std::string(kGripper)};
  Bench bench(scene.model());
  for (int i = 0; i < 500; ++i) bench.tick_at(kAround, closing_all(1));
  ASSERT_EQ(bench.output.regions, 2);
  for (int i = 0; i < 500; ++i) bench.tick_at(kAround, closing_all(0));
  EXPECT_EQ(bench.output.contact_w, Wrench{});
  EXPECT_EQ(bench.output.energy_J, 0);
  EXPECT_EQ(bench.output.regions, 0);
  for (const Region& region : bench.state->region) EXPECT_EQ(region.id, 0u);
  EXPECT_EQ(place_x(bench.model, *bench.state, 1), 0.043);
}

TEST(Gripper, TheDeviceButtonClosesWhileItIsHeld) {
  BakedScene scene{std::string(kGripper)};
  Bench bench(scene.model());
  Input input;
  input.drive = Drive::kTool;
  input.pose_w = {{0, 0.5, 0}, {}};
  input.buttons = kButtonClose;
  for (int i = 0; i < 300; ++i) tick(bench.model, *bench.state, *bench.scratch, input, bench.output);
  EXPECT_NEAR(place_x(bench.model, *bench.state, 1), 0.023, 1e-12);
  input.buttons = 0;
  for (int i = 0; i < 300; ++i) tick(bench.model, *bench.state, *bench.scratch, input, bench.output);
  EXPECT_NEAR(place_x(bench.model, *bench.state, 1), 0.043, 1e-12);
}

TEST(Gripper, DirectCommandsAreCutToTheLimitsAndGarbageIsIgnored) {
  BakedScene scene{std::string(kGripper)};
  Bench bench(scene.model());
  const Pose away{{0, 0.5, 0}, {}};
  JointCommand joints;
  joints.direct = 0b01;  // the first jaw alone
  joints.target[0] = 0.005f;
  for (int i = 0; i < 300; ++i) bench.tick_at(away, joints);
  EXPECT_EQ(bench.output.status, 0u);
  EXPECT_NEAR(place_x(bench.model, *bench.state, 0), -0.028, 1e-9);
  EXPECT_NEAR(place_x(bench.model, *bench.state, 1), 0.043, 1e-12);
  for (const float target : {5.0f, -5.0f}) {
    joints.target[0] = target;
    for (int i = 0; i < 300; ++i) bench.tick_at(away, joints);
    EXPECT_TRUE((bench.output.status & Status::kJointLimited) != 0);
    EXPECT_NEAR(place_x(bench.model, *bench.state, 0), target > 0 ? -0.043 : -0.023, 1e-9);
  }
  for (const float garbage : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    JointCommand hostile = closing_all(0);
    hostile.direct = 0b01;
    hostile.target[0] = garbage;
    hostile.closing[0] = garbage;
    const double first = bench.state->articulation.joint[0], second = bench.state->articulation.joint[1];
    for (int i = 0; i < 50; ++i) bench.tick_at(away, hostile);
    EXPECT_TRUE((bench.output.status & Status::kJointLimited) != 0);
    EXPECT_EQ(bench.state->articulation.joint[0], first);
    EXPECT_EQ(bench.state->articulation.joint[1], second);
  }
}

TEST(Gripper, ARigidToolIgnoresJointCommands) {
  std::string text = kGripper;
  text.erase(text.find("[gripper]"), text.find("[[tool.piece]]") - text.find("[gripper]"));
  for (std::size_t at; (at = text.find("slide_mm")) != std::string::npos;) text.erase(at, text.find('\n', at) - at + 1);
  const BakedScene scene(text);
  Bench with(scene.model()), without(scene.model());
  for (int i = 0; i < 50; ++i) {
    const Pose pose{{1e-4 * i, 0.03, 0}, {}};
    with.tick_at(pose, closing_all(1));
    without.tick_at(pose, {});
    ASSERT_EQ(hash_state(*with.state), hash_state(*without.state));
  }
  EXPECT_GT(norm(with.output.contact_w.force_N), 0);
}

// The jaw drags the surface along: friction must follow the piece, not the tool, which stands still.
TEST(Gripper, FrictionFollowsTheJawThatMoves) {
  std::string text = kGripper;
  const std::string from = "slide_mm = [20, 0, 0]", to = "slide_mm = [0, 20, 0]";
  text.replace(text.find(from), from.size(), to);
  BakedScene scene(text);
  scene.model().params.stop_force_N = 1e6;
  Bench bench(scene.model());
  JointCommand joints = closing_all(0);
  for (int i = 0; i < 40; ++i)
    bench.tick_at({{-0.0035, 0.03, 0}, {}}, joints);  // the right jaw touches, raised by 20 mm
  ASSERT_EQ(bench.output.regions, 1);
  EXPECT_NEAR(bench.output.contact_w.force_N.y, 0, 1e-12);
  for (int i = 0; i < 100; ++i) bench.tick_at({{-0.0035, 0.03, 0}, {}}, closing_all(1));
  EXPECT_GT(bench.output.contact_w.force_N.y, 0.1);  // moving down, held back upwards
}

TEST(Gripper, SceneErrorsNameTheKey) {
  const auto error_of = [](std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    try {
      parse_scene(text, "test.toml");
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(error_of(kGripper, "[gripper]\nclosing_s = 0.2\nstop_force_N = 3\n", "").find("slide_mm"),
            std::string::npos);
  EXPECT_NE(error_of(kGripper, "closing_s = 0.2", "closing_s = 0").find("gripper.closing_s: 0 is out of range"),
            std::string::npos);
  EXPECT_NE(error_of(kGripper, "[gripper]", "[path]\npoint = [{ time_s = 0, closing = [0.1, 0.2] }]\n[gripper]")
                .find("path.point[0].closing"),
            std::string::npos);
  EXPECT_EQ(error_of(kGripper, "[gripper]", "[path]\npoint = [{ time_s = 0, closing = [1] }]\n[gripper]"), "");
}

TEST(GripperImage, EveryBrokenJointIsRefused) {
  const BakedScene scene{std::string(kGripper)};
  const Model& good = scene.model();
  ASSERT_EQ(good.joint.size(), 2u);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<const char*, std::function<void(Joint&)>>> damages = {
      {"joint.pose", [&](Joint& j) { j.before.position_m.x = nan; }},
      {"joint.pose", [](Joint& j) { j.after.orientation.w = 3; }},
      {"joint.limits", [](Joint& j) { j.lowest = 1; }},
      {"joint.open", [](Joint& j) { j.open = 5; }},
      {"joint.open", [&](Joint& j) { j.closed = nan; }},
      {"joint.speed_max", [](Joint& j) { j.speed_max = 0; }},
      {"joint.sign", [](Joint& j) { j.sign = 0.5; }},
      {"joint.parent", [](Joint& j) { j.parent = 1; }},
      {"joint.kind", [](Joint& j) { j.kind = static_cast<JointKind>(2); }},
      {"joint.finger", [](Joint& j) { j.finger = kMaxFingers; }},
  };
  for (const auto& [field, damage] : damages) {
    std::vector<Joint> joints(good.joint.begin(), good.joint.end());
    damage(joints[1]);
    Model model = good;
    model.joint = joints;
    const ImageResult result = check_arrays(model);
    EXPECT_NE(result.error, ImageError::kNone) << field;
    EXPECT_STREQ(result.field, field);
  }
  Model model = good;
  model.params.articulation = Articulation::kRigid;
  EXPECT_STREQ(check_arrays(model).field, "n_joint");
}

}  // namespace
}  // namespace palpate::test
