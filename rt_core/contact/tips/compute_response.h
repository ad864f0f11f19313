// The force stage of scenes whose tool tips carry whole-contact laws: one scalar law per tip, or curves tabulated over
// the surface, instead of springs at many tool points.
#pragma once

#include "rt_core/contact/regions/sort_contacts.h"
#include "rt_core/stages.h"

namespace palpate {

// Called by compute_force with its outputs cleared and at least one region in contact. Writes what that stage writes.
// Bound: kMaxPieces tips, the solves of travel.h.
void compute_response(const Model& model, State& state, Scratch& scratch, const SortedContacts& sorted) PALPATE_RT;

}  // namespace palpate
