// Where on its axis a capsule's force acts, on the body as it is about its foot.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"

namespace palpate {

// Goes along the axis by one step to where the force that it had acts (LineLaw), with the travel, and says the line
// there and how it resists leaning. `box`: root_box of the body. `bend_1_per_m`: of the height along the axis. Returns
// how far it went.
Real stand_on_line(const Model& model, const Box& box, Real bend_1_per_m, Real force_N, ElasticRow& row) PALPATE_RT;

// Along one axis of a plate that went `step_m` to where it is to press: how the height bends there, and how far a lean
// of the surface takes the place along, its moment per lean and force.
struct PlateAxis {
  Real step_m, bend_1_per_m, arm_m;
};
// How the height bends along a plate's axes, and how much it leans along either for a step along the other.
struct PlateBends {
  Real along_1_per_m, across_1_per_m, mixed_1_per_m;
};
// The same for a plate, along one axis and then along the other.
void stand_on_plate(const Model& model, const Box& box, const PlateBends& bends, Real force_N, ElasticRow& row,
                    PlateAxis (&axes)[2]) PALPATE_RT;

}  // namespace palpate
