// Presses through the whole tick(): action equals reaction, nothing pushes without contact, and the table says so.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "sim_host/bake/scene_model.h"
#include "sim_host/press/force_csv.h"
#include "sim_host/press/press.h"
#include "sim_host/tick_memory.h"

namespace palpate {
namespace {

std::string scene_path(const std::string& name) {
  return std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml";
}

// The forces of a press, added up on both sides by hand.
struct Balance {
  double force_N = 0, moment_Nm = 0;     // largest sum of tool side and body side
  double regions_N = 0, regions_Nm = 0;  // largest difference of the regions' sum and the whole
  double force_max_N = 0;
  int loaded = 0, regions_max = 0;
};

void check_row(const PressRow& row, const State& state, const Scratch& scratch, Balance& worst) {
  const Output& output = row.record.output;
  const Vec3 origin = output.tool_w.position_m;
  // Body side, about the world's origin: every contact pushes the body inward at its surface point; friction acts on it
  // at the centre of its region.
  Vec3 force, moment;
  for (std::int32_t i = 0; i < scratch.contact_count; ++i) {
    const Contact& contact = scratch.contact[i];
    const Vec3 f = -(contact.force_N * contact.normal_w);
    force += f;
    moment += cross(contact.position_w, f);
  }
  Wrench regions;
  int count = 0;
  for (const Region& region : state.region) {
    if (region.id == 0 || region.lost_ticks > 0) continue;
    force += -region.friction_force_w;
    moment += cross(region.centre_w, -region.friction_force_w);
    regions.force_N += region.wrench_w.force_N;
    regions.torque_Nm += region.wrench_w.torque_Nm;
    ++count;
  }
  const Wrench tool = output.contact_w;
  worst.force_N = std::max(worst.force_N, norm(force + tool.force_N));
  worst.moment_Nm = std::max(worst.moment_Nm, norm(moment + tool.torque_Nm + cross(origin, tool.force_N)));
  worst.regions_N = std::max(worst.regions_N, norm(regions.force_N - tool.force_N));
  worst.regions_Nm = std::max(worst.regions_Nm, norm(regions.torque_Nm - tool.torque_Nm));
  worst.force_max_N = std::max(worst.force_max_N, norm(tool.force_N));
  worst.loaded += norm(tool.force_N) > 0 ? 1 : 0;
  worst.regions_max = std::max(worst.regions_max, count);
  if (output.contacts == 0) {
    EXPECT_EQ(tool, Wrench{}) << "a force without contact at tick " << row.record.tick;
    EXPECT_EQ(output.energy_J, 0.0);
    EXPECT_EQ(output.regions, 0);
  }
  EXPECT_EQ(output.regions, count);
  EXPECT_EQ(row.record.region_count, count);
}

Balance balance_of(const std::string& name) {
  const SceneModel scene(scene_path(name));
  const double period_s = scene.model().params.period_s;
  const auto poses = scripted_poses(scene.scene()->path, period_s);
  Balance worst;
  const auto state = make_state(scene.model());
  const PressDrive drive{scene.scene()->path.hand_stiffness_N_per_m};
  press(scene.model(), poses, drive, *state, nullptr,
        [&](const PressRow& row, const State& now, const Scratch& scratch) { check_row(row, now, scratch, worst); });
  return worst;
}

// 1e-9 N: rounding of some 40 contacts of up to 10 N is 1e-13; anything structural is far larger.
constexpr double kForceTolerance_N = 1e-9, kMomentTolerance_Nm = 1e-10;

class PressScene : public ::testing::TestWithParam<const char*> {};
TEST_P(PressScene, ActionEqualsReactionAndMomentsBalance) {
  const Balance worst = balance_of(GetParam());
  EXPECT_GT(worst.loaded, 1000);
  EXPECT_GT(worst.force_max_N, 1.0);
  EXPECT_LT(worst.force_N, kForceTolerance_N);
  EXPECT_LT(worst.moment_Nm, kMomentTolerance_Nm);
  EXPECT_LT(worst.regions_N, kForceTolerance_N);
  EXPECT_LT(worst.regions_Nm, kMomentTolerance_Nm);
  RecordProperty("largest_force_imbalance_N", std::to_string(worst.force_N));
  if (std::string(GetParam()) == "heart_compass_paper") {
    EXPECT_EQ(worst.regions_max, 2);
  }
}
INSTANTIATE_TEST_SUITE_P(AllScenes, PressScene,
                         ::testing::Values("ellipsoid_mallet_springs", "ellipsoid_mallet_paper",
                                           "heart_compass_paper"));

// A scene without a motion gets one that presses its body's top, slides and lets go.
TEST(DefaultPath, PressesTheHighestPointAndLetsGo) {
  const SceneModel scene(parse_scene(
      "name = \"s\"\n[body]\nshape = \"ellipsoid\"\nposition_mm = [100, 20, 0]\n[[tool.piece]]\nshape = \"sphere\"\n"
      "radius_mm = 8\nposition_mm = [0, 15, 0]\n",
      "s.toml"));
  const auto poses = scripted_poses(scene.scene()->path, scene.model().params.period_s);
  const auto state = make_state(scene.model());
  double most_N = 0, first_x_m = 0, last_N = 1;
  press(scene.model(), poses, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
    const double force_N = norm(row.record.output.contact_w.force_N);
    if (most_N == 0 && force_N > 0) first_x_m = row.record.output.tool_w.position_m.x;
    most_N = std::max(most_N, force_N);
    last_N = force_N;
  });
  EXPECT_GT(most_N, 0.5);
  EXPECT_NEAR(first_x_m, 0.1, 1e-3);  // above the moved body's top
  EXPECT_EQ(last_N, 0);
}

TEST(DefaultPath, OnAFlatTopItPressesTheMiddle) {
  const SceneModel scene(parse_scene(
      "name = \"s\"\n[body]\nshape = \"box\"\nsize_mm = [80, 16, 60]\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = "
      "8\n",
      "s.toml"));
  for (const PathPoint& point : scene.scene()->path.point) {
    EXPECT_GT(point.position_m.x, -0.005);
    EXPECT_LT(point.position_m.x, 0.013);  // slid by a tenth of the length
    EXPECT_NEAR(point.position_m.z, 0, 0.005);
  }
}

// A sphere held against the side of a ball: force along the line of centres, of the size the law says.
SceneDesc ball_scene() {
  return parse_scene(R"(
name = "ball"
[body]
shape = "sphere"
radius_mm = 30
triangles = 20000
[contact]
law = "cubic"
weight = "paper"
[contact.cubic]
k1_N_per_m = 40
k3_N_per_m3 = 3e8
[coupling]
law = "none"
[friction]
law = "none"
[[tool.piece]]
shape = "sphere"
radius_mm = 10
points = 1
)",
                     "ball.toml");
}

TEST(Press, OnePointGivesTheLawsForce) {
  const SceneModel scene(ball_scene());
  for (const double depth_m : {0.5e-3, 1e-3, 2e-3, 3e-3, 5e-3}) {
    const std::vector<TimedPose> poses = {{0, {{0, 0.030 + 0.030 + 0.010 - depth_m, 0}, {}}}};
    const auto state = make_state(scene.model());
    press(scene.model(), poses, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
      const Output& output = row.record.output;
      // The mesh touches the sphere only at its vertices; its depth is measured, the law is exact.
      const double depth = output.penetration_m;
      EXPECT_NEAR(depth, depth_m, 3e-5);
      EXPECT_NEAR(output.contact_w.force_N.y, 40 * depth + 3e8 * depth * depth * depth, 1e-9);
      EXPECT_NEAR(output.energy_J, 20 * depth * depth + 0.75e8 * depth * depth * depth * depth, 1e-12);
      EXPECT_LT(norm(cross(output.contact_w.force_N, {0, 1, 0})), 0.02 * norm(output.contact_w.force_N));
      EXPECT_EQ(output.status & ~Status::kForceClamped & ~Status::kRamping, 0u);
    });
  }
}

TEST(Press, HandSpringSettlesInEquilibrium) {
  const SceneModel scene(ball_scene());
  std::vector<TimedPose> poses;
  for (int n = 0; n < 400; ++n) {
    poses.push_back({1e-3 * n, {{0.002, 0.075 - 0.01 * std::min(1.0, n / 300.0), 0}, {}}});
  }
  const auto state = make_state(scene.model());
  const double hand_N_per_m = 800;
  double left_N = 1e9, force_N = 0;
  press(scene.model(), poses, {hand_N_per_m}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
    const Output& output = row.record.output;
    const Vec3 pull = hand_N_per_m * (poses[row.record.tick].tool_w.position_m - output.tool_w.position_m);
    left_N = norm(pull + output.contact_w.force_N);
    force_N = norm(output.contact_w.force_N);
  });
  EXPECT_GT(force_N, 1.0);
  EXPECT_LT(left_N, 1e-9);  // Newton converges quadratically; the target has rested for 100 ticks
}

// A tube slides between the arms of a clip, with friction along its axis and across. Held by a hand's spring it must
// neither swing from one sense of sliding to the other nor be thrown into the clip.
TEST(Press, HandOnANodalBodyIsSteadyAndInEquilibrium) {
  const SceneModel scene(scene_path("snap_in_paper"));
  auto poses = scripted_poses(scene.scene()->path, scene.model().params.period_s);
  poses.resize(2300);  // pressing in, before the clip snaps
  const double hand_N_per_m = scene.scene()->path.hand_stiffness_N_per_m;
  const auto state = make_state(scene.model());
  Vec3 before;
  double largest_step_N = 0, left_N = 0, force_N = 0;
  std::uint32_t seen = 0;
  press(scene.model(), poses, {hand_N_per_m}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
    const Output& output = row.record.output;
    const Vec3 pull = hand_N_per_m * (poses[row.record.tick].tool_w.position_m - output.tool_w.position_m);
    left_N = std::max(left_N, norm(pull + output.contact_w.force_N));
    force_N = norm(output.contact_w.force_N);
    largest_step_N = std::max(largest_step_N, norm(output.contact_w.force_N - before));
    before = output.contact_w.force_N;
    seen |= output.status;
  });
  EXPECT_GT(force_N, 5.0);
  EXPECT_LT(left_N, 0.1);          // 1 % of the force: contact is linearised at the pose the tick predicts
  EXPECT_LT(largest_step_N, 0.3);  // 10 N grow within 0.7 s, facets included; swinging made steps of 5 N
  EXPECT_EQ(seen & (Status::kRamping | Status::kForceClamped | Status::kInputRejected), 0u);
}

// Fig. 10 of Luo & Xiao 2006: a mallet comes down on an ellipsoid, then slides along +x; the figure's force axis ends
// at 25 N. With the printed K = 10 it slides once 25 N pull at 3 N of press, and no tick changes the force by 1 % of
// that.
TEST(Press, TheMalletOfFigure10SlidesCompliantly) {
  const SceneModel scene(scene_path("ellipsoid_mallet_paper"));
  const auto poses = scripted_poses(scene.scene()->path, scene.model().params.period_s);
  const auto state = make_state(scene.model());
  int slipping = 0;
  double largest_N = 0, step_N = 0, first_m = kHuge, last_m = 0;
  Vec3 before;
  press(scene.model(), poses, {scene.scene()->path.hand_stiffness_N_per_m}, *state, nullptr,
        [&](const PressRow& row, const State& now, const Scratch&) {
          const Vec3 force = row.record.output.contact_w.force_N;
          largest_N = std::max(largest_N, norm(force));
          step_N = std::max(step_N, norm(force - before));
          before = force;
          const auto sliding = [](const Region& r) { return r.id != 0 && r.friction == FrictionMode::kSlip; };
          if (!std::any_of(now.region.begin(), now.region.end(), sliding) || row.time_s > 7.5) return;
          ++slipping;
          first_m = std::min(first_m, now.tool_w.position_m.x);
          last_m = std::max(last_m, now.tool_w.position_m.x);
        });
  EXPECT_NEAR(largest_N, 25, 0.5);
  EXPECT_LT(step_N, 0.15);  // 0.1497 N, at lift-off (2026-11-25)
  EXPECT_GT(slipping, 1000);
  EXPECT_GT(last_m - first_m, 0.003);  // along +x
}

TEST(Press, TheSamePosesGiveTheSameBits) {
  const SceneModel scene(scene_path("heart_compass_paper"));
  const auto poses = scripted_poses(scene.scene()->path, 5e-3);
  std::vector<std::uint64_t> first, second;
  const auto state = make_state(scene.model());
  for (std::vector<std::uint64_t>* hashes : {&first, &second}) {
    press(scene.model(), poses, {800}, *state, nullptr,
          [&](const PressRow& row, const State&, const Scratch&) { hashes->push_back(row.record.state_hash); });
  }
  EXPECT_EQ(first, second);
}

TEST(Press, CountsInstructionsOrSaysItCannot) {
  InstructionCounter counter;
  counter.start();
  volatile double sum = 0;
  for (int i = 0; i < 1000; ++i) sum = sum + i;
  const std::int64_t count = counter.stop();
  if (counter.available()) {
    EXPECT_GT(count, 1000);
  } else {
    EXPECT_EQ(count, -1);
  }
}

std::size_t cells(const std::string& line) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

TEST(ForceCsv, EveryRowHasTheHeadersColumns) {
  PressRow row;
  for (int regions = 0; regions <= 7; ++regions) {
    row.record.region_count = regions;
    for (int k = 0; k < regions; ++k) {
      RegionRecord& region = row.record.region[k];
      region.id = static_cast<std::uint32_t>(k + 1);
      region.point_count = 3;
      region.centre_w = {1e-3, 2e-3, 3e-3};
      region.force_w = {4, 5, 6};
      region.depth_equivalent_m = 7e-3;
      region.friction = 2;
    }
    EXPECT_EQ(cells(force_csv_row(row)), cells(force_csv_header())) << regions;
  }
  const std::string text = force_csv_row(row);
  EXPECT_NE(text.find(",4,1,2,3,4,5,6,7,slip,3,"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with(",5 1 2 3 4 5 6 7 slip 3;6 1 2 3 4 5 6 7 slip 3;7 1 2 3 4 5 6 7 slip 3")) << text;
}

TEST(ForceCsv, NamesStatusAndLeavesMissingCostEmpty) {
  PressRow row;
  row.record.output.status = Status::kDepthBeyondRange | Status::kForceClamped;
  row.record.output.fault = Fault::kNotFinite;
  row.compute_ns = 1234;
  EXPECT_NE(force_csv_row(row).find(",0x00000030,DepthBeyondRange ForceClamped,0x00000001,NotFinite,1234,,"),
            std::string::npos)
      << force_csv_row(row);
  row.instructions = 5678;
  EXPECT_NE(force_csv_row(row).find(",1234,5678,"), std::string::npos);
}

TEST(ForceCsv, WritesAFileAndReportsFailure) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("palpate_forces_" + std::to_string(getpid()) + ".csv");
  {
    ForceCsv csv(path.string());
    csv.add({});
    csv.finish();
  }
  std::ifstream file(path);
  std::string header, row, extra;
  EXPECT_TRUE(std::getline(file, header) && std::getline(file, row));
  EXPECT_FALSE(std::getline(file, extra));
  EXPECT_EQ(header, force_csv_header());
  std::filesystem::remove(path);
  EXPECT_THROW(ForceCsv("/nonexistent_folder/forces.csv"), std::runtime_error);
}

}  // namespace
}  // namespace palpate
