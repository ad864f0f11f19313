// Whole tips through the real tick(): sliding over the mesh, closed loops, and poses that no law likes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <random>

#include "rt_core/contact/tips/tip_law.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/press/press.h"
#include "sim_host/tick_memory.h"

namespace palpate {
namespace {

constexpr double kTwoPi = 6.28318530717958648;
constexpr double kRadius = 0.1;  // of the cylinder of tools_on_cylinder, which lies along x
constexpr double kTip = 0.02;    // its tool frame above the tip
const Vec3 kAxis{0, kRadius, 0};

std::string scene_path(const std::string& name) {
  return std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + name + ".toml";
}

SceneDesc cylinder_scene(const std::string& tool = "", std::vector<std::string> settings = {}) {
  SceneOverlays overlays;
  if (!tool.empty()) overlays.file.push_back(scene_path("tools/" + tool));
  overlays.setting = std::move(settings);
  return load_scene(scene_path("tools_on_cylinder"), overlays);
}

// Tool pressed radially into the cylinder: at `along` of its axis, `angle` around it from the top.
Pose pose_at(double along, double angle, double depth_m) {
  const Vec3 out{0, std::cos(angle), std::sin(angle)};
  const Vec3 tip = kAxis + Vec3{along, 0, 0} + (kRadius - depth_m) * out;
  return {tip + kTip * out, {std::cos(angle / 2), std::sin(angle / 2), 0, 0}};
}

struct SlideResult {
  double force_min_N = kHuge, force_max_N = 0, step_max_N = 0, aside_max_N = 0;
  int edges = 0;
  std::uint32_t status = 0;
};

SlideResult slide(const Model& model, const std::vector<TimedPose>& poses) {
  const auto state = make_state(model);
  SlideResult result;
  Vec3 last;
  std::int32_t triangle = -1;
  press(model, poses, {}, *state, nullptr, [&](const PressRow& row, const State& s, const Scratch&) {
    const Vec3 force = row.record.output.contact_w.force_N;
    const Pose tool = row.record.output.tool_w;
    const Vec3 out = rotate(tool.orientation, {0, 1, 0});
    result.force_min_N = std::min(result.force_min_N, norm(force));
    result.force_max_N = std::max(result.force_max_N, norm(force));
    result.aside_max_N = std::max(result.aside_max_N, norm(tangential_part(force, out)));
    // In the turning frame a slide at constant depth has a constant force.
    const Vec3 local = rotate(conjugate(tool.orientation), force);
    if (row.record.tick > 0) result.step_max_N = std::max(result.step_max_N, norm(local - last));
    last = local;
    if (triangle >= 0 && s.point[0].triangle != triangle) result.edges += 1;
    triangle = s.point[0].triangle;
    result.status |= row.record.output.status;
  });
  return result;
}

// A helix at constant depth, 3.7 m long, over more than a thousand edges: the force is as constant as the body is
// round, and no step of 60 um changes it by 0.1 %.
TEST(PressTools, SlidesOverAThousandEdgesWithoutAStep) {
  for (const char* tool : {"sphere_12_7", "flat_3_2", "cone_60"}) {
    const SceneModel scene(cylinder_scene(tool, {"friction.law=none"}));
    std::vector<TimedPose> poses;
    const int steps = 60000;
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      poses.push_back({t, pose_at(-0.09 + 0.18 * t, 6 * kTwoPi * t, 0.002)});
    }
    const SlideResult r = slide(scene.model(), poses);
    const double mean = 0.5 * (r.force_min_N + r.force_max_N);
    std::printf("  %-12s %.5f N, ripple %.4f %%, largest step %.5f %%, aside %.4f %%, %d edges\n", tool, mean,
                100 * (r.force_max_N - r.force_min_N) / mean, 100 * r.step_max_N / mean, 100 * r.aside_max_N / mean,
                r.edges);
    EXPECT_GT(r.edges, 1000);
    EXPECT_LT(r.step_max_N, 1e-3 * mean);
    EXPECT_LT(r.force_max_N - r.force_min_N, 5e-3 * mean);
    EXPECT_EQ(r.status & ~Status::kForceClamped, 0u);  // more than the simulated device can render
  }
}

struct LoopWork {
  double work_J = 0, energy_max_J = 0, closing_J = 0;
};
// Work of a loop by the trapezoidal rule, with the energy the tick itself reports as the measure.
LoopWork loop_work(const Model& model, const std::vector<TimedPose>& poses) {
  const auto state = make_state(model);
  LoopWork loop;
  Wrench last;
  Pose from;
  press(model, poses, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
    const Wrench now = row.record.output.contact_w;
    const Pose to = row.record.output.tool_w;
    if (row.record.tick > 0) {
      const Vec3 step = to.position_m - from.position_m;
      const Vec3 turn = small_rotation_vector(to.orientation * conjugate(from.orientation));
      loop.work_J -= 0.5 * (dot(now.force_N + last.force_N, step) + dot(now.torque_Nm + last.torque_Nm, turn));
    }
    loop.energy_max_J = std::max(loop.energy_max_J, row.record.output.energy_J);
    last = now;
    from = to;
  });
  return loop;
}

// Press, wander and turn, lift: a closed loop over the top of the cylinder.
std::vector<TimedPose> random_loop(std::mt19937_64& random, double depth_m, int steps) {
  std::uniform_real_distribution<double> symmetric(-1, 1);
  double a[8];
  for (double& x : a) x = symmetric(random);
  std::vector<TimedPose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps, w = kTwoPi * t;
    const double u = clamp_to(std::min(t, 1 - t) / 0.2, 0, 1), in = u * u * (3 - 2 * u);
    const double along = 0.04 * in * (a[0] * std::sin(w) + a[1] * std::sin(2 * w + 6 * a[2]));
    const double angle = 0.4 * in * (a[3] * std::sin(w + 6 * a[4]) + a[5] * std::sin(3 * w));
    Pose pose = pose_at(along, angle, -0.001 + in * (0.001 + depth_m * (0.7 + 0.3 * a[6] * std::sin(2 * w))));
    // Turned about the sphere's or the punch's centre, not about the tip.
    pose.orientation = small_rotation({0.1 * in * a[7] * std::sin(w), 0, 0}) * pose.orientation;
    poses.push_back({t, pose});
  }
  return poses;
}

void expect_conservative(const SceneModel& scene, const char* name, int loops, double share) {
  std::mt19937_64 random(11);
  double worst = 0;
  for (int loop = 0; loop < loops; ++loop) {
    const LoopWork work = loop_work(scene.model(), random_loop(random, 0.003, 8000));
    ASSERT_GT(work.energy_max_J, 1e-4);
    worst = std::max(worst, std::abs(work.work_J) / work.energy_max_J);
  }
  std::printf("  %-12s largest loop energy %.4f %% of the energy stored\n", name, 100 * worst);
  EXPECT_LT(worst, share) << name;
}

TEST(PressTools, FrictionlessLoopsAreConservative) {
  for (const char* tool : {"sphere_12_7", "flat_3_2", "cone_45"}) {
    const SceneModel scene(cylinder_scene(tool, {"friction.law=none", "contact.series.c0_mm_per_N=0.02"}));
    expect_conservative(scene, tool, 8, 1e-3);
  }
}

// The energy the tick reports, and `palpate press` writes, is the work done against the tips at every depth: that of
// the far field with c1, and of two tips that lean on one another in first and second order, included.
void expect_energy_is_work(const SceneModel& scene, const char* name) {
  std::vector<TimedPose> poses;
  constexpr int kSteps = 4000;
  // Down, and then along a slant, so that depths and places change together.
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    poses.push_back({t, pose_at(0.02 * t * t, 0.1 * t, 0.004 * t)});
  }
  const auto state = make_state(scene.model());
  double work = 0, worst = 0, energy = 0;
  Wrench last;
  Pose from;
  press(scene.model(), poses, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
    const Output& output = row.record.output;
    if (row.record.tick > 0) {
      const Vec3 step = output.tool_w.position_m - from.position_m;
      const Vec3 turn = small_rotation_vector(output.tool_w.orientation * conjugate(from.orientation));
      work -= 0.5 * (dot(output.contact_w.force_N + last.force_N, step) +
                     dot(output.contact_w.torque_Nm + last.torque_Nm, turn));
      worst = std::max(worst, std::abs(output.energy_J - work));
    }
    energy = output.energy_J;
    last = output.contact_w;
    from = output.tool_w;
  });
  ASSERT_GT(energy, 1e-4) << name;
  std::printf("  %-12s %.5f mJ stored, at most %.4f %% of it from the work done\n", name, 1e3 * energy,
              100 * worst / energy);
  EXPECT_LT(worst, 1e-4 * energy) << name;
}

TEST(PressTools, EnergyReportedIsTheWorkDone) {
  expect_energy_is_work(SceneModel(cylinder_scene("", {"friction.law=none", "contact.series.c0_mm_per_N=0.02",
                                                       "contact.series.c1_mm_per_N2=0.0004"})),
                        "c0, c1");
  const std::string path =
      (std::filesystem::temp_directory_path() / "palpate_EnergyReportedIsTheWorkDone.toml").string();
  std::ofstream(path) << "[[tool.piece]]\nshape = \"sphere\"\nposition_mm = [-15, -13.65, 0]\nradius_mm = 6.35\n"
                         "[[tool.piece]]\nshape = \"sphere\"\nposition_mm = [15, -13.65, 0]\nradius_mm = 6.35\n"
                         "[[contact.pair]]\npiece_a = 0\npiece_b = 1\nc_mm_per_N = 0.004\nh_ab_mm_per_N2 = 5e-5\n"
                         "h_ba_mm_per_N2 = -3e-5\n";
  SceneOverlays overlays;
  overlays.file.push_back(path);
  overlays.setting = {"friction.law=none", "contact.series.c0_mm_per_N=0.01", "contact.series.c1_mm_per_N2=0.0001"};
  const SceneModel two(load_scene(scene_path("tools_on_cylinder"), overlays));
  std::filesystem::remove(path);
  expect_energy_is_work(two, "two tips");
}

// Curves that differ over the surface by a factor of two and more.
class TableScene : public ::testing::Test {
 protected:
  SceneModel make(const std::string& csv, std::vector<std::string> settings = {}) {
    // Tests run side by side: a file of its own for each.
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    path_ = (std::filesystem::temp_directory_path() / ("palpate_" + name + ".csv")).string();
    std::ofstream(path_) << csv;
    settings.insert(settings.end(), {"contact.law=table", "contact.table.file=" + path_, "friction.law=none"});
    return SceneModel(cylinder_scene("", settings));
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_;
};

TEST_F(TableScene, LoopsOverSoftAndStiffPlacesAreConservative) {
  const SceneModel scene = make(
      "x_mm,y_mm,z_mm,depth_mm,force_N\n"
      "-40,200,0,0,0\n-40,200,0,1,2\n-40,200,0,2,5\n-40,200,0,6,20\n"
      "40,200,0,0,0\n40,200,0,1,4\n40,200,0,2,9\n40,200,0,6,50\n");
  expect_conservative(scene, "table", 8, 1e-3);
}

// Eq. 3 of Mahvash & Hayward 2002 as printed: F = sum n_i f_i U_i. Along the axis, where stiff and soft places differ,
// it has no force aside, which the interpolated energy has; around it, the normals' own. And loops over such places
// give or take energy.
TEST_F(TableScene, PrintedInterpolationIsTheSumOfTheCornersForces) {
  const std::string csv =
      "x_mm,y_mm,z_mm,depth_mm,force_N\n"
      "-40,200,0,0,0\n-40,200,0,1,2\n-40,200,0,2,5\n-40,200,0,6,20\n"
      "40,200,0,0,0\n40,200,0,1,4\n40,200,0,2,9\n40,200,0,6,50\n";
  const SceneModel printed = make(csv, {"contact.table.interpolation=paper"}), corrected = make(csv);
  const Model& model = printed.model();
  double aside_N = 0;
  for (int i = 0; i < 12; ++i) {
    const Pose pose = pose_at(-0.03 + 0.005 * i, 0.02 * i, 2e-3);
    const auto state = make_state(model);
    Vec3 expected, force;
    press(model, std::vector<TimedPose>{{0, pose}}, {}, *state, nullptr,
          [&](const PressRow& row, const State&, const Scratch& scratch) {
            const SurfaceFoot& foot = scratch.foot[0];
            const TableLaw law = table_law(model, 0, foot.triangle, foot.weight);
            const CornerForces corner = table_forces(law, scratch.contact[0].depth_m);
            for (int k = 0; k < 3; ++k)
              expected += foot.weight[k] * corner.force_N[k] *
                          model.corner_normal[static_cast<std::size_t>(foot.triangle)].normal[k];
            force = row.record.output.contact_w.force_N;
          });
    EXPECT_GT(norm(expected), 5);
    EXPECT_LT(norm(force - expected), 1e-9);
    const SlideResult other = slide(corrected.model(), {{0, pose}});
    aside_N = std::max(aside_N, other.aside_max_N - norm(tangential_part(force, rotate(pose.orientation, {0, 1, 0}))));
  }
  EXPECT_GT(aside_N, 0.02);  // on 6 N: what the printed sum leaves out
}

// Curves per tool, chosen in the tick: each tip of one tool has the presses made with it.
TEST_F(TableScene, EachTipHasItsOwnCurves) {
  const std::string soft = (std::filesystem::temp_directory_path() / "palpate_EachTip_soft.csv").string();
  const std::string tools = (std::filesystem::temp_directory_path() / "palpate_EachTip.toml").string();
  const std::string csv = (std::filesystem::temp_directory_path() / "palpate_EachTip_hard.csv").string();
  std::ofstream(soft) << "depth_mm,force_N\n0,0\n1.5,1\n6,10\n";
  std::ofstream(csv) << "depth_mm,force_N\n0,0\n1,4\n6,30\n";
  std::ofstream(tools) << "[[tool.piece]]\nshape = \"sphere\"\nposition_mm = [0, -13.65, 0]\nradius_mm = 6.35\n"
                          "[[tool.piece]]\nshape = \"sphere\"\nposition_mm = [0, 13.65, 0]\nradius_mm = 6.35\n"
                          "table_file = \"" +
                              soft + "\"\n";
  SceneOverlays overlays;
  overlays.file.push_back(tools);
  overlays.setting = {"contact.law=table", "contact.table.file=" + csv, "friction.law=none"};
  const SceneModel scene(load_scene(scene_path("tools_on_cylinder"), overlays));
  EXPECT_EQ(scene.model().vertex_response.size(), 2 * scene.model().vertex_m.size());
  Pose pose = pose_at(0, 0, 3e-3);
  EXPECT_NEAR(slide(scene.model(), {{0, pose}}).force_max_N, 13.34, 0.01);
  pose.orientation = Quat{0, 0, 0, 1};  // the other end down
  EXPECT_NEAR(slide(scene.model(), {{0, pose}}).force_max_N, 3.1, 0.4);
  for (const std::string& file : {soft, tools, csv}) std::filesystem::remove(file);
}

// Curves pressed by the baker, cubic in the root of the depth, softer towards the edge: loops up to 20 mm from the edge
// of a layer and back, at 3 mm of its 10.
TEST(PressTools, PressesOfTheBakerAreConservative) {
  SceneOverlays overlays;
  overlays.file.push_back(scene_path("responses/table_fem"));
  overlays.setting = {"friction.law=none", "contact.max_depth_mm=4", "body.triangles=1200"};
  const SceneModel scene(load_scene(scene_path("tools_on_layer"), overlays));
  ASSERT_EQ(scene.model().params.response_root, 1);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> symmetric(-1, 1);
  double worst = 0;
  for (int loop = 0; loop < 6; ++loop) {
    double a[6];
    for (double& x : a) x = symmetric(random);
    std::vector<TimedPose> poses;
    for (int i = 0; i <= 8000; ++i) {
      const double t = i / 8000.0, w = kTwoPi * t, u = clamp_to(std::min(t, 1 - t) / 0.2, 0, 1);
      const double in = u * u * (3 - 2 * u), depth = -0.001 + in * (0.0035 + 0.0005 * std::sin(2 * w + a[4]));
      const double x = 0.05 + in * (0.005 * a[0] * std::sin(w) - 0.03 * a[1] * a[1] * std::sin(0.5 * w));
      poses.push_back({t, {{x, 0.01 - depth + kTip, 0.03 * a[2] * std::sin(w + a[3]) * in}, {}}});
    }
    const LoopWork work = loop_work(scene.model(), poses);
    ASSERT_GT(work.energy_max_J, 1e-5);
    worst = std::max(worst, std::abs(work.work_J) / work.energy_max_J);
  }
  std::printf("  fem table    largest loop energy %.4f %% of the energy stored\n", 100 * worst);
  EXPECT_LT(worst, 1e-3);
}

// At the place of a press its samples come back, through baker, image and tick.
TEST_F(TableScene, MeasuredSamplesComeBackThroughTheTick) {
  const SceneModel scene = make("depth_mm,force_N\n0,0\n0.5,0.8\n1,2.5\n2,7\n3,7.5\n5,21\n");
  const double depth_mm[] = {0.5, 1, 2, 3, 5}, force_N[] = {0.8, 2.5, 7, 7.5, 21};
  for (int k = 0; k < 5; ++k) {
    const SlideResult r = slide(scene.model(), {{0, pose_at(0, 0, 1e-3 * depth_mm[k])}});
    // The depth through the smooth surface is within 0.1 um; the curve's slope is up to 7 N/mm.
    EXPECT_NEAR(r.force_max_N, force_N[k], 2e-3);
    EXPECT_LT(r.aside_max_N, 1e-3);
  }
}

TEST(PressTools, RendersThePublishedForces) {
  // Mahvash & Hayward 2002, section 4: their tools on a flat half space. The cylinder's radius of 100 mm softens the
  // spheres by sqrt(1/(1 + R/100)) in the geometric mean of the curvatures: 1.6 % and 0.4 %.
  const struct {
    const char* tool;
    double depth_mm, force_N, share;
  } rows[] = {{"flat_3_2", 0.5, 5.52, 1e-4},
              {"sphere_12_7", 1, 11.5916 * 0.9847, 2e-3},
              {"sphere_3_2", 1, 5.818591 * 0.9960, 2e-3},
              // Their largest force below which it fits, deeper than the radius.
              {"sphere_3_2", 1.62, 11.997 * 0.9960, 2e-3},
              {"sphere_3_2_true", 1, 5.818591 * 0.9960, 7e-2},  // a true sphere at 0.6 R is 6 % softer than Hertz
              {"cone_30", 1, 1.268056, 1e-3},
              {"cone_45", 1, 2.196338, 1e-3},
              {"cone_60", 1, 3.804169, 1e-3}};
  for (const auto& row : rows) {
    const SceneModel scene(cylinder_scene(row.tool, {"friction.law=none"}));
    const SlideResult r = slide(scene.model(), {{0, pose_at(0, 0, 1e-3 * row.depth_mm)}});
    EXPECT_NEAR(r.force_max_N, row.force_N, row.share * row.force_N) << row.tool;
  }
}

// Approach at one degree: the force grows from zero without a step, and friction does not make it jump.
TEST(PressTools, GrazesAtOneDegree) {
  for (const char* law : {"none", "presliding"}) {
    const SceneModel scene(cylinder_scene("flat_3_2", {std::string("friction.law=") + law}));
    std::vector<TimedPose> poses;
    for (int i = 0; i <= 20000; ++i) {
      const double along = -0.05 + 5e-6 * i;
      poses.push_back({1e-3 * i, pose_at(along, 0.01, -4e-4 + 5e-6 * i * std::tan(M_PI / 180))});
    }
    const SlideResult r = slide(scene.model(), poses);
    EXPECT_EQ(r.force_min_N, 0);
    EXPECT_GT(r.force_max_N, 5);
    // 5 um at one degree are 87 nm of depth: 1 mN of the punch's 11 N/mm; with friction 1.12 times it.
    EXPECT_LT(r.step_max_N, 2e-3);
  }
}

TEST(PressTools, DeepOverTheRimAndBackStaysFinite) {
  for (const char* tool : {"sphere_12_7", "flat_3_2", "cone_45"}) {
    const SceneModel scene(cylinder_scene(tool));
    std::vector<TimedPose> poses;
    // Over the sharp rim of the end face at 3 mm depth and back; down to the axis; far beyond; a jump of 20 mm; NaN.
    for (int i = 0; i <= 2000; ++i) poses.push_back({0, pose_at(0.1 + 2e-5 * i, 0, 0.003)});
    for (int i = 0; i <= 2000; ++i) poses.push_back({0, pose_at(0.14 - 2e-5 * i, 0, 0.003)});
    for (int i = 0; i <= 2000; ++i) poses.push_back({0, pose_at(0, 0.3, 1e-4 * i)});
    for (int i = 0; i <= 100; ++i) poses.push_back({0, pose_at(0.02 * (i % 2), 0, 0.002)});
    Pose broken = pose_at(0, 0, 0.002);
    broken.position_m.x = std::numeric_limits<double>::quiet_NaN();
    poses.push_back({0, broken});
    poses.push_back({0, pose_at(0, 0, 0.002)});
    const auto state = make_state(scene.model());
    std::uint32_t status = 0;
    double last = 0;
    press(scene.model(), poses, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
      const Wrench& w = row.record.output.contact_w;
      ASSERT_TRUE(is_finite(w.force_N) && is_finite(w.torque_Nm)) << tool << " " << row.record.tick;
      ASSERT_EQ(row.record.output.fault, 0u);
      status |= row.record.output.status;
      last = norm(w.force_N);
    });
    EXPECT_NE(status & Status::kFootHeld, 0u) << tool;
    EXPECT_NE(status & Status::kDepthBeyondRange, 0u) << tool;
    EXPECT_NE(status & Status::kInputRejected, 0u) << tool;
    EXPECT_GT(last, 0.1);
  }
}

// A layer stiffens the contact by the exact factor, through baker, image and tick: S(0.5) of a parabola is 2.11 at
// nu = 0.49; chi = sqrt(R d)/h = 0.5 at d = 3.937 mm.
TEST(PressTools, LayerIsExactThroughTheTick) {
  SceneOverlays overlays;
  overlays.setting = {"contact.tip.sphere=parabola", "friction.law=none"};
  const SceneModel scene(load_scene(scene_path("tools_on_layer"), overlays));
  const double depth = 0.25 * 1e-4 / 6.35e-3;
  const auto state = make_state(scene.model());
  double force = 0;
  press(scene.model(), std::vector<TimedPose>{{0, {{0, 0.01 - depth + kTip, 0}, {}}}}, {}, *state, nullptr,
        [&](const PressRow& row, const State&, const Scratch&) { force = norm(row.record.output.contact_w.force_N); });
  const double hertz = 4.0 / 3 * 2e4 / (1 - 0.49 * 0.49) * std::sqrt(6.35e-3) * std::pow(depth, 1.5);
  EXPECT_NEAR(force / hertz, 2.10988, 2e-5);
}

// Past the middle of a thin body its other face is nearer, and past the axis of a cylinder its other side: neither may
// pull the tip through. Pressed from 10 mm above to 9 of 10 mm, and to 1.6 of the radius.
TEST(PressTools, DeepPressesNeverPull) {
  for (const char* tool : {"cone_30", "cone_60", "flat_3_2", "sphere_3_2", "sphere_12_7"}) {
    SceneOverlays overlays;
    overlays.file.push_back(scene_path(std::string("tools/") + tool));
    overlays.setting = {"friction.law=none"};
    const SceneModel layer(load_scene(scene_path("tools_on_layer"), overlays));
    std::vector<TimedPose> down;
    for (int i = 0; i <= 2000; ++i) down.push_back({0, {{0.003, 0.02 - 9.5e-6 * i + kTip, 0.002}, {}}});
    const auto state = make_state(layer.model());
    double last = 0;
    press(layer.model(), down, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
      const Vec3 force = row.record.output.contact_w.force_N;
      EXPECT_GE(force.y, last) << tool << " " << row.record.tick;
      EXPECT_LT(norm(Vec3{force.x, 0, force.z}), 1e-9 + 1e-6 * force.y) << tool << " " << row.record.tick;
      last = force.y;
    });
    EXPECT_GT(last, 0.1) << tool;
    const SceneModel cylinder(cylinder_scene(tool, {"friction.law=none"}));
    std::vector<TimedPose> through;
    for (int i = 0; i <= 3200; ++i) through.push_back({0, pose_at(0, 0, 5e-5 * i)});
    press(cylinder.model(), through, {}, *state, nullptr, [&](const PressRow& row, const State&, const Scratch&) {
      ASSERT_GE(row.record.output.contact_w.force_N.y, 0) << tool << " " << row.record.tick;
    });
  }
}

TEST(PressTools, OverlaysAndSettingsNameThemselvesInErrors) {
  const auto message = [](const SceneOverlays& overlays) {
    try {
      load_scene(scene_path("tools_on_cylinder"), overlays);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message({{}, {"contact.max_depth=3"}}).find("--set:1: contact.max_depth: unknown key"), std::string::npos);
  EXPECT_NE(message({{}, {"contact.max_depth_mm"}}).find("write KEY=VALUE"), std::string::npos);
  EXPECT_NE(message({{"/nonexistent.toml"}, {}}).find("/nonexistent.toml: no such scene file"), std::string::npos);
  EXPECT_NE(message({{}, {"friction.law=return_map"}}).find("--set:1: friction.law"), std::string::npos);
  EXPECT_NE(message({{}, {"coupling.law=temporal_paper"}}).find("allowed none, coupled"), std::string::npos);
  EXPECT_EQ(message({{scene_path("materials/foam")}, {}}), "accepted");
}

}  // namespace
}  // namespace palpate
