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
  double instructions = 0;            // of the worst tick, at most
};

// Fills surface_work_max and stage_cost for a tick that looks at `worst_work`.
void state_costs(std::int32_t worst_work, ImageContents& image);

// The same for what an adversary finds who moves the tool: touching and inside the body, along its edges and towards
// its middle, as deep as the contact law reaches and as fast as the scene's device may move. Fixed seed. The image must
// be sound and allow kMaxSurfaceWork.
TickCost bake_costs(ImageContents& image);

// Why no ordinary computer can tick this scene in its period; "" when one can.
std::string cost_refusal(const TickCost& cost, double period_s);

}  // namespace palpate
