// What the regions of a tick do to one another through the body's linear modes and beyond them.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"
#include "rt_core/contact/elastic/near_field.h"
#include "rt_core/contact/elastic/pair_lanes.h"

namespace palpate {

struct ModePairs {
  Real linear_m_per_N[kMaxRegions][kMaxRegions];  // by modes and near field; zero on the diagonal
  Real share[kMaxRegions][kMaxRegions];           // of the modes' travel under a region, what another's newton makes

  // `row`: of each of n regions.
  void link(const Model& model, ElasticRow* const* row, std::int32_t n) PALPATE_RT;
  // Slope along the surface of what the others' forces move under each region. The near field's alone: the linear modes
  // are straight between the vertices, and their slope would step from facet to facet, by 1.3 % of the force on a
  // pinched wall (2026-11-23).
  void pull_aside(std::int32_t n, const Real* force_N, Vec3* aside) const PALPATE_RT;

 private:
  void meet_modes(const Model& model, ElasticRow* const* row, std::int32_t n) PALPATE_RT;
  void stand(const Model& model, const ElasticRow* const* row, std::int32_t n) PALPATE_RT;
  // Of region r with the four from b on, which have `shared` by the modes.
  void near(std::int32_t r, std::int32_t b, const Double4& shared) PALPATE_RT;
  Vec3x4 foot(std::int32_t b) const PALPATE_RT {
    return {load4(foot_[0] + b), load4(foot_[1] + b), load4(foot_[2] + b)};
  }
  Vec3x4 normal(std::int32_t b) const PALPATE_RT {
    return {load4(normal_[0] + b), load4(normal_[1] + b), load4(normal_[2] + b)};
  }
  Vec3 foot_of(std::int32_t r) const PALPATE_RT { return {foot_[0][r], foot_[1][r], foot_[2][r]}; }
  Vec3 normal_of(std::int32_t r) const PALPATE_RT { return {normal_[0][r], normal_[1][r], normal_[2][r]}; }

  NearField field_{0};
  Real by_modes_m_per_N_[kMaxRegions][kMaxRegions];
  Real foot_[3][kMaxRegions], normal_[3][kMaxRegions], core_m_[kMaxRegions], cut_1_per_m_[kMaxRegions];
  Real solid_m_[kMaxRegions];            // NearField::kSolid, of parts of solids
  Real fall_[kMaxRegions][kMaxRegions];  // near field's slope over the distance; zero on the diagonal
};

}  // namespace palpate
