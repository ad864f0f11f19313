// The coupled solve of points' regions (PointLaws) for contact/region_solve.h, four regions at a time: as PointLaws
// region by region, to the bit. Fifteen regions of 52 points on rubber took 9,500 instructions a Newton step and 3,000
// an evaluation one by one (2026-11-26); docs/models_grasp.md has what they take now.
#pragma once

#include "rt_core/contact/cubic_law_lanes.h"
#include "rt_core/contact/points/point_laws.h"
#include "rt_core/lanes.h"

namespace palpate {

// Rows of a matrix of regions: whole lanes.
inline constexpr std::int32_t kRegionStride = whole_lanes(kMaxRegions, 4);

struct ToolSprings;

class CoupledPoints {
 public:
  static constexpr std::int32_t kIterations = PointLaws::kIterations;
  static constexpr Real kEnough_m = PointLaws::kEnough_m;
  static constexpr Real kTolerance_m = PointLaws::kTolerance_m;

  // `compliance_m_per_N`: C, symmetric to the bit, in rows of kRegionStride. Bound: rows.
  CoupledPoints(const PointLaws& laws, const Real* compliance_m_per_N) PALPATE_RT;

  // From where the last tick's forces `before_N`, of whole lanes, would have the surface, until no more is left than a
  // micronewton; from start() where they are of no use.
  RegionSolution solve(const Real* before_N, RegionSystem& system) const PALPATE_RT;
  void start(Real* shift_m) const PALPATE_RT;
  Real evaluate(const Real* shift_m, RegionSystem& system) const PALPATE_RT;
  bool newton_step(RegionSystem& system) const PALPATE_RT;
  // As press_regions(), at the shifts in scratch.system.
  void press(State& state, Scratch& scratch) const PALPATE_RT;

 private:
  struct Four;
  static constexpr std::int32_t kFours = kRegionStride / 4;
  void load_four(std::int32_t i, const Double4& shift_m, const Vec3x4& pivot_w, Four& four) const PALPATE_RT;
  void centre_four(std::int32_t i, const Vec3x4& last_normal_w, Four& four) const PALPATE_RT;
  void press_four(std::int32_t i, State& state, Scratch& scratch, ToolSprings& all) const PALPATE_RT;
  template <int kWide>
  void reduce_row(RegionSystem& system, std::int32_t j) const PALPATE_RT;
  bool factorise(RegionSystem& system, Real* pivot) const PALPATE_RT;
  Double4 moved_by(const Real* per_region, std::int32_t four) const PALPATE_RT;

  const CubicLaw law_;
  const RegionRows* const rows_;
  const Real* compliance_;
  const std::int32_t n_;      // regions, one at least
  const std::int32_t fours_;  // of regions
  // Row k of regions 4 i to 4 i + 3 side by side at first_[i] + k; where a region has no such row, none presses.
  std::int32_t first_[kFours + 1];
  Double4 depth_[kMaxContacts], weight_[kMaxContacts];
  Vec3x4 place_[kMaxContacts], normal_[kMaxContacts];
  bool geometric_;  // RegionRows::geometric
};

}  // namespace palpate
