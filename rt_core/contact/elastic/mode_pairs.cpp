#include "rt_core/contact/elastic/mode_pairs.h"

#include "rt_core/contact/region_solve.h"

namespace palpate {

namespace {

Real dot_lanes(const Real* a, const Real* b, std::int32_t n) PALPATE_RT {
  Double4 total{};
  for (std::int32_t i = 0; i < n; i += 4) total += load4(a + i) * load4(b + i);  // bound: n / 4
  return sum(total);
}

}  // namespace

void ModePairs::meet_modes(const Model& model, ElasticRow* const* row, std::int32_t n) PALPATE_RT {
  const std::int32_t modes = model.params.elastic_linear;
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions^2 kMaxLinearModes / 8
    show_linear_modes(model, *row[r]);
    for (std::int32_t j = 0; j <= r; ++j)
      by_modes_m_per_N_[r][j] = by_modes_m_per_N_[j][r] = dot_lanes(row[r]->along, row[j]->along, modes);
  }
}

void ModePairs::stand(const Model& model, const ElasticRow* const* row, std::int32_t n) PALPATE_RT {
  field_ = {far_field_scale_m2_per_N(model.params.youngs_modulus_Pa, model.params.poisson_ratio)};
  for (std::int32_t r = 0; r < whole_lanes(n, kRegionLanes); ++r) {  // bound: kMaxRegions
    const ElasticRow& one = *row[r < n ? r : 0];
    const Vec3 foot = one.foot.foot_w, normal = one.foot.normal_w;
    const Real at[3] = {foot.x, foot.y, foot.z}, up[3] = {normal.x, normal.y, normal.z};
    for (int i = 0; i < 3; ++i) {  // bound: 3
      foot_[i][r] = at[i];
      normal_[i][r] = up[i];
    }
    core_m_[r] = NearField::kCore * one.tip.margin_m;
    solid_m_[r] = one.tip.is_of_solid() ? NearField::kSolid * one.tip.margin_m : 0.0;
    cut_1_per_m_[r] = field_.cut_1_per_m(r < n ? by_modes_m_per_N_[r][r] : 0.0, one.c_m_per_N);
  }
}

// The near field with the core of both contacts, and the fall of it. Of normals that look away from one another it is
// what goes through the wall between them.
void ModePairs::near(std::int32_t r, std::int32_t b, const Double4& shared) PALPATE_RT {
  const Vec3x4 apart = foot(b) - splat4(foot_of(r)), ours = splat4(normal_of(r)), theirs = normal(b);
  const Double4 core = splat4(core_m_[r]) + load4(core_m_ + b), square = dot(apart, apart) + core * core;
  const Double4 facing = dot(ours, theirs), in = -dot(apart, ours), out = dot(apart, theirs);
  const Double4 through = ((in > 0) & (out > 0)) ? facing * (in * out / square) : splat4(0.0);
  const Double4 part = facing < 0 ? through : facing;
  const Double4 cut = splat4(0.5) * (splat4(cut_1_per_m_[r]) + load4(cut_1_per_m_ + b));
  const Double4 length = square_root(square), by_cut = length * cut, root = square_root(by_cut * by_cut + splat4(1.0));
  const Double4 value = splat4(field_.scale_m2_per_N) * part / length * (splat4(1.0) - by_cut / root);
  // Of two parts of a solid 1 / r becomes r / (r^2 + d^2).
  const Double4 own = splat4(solid_m_[r]) * load4(solid_m_ + b) / square,
                apart_share = splat4(1.0) / (splat4(1.0) + own);
  const Double4 near = splat4(field_.scale_m2_per_N) * part / length;
  store(linear_m_per_N[r] + b, shared + (value + near * (apart_share - splat4(1.0))));
  // K = s / r - s c / sqrt(r^2 c^2 + 1): dK/dr = -K / r (1 + x (x + root) / root^2) with x = r c
  const Double4 less = near * (apart_share * apart_share * (splat4(1.0) - own) - splat4(1.0));
  store(fall_[r] + b, value / square * (splat4(1.0) + by_cut * (by_cut + root) / (root * root)) + less / square);
}

void ModePairs::link(const Model& model, ElasticRow* const* row, std::int32_t n) PALPATE_RT {
  meet_modes(model, row, n);
  stand(model, row, n);
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions^2 / 4
    for (std::int32_t j = n; j < whole_lanes(n, kRegionLanes); ++j) by_modes_m_per_N_[r][j] = 0;
    const Real own = by_modes_m_per_N_[r][r];
    const Double4 inverse = splat4(own > 0 ? 1.0 / own : 0.0), one = splat4(1.0);
    for (std::int32_t b = 0; b < n; b += kRegionLanes) {
      const Double4 shared = load4(by_modes_m_per_N_[r] + b), part = shared * inverse;
      store(share[r] + b, part > one ? one : part < -one ? -one : part);
      near(r, b, shared);
    }
    linear_m_per_N[r][r] = fall_[r][r] = share[r][r] = 0;
  }
}

void ModePairs::pull_aside(std::int32_t n, const Real* force_N, Vec3* aside) const PALPATE_RT {
  Real force[kMaxRegions];
  for (std::int32_t r = 0; r < n; ++r) force[r] = force_N[r];  // bound: kMaxRegions
  end_lanes(n, force);
  for (std::int32_t r = 0; r < n; ++r) {  // bound: kMaxRegions^2 / 4
    Vec3x4 slope{};
    for (std::int32_t b = 0; b < n; b += kRegionLanes)
      slope = slope + (load4(force + b) * load4(fall_[r] + b)) * (foot(b) - splat4(foot_of(r)));
    aside[r] = tangential_part({sum(slope.x), sum(slope.y), sum(slope.z)}, normal_of(r));
  }
}

}  // namespace palpate
