// An elastic body's energy around its last amplitudes: quadratic in their step, linear in the forces of the regions.
#pragma once

#include "rt_core/contact/elastic/elastic_load.h"
#include "rt_core/contact/elastic/elastic_work.h"
#include "rt_core/contact/elastic/mode_count.h"
#include "rt_core/contact/elastic/mode_pairs.h"
#include "rt_core/contact/region_solve.h"

namespace palpate {

// Entries that the body's energy sums up, and what comes beside them for as much.
constexpr std::int32_t soft_work(std::int32_t pair) noexcept { return pair * (pair + 20) + 600; }

// Body at its amplitudes: products and energy.
CarriedSurface look(const Model& model, const State& state, Scratch& scratch) PALPATE_RT;
// Step of the amplitudes when every force is let go, with H of no force.
void let_go(const Model& model, const SoftEnergy& energy, Real* step) PALPATE_RT;
// Of a tool point: a capsule that touches all over has its point in its middle; at one end, there.
RoundTip round_tip(const Model& model, std::int32_t index, const Pose& carrier) PALPATE_RT;
// Whether its tips are edges or plates of a solid (RoundTip::is_of_solid).
inline bool is_of_solid(const ToolPiece& piece) PALPATE_RT {
  const bool leaves = piece.half_extent_m[0] > 0 || piece.half_extent_m[1] > 0;
  return piece.shape == PieceShape::kBox || (piece.shape == PieceShape::kCapsule && leaves);
}
// The rows of this tick (ContactMethod::find_rows).
void find_elastic_tips(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

template <class Count>
inline Real dot(const Real* a, const Real* b, Count n) PALPATE_RT {
  Real sum = 0;
  for (std::int32_t i = 0; i < n; ++i) sum += a[i] * b[i];  // bound: n
  return sum;
}

// The tick's linearisation: H's factor, and per region H^-1 pull of its deepest row. Count: FourModes or std::int32_t.
template <class Count>
class Linearised {
 public:
  Linearised(const Model& model, State& state, Scratch& scratch, ElasticLoad& load, Count soft) PALPATE_RT;

  // Laws of all tips; every tip sticks. `force_N`: of every region before.
  void prepare(const Real* force_N) PALPATE_RT;
  // For every solve, depths and far fields of all regions and what couples them.
  void let_give(const Real* before_N) PALPATE_RT;
  // The step under the forces found. True: a tip slips under it, and the linearisation is made anew for that.
  bool slips(const Real* force_N) PALPATE_RT;
  // Moves the amplitudes under the forces found; returns how far the next linearisation would move the surface under
  // any region.
  Real step(const Real* force_N) PALPATE_RT;
  // What the pairs' compliance asks for along the surface, for ElasticLoad::row().
  void pull_aside(const Real* force_N) PALPATE_RT {
    if (regions() > 1) pairs_.pull_aside(regions(), force_N, load_.pair_aside);
  }
  // How the normal forces found change with tool and modes. After press_regions().
  void tell_tangent(const Real* force_N) const PALPATE_RT;
  Real energy_J() const PALPATE_RT { return energy_J_; }
  Real linear_energy_J(const Real* force_N) const PALPATE_RT;

 private:
  std::int32_t regions() const PALPATE_RT { return scratch_.rows.regions; }
  void gather() PALPATE_RT;
  Real place_ahead(const Real* force_N, std::int32_t r, PlaceForce& place) const PALPATE_RT;
  void add_places(const Real* force_N) PALPATE_RT;
  void turned(const Real* force_N, Real* h) const PALPATE_RT;
  void factorise(const Real* force_N) PALPATE_RT;
  template <class Size>
  void aim_normal(Size size, std::int32_t r, ToolTangent::Spring& out) const PALPATE_RT;
  template <class Size>
  void tell_pairs(Size size, const Real* force_N) const PALPATE_RT;
  bool damp_step(Real* delta) PALPATE_RT;
  Real find_step(const Real* force_N, Real* delta) const PALPATE_RT;
  void sweep(const Real* delta, std::int32_t r) PALPATE_RT;
  Real left_m(const Real* force_N, const Real* delta) PALPATE_RT;
  void add_tip(Contact& contact, std::int32_t at) PALPATE_RT;
  void couple() PALPATE_RT;

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ElasticLoad& load_;
  ElasticWork& work_;
  const FrictionParameters friction_;
  const Count n_;
  ElasticRow* row_[kMaxRegions];  // by region, each of which is one tip
  Real factor_[kMaxSoftModes * kMaxSoftModes];
  // Slope of the places' own energies in the amplitudes, less what the rows' pull has of it.
  Real place_rootJ_[kMaxSoftModes];
  Real free_step_[kMaxSoftModes];
  Real moved_[kMaxSoftModes][kMaxRegions];
  ModePairs pairs_;  // of several regions
  Real energy_J_ = 0;
  bool slips_ = false;  // some tip does
};

}  // namespace palpate
