// Friction of one contact region: what the region moved, the law's answer, and both written back.
#pragma once

#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/contact/friction/friction.h"
#include "rt_core/contact/points/region_load.h"
#include "rt_core/state.h"

namespace palpate {

// Friction at the region's centre, added to its wrench, energy and to `stiffness`. The caller fills
// region.depth_equivalent_m and `load`'s tangent and depth rate; motion, normal and force are taken from the region.
void slide(const Model& model, const State& state, const FrictionParameters& parameters, const RegionContacts& contacts,
           FrictionLoad& load, Region& region, ContactStiffness& stiffness) PALPATE_RT;

}  // namespace palpate
