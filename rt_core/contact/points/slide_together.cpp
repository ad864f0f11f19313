#include "rt_core/contact/points/slide_together.h"

#include "rt_core/contact/cubic_law_lanes.h"
#include "rt_core/contact/friction_lanes.h"
#include "rt_core/contact/points/coupled_points.h"
#include "rt_core/contact/points/spring_lanes.h"
#include "rt_core/tool/pose_lanes.h"

namespace palpate {

namespace {

// Of four regions: what friction is between, and what it does.
struct FourSliding {
  Vec3x4 centre_w{}, normal_w{}, arm_w{};
  Double4 hand{}, force_N{};
  std::int32_t piece[4] = {};
  RegionRows rows[4];
  Region* region[4];
  std::uint32_t count = 0;
  Vec3x4 step_w;
  Vec3x4 direction_w{};
  Double4 along_N_per_m{}, across_N_per_m{};
};

// material_motion() where one piece touches.
Vec3x4 motions(const Model& model, const State& state, const FourSliding& four) PALPATE_RT {
  const Vec3x4 at_tool = inverse_transform(splat4(state.tool_w), four.centre_w);
  const Pose4 before_w = splat4(state.tool_previous_w);
  if (!is_articulated(model)) return four.centre_w - transform(before_w, at_tool);
  const auto of = [&](const auto& motion) PALPATE_RT {
    return side_by_side(motion[four.piece[0]], motion[four.piece[1]], motion[four.piece[2]], motion[four.piece[3]]);
  };
  const ArticulationState& a = state.articulation;
  const Vec3x4 before = transform(of(a.motion_previous_tool), inverse_transform(of(a.motion_tool), at_tool));
  return four.centre_w - transform(before_w, before);
}

bool is_of_one_piece(const RegionRows& rows) PALPATE_RT {
  for (std::int32_t k = 1; k < rows.count; ++k)  // bound: rows
    if (rows[k].piece != rows[0].piece) return false;
  return true;
}

// tangent_axes(); what has neither stretch nor motion takes any direction.
Vec3x4 axes_along(const FourSliding& four) PALPATE_RT {
  const Vec3x4 along = unit_or(four.direction_w, Vec3x4{}), n = four.normal_w;
  const Mask4 none = !(dot(along, along) > Double4{});
  const Vec3x4 off = where(abs_of(n.x) < splat4(0.6), splat4(Vec3{1, 0, 0}), splat4(Vec3{0, 1, 0}));
  return where(none, unit_or(tangential_part(off, n), Vec3x4{}), along);
}

// Those that stick; of several pieces' motions none is told here.
Sticking4 sticking(const FrictionParameters& parameters, const FourSliding& four, std::uint32_t alone) PALPATE_RT {
  if (!sticks_by_fours(parameters)) return Sticking4{};
  Vec3x4 stretch{};
  const FrictionLoad4 load{four.step_w, four.normal_w, four.force_N};
  std::uint32_t touched = 0, slipping = 0;
  for (std::uint32_t l = 0; l < four.count; ++l) {  // bound: 4
    const Region& region = *four.region[l];
    stretch.set(l, region.stretch_w);
    touched |= region.friction != FrictionMode::kFree ? 1u << l : 0u;
    slipping |= region.friction == FrictionMode::kSlip ? 1u << l : 0u;
  }
  return stick_four(parameters, load, stretch, touched & alone, slipping);
}

// As rub_region().
void stick(const Sticking4& stuck, const Vec3x4& torque_Nm, std::uint32_t l, Region& region,
           FourSliding& four) PALPATE_RT {
  const Vec3 force = stuck.force_w[l];
  region.stretch_w = stuck.stretch_w[l];
  region.friction = (stuck.slip >> l & 1) != 0 ? FrictionMode::kSlip : FrictionMode::kStick;
  region.reversal_N_per_m = 0;
  region.friction_force_w = force;
  region.wrench_w.force_N += force;
  region.wrench_w.torque_Nm += torque_Nm[l];
  region.energy_J += stuck.energy_J[l];
  four.direction_w.set(l, stuck.direction_w[l]);
  four.along_N_per_m[l] = stuck.along_N_per_m[l];
  four.across_N_per_m[l] = stuck.across_N_per_m[l];
}

FourSliding four_from(const Model& model, State& state, Scratch& scratch, std::int32_t r) PALPATE_RT {
  FourSliding four;
  const std::int32_t left = scratch.rows.regions - r;
  four.count = static_cast<std::uint32_t>(left < 4 ? left : 4);
  for (std::uint32_t l = 0; l < four.count; ++l) {  // bound: 4
    four.rows[l] = rows_of(scratch, r + static_cast<std::int32_t>(l));
    Region& region = state.region[scratch.rows.slot[r + static_cast<std::int32_t>(l)]];
    four.region[l] = &region;
    four.centre_w.set(l, region.centre_w);
    four.normal_w.set(l, region.normal_w);
    four.arm_w.set(l, region.centre_w - pivot_w(state, four.rows[l]));
    four.hand[l] = region.hand;
    four.force_N[l] = region.normal_force_N;
    four.piece[l] = four.rows[l][0].piece;
  }
  four.step_w = motions(model, state, four);
  return four;
}

void slide_four(const Model& model, State& state, Scratch& scratch, const FrictionParameters& parameters, bool yields,
                std::int32_t r, ToolSprings& all) PALPATE_RT {
  FourSliding four = four_from(model, state, scratch, r);
  std::uint32_t alone = 0;
  for (std::uint32_t l = 0; l < four.count; ++l) alone |= is_of_one_piece(four.rows[l]) ? 1u << l : 0u;  // bound: rows
  const Sticking4 stuck = sticking(parameters, four, alone);
  const Vec3x4 torque = cross(four.arm_w, stuck.force_w);
  const Double4 depth = law_depth_m(parameters.contact, four.force_N);
  for (std::uint32_t l = 0; l < four.count; ++l) {  // bound: kMaxContacts rows
    Region& region = *four.region[l];
    region.depth_equivalent_m = depth[l];
    if ((stuck.which >> l & 1) != 0) {
      stick(stuck, torque, l, region, four);
      continue;
    }
    FrictionLoad load = load_on_points(scratch, parameters, yields, r + static_cast<std::int32_t>(l), region);
    const bool is_alone = (alone >> l & 1) != 0;
    load.step_w = is_alone ? four.step_w[l] : material_motion(model, state, four.rows[l], region.centre_w);
    const FrictionForce friction = rub_region(parameters, load, four.arm_w[l], region);
    four.direction_w.set(l, friction.direction_w);
    four.along_N_per_m[l] = friction.along_N_per_m;
    four.across_N_per_m[l] = friction.across_N_per_m;
  }
  const Vec3x4 along = axes_along(four), across = cross(four.normal_w, along);
  Springs springs;
  springs.add(four.along_N_per_m, along, cross(four.arm_w, along));
  springs.add(four.across_N_per_m, across, cross(four.arm_w, across));
  all.add(springs, four.hand);
}

}  // namespace

FrictionLoad load_on_points(const Scratch& scratch, const FrictionParameters& parameters, bool yields, std::int32_t r,
                            const Region& region) PALPATE_RT {
  const Real own = yields ? scratch.system.compliance_m_per_N[r * (kRegionStride + 1)] : 0.0;
  FrictionLoad load;
  // With the surface yielding under the region, its stiffness is that of the two springs in series.
  load.tangent_N_per_m = region.tangent_N_per_m / (1.0 + own * region.tangent_N_per_m);
  const Real tangent = law_tangent_N_per_m(parameters.contact, region.depth_equivalent_m);
  load.depth_rate = tangent > 0 ? load.tangent_N_per_m / tangent : 1.0;
  return load;
}

void slide_together(const Model& model, State& state, Scratch& scratch, const FrictionParameters& parameters,
                    bool yields) PALPATE_RT {
  ToolSprings all;
  for (std::int32_t r = 0; r < scratch.rows.regions; r += 4)  // bound: kMaxRegions
    slide_four(model, state, scratch, parameters, yields, r, all);
  all.add_to(scratch);
}

}  // namespace palpate
