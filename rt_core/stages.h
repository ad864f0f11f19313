// The stages of a tick. Each is a free function of (Model, State, Scratch): no other memory, no clock, no text. The
// table in docs/architecture.md lists reads, writes, loop bound and status bits of each.
#pragma once

#include "rt_core/io.h"
#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Checks the sample and predicts the tool pose from device pose and last tick's tangent stiffness.
// Writes state.device*, state.tool*, scratch.status.
void sense(const Model& model, State& state, Scratch& scratch, const Input& input) PALPATE_RT;
// Closest rest-surface point of every tool point that can have reached it. Writes state.point (but region),
// scratch.contact (point, position, normal, depth). Bound: n_tool_point hierarchy queries.
void collide(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
// Clusters contacts, keeps identities and order. Writes state.region (identity part), state.point.region,
// contact.region.
void find_regions(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
// Contact law, coupling between regions, friction; total wrench, energy and tangent stiffness.
void compute_force(const Model& model, State& state, Scratch& scratch) PALPATE_RT;
// Virtual coupling, finite check, limits, mode machine. Writes state.safety, state.tool_w, output.device_w, fault,
// mode.
void make_safe(const Model& model, State& state, Scratch& scratch, const Input& input, Output& output) PALPATE_RT;

}  // namespace palpate
