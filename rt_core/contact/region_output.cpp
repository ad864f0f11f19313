#include "rt_core/contact/region_output.h"

namespace palpate {

namespace {

// A region out of contact exerts nothing but remembers its stretch until its slot is freed (a bounce keeps its friction
// history); an empty slot remembers nothing.
void clear_force(Region& region) PALPATE_RT {
  region.normal_force_N = 0;
  region.friction_force_w = {};
  region.wrench_w = {};
  region.depth_equivalent_m = 0;
  region.far_field_m = 0;
  region.energy_J = 0;
  region.tangent_N_per_m = 0;
  if (region.id != 0) return;
  region.stretch_w = {};
  region.tangential_k_N_per_m = 0;
  region.friction = FrictionMode::kFree;
  region.lean_normal_tool = {};
}

}  // namespace

void clear_outputs(State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_wrench_w = {};
  scratch.energy_J = 0;
  scratch.residual_m = 0;
  for (Real& entry : state.contact_stiffness) entry = 0;  // bound: 36
  const std::int32_t contacts = scratch.contact_count < kMaxContacts ? scratch.contact_count : kMaxContacts;
  for (std::int32_t i = 0; i < contacts; ++i) scratch.contact[i].force_N = 0;  // bound: kMaxContacts
}

void clear_idle_regions(State& state, const SortedContacts& sorted) PALPATE_RT {
  bool busy[kMaxRegions] = {};
  for (std::int32_t r = 0; r < sorted.region_count; ++r) busy[sorted.slot[r]] = true;  // bound: kMaxRegions
  for (std::int32_t s = 0; s < kMaxRegions; ++s) {                                     // bound: kMaxRegions
    if (!busy[s]) clear_force(state.region[s]);
  }
}

Vec3 carried(Vec3 stretch, Vec3 from_normal, Vec3 to_normal) PALPATE_RT {
  const Vec3 turned = tangential_part(rotate(rotation_between(from_normal, to_normal), stretch), to_normal);
  const Real length = norm(turned);
  return length > 1e-15 ? (norm(stretch) / length) * turned : Vec3{};
}

}  // namespace palpate
