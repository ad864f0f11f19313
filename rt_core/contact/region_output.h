// What the force stage leaves behind where nothing presses, and how a region's memory follows the surface.
#pragma once

#include "rt_core/contact/regions/sort_contacts.h"
#include "rt_core/state.h"

namespace palpate {

// Zeroes the stage's outputs of this tick: total wrench, energy, residual, tangent stiffness, contact forces.
void clear_outputs(State& state, Scratch& scratch) PALPATE_RT;
// Regions without a usable contact exert nothing.
void clear_idle_regions(State& state, const SortedContacts& sorted) PALPATE_RT;
// Stretch carried to the new tangent plane by the smallest rotation of the normal, its length kept.
Vec3 carried(Vec3 stretch, Vec3 from_normal, Vec3 to_normal) PALPATE_RT;

}  // namespace palpate
