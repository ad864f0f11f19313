// Where on its axis a capsule's force acts, on the body as it is about its foot.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"

namespace palpate {

// Goes along the axis by one step to where the force that it had acts (LineLaw), with the travel, and says the line
// there and how it resists leaning. `box`: root_box of the body. `bend_1_per_m`: of the height along the axis. Returns
// how far it went.
Real stand_on_line(const Model& model, const Box& box, Real bend_1_per_m, Real force_N, ElasticRow& row) PALPATE_RT;

// Along both of a plate's axes.
struct PlateBends {
  Real along_1_per_m, across_1_per_m;  // of the height
};
void stand_on_plate(PlateBends bend, Real force_N, ElasticRow& row) PALPATE_RT;

}  // namespace palpate
