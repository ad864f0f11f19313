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

// Upper bound of one stage. No image with a smaller stage_cost is loaded.
double least_stage_cost(const Model& model, Stage stage) noexcept;

// Sum over the stages that the image states.
double worst_tick_instructions(const Model& model) noexcept;

}  // namespace palpate
