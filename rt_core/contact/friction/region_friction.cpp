#include "rt_core/contact/friction/region_friction.h"

#include "rt_core/tool/articulate.h"
#include "rt_core/tool/carrier.h"

namespace palpate {

namespace {

// Motion since the last tick of the material at `point` that moves rigidly from `before` to `now`.
Vec3 carried_motion(const Pose& before, const Pose& now, Vec3 point) PALPATE_RT {
  return point - transform(before, inverse_transform(now, point));
}

// Motion since the last tick of the tool material that is at `point` now, rotation included: exact where one piece
// touches; the mean by force where pieces that move against one another share the region.
Vec3 material_motion(const Model& model, const State& state, const RegionContacts& contacts, Vec3 point) PALPATE_RT {
  if (!is_articulated(model)) return carried_motion(state.tool_previous_w, state.tool_w, point);
  Vec3 sum;
  Real total = 0;
  std::int32_t last = -1;
  Vec3 motion;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    const std::int32_t piece = model.tool_point[static_cast<std::size_t>(contacts[k].point)].piece;
    if (piece != last) {
      motion = carried_motion(carrier_previous_w(model, state, piece), carrier_w(model, state, piece), point);
      last = piece;
    }
    sum += contacts[k].force_N * motion;
    total += contacts[k].force_N;
  }
  return total > 0 ? (1.0 / total) * sum : motion;
}

void add_tangential_stiffness(ContactStiffness& stiffness, const FrictionForce& friction, Vec3 normal,
                              Vec3 arm) PALPATE_RT {
  const Vec3 axis = abs_of(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 any = unit_or(tangential_part(axis, normal), {});
  const Vec3 along = unit_or(friction.direction_w, any), across = cross(normal, along);
  add_spring(stiffness, friction.along_N_per_m, along, cross(arm, along));
  add_spring(stiffness, friction.across_N_per_m, across, cross(arm, across));
}

}  // namespace

void slide(const Model& model, const State& state, const FrictionParameters& parameters, const RegionContacts& contacts,
           FrictionLoad& load, Region& region, ContactStiffness& stiffness) PALPATE_RT {
  load.step_w = material_motion(model, state, contacts, region.centre_w);
  load.normal_w = region.normal_w;
  load.force_N = region.normal_force_N;
  load.depth_m = region.depth_equivalent_m;
  FrictionMemory memory{region.stretch_w, region.tangential_k_N_per_m, region.friction};
  const FrictionForce friction = friction_step(parameters, load, memory);
  region.stretch_w = memory.stretch_w;
  region.tangential_k_N_per_m = memory.stiffness_N_per_m;
  region.friction = memory.mode;
  region.reversal_N_per_m = friction.reversal_N_per_m;
  const Vec3 arm = region.centre_w - state.tool_w.position_m;
  const Vec3 force = friction.force_w + friction.normal_gain_N * region.normal_w;
  region.normal_force_N += friction.normal_gain_N;
  region.friction_force_w = friction.force_w;
  region.wrench_w.force_N += force;
  region.wrench_w.torque_Nm += cross(arm, force);
  region.energy_J += friction.energy_J;
  region.origin_w = region.centre_w - region.stretch_w;
  add_tangential_stiffness(stiffness, friction, region.normal_w, arm);
}

}  // namespace palpate
