// What a viewer offers to go over to, and a run that goes over because its viewer asked: baked beside the run, at zero
// force, two recordings that replay; refused in words, and then nothing changes.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "config/bake/compile.h"
#include "config/bake/image_writer.h"
#include "sim_host/run/settings_port.h"
#include "sim_host/view/live_run.h"
#include "tests/support/ball_run.h"
#include "tests/support/refusal.h"
#include "tests/support/replayed.h"

namespace palpate {
namespace {

using At = SceneChange::Stage;

class SceneChangeRun : public BallRun {
 protected:
  SceneChangeRun() {
    std::filesystem::create_directories(folder_ / "bodies");
    std::filesystem::create_directories(folder_ / "tools");
    std::filesystem::create_directories(folder_ / "empty");
    write("bodies/small.toml", "[body]\nradius_mm = 27\n");
    write("tools/blunt.toml", "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 12\n");
    write("tools/broken.toml", "[tool]\nsharpness = 3\n");
    options_.device = "auto";
    options_.time = RunTime::kVirtual;
    options_.record = file("run.plr");
    options_.duration_s = 60;
    options_.image = file("ball.pal");
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  std::string bake(const std::string& name, const std::vector<std::string>& settings) const {
    std::string error;
    EXPECT_TRUE(save_image(file(name), compile_scene(load_scene(options_.scene, {{}, settings})).bytes, error))
        << error;
    return file(name);
  }
  SceneChoice choice(const std::vector<std::string>& overlays) const { return {options_.scene, {overlays, {}}}; }
  // Until it is decided: a bake of the ball takes a fraction of a second.
  static SceneChange::News decided(StartedRun& run) {
    while (run.goes_on() && run.change().news().going_on()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return run.change().news();
  }
  static void await_ticks(const StartedRun& run, std::size_t ticks) {
    while (run.goes_on() && run.scene()->track.size() < ticks)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
};

TEST_F(SceneChangeRun, TheListHasScenesImagesAndOverlaysByFolder) {
  bake("ready.pal", {});
  write("elsewhere.txt", "no scene");
  const SceneOffer offer = offer_beside(options_.scene, {file("ready.pal"), "/far/other.toml"});
  EXPECT_EQ(offer.scene, (std::vector<std::string>{file("ball.toml"), file("ready.pal"), "/far/other.toml"}));
  ASSERT_EQ(offer.group.size(), 2u) << "a folder without overlays is none";
  EXPECT_EQ(offer.group[0].name, "bodies");
  EXPECT_EQ(offer.group[1].file, (std::vector<std::string>{file("tools/blunt.toml"), file("tools/broken.toml")}));
}

TEST_F(SceneChangeRun, WhatDoesNotGoTogetherSaysWhy) {
  EXPECT_EQ(why_not(choice({file("tools/blunt.toml"), file("bodies/small.toml")})), "");
  const std::string broken = why_not(choice({file("tools/broken.toml")}));
  EXPECT_NE(broken.find("broken.toml:2"), std::string::npos) << broken;
  EXPECT_NE(broken.find("sharpness"), std::string::npos) << broken;
  const std::string image = bake("ready.pal", {});
  EXPECT_EQ(why_not({image, {}}), "");
  EXPECT_NE(why_not({image, {{file("tools/blunt.toml")}, {}}}).find("takes no overlays"), std::string::npos);
  EXPECT_NE(why_not({file("none.pal"), {}}).find("none.pal"), std::string::npos);
}

TEST_F(SceneChangeRun, AChoiceIsNamedAsTheListHasIt) {
  const SceneChoice now = choice({});
  const SceneChoice chosen = choice_of(". tools/blunt bodies/small.toml body.triangles=300", now);
  EXPECT_EQ(chosen.scene, options_.scene);
  EXPECT_EQ(chosen.overlays.file, (std::vector<std::string>{file("tools/blunt.toml"), file("bodies/small.toml")}));
  EXPECT_EQ(chosen.overlays.setting, std::vector<std::string>{"body.triangles=300"});
  EXPECT_EQ(title_of(chosen), "ball + blunt + small, body.triangles=300");
  EXPECT_EQ(choice_of("ball", now).scene, options_.scene);
  const std::string refusal = test::refusal_by<std::runtime_error>([&] { choice_of(". tools/sharp", now); });
  EXPECT_NE(refusal.find("tools/sharp: no such file"), std::string::npos) << refusal;
}

TEST_F(SceneChangeRun, GoesOverToABakedOverlayAndBothRecordingsReplay) {
  StartedRun run(options_, true);
  await_ticks(run, 200);
  const std::shared_ptr<const LiveScene> first = run.scene();
  ASSERT_TRUE(run.change().ask(choice({file("bodies/small.toml")})));
  EXPECT_FALSE(run.change().ask(choice({}))) << "one change at a time";
  const SceneChange::News news = decided(run);
  ASSERT_EQ(news.stage, At::kThere) << news.words;
  const std::shared_ptr<const LiveScene> second = run.scene();
  ASSERT_NE(second, first);
  EXPECT_EQ(second->title, "ball + small");
  EXPECT_EQ(second->track.at(0).tick, 0u);
  // 3 mm less of a ball, and the first scene's last tick is at rest without force.
  EXPECT_NEAR(first->image.model().params.surface_size_m - second->image.model().params.surface_size_m, 0, 0.02);
  EXPECT_LT(second->image.model().params.surface_size_m, first->image.model().params.surface_size_m);
  const TrackTick last = first->track.at(first->track.size() - 1);
  EXPECT_EQ(last.mode, Mode::kIdle);
  EXPECT_EQ(norm(last.device_N), 0);
  await_ticks(run, 400);
  run.stop();
  const RunResult& result = run.result();
  EXPECT_EQ(result.summary.fault, 0u);
  ASSERT_EQ(result.later_recordings.size(), 1u);
  EXPECT_EQ(test::replayed(options_.record), "identical");
  EXPECT_EQ(test::replayed(result.later_recordings[0]), "identical");
  EXPECT_EQ(run.change().now().overlays.file, std::vector<std::string>{file("bodies/small.toml")});
}

TEST_F(SceneChangeRun, TakesAnImageAndComesBackToTheSceneItBeganWith) {
  const std::string image = bake("smaller.pal", {"body.radius_mm=29", "name=smaller"});
  StartedRun run(options_, true);
  ASSERT_TRUE(run.change().ask({image, {}}));
  ASSERT_EQ(decided(run).stage, At::kThere);
  EXPECT_EQ(run.scene()->title, "smaller");
  ASSERT_TRUE(run.change().ask(choice({})));
  ASSERT_EQ(decided(run).stage, At::kThere);
  EXPECT_EQ(run.scene()->title, "ball");
  run.stop();
  EXPECT_EQ(run.result().later_recordings.size(), 2u);
}

TEST_F(SceneChangeRun, WhatIsRefusedIsSaidAndTheRunGoesOnAsItWas) {
  const std::string slow = bake("slow.pal", {"device.period_ms=2"});
  write("garbage.pal", "no image");
  StartedRun run(options_, true);
  const std::shared_ptr<const LiveScene> first = run.scene();
  const auto refused = [&](const SceneChoice& asked, const std::string& words) {
    ASSERT_TRUE(run.change().ask(asked));
    const SceneChange::News news = decided(run);
    EXPECT_EQ(news.stage, At::kRefused);
    EXPECT_NE(news.words.find(words), std::string::npos) << news.words;
  };
  refused({slow, {}}, "period_s is 0.002");                   // by the controller
  refused(choice({file("tools/broken.toml")}), "sharpness");  // by the loader
  refused({file("garbage.pal"), {}}, "garbage.pal");          // by the viewer's own look at it
  refused({file("none.toml"), {}}, "none.toml");
  EXPECT_EQ(run.scene(), first);
  const std::size_t ticks = first->track.size();
  await_ticks(run, ticks + 100);
  EXPECT_TRUE(run.goes_on());
  run.stop();
  EXPECT_EQ(run.result().summary.fault, 0u);
  EXPECT_TRUE(run.result().later_recordings.empty());
}

// `palpate switch` speaks to the process that hosts the run, here the viewer's.
TEST_F(SceneChangeRun, ShowsASceneThatSomebodyElseAskedFor) {
  const std::string image = bake("smaller.pal", {"body.radius_mm=29", "name=smaller"});
  StartedRun run(options_, true);
  await_ticks(run, 100);
  ask_run(getpid(), kSceneWord + image);
  while (run.goes_on() && run.scene()->title == "ball") std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(run.scene()->title, "smaller");
  EXPECT_EQ(run.change().news().stage, At::kNone) << "nobody asked here";
  run.stop();
  EXPECT_EQ(run.result().summary.fault, 0u);
}

// Closing the window does not wait for a bake of minutes.
TEST_F(SceneChangeRun, ABakeThatIsUnderWayEndsWithTheRun) {
  StartedRun run(options_, true);
  ASSERT_TRUE(run.change().ask({PALPATE_SOURCE_DIR "/config/scenes/snap_in.toml", {}}));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  run.stop();
  EXPECT_EQ(run.result().summary.fault, 0u);
}

}  // namespace
}  // namespace palpate
