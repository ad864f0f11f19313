#include "rt_core/cholesky.h"
#include "rt_core/contact/nodes/nodes.h"
#include "rt_core/contact/nodes/region_motion.h"
#include "rt_core/contact/regions.h"

namespace palpate {

// Minimises sum |u - t - r x (x - c)|^2: with d = x - c, (sum d.d 1 - d d^T) r = sum d x u.
RegionMotion MotionFit::result(double blur_m, double share) const PALPATE_RT {
  RegionMotion motion;
  if (!(count_ > 0)) return motion;
  const Vec3 mean = (1 / count_) * position_;
  motion.centre_w = origin_ + mean;
  motion.translation_m = (share / count_) * displacement_;
  const Vec3 moment = moment_ - cross(mean, displacement_);
  const double xx = square_[0] - count_ * mean.x * mean.x, xy = square_[1] - count_ * mean.x * mean.y,
               xz = square_[2] - count_ * mean.x * mean.z, yy = square_[3] - count_ * mean.y * mean.y,
               yz = square_[4] - count_ * mean.y * mean.z, zz = square_[5] - count_ * mean.z * mean.z;
  const double blur = count_ * blur_m * blur_m;
  Real matrix[9] = {yy + zz + blur, -xy, -xz, -xy, xx + zz + blur, -yz, -xz, -yz, xx + yy + blur};
  Real x[3] = {moment.x, moment.y, moment.z};
  if (!cholesky_factor(matrix, 3)) return motion;
  cholesky_solve(matrix, x, 3);
  const Vec3 rotation{share * x[0], share * x[1], share * x[2]};
  constexpr Real kMost_rad = 0.5;  // beyond it no linear body is meant
  const Real size = norm(rotation);
  motion.rotation_rad = size > kMost_rad ? (kMost_rad / size) * rotation : rotation;
  return motion;
}

namespace {

// Mean displacement of a half space under a uniform pressure, times E* and the radius, over the force: 16 / (3 pi^2)
// (Johnson 1985, section 3.4). What a body has beyond it is far field.
constexpr Real kPatchMean = 0.5403796460924681;

// Out of contact: its place and identity stay, for the ticks it may come back in.
void keep_identity(Region& region) PALPATE_RT {
  const Region kept = region;
  region = Region{};
  region.id = kept.id;
  region.born_tick = kept.born_tick;
  region.lost_ticks = kept.lost_ticks;
  region.centre_w = kept.centre_w;
  region.normal_w = kept.normal_w;
}

// Nodes nearer together than this share of the cluster distance do not show a rotation.
constexpr Real kBlur = 0.02;

struct Sums {
  Vec3 centre, normal, friction, force, torque, carry;
  Real load = 0, energy = 0, area = 0;
  std::int32_t slipping = 0, count = 0;
};

void add(const Model& model, const Scratch& scratch, const Contact& contact, Sums& s) PALPATE_RT {
  const ContactNode& node = problem_of(scratch).node[contact.row];
  const Vec3 on_tool = -node.force_w;
  s.centre += contact.force_N * contact.position_w;
  s.normal += contact.force_N * contact.normal_w;
  s.friction += on_tool - contact.force_N * contact.normal_w;
  s.force += on_tool;
  s.torque += cross(node.arm_w, on_tool);
  s.carry += contact.force_N * motion_of(problem_of(scratch), contact.row);
  s.load += contact.force_N;
  s.energy += 0.5 * dot(node.force_w, motion_of(problem_of(scratch), contact.row));
  s.area += model.nodal_vertex[static_cast<std::size_t>(node.vertex)].area_m2;
  s.slipping += node.push.slips ? 1 : 0;
  s.count += 1;
}

void write(const Sums& s, Region& region) PALPATE_RT {
  region.lost_ticks = 0;
  region.point_count = s.count;
  region.area_m2 = s.area;
  region.centre_w = (1.0 / s.load) * s.centre;
  region.normal_w = unit_or(s.normal, {0, 1, 0});
  region.normal_force_N = dot(s.normal, region.normal_w);
  region.friction_force_w = s.friction;
  region.wrench_w = {s.force, s.torque};
  region.energy_J = s.energy;
  region.friction = s.slipping == s.count ? FrictionMode::kSlip : FrictionMode::kStick;
  const Vec3 mean = (1.0 / s.load) * s.carry;
  region.depth_equivalent_m = max_of(-dot(mean, region.normal_w), 0.0);
  region.depth_max_m = max_of(region.depth_max_m, region.depth_equivalent_m);
  region.tangent_N_per_m = region.depth_equivalent_m > 0 ? region.normal_force_N / region.depth_equivalent_m : 0;
}

// Energy of a half space of the same material under the same force and area.
Real local_energy_J(const Model& model, const Region& region) PALPATE_RT {
  const Real nu = model.params.poisson_ratio;
  const Real modulus = model.params.youngs_modulus_Pa / (1 - nu * nu);
  const Real radius = square_root(region.area_m2 / kPi);
  return 0.5 * kPatchMean * squared_norm(region.wrench_w.force_N) / (modulus * radius);
}

// Which part of the nodes' motion carries the place where gap and normal are taken. With a body that deforms only
// around the contact it is none: normals re-evaluated on a node's own dent cost 17 % of the force on an ellipsoid
// pressed by 0.8 of the sphere's radius (and 44 % under a punch). With one that gives way as a whole it is all: a
// clip's peak is 38 % too high without.
Real far_share(const Model& model, Real local_J, Real energy_J) PALPATE_RT {
  switch (model.params.nodal_carry) {
    case NodalCarry::kRest:
      return 0;
    case NodalCarry::kFarField:
    case NodalCarry::kTurned:
      break;
  }
  return energy_J > 0 ? 1 - min_of(local_J / energy_J, 1.0) : 0;
}

void label_nodes(State& state, Scratch& scratch, const Clusters& clusters) PALPATE_RT {
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    Contact& contact = scratch.contact[i];
    contact.region = clusters.cluster[clusters.of_contact[i]].slot;
    state.nodal.contact[i].region = contact.region;  // both list the pushing nodes in order
    problem_of(scratch).node[contact.row].region = contact.region;
  }
}

// How the surface around each region has moved as a whole: its nodes, and those near it that do not push.
void fit_motions(const Model& model, State& state, const Scratch& scratch) PALPATE_RT {
  const ContactProblem& p = problem_of(scratch);
  MotionFit fit[kMaxRegions];
  Real reach2[kMaxRegions] = {};
  std::int32_t touching[kMaxRegions], count = 0;
  for (std::int32_t s = 0; s < kMaxRegions; ++s) {  // bound: kMaxRegions
    if (state.region[s].id != 0 && state.region[s].lost_ticks == 0) touching[count++] = s;
  }
  const Real near = 2 * model.params.cluster_distance_m;
  for (std::int32_t i = 0; i < p.count; ++i) {  // bound: kMaxContacts
    const bool pushes = p.node[i].push.normal_N > 0;
    std::int32_t slot = pushes ? p.node[i].region : -1;
    Real distance2 = pushes && slot >= 0 ? squared_norm(p.node[i].rest_w - state.region[slot].centre_w) : near * near;
    for (std::int32_t k = 0; !pushes && k < count; ++k) {  // bound: kMaxRegions
      const Real to_region2 = squared_norm(p.node[i].rest_w - state.region[touching[k]].centre_w);
      if (!(to_region2 < distance2)) continue;
      distance2 = to_region2;
      slot = touching[k];
    }
    if (slot < 0) continue;
    fit[slot].add(p.node[i].rest_w, motion_of(p, i));
    reach2[slot] = max_of(reach2[slot], distance2);
  }
  const bool turned = model.params.nodal_carry == NodalCarry::kTurned;
  for (std::int32_t k = 0; k < count; ++k) {  // bound: kMaxRegions; of the others nobody reads it
    const std::int32_t s = touching[k];
    RegionMotion& motion = state.nodal.motion[s];
    motion = fit[s].result(kBlur * model.params.cluster_distance_m, state.nodal.far_share);
    motion.finite = turned ? 1 : 0;
    motion.growth = growth_under(motion, -state.region[s].wrench_w.force_N);
    motion.reach_m = square_root(reach2[s]) + 2 * model.params.cluster_distance_m;
  }
}

void age(const Model& model, Region& region) PALPATE_RT {
  keep_identity(region);
  region.lost_ticks += 1;
  if (region.lost_ticks > region_memory_ticks(model.params)) region = Region{};
}

}  // namespace

void find_nodal_regions(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  Clusters clusters;
  find_clusters(model, scratch, clusters);
  if (!assign_slots(scratch, clusters, state)) scratch.status |= Status::kRegionsDropped;
  label_nodes(state, scratch, clusters);
  scratch.work.joined += clusters.pairs + clusters.recalls;
  scratch.work.grouped += clusters.count;

  Sums sums[kMaxRegions];
  for (std::int32_t i = 0; i < scratch.contact_count; ++i) {  // bound: kMaxContacts
    const Contact& contact = scratch.contact[i];
    if (contact.region >= 0) add(model, scratch, contact, sums[contact.region]);
  }
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts
    const Cluster& cluster = clusters.cluster[c];
    if (cluster.slot >= 0) state.region[cluster.slot].depth_max_m = cluster.depth_max_m;
  }
  Real local_J = 0;
  std::int32_t touching = 0;
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {  // bound: kMaxRegions
    Region& region = state.region[slot];
    const Sums& s = sums[slot];
    if (region.id == 0) continue;
    if (s.count == 0) {
      age(model, region);
      continue;
    }
    write(s, region);
    local_J += local_energy_J(model, region);
    touching += 1;
  }
  scratch.work.rubbed += touching;
  if (touching > state.high_water.regions) state.high_water.regions = touching;
  state.nodal.far_share = far_share(model, local_J, scratch.energy_J);
  fit_motions(model, state, scratch);
}

}  // namespace palpate
