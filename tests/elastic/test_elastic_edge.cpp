// Where the smooth surface of a body that is carried along ends: a tip on a block's edge, and a soft ring that falls
// from under its rod and lies with an edge against it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "config/scene/scene.h"
#include "rt_core/contact/elastic/elastic_work.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

// Round a block's upper edge at one distance from it: the force points away from the edge and turns with the tip.
TEST(ElasticEdge, TheForceTurnsRoundABlocksEdge) {
  const BakedScene scene(parse_scene(
      elastic_scene("shape = \"box\"\nsize_mm = [40, 40, 40]\ntriangles = 1200\n", 8, 10, 8, 2), "test.toml"));
  Bench bench(scene.model());
  constexpr Vec3 kEdge{0.02, 0.04, 0.001};
  constexpr double kDepth_m = 4e-4, kFrom_rad = 0.3, kTo_rad = std::numbers::pi / 2 - 0.3;
  constexpr int kSteps = 400;
  const auto outward = [](double angle) { return Vec3{std::sin(angle), std::cos(angle), 0}; };
  const auto centre = [&](double angle, double depth_m) { return kEdge + (8e-3 - depth_m) * outward(angle); };
  move_to(bench, centre(kFrom_rad, -1e-3), centre(kFrom_rad, kDepth_m));
  Vec3 before;
  double turned = 0, jump = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = kFrom_rad + (kTo_rad - kFrom_rad) * i / kSteps;
    const Output& out = bench.tick_at({centre(angle, kDepth_m), {}}, {});
    const Vec3 force = out.contact_w.force_N;
    ASSERT_GT(norm(force), 0.05) << angle;
    EXPECT_TRUE((out.status & Status::kDepthBeyondRange) != 0) << angle;
    turned = std::max(turned, norm(cross(force, outward(angle))) / norm(force));
    if (i > 1) jump = std::max(jump, norm(force - before) / norm(force));
    before = force;
  }
  RecordProperty("largest_sine_to_the_radius", std::to_string(turned));
  RecordProperty("largest_step_of_the_force", std::to_string(jump));
  EXPECT_LT(turned, 0.02);  // 0.009 on 2026-11-23: the edge gives way sideways
  EXPECT_LT(jump, 0.01);    // a step is 0.0024 rad, and 0.25 % of the force for its turn alone
}

// Half way to where the hand's spring and the contact balance, by the tangent of the last tick. All the way, a tool
// that has no mass is thrown from one sense of sliding to the other for ever.
Vec3 held_at(const State& state, const Output& output, Vec3 hand, double stiffness_N_per_m) {
  const double(&k)[36] = state.contact_stiffness;
  const double h = stiffness_N_per_m;
  const Vec3 c0{k[0] + h, k[6], k[12]}, c1{k[1], k[7] + h, k[13]}, c2{k[2], k[8], k[14] + h};
  const Vec3 from = state.tool_w.position_m, b = h * (hand - from) + output.contact_w.force_N;
  const double determinant = dot(c0, cross(c1, c2));
  if (!(determinant > 1e-9 * h * h * h)) return from + (0.5 / h) * b;
  return from + (0.5 / determinant) * Vec3{dot(b, cross(c1, c2)), dot(c0, cross(b, c2)), dot(c0, cross(c1, b))};
}

// Scene `ring` with half the stiffness and half the friction, pressed on its crest and dragged off by a hand.
struct Drag {
  double friction = 1;  // of the scene's
  double hand_N_per_m = 800;
  Vec3 to{14e-3, 92e-3, 0};
};

class FallenRing : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    SceneOverlays overlays;
    overlays.setting = {"body.material.youngs_modulus_Pa=1.5e6", "friction.mu_ref=0.15"};
    scene_ = new BakedScene(load_scene(PALPATE_SOURCE_DIR "/config/scenes/ring.toml", overlays));
  }
  static void TearDownTestSuite() { delete scene_; }

  static Model model_of(const Drag& drag) {
    Model model = scene_->model();
    model.params.friction_k_N *= drag.friction;
    model.params.friction_mu_dynamic *= drag.friction;
    if (drag.friction == 0) model.params.friction_law = FrictionLaw::kNone;
    return model;
  }
  // Calls each(bench) after every tick: from above to the crest, 0.4 s there, 0.8 s aside and 1 s there.
  template <class Each>
  static void play(const Model& model, const Drag& drag, const Each& each) {
    constexpr Vec3 kAbove{0, 109e-3, 0}, kCrest{0, 94e-3, 0};
    Bench bench(model);
    const auto leg = [&](Vec3 from, Vec3 to, int ticks) {
      for (int i = 1; i <= ticks; ++i) {
        const Vec3 hand = from + (static_cast<double>(i) / ticks) * (to - from);
        const Vec3 tool = norm(bench.output.contact_w.force_N) > 0
                              ? held_at(*bench.state, bench.output, hand, drag.hand_N_per_m)
                              : hand;
        bench.tick_at({tool, {}}, {});
        each(bench);
      }
    };
    leg(kAbove, kCrest, 1000);
    leg(kCrest, kCrest, 400);
    leg(kCrest, drag.to, 800);
    leg(drag.to, drag.to, kHeld);
  }
  static constexpr int kHeld = 1000, kTicks = 3200 - kHeld;
  // A hand twice as stiff is a ring of a quarter of the shipped scene's stiffness: all but its forces is the same.
  static constexpr Drag kDrags[] = {{},
                                    {1, 800, {-14e-3, 92e-3, 0}},
                                    {1, 800, {0, 92e-3, 8e-3}},
                                    {1, 800, {10e-3, 92e-3, -6e-3}},
                                    {0.5, 800, {14e-3, 92e-3, 0}},
                                    {0, 800, {14e-3, 92e-3, 0}},
                                    {1, 1600, {14e-3, 92e-3, 0}},
                                    {1, 3200, {14e-3, 92e-3, 0}}};
  static BakedScene* scene_;
};
BakedScene* FallenRing::scene_ = nullptr;

// It swung by 0.3 mm and 1 N every other tick, unconverged in 380 of 1,000. A hand twice as stiff is a ring of a
// quarter of the shipped scene's stiffness: all but its forces is the same.
TEST_F(FallenRing, LiesStill) {
  for (const Drag& drag : kDrags) {
    int tick = 0, unconverged = 0, unflagged = 0;
    double most = 0, change = 0;
    Vec3 before;
    play(model_of(drag), drag, [&](const Bench& bench) {
      const Output& out = bench.output;
      most = std::max(most, norm(out.contact_w.force_N));
      const bool on_edge = out.regions > 0 && work_of(*bench.scratch).row_of(0).foot.state != FootState::kFound;
      unflagged += on_edge && (out.status & Status::kDepthBeyondRange) == 0 ? 1 : 0;
      if (++tick > kTicks + 100) {
        unconverged += (out.status & Status::kNotConverged) != 0 ? 1 : 0;
        change = std::max(change, norm(out.contact_w.force_N - before));
      }
      before = out.contact_w.force_N;
    });
    EXPECT_EQ(unconverged, 0);
    EXPECT_EQ(unflagged, 0);
    EXPECT_LT(change, 5e-3);  // of 1 to 2 N, while friction creeps
    // What the hand can press with at most, from 17 mm above where it pulls to.
    EXPECT_LT(most, drag.hand_N_per_m * 17e-3);
    EXPECT_GT(norm(before), 0.1);
  }
}

// Wherever the tool is stopped on its way, the body comes to rest: it swung by 0.3 N every other tick (2026-11-23).
TEST_F(FallenRing, ATickComesToRest) {
  for (const Drag& drag : kDrags) {
    const Model model = model_of(drag);
    Bench stopped(model);
    int tick = 0;
    double most = 0;
    play(model, drag, [&](const Bench& bench) {
      if (++tick % 67 != 0 || bench.output.regions == 0) return;
      copy_state(*bench.state, *stopped.state);
      const Pose pose = bench.state->tool_w;
      Vec3 before;
      for (int i = 0; i < 400; ++i) {
        const Vec3 force = stopped.tick_at(pose, {}).contact_w.force_N;
        if (i > 380) most = std::max(most, norm(force - before));
        before = force;
      }
    });
    RecordProperty("changes_by_N", std::to_string(most));
    // Without friction a ring may lie where two facets meet, and its force changes between theirs: 0.011 N of 1.4 N.
    // With friction one of the stops sits at the rim's kink, as a few in ten thousand do: 0.0002 N of 1.5 N
    // (2026-11-27).
    EXPECT_LT(most, drag.friction > 0 ? 5e-4 : 0.02);
  }
}

}  // namespace
}  // namespace palpate::test
