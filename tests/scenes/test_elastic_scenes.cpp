// What the shipped scenes on an elastic body must keep beyond what every scene must: their memory, and the smoothness
// of the force when a tool slides over them without friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "rt_core/contact/contact.h"
#include "rt_core/tick.h"
#include "sim_host/press/press.h"
#include "sim_host/report/curve_error.h"
#include "sim_host/tick_memory.h"
#include "tests/scenes/scene_names.h"
#include "tests/support/image_file.h"

namespace palpate::test {
namespace {

std::string image_path(const std::string& scene) { return std::string(PALPATE_IMAGE_DIR) + "/" + scene + ".pal"; }

std::vector<std::string> elastic_scenes() {
  std::vector<std::string> names;
  for (const std::string& name : scene_names())
    if (method_of(ImageFile(image_path(name)).model()) == Method::kElastic) names.push_back(name);
  return names;
}

TEST(ElasticScenes, FitTheMemoryOfASmallComputer) {
  constexpr std::size_t kTickMemory = 256 * 1024, kImage = 16'000'000;
  const std::vector<std::string> names = elastic_scenes();
  ASSERT_GE(names.size(), 5u);
  for (const std::string& name : names) {
    const ImageFile image(image_path(name));
    const std::size_t memory = state_bytes(image.model()) + scratch_bytes(image.model()),
                      bytes = std::filesystem::file_size(image_path(name));
    std::printf("  %s: State and Scratch %zu, image %zu bytes\n", name.c_str(), memory, bytes);
    EXPECT_LE(memory, kTickMemory) << name;
    EXPECT_LE(bytes, kImage) << name;
  }
}

// A shipped body under its own tool, held at poses, without friction.
class Slide {
 public:
  explicit Slide(const std::string& scene) : image_(image_path(scene)), model_(image_.model()) {
    model_.params.friction_law = FrictionLaw::kNone;
  }
  // Highest place where the tool, straight above (x, z), touches.
  double touches_at_m(double x, double z) {
    reset(*state_);
    double y = 0.2;
    for (const double step : {1e-3, 2e-5}) {
      while (!(norm(at({x, y, z})) > 0) && y > -0.05) y -= step;
      y += step;
      reset(*state_);
    }
    return y;
  }
  Vec3 at(Vec3 position_m) {
    Input input;
    input.drive = Drive::kTool;
    input.pose_w.position_m = position_m;
    tick(model_, *state_, *scratch_, input, output_);
    return output_.contact_w.force_N;
  }
  void go(Vec3 from, Vec3 to, double step_m, std::vector<Vec3>* force = nullptr) {
    const int steps = static_cast<int>(norm(to - from) / step_m) + 1;
    for (int i = 1; i <= steps; ++i) {
      const Vec3 felt = at(from + (static_cast<double>(i) / steps) * (to - from));
      if (force != nullptr) force->push_back(felt);
    }
  }

 private:
  ImageFile image_;
  Model model_;
  StatePtr state_ = make_state(model_);
  ScratchPtr scratch_ = make_scratch(model_);
  Output output_;
};

struct Way {
  Vec3 from_m, to_m;
};

// Largest step beyond the trend of a slide, of the mean force on it.
double step_share(Slide& slide, const Way& way, double mm_per_s) {
  slide.go(way.from_m + Vec3{0, 5e-3, 0}, way.from_m, 2e-5);
  for (int i = 0; i < 20; ++i) slide.at(way.from_m);
  std::vector<Vec3> force;
  slide.go(way.from_m, way.to_m, 1e-6 * mm_per_s, &force);
  double mean = 0;
  for (const Vec3 f : force) EXPECT_GT(norm(f), 0);  // a touch that begins or ends is a bend of the force, not a step
  for (const Vec3 f : force) mean += norm(f) / static_cast<double>(force.size());
  EXPECT_GT(mean, 0.02);
  slide.go(way.to_m, way.to_m + Vec3{0, 8e-3, 0}, 2e-5);
  return largest_step_N(force) / mean;
}

struct SlideCase {
  friend void PrintTo(const SlideCase& slide, std::ostream* out) { *out << slide.scene; }
  const char* scene;
  Vec3 along_m[2];  // half a way; its middle is above the origin
  double deep_m[2];
};

// The ring sways aside from under a rod without friction at 2.7 N, which is 1.2 mm deep. The compass slides along its
// two lobes.
const SlideCase kSlides[] = {
    {"ellipsoid_mallet", {{8e-3, 0, 0}, {5e-3, 0, 4e-3}}, {1e-3, 2.5e-3}},
    {"half_shell", {{8e-3, 0, 0}, {5e-3, 0, 4e-3}}, {1e-3, 2.5e-3}},
    {"heart_compass", {{0, 0, 2.5e-3}, {1e-3, 0, 2e-3}}, {0.7e-3, 1.2e-3}},
    {"hollow_cylinder", {{8e-3, 0, 0}, {5e-3, 0, 4e-3}}, {1e-3, 2.5e-3}},
    {"ring", {{4e-3, 0, 0}, {3e-3, 0, 1.5e-3}}, {0.5e-3, 0.8e-3}},
};

class ElasticSlides : public testing::TestWithParam<SlideCase> {};

// 0.000 to 0.13 % on 2026-11-26.
TEST_P(ElasticSlides, ForceHasNoSteps) {
  const SlideCase& given = GetParam();
  Slide slide(given.scene);
  for (const double mm_per_s : {5.0, 25.0, 100.0}) {
    double worst = 0;
    for (const Vec3 along : given.along_m)
      for (const double deep : given.deep_m) {
        const Vec3 middle{0, slide.touches_at_m(0, 0) - deep, 0};
        worst = std::max(worst, step_share(slide, {middle - along, middle + along}, mm_per_s));
      }
    RecordProperty("at_" + std::to_string(static_cast<int>(mm_per_s)) + "_mm_per_s",
                   std::to_string(100 * worst) + " %");
    std::printf("  %s at %g mm/s: %.3f %%\n", given.scene, mm_per_s, 100 * worst);
    EXPECT_LT(worst, 0.005) << mm_per_s;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, ElasticSlides, testing::ValuesIn(kSlides),
                         [](const auto& slide) { return std::string(slide.param.scene); });

// Across the lobes a leg drops into the cleft between them, which its mesh hardly resolves: while the surface had kinks
// between facets, of 0.11 rad there, these slides stepped by 0.54 to 0.94 %, and 6 mm deep by 5.4 (2026-11-26). Off the
// middle plane: in it the heart sways aside from under legs without friction, from 39 N on.
TEST(ElasticScenes, TheCompassSlidesIntoTheCleft) {
  Slide slide("heart_compass");
  const double top = slide.touches_at_m(0, 0);
  for (const double mm_per_s : {5.0, 25.0, 100.0}) {
    double worst = 0;
    for (const double aside_m : {2e-3, 4e-3}) {
      const Vec3 from{0, top - 4e-3, aside_m};
      worst = std::max(worst, step_share(slide, {from, from + Vec3{12e-3, 0, 0}}, mm_per_s));
    }
    std::printf("  at %g mm/s: %.3f %%\n", mm_per_s, 100 * worst);
    EXPECT_LT(worst, 0.005) << mm_per_s;
  }
}

// Along the path that the scene scripts for a hand the force does not turn every other tick by more than a share of it.
void expect_still(const std::string& scene, double most_share) {
  const ImageFile image(image_path(scene));
  const auto path = load_scene(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + scene + ".toml").path;
  const StatePtr state = make_state(image.model());
  std::vector<Vec3> force;
  press(image.model(), scripted_poses(path, image.model().params.period_s), {path.hand_stiffness_N_per_m}, *state,
        nullptr, [&](const PressRow& row, const State&, const Scratch&) {
          force.push_back(row.record.output.contact_w.force_N);
        });
  double most_N = 0, largest_N = 0;
  for (std::size_t i = 3; i < force.size(); ++i) {
    const Vec3 turn[3] = {force[i - 2] - force[i - 3], force[i - 1] - force[i - 2], force[i] - force[i - 1]};
    largest_N = std::max(largest_N, norm(force[i]));
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      const double a = dot(turn[0], axis), b = dot(turn[1], axis), c = dot(turn[2], axis);
      if (a * b < 0 && b * c < 0) most_N = std::max(most_N, std::min({std::abs(a), std::abs(b), std::abs(c)}));
    }
  }
  std::printf("  %.2f mN of %.1f N\n", 1e3 * most_N, largest_N);
  EXPECT_GT(largest_N, 5);
  EXPECT_LT(most_N, most_share * largest_N);
}

// Where the rod crossed a vertex of the ring it turned by 31 mN, and on either side of it the place asked for a force
// or for none; and by 5.5 mN for a few ticks after it had stuck while the surface had kinks (2026-11-26).
TEST(ElasticScenes, TheRingsOwnPathDoesNotShake) { expect_still("ring", 1e-4); }

// The rod stands on the dome's pole, a vertex: it shook in 1,387 ticks by more than 2 mN while the surface had kinks
// (2026-11-26).
TEST(ElasticScenes, TheDomesOwnPathDoesNotShake) { expect_still("half_shell", 1e-4); }

// Jaws that come down about the block, close, are pressed `down_m` and drag it along their axes.
class JawsOnABlock {
 public:
  static constexpr int kPressed = 3500;
  explicit JawsOnABlock(double down_m) : down_m_(down_m) { reset(*state_); }

  // One tick of the handle `dragged_m` aside, from kPressed on.
  const Output& put(double dragged_m) {
    Input input;
    input.commands = tick_ == 1 ? Command::kArm : 0;
    input.pose_w.position_m = {0, 0.045 - 0.025 * share(0, 1000) - down_m_ * share(3000, kPressed), dragged_m};
    for (float& closing : input.joints.closing) closing = static_cast<float>(share(1200, 2200));
    tick(image_.model(), *state_, *scratch_, input, output_);
    for (int k = 3; k > 0; --k) last_[k] = last_[k - 1];
    last_[0] = output_.device_w.force_N;
    tick_ += 1;
    return output_;
  }
  void press() {
    while (tick_ < kPressed) put(0);
  }
  // The part of the last four ticks' force that turns every tick.
  Vec3 turns_N() const { return 0.125 * (last_[0] - 3.0 * last_[1] + 3.0 * last_[2] - last_[3]); }

 private:
  double share(int from, int until) const {
    return std::clamp(static_cast<double>(tick_ - from) / (until - from), 0.0, 1.0);
  }

  const ImageFile image_{image_path("pinch_block")};
  const StatePtr state_ = make_state(image_.model());
  const ScratchPtr scratch_ = make_scratch(image_.model());
  const double down_m_;
  Output output_;
  Vec3 last_[4];
  int tick_ = 0;
};

// The force across, which symmetry leaves at none, does not turn every other tick. Until every amplitude stopped by
// itself it did for as long as the drag went on, by 7 to 9 mN (2026-11-26).
TEST(ElasticScenes, ADragDoesNotShakeTheBlockAcross) {
  for (const double speed_m_per_tick : {2.5e-5, 5e-5}) {
    JawsOnABlock jaws(0.002);
    jaws.press();
    double most_N = 0, along_N = 0;
    const int dragged = static_cast<int>(0.012 / speed_m_per_tick);  // to where the jaws begin to slip
    for (int i = 0; i < dragged; ++i) {
      const Output& output = jaws.put(speed_m_per_tick * i);
      if (i > 0) most_N = std::max(most_N, std::abs(jaws.turns_N().x));
      along_N = std::max(along_N, std::abs(output.device_w.force_N.z));
    }
    std::printf("  %.0f mm/s: %.2e N across, %.2f N along\n", 1e6 * speed_m_per_tick, most_N, along_N);
    EXPECT_GT(along_N, 3);
    EXPECT_LT(most_N, 1e-3);  // of a hand that feels 1 % of some newtons
  }
}

// Nor does the force along it where a slow drag has turned back and both jaws stick: they went to and fro between two
// triangles, on which their place asked for a force along, and on which not (2026-11-26).
TEST(ElasticScenes, ADragThatTurnsBackDoesNotGoToAndFro) {
  constexpr double kWay_m = 0.012, kStep_m = 5e-6;
  constexpr double kFelt_N = 2e-3;  // what a still hand's tremor may add
  constexpr int kWay = 2400;
  for (const double down_m : {0.0, 0.002}) {
    JawsOnABlock jaws(down_m);
    jaws.press();
    int turning = 0;
    double along_N = 0, most_N = 0;
    for (int i = 0; i < 2 * kWay; ++i) {
      const Output& output = jaws.put(i < kWay ? i * kStep_m : kWay_m - (i - kWay) * kStep_m);
      const double turns_N = std::abs(jaws.turns_N().z);
      turning += turns_N > kFelt_N ? 1 : 0;
      most_N = std::max(most_N, turns_N);
      along_N = std::max(along_N, std::abs(output.device_w.force_N.z));
    }
    std::printf("  %.0f mm down: %d ticks that turn, by up to %.2e N of %.2f N\n", 1e3 * down_m, turning, most_N,
                along_N);
    EXPECT_GT(along_N, 3);
    EXPECT_LE(turning, 10);
  }
}

}  // namespace
}  // namespace palpate::test
