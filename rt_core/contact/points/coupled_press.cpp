// press_regions() of points, four regions at a time and to the bit: 18,800 instructions one by one for fifteen regions
// of 52 points (2026-11-26).
#include "rt_core/contact/points/coupled_points.h"
#include "rt_core/contact/points/spring_lanes.h"

namespace palpate {

namespace {

// Rotates v as the smallest rotation does that carries unit vector a onto unit vector b.
Vec3x4 turned_with(const Vec3x4& a, const Vec3x4& b, const Vec3x4& v) PALPATE_RT {
  const Vec3x4 axis = cross(a, b);
  const Double4 w = splat4(1.0) + dot(a, b);
  const Double4 length = square_root(w * w + axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
  const Mask4 usable = (length > splat4(1e-9)) & (length < splat4(kHuge));
  const Double4 scale = splat4(1.0) / length;
  const Vec3x4 u = where(usable, scale * axis, Vec3x4{});
  const Vec3x4 t = splat4(2.0) * cross(u, v);
  return v + where(usable, scale * w, splat4(1.0)) * t + cross(u, t);
}

// carried() of region_load.cpp.
Vec3x4 carried(const Vec3x4& stretch, const Vec3x4& from_normal, const Vec3x4& to_normal) PALPATE_RT {
  const Vec3x4 turned = tangential_part(turned_with(from_normal, to_normal, stretch), to_normal);
  const Double4 length = length_of(turned);
  return where(length > splat4(1e-15), (length_of(stretch) / length) * turned, Vec3x4{});
}

}  // namespace

// Of four regions: their loads, and where those act.
struct CoupledPoints::Four {
  Springs springs;
  Vec3x4 resultant{}, torque{}, centre{}, normal{};
  Double4 force{}, energy{};
  Mask4 beyond{};
  Double4 row_force[kMaxContacts];
};

// region_load().
void CoupledPoints::load_four(std::int32_t i, const Double4& shift, const Vec3x4& pivot, Four& four) const PALPATE_RT {
  const Double4 most = splat4(law_.max_depth_m);
  for (std::int32_t k = first_[i]; k < first_[i + 1]; ++k) {  // bound: rows
    const Double4 depth = depth_[k] - shift;
    const LawPoint4 load = law_at(law_, depth);
    const Double4 force = weight_[k] * load.force_N;
    const Vec3x4 turn = cross(place_[k] - pivot, normal_[k]);
    four.row_force[k] = force;
    four.resultant = four.resultant + force * normal_[k];
    four.torque = four.torque + force * turn;
    four.force += force;
    four.energy += weight_[k] * law_energy_J(law_, depth);
    four.beyond |= depth > most;
    four.springs.add(weight_[k] * load.tangent_N_per_m, normal_[k], turn);
  }
}

// centre_of(), by force where there is any.
void CoupledPoints::centre_four(std::int32_t i, const Vec3x4& last_normal, Four& four) const PALPATE_RT {
  const Mask4 loaded = (four.force > Double4{}) & (geometric_ ? Mask4{} : ~Mask4{});
  const auto share = [&](std::int32_t k) PALPATE_RT { return where(loaded, four.row_force[k], weight_[k]); };
  Vec3x4 moment{}, sum{};
  Double4 total{}, height{};
  for (std::int32_t k = first_[i]; k < first_[i + 1]; ++k) {  // bound: rows
    moment = moment + share(k) * place_[k];
    sum = sum + share(k) * normal_[k];
    total += share(k);
  }
  const std::int32_t first = first_[i];
  const Vec3x4 fallback = where(dot(last_normal, last_normal) > splat4(0.5), last_normal, normal_[first]);
  const Vec3x4 centre = (splat4(1.0) / total) * moment;
  const Vec3x4 normal = where(length_of(sum) > splat4(1e-6) * total, unit_or(sum, fallback), fallback);
  for (std::int32_t k = first_[i]; k < first_[i + 1]; ++k) {  // bound: rows; height_above()
    const Vec3x4 mean = normal_[k] + normal;
    const Double4 slope = dot(mean, normal);
    const Double4 above = dot(place_[k] - centre, mean) / slope;
    height += share(k) * where(slope > splat4(0.5), above, Double4{});
  }
  const Mask4 placed = total > Double4{};
  four.centre = where(placed, centre + (height / total) * normal, place_[first]);
  four.normal = where(placed, normal, fallback);
}

// press() of region_load.cpp.
void CoupledPoints::press_four(std::int32_t i, State& state, Scratch& scratch, ToolSprings& all) const PALPATE_RT {
  const std::int32_t regions = n_ - 4 * i < 4 ? n_ - 4 * i : 4;
  Vec3x4 pivot{}, stretch{}, last_normal{};
  Double4 hand{};
  for (std::int32_t l = 0; l < regions; ++l) {  // bound: 4
    const Region& region = state.region[scratch.rows.slot[4 * i + l]];
    const auto lane = static_cast<std::uint32_t>(l);
    pivot.set(lane, pivot_w(state, rows_[4 * i + l]));
    stretch.set(lane, region.stretch_w);
    last_normal.set(lane, region.normal_w);
  }
  const Double4 shift = load4(scratch.system.shift_m + 4 * i);
  Four four;
  load_four(i, shift, pivot, four);
  centre_four(i, last_normal, four);
  stretch = carried(stretch, last_normal, four.normal);
  const Double4 along = dot(four.resultant, four.normal), normal_force = along > Double4{} ? along : Double4{};
  const Double4 energy = four.energy + splat4(0.5) * four.force * shift;
  const Double4 tangent = four.springs.along(four.normal);
  for (std::int32_t l = 0; l < regions; ++l) {  // bound: 4
    const RegionRows& rows = rows_[4 * i + l];
    Region& region = state.region[scratch.rows.slot[4 * i + l]];
    const auto lane = static_cast<std::uint32_t>(l);
    region.stretch_w = stretch[lane];
    region.centre_w = four.centre[lane];
    region.normal_w = four.normal[lane];
    region.normal_force_N = normal_force[l];
    region.wrench_w = {four.resultant[lane], four.torque[lane]};
    region.energy_J = energy[l];
    region.tangent_N_per_m = tangent[l];
    region.hand = rows[0].hand;
    hand[l] = region.hand;
    if (four.beyond[l] != 0) scratch.status |= Status::kDepthBeyondRange;
    for (std::int32_t k = 0; k < rows.count; ++k) rows[k].force_N = four.row_force[first_[i] + k][l];
  }
  all.add(four.springs, hand);
}

void CoupledPoints::press(State& state, Scratch& scratch) const PALPATE_RT {
  scratch.stiffness = scratch.other.stiffness = {};
  ToolSprings all;
  for (std::int32_t i = 0; i < fours_; ++i) press_four(i, state, scratch, all);  // bound: kMaxContacts rows
  all.add_to(scratch);
}

}  // namespace palpate
