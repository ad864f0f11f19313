// Automatic preshape: how far each finger must open to let the body in, and how far it closes to hold it.
#pragma once

#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "rt_core/model.h"

namespace palpate {

struct Preshape {
  std::vector<double> open, closed;  // of each joint
  std::int32_t parts_touching = 0;   // with every joint closed
  double clearance_m = 0;            // smallest gap with every joint open, over the way in
  std::string warning;               // what could not be had; empty: nothing
};

// The grasp planner of robot hands in its simplest form: with the palm where the scene grasps, each finger that takes
// part bends one joint after the other, root first, until a part that the joint carries is `squeeze` deep in the body;
// these are the closed positions. Opened are the joints by the smallest common share of the way back to stretched out
// at which every part keeps its clearance while the hand comes in along the palm's normal. Fingers that take no part
// stay stretched out. Needs the model's surface, pieces, tool points and joints; takes `stretched` as their straight
// positions. Deterministic.
Preshape plan_preshape(const Model& model, const HandDesc& hand, const std::vector<double>& stretched);

}  // namespace palpate
