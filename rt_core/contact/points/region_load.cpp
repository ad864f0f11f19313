#include "rt_core/contact/points/region_load.h"

namespace palpate {

namespace {

// Distance along `normal` from `centre` to the rest surface, seen from one of its points: on a sphere or a plane the
// chord from point to centre is normal to the mean of the two end normals; other smooth surfaces follow to third order.
Real height_above(const Contact& contact, Vec3 centre, Vec3 normal) PALPATE_RT {
  const Vec3 mean = contact.normal_w + normal;
  const Real slope = dot(mean, normal);
  // Where the normals differ by more than 120 degrees there is no common smooth patch.
  return slope > 0.5 ? dot(contact.position_w - centre, mean) / slope : 0.0;
}

}  // namespace

void weigh_contacts(ContactWeight law, const RegionContacts& contacts) PALPATE_RT {
  Real sum = 0;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    Real& weight = contacts[k].weight;
    if (!(weight > 0 && weight < kHuge)) weight = 0;
    sum += weight;
  }
  if (law == ContactWeight::kWinkler) return;
  const Real even = contacts.count > 0 ? 1.0 / contacts.count : 0.0;
  const Real scale = sum > 0 ? 1.0 / sum : 0.0;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    contacts[k].weight = law == ContactWeight::kPaper ? even : scale * contacts[k].weight;
  }
}

LawPoint scalar_load(const CubicLaw& law, const RegionContacts& contacts, Real shift_m) PALPATE_RT {
  LawPoint sum;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    const Contact& contact = contacts[k];
    const LawPoint point = law_at(law, contact.depth_m - shift_m);
    sum.force_N += contact.weight * point.force_N;
    sum.tangent_N_per_m += contact.weight * point.tangent_N_per_m;
  }
  return sum;
}

RegionCentre region_centre(const RegionContacts& contacts, Vec3 fallback_normal) PALPATE_RT {
  Real total = 0;
  for (std::int32_t k = 0; k < contacts.count; ++k) total += contacts[k].force_N;  // bound: points
  const bool loaded = total > 0;
  const auto share = [loaded](const Contact& c) PALPATE_RT { return loaded ? c.force_N : c.weight; };
  Vec3 moment, sum;
  total = 0;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    const Contact& contact = contacts[k];
    moment += share(contact) * contact.position_w;
    sum += share(contact) * contact.normal_w;
    total += share(contact);
  }
  if (!(total > 0)) return {contacts.count > 0 ? contacts[0].position_w : Vec3{}, fallback_normal};
  const Vec3 centre = (1.0 / total) * moment;
  // Opposed normals may cancel to rounding: then there is no direction worth following.
  const Vec3 normal = norm(sum) > 1e-6 * total ? unit_or(sum, fallback_normal) : fallback_normal;
  Real height = 0;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    height += share(contacts[k]) * height_above(contacts[k], centre, normal);
  }
  return {centre + (height / total) * normal, normal};
}

RegionLoad region_load(const CubicLaw& law, const RegionContacts& contacts, Real shift_m, Vec3 pivot_w) PALPATE_RT {
  RegionLoad load;
  for (std::int32_t k = 0; k < contacts.count; ++k) {  // bound: points
    Contact& contact = contacts[k];
    const Real depth = contact.depth_m - shift_m;
    const LawPoint point = law_at(law, depth);
    const Vec3 turn = cross(contact.position_w - pivot_w, contact.normal_w);
    contact.force_N = contact.weight * point.force_N;
    load.resultant_w += contact.force_N * contact.normal_w;
    load.torque_w += contact.force_N * turn;
    load.force_N += contact.force_N;
    load.energy_J += contact.weight * law_energy_J(law, depth);
    load.depth_max_m = max_of(depth, load.depth_max_m);
    add_spring(load.stiffness, contact.weight * point.tangent_N_per_m, contact.normal_w, turn);
  }
  return load;
}

}  // namespace palpate
