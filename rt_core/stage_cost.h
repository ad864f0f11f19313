// What a scene's worst tick may take, stage by stage, in instructions: the bound that an image states, a baker compares
// with the period and a controller with its machine. A tick can count what it does, never what it takes, so the bound
// is made of the scene's sizes, the capacities of limits.h and prices per unit.
#pragma once

#include "rt_core/model.h"

namespace palpate {

// Price of a box or triangle looked at, the query around it included: 130 to 183 on the shipped bodies, from 2 mm above
// the surface to the middle (2000 cold queries each, callgrind, gcc 12 -O3, 2026-11-22).
inline constexpr double kSurfaceLookInstructions = 200;
// What an ordinary core does in a second: the baker refuses what would take the whole period there. The controller
// measures its own machine before it drives a device.
inline constexpr double kBakeInstructionsPerSecond = 3e9;

// What the prices are multiplied with: tool points, contacts and regions at once, joints, pieces, anchors, nodes.
struct SceneSizes {
  double points, contacts, regions, joints, pieces, anchors, nodes;
};
SceneSizes scene_sizes(const Model& model) noexcept;

// Upper bound of one stage; those of contact are the method's own (ContactMethod::least_cost). No image with a smaller
// stage_cost is loaded. Prices are the dearest seen in callgrind over the shipped scenes (tests/bench, 2026-11-22) and
// up to twice that, because no scene meets every capacity at once. tests/bench/tick_instructions.sh compares them with
// every scene.
double least_stage_cost(const Model& model, Stage stage) noexcept;

// What methods share. The tick's share of surface work and the query that ends it.
double surface_search_cost(const Model& model) noexcept;
// Tool points against the surface: that, what is skipped, clusters of all pairs, and a cross-check of every region that
// was lost at once.
double find_points_cost(const Model& model, const SceneSizes& n) noexcept;
// Friction and sums of regions, with the skeletons of temporal coupling.
double rub_regions_cost(const SceneSizes& n) noexcept;

// Sum over the stages that the image states.
double worst_tick_instructions(const Model& model) noexcept;

}  // namespace palpate
