// Friction of points' regions, four at a time.
#pragma once

#include "rt_core/contact/region_load.h"

namespace palpate {

// What friction asks of region r: its tangential spring is the points' own law, at
// region.depth_equivalent_m. `yields`: the surface does, under the region (scratch.system).
FrictionLoad load_on_points(const Scratch& scratch, const FrictionParameters& parameters, bool yields, std::int32_t r,
                            const Region& region) PALPATE_RT;

// slide() of all regions: fifteen take 15,600 instructions one by one (2026-11-26). Sums of springs are in another
// order, and a region that one piece touches has its motion, not the mean of its rows'.
void slide_together(const Model& model, State& state, Scratch& scratch, const FrictionParameters& parameters,
                    bool yields) PALPATE_RT;

}  // namespace palpate
