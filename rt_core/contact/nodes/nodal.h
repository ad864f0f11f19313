// The nodal back-end: contact between the tool's convex pieces and the surface nodes of a finite-element body, solved
// as a complementarity problem on the body's compliance (Duriez, Andriot & Kheddar 2003), here with unit normals,
// friction and the virtual coupling in the same problem. Equations and measured errors: docs/models_contact_lcp.md.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline bool is_nodal(const Model& model) PALPATE_RT {
  return model.params.backend == static_cast<std::int32_t>(Backend::kNodal);
}

// Stage collide: nodes near the tool, with gaps and normals where the body's far field has carried them. Writes
// scratch.nodal (nodes). Bound: one visit of the hierarchy per piece. Status: kContactsDropped, kTraversalTruncated.
void collide_nodal(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
// Stage force: pushes, the tool's balance with the virtual coupling, regions, wrench, energy, tangent stiffness. Writes
// state.nodal, state.region, state.contact_stiffness, scratch.contact and the totals in scratch. Bound: kMaxPivots
// factorisations and the sweeps the image asks for. Status: kNotConverged, kRegionsDropped, kStrainBeyondLinear.
void compute_nodal_force(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
// Groups the contacts into lasting regions and sums what they do to the tool. Part of the stage force.
void find_nodal_regions(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

}  // namespace palpate
