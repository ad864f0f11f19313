// A second judge of grasps, by another method than the product's.
#pragma once

#include "sim_host/press/grasp_stability.h"

namespace palpate::test {

// What is left of the body's weight by forces within round cones: fingers at their normal forces with friction of any
// direction up to `scale` of their limits, corners of the palm pushing as hard as they like. Nesterov's projected
// gradient: another method than the product's, and without its edges.
double left_in_round_cones_N(const Grasp& grasp, double scale);

}  // namespace palpate::test
