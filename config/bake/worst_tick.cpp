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
#include "rt_core/surface/overlap.h"
#include "rt_core/tick.h"

namespace palpate {

namespace {

// Ticks in which the dearest of each stage is looked for. What a million find beyond the dearest whole tick is a few
// per cent, but a stage of them was 44 % dearer (solve of pinch_block, 2026-11-22): four tenths of each are stated
// beside, and a share of the whole.
constexpr int kStageTicks = 4000, kQueries = 2000;
constexpr std::uint64_t kStageSeed = 1;
constexpr double kReserve = 1.4, kReserveOfQuery = 1.25, kReserveOfAll = 0.12;
// An elastic body's dearest solves are rarer than a bake can search for, as its surface is elsewhere every tick: ten
// million found one of half_shell 2.3 times (2026-11-22), of snap_in 2.0 times the dearest of the baker's (2026-11-28).
constexpr double kReserveOfElasticSolve = 2.2;
// How many regions the solve of points has varies most: climbing found 1.47 times the dearest of grasp_cylinder_5 that
// its bake did (2026-11-28).
constexpr double kReserveOfPointsSolve = 1.6;
bool is_of_points(const Model& model) {
  const Method method = method_of(model);
  return method != Method::kElastic && method != Method::kNodes;
}
bool is_shared(const Model& model, Stage stage) { return stage == Stage::kFindRows && is_of_points(model); }
double reserve_of(const Model& model, Stage stage) {
  if (stage != Stage::kSolve) return kReserve;
  if (method_of(model) == Method::kElastic) return kReserveOfElasticSolve;
  return is_of_points(model) ? kReserveOfPointsSolve : kReserve;
}
int effort(const Model& model) { return method_of(model) == Method::kElastic ? 4 : 1; }
// What a tick looks at; points it does not suffice for wait some ticks, on the plane they had. Hands on scripted paths
// look at 126 at most with the 60 points of a grasp, a point near the surface at two. Thirty points as deep in a sphere
// of 30 mm as its law reaches want 4,986, a million instructions (2026-11-28).
constexpr std::int32_t kShare = 128;
// Of an elastic body's tick: one tip that looks for it anew and others that know where it was. A tip that touches asks
// nothing; scripted paths look at 65 at most, in the first touch of ellipsoid_mallet (2026-11-28).
constexpr std::int32_t kElasticShare = 72;

class Search {
 public:
  explicit Search(const Model& model)
      : model_(model), memory_(model), state_(memory_.state), scratch_(memory_.scratch) {}

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
  const Model& model_;
  TickMemory memory_;
  State& state_;
  Scratch& scratch_;
};

bool is_contact(Stage stage) { return stage == Stage::kFindRows || stage == Stage::kSolve || stage == Stage::kAccount; }

// Pieces of which libccd is asked whether they still touch: of the others a closed form tells it for the price of two
// supports.
bool asks_libccd(const Model& model) {
  return std::any_of(model.piece.begin(), model.piece.end(), [](const ToolPiece& piece) {
    return piece.shape != PieceShape::kSphere && piece.shape != PieceShape::kCapsule;
  });
}

// Every point measured by the dearest query, twice on a body that moves; but none is begun when the tick's share is
// spent, and a tool point's search ends with it: what it looks at beyond are its walks. That query is looked for, so it
// has a reserve. And all that overlap tests may ask for, which few ticks do: of ten million of ellipsoid_mallet_paper
// one asked for 90 supports, before they had a budget, and took 1.28 times what was stated (2026-11-28).
double rows_cost(const Model& model, Search& search) {
  const SceneSizes sizes = scene_sizes(model);
  const std::int32_t share = surface_work_share(model.params);
  const auto dearest = [&](std::int32_t searched) {
    return static_cast<std::int32_t>(kReserveOfQuery * search.query(searched));
  };
  Work work;
  work.points = work.queries = sizes.points;
  work.pieces = sizes.pieces;
  if (is_shared(model, Stage::kFindRows)) {
    work.looks = std::min(work.queries * dearest(std::min(share / 2, kMaxSearched)), share + dearest(1));
    if (asks_libccd(model)) work.supports = kGjkSupportBudget + kMostSupportsBeyond;
  } else {
    work.queries *= 2;
    const std::int32_t query = dearest(kMaxTipSearched);
    work.looks = std::min(work.queries * query, share + query);
  }
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
  image.params.surface_work_max = method == Method::kElastic ? kElasticShare : kShare;
  if (method != Method::kNodes) cost.looks_max = image.params.surface_work_max;
  const Model model = model_of(image);
  Search search(model);
  const std::array<double, kStageCount> found = search.stages();
  for (const double stage : found) cost.found += stage;
  const double rows = method == Method::kNodes ? 0 : rows_cost(model, search);
  image.stage_cost.clear();
  for (int i = 0; i < kStageCount; ++i) {
    const auto stage = static_cast<Stage>(i);
    double stated = reserve_of(model, stage) * found[static_cast<std::size_t>(i)];
    if (stage == Stage::kFindRows) stated = std::max(stated, rows);
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
