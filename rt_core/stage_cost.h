// What a scene's worst tick may take, stage by stage, in instructions: the bound that an image states, a baker compares
// with the period and a controller with its machine. A tick can count what it does, never what it takes, so the bound
// is made of the scene's sizes, the capacities of limits.h and prices per unit.
#pragma once

#include "rt_core/model.h"
#include "rt_core/work.h"

namespace palpate {

// What an ordinary core does in a second: the baker refuses what would take the whole period there. The controller
// measures its own machine before it drives a device.
inline constexpr double kBakeInstructionsPerSecond = 3e9;

// Tool points, contacts and regions at once, joints, pieces, anchors, nodes.
struct SceneSizes {
  std::int32_t points, contacts, regions, joints, pieces, anchors, nodes;
};
SceneSizes scene_sizes(const Model& model) noexcept;

// What a stage took by the work it counted: Scratch::work after a tick. The prices in work.h are the least, by linear
// programming and with 4 to 5 %, by which no stage of 78,000 ticks of the adversary took more: of every shipped scene,
// the bodies of tests/accuracy, ring and heart of one and two soft modes and two tools on the ring (callgrind, gcc 12
// -O3, 2026-11-28); those of nodes, beams and hulls are from 2026-11-22. budget.work holds other ticks against them.
double counted_instructions(const Work& work, Stage stage) noexcept;
double counted_instructions(const Work& work) noexcept;

// What no tick of any scene of these sizes can exceed in any unit, its capacities all met at once; those of contact are
// the method's own (ContactMethod::add_most_work).
Work most_work(const Model& model) noexcept;
// The same in instructions. Up to 50 times what a tick that can be found takes: nobody meets every capacity at once. An
// image states less, what an adversary found and a reserve (config/bake/worst_tick.h).
double most_stage_cost(const Model& model, Stage stage) noexcept;
// What any tick in contact takes: every point looked at, one contact of one region. No image that states less is
// loaded, and none that states more than most_stage_cost().
double least_stage_cost(const Model& model, Stage stage) noexcept;

// What methods share, for their ContactMethod::add_most_work: tool points against the surface; and rows in regions,
// solved in so many Newton steps, in which all laws are evaluated so many times.
void add_most_points(const Model& model, const SceneSizes& n, Work& work) noexcept;
void add_most_regions(const SceneSizes& n, std::int32_t steps, std::int32_t evaluations, Work& work) noexcept;

// Whether a stage counted more than the image states for it: the statement, by which the controller judged whether the
// scene fits its period, is wrong. Bound: kStageCount.
bool is_beyond_stated(const Model& model, const Work& work) PALPATE_RT;

// Sum over the stages that the image states.
double worst_tick_instructions(const Model& model) noexcept;

}  // namespace palpate
