// Where tool points touch the rest surface: the rows of points and tips (proxies on the surface, as a god-object's).
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Closest rest-surface point of every tool point that can have reached it. Writes state.point (but region),
// scratch.contact, contact_count, foot. Bound: n_tool_point hierarchy queries. Status: kContactsDropped,
// kTraversalTruncated, kFootHeld.
void collide(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

// Whether the piece last at this region may still touch the surface there: tool points only sample the piece, so a flat
// face can touch between them. An overlap test of the piece against the surface triangle it last touched; inconclusive
// counts as touching, since "could not decide" must never be read as "no contact". Status: kOverlapInconclusive.
bool still_touching(const Model& model, State& state, Scratch& scratch, const Region& region) PALPATE_RT;

}  // namespace palpate
