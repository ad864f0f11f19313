#include "rt_core/stage_cost.h"

#include "rt_core/contact/contact.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/overlap.h"
#include "rt_core/tool/landing.h"
#include "rt_core/tool/two_tools.h"
#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

namespace {

// What a stage takes whatever it finds to do, in the stages' order; the last with what stands between them.
constexpr double kStageInstructions[kStageCount] = {3800, 80, 2400, 1170, 4310, 1800, 960};

}  // namespace

SceneSizes scene_sizes(const Model& model) noexcept {
  const ModelSizes& n = model.sizes;
  const auto size = [](std::int64_t count) { return static_cast<std::int32_t>(count); };
  const std::int32_t rows = size(n.n_nodal > 0 ? n.n_nodal : n.n_tool_point);
  const std::int32_t contacts = rows < kMaxContacts ? rows : kMaxContacts;
  return {size(n.n_tool_point), contacts,        contacts < kMaxRegions ? contacts : kMaxRegions,
          size(n.n_joint),      size(n.n_piece), size(n.n_anchor),
          size(n.n_nodal)};
}

void add_most_points(const Model& model, const SceneSizes& n, Work& work) noexcept {
  const std::int32_t share = surface_work_share(model.params), spare = n.points - n.contacts;
  work.points += n.points > n.pieces ? n.points : n.pieces;  // of an elastic body pieces are gone over
  const std::int32_t asked = 2 * n.points * kMaxQueryWork, allowed = share + kMaxQueryWork;
  work.looks += asked < allowed ? asked : allowed;      // an elastic body asks twice
  work.queries += n.points < share ? n.points : share;  // each looks at one thing at least
  work.waiting += n.points;
  if (!model.corner_normal.empty()) work.feet += 2 * kFootNewtonSteps * n.points;
  work.found += n.contacts;
  work.pairs += n.contacts * n.contacts + kMaxContacts * spare;
  work.clusters += n.contacts;
  work.recalls += (n.regions + kMaxRegions) * n.contacts;
  work.scans += kMaxRegions * n.points;
  work.supports += kGjkSupportBudget + kMostSupportsBeyond;
}

void add_most_regions(const SceneSizes& n, std::int32_t steps, std::int32_t evaluations, Work& work) noexcept {
  const std::int32_t square = n.regions * n.regions;
  work.rows += n.contacts;
  work.regions += n.regions;
  work.region_pairs += (evaluations + 2 * steps) * square;
  work.region_cubes += steps * square * n.regions;
  work.slid += n.contacts;
  work.rubbed += n.regions;
}

double counted_instructions(const Work& work, Stage stage) noexcept {
  double sum = kStageInstructions[static_cast<int>(stage)];
#define PALPATE_UNIT(unit, of_stage, price, what) \
  if (Stage::of_stage == stage) sum += price * static_cast<double>(work.unit);
  PALPATE_WORK_UNITS(PALPATE_UNIT)
#undef PALPATE_UNIT
  return sum;
}

double counted_instructions(const Work& work) noexcept {
  double sum = 0;
  for (int i = 0; i < kStageCount; ++i) sum += counted_instructions(work, static_cast<Stage>(i));
  return sum;
}

Work most_work(const Model& model) noexcept {
  const SceneSizes n = scene_sizes(model);
  Work work;
  work.joints = n.joints + (n.joints > 0 ? n.pieces : 0);
  work.joint_loads = n.pieces * n.joints;
  work.pieces = 2 * n.pieces;
  if (has_two_tools(model)) work.joints = n.pieces, work.other_samples = work.other_balances = work.other_outputs = 1;
  if (touches_in_parts(model)) work.landings = work.landings_again = (has_two_tools(model) ? 2 : 1) * (1 + kLandings);
  if (asks_what_is_felt(model.params)) work.felt = has_two_tools(model) ? 2 : 1;
  contact_method(method_of(model)).add_most_work(model, n, work);
  return work;
}

double most_stage_cost(const Model& model, Stage stage) noexcept {
  return counted_instructions(most_work(model), stage);
}

double least_stage_cost(const Model& model, Stage stage) noexcept {
  Work work;
  work.pieces = static_cast<std::int32_t>(model.sizes.n_piece);
  work.joints = static_cast<std::int32_t>(model.sizes.n_joint);
  if (has_two_tools(model)) work.other_samples = work.other_balances = work.other_outputs = 1;
  work.found = work.rows = work.regions = work.slid = work.rubbed = 1;
  return counted_instructions(work, stage);
}

bool is_beyond_stated(const Model& model, const Work& work) PALPATE_RT {
  double sum[kStageCount];
  for (int i = 0; i < kStageCount; ++i) sum[i] = kStageInstructions[i];  // bound: kStageCount
#define PALPATE_UNIT(unit, of_stage, price, what) \
  sum[static_cast<int>(Stage::of_stage)] += price * static_cast<double>(work.unit);
  PALPATE_WORK_UNITS(PALPATE_UNIT)
#undef PALPATE_UNIT
  bool beyond = false;
  for (std::size_t i = 0; i < model.stage_cost.size() && i < std::size_t{kStageCount}; ++i)  // bound: kStageCount
    beyond = beyond || sum[i] > model.stage_cost[i].instructions;
  return beyond;
}

double worst_tick_instructions(const Model& model) noexcept {
  double sum = 0;
  for (const StageCost& stage : model.stage_cost) sum += stage.instructions;
  return sum;
}

}  // namespace palpate
