// How much of the surface a tick of a scene looks at in the worst case, found by looking for it; and what its stages
// may take then. Counts, not times: an image has the same bytes wherever it is baked.
#pragma once

#include <cstdint>
#include <string>

#include "config/bake/image_writer.h"
#include "rt_core/model.h"

namespace palpate {

struct TickCost {
  std::int32_t surface_work = 0;      // most boxes and triangles one tick looked at; 0: the method looks at none
  std::int32_t surface_work_max = 0;  // what a tick may
  double found = 0;                   // instructions: the dearest tick of each stage that was found, summed up
  double instructions = 0;            // stated of the worst tick
};

// Fills stage_cost with what no tick can exceed, for an image that is looked at before it is ticked.
void state_most_costs(ImageContents& image);

// Fills surface_work_max and stage_cost by what an adversary finds (adversary.h). The share of surface work is for a
// tool that touches and creeps inside the body, as deep as the contact law reaches and as fast as the scene's device
// may move; a stage's cost for one that is put anywhere and moved anyhow, with a reserve. Fixed seeds. The image
// must be sound.
TickCost bake_costs(ImageContents& image);

// Why no ordinary computer can tick this scene in its period; "" when one can.
std::string cost_refusal(const TickCost& cost, double period_s);

}  // namespace palpate
