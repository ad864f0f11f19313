// How much of the surface a tick of a scene may look at, and what its stages take in the worst case, found by looking
// for it. Counts, not times: an image has the same bytes wherever it is baked.
#pragma once

#include <cstdint>
#include <string>

#include "config/bake/image_writer.h"
#include "rt_core/model.h"

namespace palpate {

struct TickCost {
  std::int32_t looks_max = 0;  // boxes and triangles that a tick may look at; 0: the method looks at none
  double found = 0;            // instructions: the dearest tick of each stage that was found, summed up
  double instructions = 0;     // stated of the worst tick
};

// Fills stage_cost with what no tick can exceed, for an image that is looked at before it is ticked.
void state_most_costs(ImageContents& image);

// Fills surface_work_max, and stage_cost by what an adversary finds (adversary.h) for a tool that is put anywhere and
// moved anyhow, with a reserve. Fixed seeds. The image must be sound.
TickCost bake_costs(ImageContents& image);

// Why no ordinary computer can tick this scene in its period; "" when one can.
std::string cost_refusal(const TickCost& cost, double period_s);

}  // namespace palpate
