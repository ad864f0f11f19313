// What a viewer computes without a screen: camera, dragging, scales, the run's time, states found again by scrubbing.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "config/scene/child_program.h"

#include "rt_core/state.h"
#include "rt_core/tick.h"
#include "sim_host/view/frame_maker.h"
#include "sim_host/view/live_run.h"
#include "sim_host/view/orbit_camera.h"
#include "sim_host/view/player.h"
#include "sim_host/view/steering.h"
#include "sim_host/view/view_scales.h"
#include "tests/host/tiny_run.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

constexpr double kTiny = 1e-9;

OrbitCamera oblique() {
  Camera camera;
  camera.eye_m = {0.2, 0.3, 0.5};
  camera.target_m = {0.01, 0.02, 0.03};
  camera.up = {0, 1, 0};
  return {camera, {0, 0, 0}};
}

TEST(OrbitCamera, BeginsWhereTheOtherCameraIs) {
  Camera camera;
  camera.eye_m = {0.2, 0.3, 0.5};
  camera.target_m = {0.01, 0.02, 0.03};
  camera.up = {0, 1, 0};
  const Camera same = oblique().camera();
  EXPECT_NEAR(norm(same.eye_m - camera.eye_m), 0, kTiny);
  const Vec3 a = unit_or(camera.target_m - camera.eye_m, {}), b = unit_or(same.target_m - same.eye_m, {});
  EXPECT_NEAR(norm(a - b), 0, kTiny);
}

TEST(OrbitCamera, TurnsAboutItsTargetAndNeverOverTheTop) {
  OrbitCamera camera = oblique();
  const double distance = camera.distance_m();
  camera.orbit(123, -45, 800);
  EXPECT_NEAR(norm(camera.camera().eye_m - camera.target_m()), distance, kTiny);
  for (int i = 0; i < 50; ++i) camera.orbit(0, 300, 800);
  EXPECT_LT(camera.elevation_rad(), 1.5707963);
  EXPECT_TRUE(is_finite(camera.camera().eye_m));
}

TEST(OrbitCamera, WhatIsUnderTheMouseGoesWithIt) {
  OrbitCamera camera = oblique();
  const Vec3 before = Projection(camera.camera(), 1000, 800)(camera.target_m());
  const Vec3 mark = camera.target_m();
  camera.pan(37, -21, 800);
  const Vec3 after = Projection(camera.camera(), 1000, 800)(mark);
  EXPECT_NEAR(after.x - before.x, 37, 1e-6);
  EXPECT_NEAR(after.y - before.y, -21, 1e-6);
}

TEST(OrbitCamera, ZoomHasEnds) {
  OrbitCamera camera = oblique();
  const double start = camera.distance_m();
  camera.zoom(1000);
  EXPECT_GT(camera.distance_m(), 0);
  camera.zoom(-10000);
  EXPECT_LE(camera.distance_m(), 51 * start);
}

TEST(OrbitCamera, StandardViewsLookAlongTheAxes) {
  OrbitCamera camera = oblique();
  const auto forward = [&](StandardView view) {
    camera.look_from(view);
    return Projection(camera.camera(), 100, 100).forward();
  };
  EXPECT_NEAR(norm(forward(StandardView::kFront) - Vec3{0, 0, -1}), 0, 1e-9);
  EXPECT_NEAR(norm(forward(StandardView::kRight) - Vec3{-1, 0, 0}), 0, 1e-9);
  EXPECT_NEAR(norm(forward(StandardView::kLeft) - Vec3{1, 0, 0}), 0, 1e-9);
  EXPECT_NEAR(norm(forward(StandardView::kTop) - Vec3{0, -1, 0}), 0, 2e-3);  // short of straight down by 1 mrad
}

TEST(OrbitCamera, TheMatrixOfTheGraphicsCardSeesWhatTheProjectionSees) {
  const Camera camera = oblique().camera();
  const int width = 1000, height = 700;
  const Matrix4 m = view_projection(camera, width, height, 0.01, 5);
  const Projection projection(camera, width, height);
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{0.05, -0.02, 0.1}, Vec3{-0.1, 0.08, -0.2}}) {
    const double in[4] = {p.x, p.y, p.z, 1};
    double out[4] = {};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) out[i] += static_cast<double>(m[4 * j + i]) * in[j];
    const Vec3 pixel = projection(p);
    EXPECT_NEAR(0.5 * width * (1 + out[0] / out[3]), pixel.x, 1e-3);  // single precision of a thousand pixels
    EXPECT_NEAR(0.5 * height * (1 - out[1] / out[3]), pixel.y, 1e-3);
    EXPECT_NEAR(out[3], pixel.z, 1e-6);
    EXPECT_LT(std::abs(out[2]), out[3]);
  }
}

TEST(Dragging, TheGrabbedPlaceStaysUnderTheMouseAtItsDepth) {
  const Projection view(oblique().camera(), 1000, 700);
  const Vec3 grabbed{0.02, 0.01, -0.03};
  const Vec3 at = drag_point(view, grabbed, 321, 456);
  const Vec3 pixel = view(at);
  EXPECT_NEAR(pixel.x, 321, 1e-6);
  EXPECT_NEAR(pixel.y, 456, 1e-6);
  EXPECT_NEAR(pixel.z, view(grabbed).z, kTiny);
  EXPECT_NEAR(view(drag_point(view, grabbed, 321, 456, 0.02)).z, view(grabbed).z + 0.02, kTiny);
}

TEST(Dragging, ARayFindsTheNearSideOfASphere) {
  const RenderMesh ball = sphere_mesh({{0, 0, -1}, {}}, 0.2);
  EXPECT_NEAR(ray_hit(ball, {0.001, 0.002, 0}, {0, 0, -1}), 0.8, 1e-3);  // 64 sectors stand 0.12 % short
  EXPECT_LT(ray_hit(ball, {0.3, 0, 0}, {0, 0, -1}), 0);
  EXPECT_LT(ray_hit(ball, {0.001, 0.002, 0}, {0, 0, 1}), 0) << "behind the eye";
}

TEST(ViewScales, RoundLengthsAndTicks) {
  EXPECT_DOUBLE_EQ(round_below(7.3), 5);
  EXPECT_DOUBLE_EQ(round_below(0.02), 0.02);
  EXPECT_DOUBLE_EQ(round_below(0.0199), 0.01);
  EXPECT_EQ(round_below(-1), 0);
  EXPECT_EQ(round_below(std::nan("")), 0);
  constexpr SurfaceColour kMoved = SurfaceColour::kDisplacement, kPressed = SurfaceColour::kPressure;
  const ColourScale scale = colour_scale(kMoved, 2.3e-3, false);
  EXPECT_GE(scale.top, 2.3e-3);
  EXPECT_NEAR(scale.tick.back() * scale.unit, scale.top, 1e-12) << "the top of the colours has a tick";
  EXPECT_DOUBLE_EQ(colour_scale(kMoved, 2.3e-3, true).top, 2.3e-3);
  EXPECT_GT(colour_scale(kMoved, 0, false).top, 0);
  for (const double largest_Pa : {0.7, 340.0, 5.2e4, 3.1e6}) {
    const ColourScale pressure = colour_scale(kPressed, largest_Pa, false);
    EXPECT_GE(pressure.top, largest_Pa);
    EXPECT_LE(pressure.top, 3 * largest_Pa);
    EXPECT_NEAR(pressure.tick.back() * pressure.unit, pressure.top, 1e-9 * pressure.top);
  }
  EXPECT_STREQ(colour_scale(kPressed, 5.2e4, false).unit_name, "kPa");
}

TEST(ViewScales, ANewtonHasOneLength) {
  const ForceScale scale = force_scale(8, 0.1);
  EXPECT_NEAR(scale.m_per_N * 8, 0.045, kTiny);
  EXPECT_DOUBLE_EQ(scale.reference_N, 2);
  EXPECT_GT(force_scale(0, 0.1).m_per_N, 0) << "a run without force";
}

TEST(ViewScales, TheFirstLineSaysWhatItsNumberIs) {
  EXPECT_EQ(force_words({}), "no contact");
  EXPECT_EQ(force_words({{0, 4.618, 0}, 4.618, 0.001, 1}), "|F| = 4.62 N");
  EXPECT_EQ(force_words({{0, 1.66, 0}, 6.5, 0.001, 2}), "|sum of 2 forces| = 1.66 N, largest 6.50 N");
}

TEST(Player, PlaysToTheEndAndFromTheStartAgain) {
  Player player;
  player.seek(0.5, 0, 2);
  player.toggle(0, 2);
  player.speed = 0.5;
  player.advance(1, 0, 2);
  EXPECT_DOUBLE_EQ(player.time_s(), 1);
  player.advance(10, 0, 2);
  EXPECT_DOUBLE_EQ(player.time_s(), 2);
  EXPECT_FALSE(player.playing);
  player.toggle(0, 2);
  EXPECT_DOUBLE_EQ(player.time_s(), 0);
}

TEST(Player, ALiveRunIsFollowedUntilAHandScrubs) {
  Player player;
  player.live = true;
  player.advance(0.01, 0, 3);
  EXPECT_DOUBLE_EQ(player.time_s(), 3);
  player.seek(1, 0, 3);
  player.advance(0.01, 0, 4);
  EXPECT_DOUBLE_EQ(player.time_s(), 1);
}

// A run of the tiny scene: comes down on the tetrahedron's face, slides and leaves.
struct TinyRun {
  static constexpr std::uint64_t kTicks = 1200;

  TinyRun() : image(test::tiny_image()), track(1e-3) {
    EXPECT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
    initial = make_state(model);
    const StatePtr state = copy_of(*initial);
    test::play_tiny_run(model, *state, kTicks, [this](TickRecord& record) {
      record.timing.compute_ns = 1000 + static_cast<std::int32_t>(records.size());
      hash.push_back(record.state_hash);
      records.push_back(record);
      track.append(record);
    });
  }

  decltype(test::tiny_image()) image;
  Model model;
  StatePtr initial;
  RunTrack track;
  std::vector<std::uint64_t> hash;
  std::vector<TickRecord> records;
};

std::unique_ptr<TinyRun> tiny_run() { return std::make_unique<TinyRun>(); }

TEST(RunTrack, TimesAndTicksBelongTogether) {
  const auto run = tiny_run();
  EXPECT_EQ(run->track.size(), TinyRun::kTicks);
  EXPECT_EQ(run->track.index_at(0.25), 250u);
  EXPECT_EQ(run->track.index_at(-1), 0u);
  EXPECT_EQ(run->track.index_at(1e6), TinyRun::kTicks - 1);
  EXPECT_DOUBLE_EQ(run->track.time_s(700), 0.7);
}

TEST(RunTrack, TellsWhatHappened) {
  const auto run = tiny_run();
  std::size_t touches = 0, armed = 0;
  for (const TrackEvent& event : run->track.events()) {
    touches += event.kind == TrackEvent::Kind::kTouch;
    armed += event.kind == TrackEvent::Kind::kMode && event.text == "armed";
    if (event.kind == TrackEvent::Kind::kTouch) {
      EXPECT_GT(run->track.at(event.index).regions, 0);
      EXPECT_EQ(run->track.at(event.index - 1).regions, 0);
    }
  }
  EXPECT_EQ(touches, 1u);
  EXPECT_EQ(armed, 1u);
  EXPECT_EQ(run->track.lost(), 0u);
}

// A handle that pushes a spring of 200 N/m in by 5 mm and lets it out again: 2.5 mJ given, and all back.
TEST(RunTrack, TheWorkOfTheHandIsForceAlongItsWay) {
  RunTrack track(1e-3);
  TickRecord record{};
  record.output.mode = Mode::kForce;
  constexpr double kStiffness_N_per_m = 200;
  const auto go = [&](double depth_m) {
    record.sequence += 1;
    record.tick += 1;
    record.input.pose_w.position_m = {0, -depth_m, 0};
    record.output.device_w.force_N = {0, kStiffness_N_per_m * depth_m, 0};
    record.output.energy_J = 0.5 * kStiffness_N_per_m * depth_m * depth_m;
    track.append(record);
  };
  constexpr int kSteps = 1000;
  for (int i = 0; i <= kSteps; ++i) go(5e-3 * i / kSteps);
  const TrackTick in = track.at(kSteps);
  EXPECT_NEAR(in.given_J, in.energy_J, 1e-3 * in.energy_J);  // a held force lags by half a step
  for (int i = kSteps; i >= 0; --i) go(5e-3 * i / kSteps);
  EXPECT_NEAR(track.at(2 * kSteps + 1).given_J, 0, 2e-3 * in.energy_J);
  const TrackColumns columns = track.columns(0, 2.1, 21);
  EXPECT_NEAR(static_cast<double>(columns.given_mJ[10].high), 1e3 * in.given_J, 1e-3);
  EXPECT_NEAR(static_cast<double>(columns.stored_mJ[10].high), 1e3 * in.energy_J, 1e-3);
}

TEST(RunTrack, ForceThatFadesAndComesBackIsMarked) {
  RunTrack track(1e-3);
  TickRecord record{};
  const auto run = [&](Mode mode, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      record.sequence += 1;
      record.tick += 1;
      record.output.mode = mode;
      track.append(record);
    }
  };
  run(Mode::kIdle, 1);
  run(Mode::kForce, 10);
  run(Mode::kHold, 1);
  run(Mode::kPassive, 2);
  run(Mode::kForce, 30);  // back for a moment: one spell
  run(Mode::kRamp, 20);
  run(Mode::kForce, 600);
  record.input.commands = Command::kStop;  // an operator's stop is no warning
  run(Mode::kRamp, 5);
  std::vector<std::string> texts;
  for (const TrackEvent& event : track.events()) texts.push_back(event.text);
  EXPECT_EQ(texts, (std::vector<std::string>{"armed", "force fades", "force again"}));
  EXPECT_EQ(track.at(track.events().back().index).mode, Mode::kForce);
  EXPECT_EQ(track.at(track.events().back().index - 1).mode, Mode::kRamp);
}

TEST(RunTrack, AGapIsMarked) {
  const auto run = tiny_run();
  RunTrack track(1e-3);
  for (const std::size_t i : {0u, 1u, 5u}) track.append(run->records[i]);
  EXPECT_EQ(track.lost(), 3u);
  ASSERT_FALSE(track.events().empty());
  EXPECT_EQ(track.events().front().kind, TrackEvent::Kind::kGap);
  EXPECT_EQ(track.events().front().index, 2u);
}

TEST(RunTrack, NoPeakIsLostInAPlot) {
  const auto run = tiny_run();
  const TrackColumns columns = run->track.columns(0, 1.2, 37);
  float largest = 0;
  for (const auto& range : columns.contact_N) {
    EXPECT_LE(range.low, range.high);
    largest = std::max(largest, range.high);
  }
  double expected = 0;
  for (const TickRecord& record : run->records) expected = std::max(expected, norm(record.output.contact_w.force_N));
  EXPECT_GT(expected, 0);
  EXPECT_FLOAT_EQ(largest, static_cast<float>(expected));
  EXPECT_EQ(run->track.timing().compute.total, TinyRun::kTicks);
  EXPECT_EQ(run->track.timing().compute.max_ns, 1000 + static_cast<std::int64_t>(TinyRun::kTicks) - 1);
}

TEST(Scrubbing, EveryStateIsTheRunsOwnBitForBit) {
  const auto run = tiny_run();
  TrackStates states(run->model, run->track, copy_of(*run->initial));
  // Forward, back before and behind checkpoints, to the ends, and where it already is.
  for (const std::size_t index : {10u, 900u, 899u, 251u, 250u, 249u, 0u, 1199u, 1199u, 500u, 501u}) {
    const State& state = states.go_to(index, 10'000);
    ASSERT_EQ(states.reached(), index);
    EXPECT_EQ(hash_state(state), run->hash[index]) << index;
  }
  states.go_to(5000, 10'000);
  EXPECT_EQ(states.reached(), TinyRun::kTicks - 1) << "beyond the end is the end";
}

TEST(Scrubbing, ALongWayIsTakenInPieces) {
  const auto run = tiny_run();
  TrackStates states(run->model, run->track, copy_of(*run->initial));
  states.go_to(1000, 100);
  EXPECT_EQ(states.reached(), 99u);
  states.go_to(1000, 100);
  EXPECT_EQ(states.reached(), 199u);
}

TEST(FrameMaker, ShowsTheSurfaceOfPicturesAndExports) {
  const auto run = tiny_run();
  FrameMaker maker(run->model, run->track, copy_of(*run->initial), 4000);
  const auto frame = maker.wait_for(600);
  ASSERT_EQ(frame->index, 600u);
  EXPECT_EQ(hash_state(*frame->state), run->hash[600]);
  const DeformedSurface surface = refined_surface(run->model, *frame->state, 4000);
  ASSERT_EQ(frame->vertex.size(), maker.body().source.size());
  for (std::size_t i = 0; i < frame->vertex.size(); ++i) {
    const Vec3 expected = surface.position_m[static_cast<std::size_t>(maker.body().source[i].vertex)];
    ASSERT_FLOAT_EQ(frame->vertex[i].position[0], static_cast<float>(expected.x));
    ASSERT_FLOAT_EQ(frame->vertex[i].position[1], static_cast<float>(expected.y));
    ASSERT_FLOAT_EQ(frame->vertex[i].position[2], static_cast<float>(expected.z));
  }
  EXPECT_EQ(maker.body().triangle.size(), surface.triangle.size());
  // A tetrahedron's edges are creases: each side has normals of its own there.
  EXPECT_GT(maker.body().source.size(), surface.rest_m.size());
}

// Keys move one finger or all, and never beyond their ways; nobody commands joints before the first key.
// --- A run that somebody takes part in ----------------------------------------------------------------------------

RunOptions live_options(const std::filesystem::path& folder) {
  RunOptions options;
  options.scene = PALPATE_SOURCE_DIR "/config/scenes/ellipsoid_mallet.toml";
  options.image = (folder / "scene.pal").string();
  options.record.clear();
  options.quiet = true;
  options.duration_s = 60;
  options.time = RunTime::kVirtual;
  return options;
}

class LiveRunTest : public testing::Test {
 protected:
  LiveRunTest() : folder_("palpate-live-test") {
    options_ = live_options(std::filesystem::path(folder_.file("x")).parent_path());
    // The tests lie in build/X/tests, the programs in build/X/bin.
    options_.program_folder = sibling_program("../bin");
  }
  // Until `wanted` holds of the newest tick; a minute of the run's own time is more than enough.
  static bool reaches(const StartedRun& run, const std::function<bool(const TrackTick&)>& wanted) {
    while (run.goes_on()) {
      const std::size_t size = run.track().size();
      if (size > 0 && wanted(run.track().at(size - 1))) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  TemporaryFolder folder_;
  RunOptions options_;
};

TEST_F(LiveRunTest, TheHandRestsUntilTheMousePullsItAndTheBodyPushesBack) {
  StartedRun run(options_, true);
  ASSERT_TRUE(reaches(run, [](const TrackTick& t) { return t.mode == Mode::kForce; }));
  const Pose start = run.track().at(0).input.pose_w;
  const Pose later = run.track().at(run.track().size() - 1).input.pose_w;
  EXPECT_LT(norm(start.position_m - later.position_m), 1e-4);
  ASSERT_NE(run.steering(), nullptr);
  Pose pressed = start;
  pressed.position_m.y -= 0.03;
  run.steering()->pull(pressed);
  EXPECT_TRUE(reaches(run, [](const TrackTick& t) { return norm(t.device_N) > 1; }));
  // The lag between the hand and the handle is the force: the hand's spring is what it presses with.
  const TrackTick held = run.track().at(run.track().size() - 1);
  EXPECT_GT(held.input.pose_w.position_m.y, pressed.position_m.y);
  run.stop();
  EXPECT_EQ(run.result().controller_exit, 0);
  EXPECT_EQ(run.result().summary.fault, 0u);
  const TrackTick last = run.track().at(run.track().size() - 1);
  EXPECT_EQ(norm(last.device_N), 0) << "the device is left without force";
}

TEST_F(LiveRunTest, AWatcherSeesTheSameRunTickByTick) {
  options_.record = folder_.file("run.plr");
  options_.pace = true;
  StartedRun run(options_, false);
  std::unique_ptr<LiveRun> watcher;
  for (int i = 0; i < 1000 && !watcher; ++i) {
    try {
      watcher = attach_to(options_.record);
    } catch (const RecordingError&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // its header is not written yet
    }
  }
  ASSERT_TRUE(watcher);
  ASSERT_TRUE(reaches(run, [](const TrackTick& t) { return t.tick > 300; }));
  run.stop();
  run.result();
  while (watcher->goes_on()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_EQ(watcher->track().size(), run.track().size());
  for (std::size_t i = 0; i < run.track().size(); ++i)
    ASSERT_EQ(watcher->track().at(i).contact_N, run.track().at(i).contact_N);
}

TEST(Attach, SaysWhatToNameWhenThereIsNoController) {
  try {
    attach_to("999999999");
    FAIL() << "no such process";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("pgrep palpate-rt"), std::string::npos) << error.what();
  }
  EXPECT_THROW(attach_to("/nowhere/run.plr"), std::exception);
}

}  // namespace
}  // namespace palpate
