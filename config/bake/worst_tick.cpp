#include "config/bake/worst_tick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "config/bake/adversary.h"
#include "config/bake/image_rules.h"
#include "config/bake/tick_memory.h"
#include "config/scene/schema.h"
#include "rt_core/contact/contact.h"
#include "rt_core/contact/elastic/elastic_row.h"
#include "rt_core/stage_cost.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/tick.h"

namespace palpate {

namespace {

constexpr int kStarts = 48, kTicks = 40, kRefined = 6;
// Ticks in which the dearest of each stage is looked for. What a million find beyond the dearest whole tick is a few
// per cent, but a stage of them was 44 % dearer (solve of pinch_block, 2026-11-22): four tenths of each are stated
// beside, and a share of the whole.
constexpr int kStageTicks = 4000, kQueries = 2000;
constexpr std::uint64_t kStageSeed = 1;
constexpr double kReserve = 1.4, kReserveOfQuery = 1.25, kReserveOfAll = 0.12;
// An elastic body's dearest ticks are rarer than a bake can search for, as its surface is elsewhere every tick: ten
// million found a solve of half_shell 2.3 times, and rows of ring 1.6 times the dearest of the baker's
// (2026-11-22).
constexpr double kReserveOfElasticRows = 1.8, kReserveOfElasticSolve = 2.2;
// Points' rows end with the share of surface work: what varies is beside it.
constexpr double kReserveOfSharedRows = 1.2;
bool is_shared(const Model& model, Stage stage) {
  const Method method = method_of(model);
  return stage == Stage::kFindRows && method != Method::kElastic && method != Method::kNodes;
}
double reserve_of(const Model& model, Stage stage) {
  if (is_shared(model, stage)) return kReserveOfSharedRows;
  if (method_of(model) != Method::kElastic) return kReserve;
  return stage == Stage::kFindRows ? kReserveOfElasticRows : stage == Stage::kSolve ? kReserveOfElasticSolve : kReserve;
}
int effort(const Model& model) { return method_of(model) == Method::kElastic ? 4 : 1; }
// A quarter more than was found is allowed, but no more than 256 looks or four a point: what needs more waits some
// ticks, on the plane it had. Hands on scripted paths look at 126 at most with the 60 points of a grasp, a point near
// the surface at two. Thirty points as deep in a sphere of 30 mm as its law reaches want 4,986, a million instructions;
// in turns of twenty ticks at 0.1 m/s they stand up to 0.07 mm off it, 10 mm deep (2026-11-28).
constexpr double kSpare = 1.25;
constexpr std::int32_t kFullShare = 256, kLooksOfPoint = 4;
// Of an elastic body's tick: one tip that looks for it anew and others that know where it was. A tip that touches asks
// nothing; scripted paths look at 81 at most, in the first touch of ellipsoid_mallet (2026-11-23).
constexpr std::int32_t kElasticShare = 96;

class Search {
 public:
  explicit Search(const Model& model)
      : model_(model), memory_(model), state_(memory_.state), scratch_(memory_.scratch) {}

  // Of the surface, in one tick of a hand that creeps over it.
  std::int32_t surface_work() {
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

  // Of the surface, in one query from as far off it on either side as its axis, that starts anywhere and searches no
  // more than so many boxes. Few ticks meet the dearest.
  std::int32_t query(std::int32_t searched) {
    Adversary adversary(model_, kStageSeed);
    std::int32_t most = 0;
    for (int i = 0; i < effort(model_) * kQueries; ++i) {
      const auto vertex = static_cast<std::size_t>(adversary.uniform(0, static_cast<double>(model_.vertex_m.size())));
      const double deep = adversary.uniform(-1, 1) * 0.5 * model_.params.surface_size_m;
      const Vec3 p = model_.vertex_m[vertex] - deep * model_.vertex_normal[vertex];
      const auto warm = static_cast<std::int32_t>(adversary.uniform(0, static_cast<double>(model_.triangle.size())));
      most = std::max(most, closest_surface_point(model_, p, kHuge, warm, searched).looked);
    }
    return most;
  }

  // The dearest of each stage in a scene whose share of surface work is set.
  std::array<double, kStageCount> stages() {
    std::array<double, kStageCount> most{};
    Adversary adversary(model_, kStageSeed);
    reset(state_);
    Output output;
    for (int t = 0; t < effort(model_) * kStageTicks; ++t) {
      bool forgets = false;
      const Input input = adversary.next(output, forgets);
      if (forgets) reset(state_);
      tick(model_, state_, scratch_, input, output);
      for (std::size_t i = 0; i < most.size(); ++i)
        most[i] = std::max(most[i], counted_instructions(scratch_.work, static_cast<Stage>(i)));
    }
    return most;
  }

 private:
  // Most work in one tick but the first, in which nothing is known and nothing armed.
  std::int32_t play(std::uint64_t seed, int ticks) {
    Adversary adversary(model_, seed);
    reset(state_);
    Input input;
    input.drive = Drive::kTool;
    input.pose_w = adversary.start(std::min(model_.params.max_depth_m, 0.25 * model_.params.surface_size_m));
    for (float& closing : input.joints.closing) closing = static_cast<float>(adversary.uniform(0, 1));
    const double step_m = std::min(model_.params.speed_max_m_per_s * model_.params.period_s, 2e-3);
    const double turn_rad = std::min(model_.params.turn_max_rad_per_s * model_.params.period_s, 0.03);
    Vec3 drift = adversary.direction(), spin = adversary.direction();
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
      if (adversary.one_in(8)) drift = adversary.direction();
      if (adversary.one_in(8)) spin = adversary.direction();
      input.pose_w.position_m += (step_m * adversary.uniform(0, 1)) * drift;
      input.pose_w.orientation =
          normalised(small_rotation((turn_rad * adversary.uniform(0, 1)) * spin) * input.pose_w.orientation);
      for (float& closing : input.joints.closing)
        closing = std::clamp(closing + static_cast<float>(adversary.uniform(-0.02, 0.02)), 0.0f, 1.0f);
    }
    return most;
  }

  const Model& model_;
  TickMemory memory_;
  State& state_;
  Scratch& scratch_;
};

bool is_contact(Stage stage) { return stage == Stage::kFindRows || stage == Stage::kSolve || stage == Stage::kAccount; }

// Every point measured by the dearest query, twice on a body that moves; but none is begun when the tick's share is
// spent, and a tool point's search ends with it: what it looks at beyond are its walks.
double rows_cost(const Model& model, Search& search) {
  const std::int32_t points = scene_sizes(model).points, share = surface_work_share(model.params);
  Work work;
  work.points = points;
  work.queries = points;
  std::int32_t query = 0, beyond = 0;
  if (is_shared(model, Stage::kFindRows)) {
    query = search.query(std::min(share / 2, kMaxSearched));
    beyond = search.query(1);
  } else {
    work.queries *= 2;
    query = beyond = search.query(kMaxTipSearched);
  }
  work.looks = std::min(work.queries * query, share + beyond);
  return counted_instructions(work, Stage::kFindRows);
}

}  // namespace

void state_most_costs(ImageContents& image) {
  const Model model = model_of(image);
  image.stage_cost.clear();
  for (int i = 0; i < kStageCount; ++i) image.stage_cost.push_back({most_stage_cost(model, static_cast<Stage>(i))});
}

TickCost bake_costs(ImageContents& image) {
  TickCost cost;
  const Method method = method_of(image.params);
  if (method != Method::kNodes) cost.surface_work = Search(model_of(image)).surface_work();
  image.params.surface_work_max =
      method == Method::kElastic
          ? kElasticShare
          : std::clamp(static_cast<std::int32_t>(kSpare * cost.surface_work), kFullShare,
                       std::clamp(kLooksOfPoint * scene_sizes(model_of(image)).points, kFullShare, kMaxSurfaceWork));
  cost.surface_work_max = image.params.surface_work_max;
  const Model model = model_of(image);
  Search search(model);
  const std::array<double, kStageCount> found = search.stages();
  for (const double stage : found) cost.found += stage;
  const double rows = method_of(image.params) == Method::kNodes ? 0 : rows_cost(model, search);
  image.stage_cost.clear();
  for (int i = 0; i < kStageCount; ++i) {
    const auto stage = static_cast<Stage>(i);
    double stated = reserve_of(model, stage) * found[static_cast<std::size_t>(i)];
    if (stage == Stage::kFindRows) stated = std::max(stated, kReserveOfQuery * rows);
    if (is_contact(stage) && !is_shared(model, stage)) stated += kReserveOfAll * cost.found;
    image.stage_cost.push_back({std::clamp(stated, least_stage_cost(model, stage), most_stage_cost(model, stage))});
  }
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
