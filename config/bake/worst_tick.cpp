#include "config/bake/worst_tick.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <random>

#include "config/bake/image_rules.h"
#include "config/scene/schema.h"
#include "rt_core/contact/contact.h"
#include "rt_core/stage_cost.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/tick.h"

namespace palpate {

namespace {

// A quarter more than was found is allowed: what a longer search would find beyond that waits a tick.
constexpr int kStarts = 48, kTicks = 40, kRefined = 6;
constexpr double kSpare = 1.25;
constexpr std::int32_t kLeastShare = 1024;  // two queries into the middle of a body

struct Block {
  explicit Block(std::size_t bytes) : at(::operator new (bytes, std::align_val_t{Arena::kAlignment})) {}
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  ~Block() { ::operator delete (at, std::align_val_t{Arena::kAlignment}); }
  void* at;
};

class Adversary {
 public:
  explicit Adversary(const Model& model)
      : model_(model),
        state_block_(state_bytes(model)),
        scratch_block_(scratch_bytes(model)),
        state_(create_state(model, state_block_.at)),
        scratch_(create_scratch(model, scratch_block_.at)) {}

  std::int32_t search() {
    struct Found {
      std::int32_t work;
      std::uint64_t seed;
    };
    std::vector<Found> found;
    for (std::uint64_t seed = 0; seed < kStarts; ++seed) found.push_back({play(seed, kTicks), seed});
    std::ranges::sort(
        found, [](const Found& a, const Found& b) { return a.work != b.work ? a.work > b.work : a.seed < b.seed; });
    std::int32_t worst = found.front().work;
    for (int i = 0; i < kRefined; ++i)
      worst = std::max(worst, play(found[static_cast<std::size_t>(i)].seed, 8 * kTicks));
    return worst;
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      if (squared_norm(v) > 1e-4 && squared_norm(v) <= 1) return (1 / norm(v)) * v;
    }
  }

  // A tool point on or below a vertex of the surface, the tool turned anyhow.
  Pose start() {
    const std::size_t v = random_() % model_.vertex_m.size(), i = random_() % model_.tool_point.size();
    const ToolPoint& point = model_.tool_point[i];
    const double deep = uniform(-1e-3, std::min(model_.params.max_depth_m, 0.25 * model_.params.surface_size_m));
    Pose pose{{}, small_rotation(uniform(0, 3) * direction())};
    if (!model_.grasp_w.empty()) pose.orientation = model_.grasp_w[0].orientation;
    const Vec3 target = model_.vertex_m[v] + (point.margin_m - deep) * model_.vertex_normal[v];
    pose.position_m = target - rotate(pose.orientation, point.position_tool_m);
    return pose;
  }

  // Most work in one tick but the first, in which nothing is known and nothing armed.
  std::int32_t play(std::uint64_t seed, int ticks) {
    random_.seed(seed);
    reset(state_);
    Input input;
    input.drive = Drive::kTool;
    input.pose_w = start();
    for (float& closing : input.joints.closing) closing = static_cast<float>(uniform(0, 1));
    const double step_m = std::min(model_.params.speed_max_m_per_s * model_.params.period_s, 2e-3);
    const double turn_rad = std::min(model_.params.turn_max_rad_per_s * model_.params.period_s, 0.03);
    Vec3 drift = direction(), spin = direction();
    Output output;
    std::int32_t most = 0;
    for (int t = 0; t < ticks; ++t) {
      tick(model_, state_, scratch_, input, output);
      if (t > 1) most = std::max(most, scratch_.surface_work);
      // As deep as the law reaches, and back: what the hand holds deeper may wait a tick.
      if (output.penetration_m > model_.params.max_depth_m) {
        drift = -drift;
        input.pose_w.position_m += (2 * step_m) * drift;
        continue;
      }
      if (random_() % 8 == 0) drift = direction();
      if (random_() % 8 == 0) spin = direction();
      input.pose_w.position_m += (step_m * uniform(0, 1)) * drift;
      input.pose_w.orientation =
          normalised(small_rotation((turn_rad * uniform(0, 1)) * spin) * input.pose_w.orientation);
      for (float& closing : input.joints.closing)
        closing = std::clamp(closing + static_cast<float>(uniform(-0.02, 0.02)), 0.0f, 1.0f);
    }
    return most;
  }

  const Model& model_;
  Block state_block_, scratch_block_;
  State& state_;
  Scratch& scratch_;
  std::mt19937_64 random_;
};

}  // namespace

void state_costs(std::int32_t worst_work, ImageContents& image) {
  image.params.surface_work_max =
      std::clamp(static_cast<std::int32_t>(kSpare * worst_work), kLeastShare, kMaxSurfaceWork);
  const Model model = model_of(image);
  image.stage_cost.clear();
  for (int i = 0; i < kStageCount; ++i) image.stage_cost.push_back({least_stage_cost(model, static_cast<Stage>(i))});
}

TickCost bake_costs(ImageContents& image) {
  TickCost cost;
  if (method_of(image.params) != Method::kNodes) cost.surface_work = Adversary(model_of(image)).search();
  state_costs(cost.surface_work, image);
  cost.surface_work_max = image.params.surface_work_max;
  cost.instructions = worst_tick_instructions(model_of(image));
  return cost;
}

std::string cost_refusal(const TickCost& cost, double period_s) {
  const double allowed = kBakeInstructionsPerSecond * period_s;
  if (cost.instructions <= allowed) return "";
  return "the worst tick may take " + std::to_string(std::llround(cost.instructions)) +
         " instructions and a period of " + number_text(1e3 * period_s) + " ms has room for " +
         std::to_string(std::llround(allowed)) +
         ": set fewer tool.piece.points or pieces, a coarser body, or a longer period";
}

}  // namespace palpate
