// Where on its axis a capsule's force acts, on the body as it is about its foot.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"

namespace palpate {

// Goes along the axis by one step to where the force that it had acts (LineLaw), with the travel, and says the line
// there and how it resists leaning. `box`: root_box of the body. `bend_1_per_m`: of the height along the axis. Returns
// how far it went.
Real stand_on_line(const Model& model, const Box& box, Real bend_1_per_m, Real force_N, ElasticRow& row) PALPATE_RT;

// Along one of a plate's axes: how the height bends, and how much the body leans under a moment, which is how much it
// would lean back if the force went on. Without the latter a plate on a block narrower than it went from corner to
// corner in every tick (2026-11-28).
struct PlateAxis {
  Real bend_1_per_m, lean_per_Nm;
};
void stand_on_plate(const Model& model, const Box& box, PlateAxis along, PlateAxis across, Real force_N,
                    ElasticRow& row) PALPATE_RT;

}  // namespace palpate
