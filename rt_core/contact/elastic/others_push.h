// What the tips that press do to the surface under the others by its linear modes, which the carried surface has not in
// it: a body squeezed by two fingers bulges towards a third. Asked for before it is known which tips touch.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"

namespace palpate {

// What a tip that presses, or one that is asked, takes, in terms of vertices summed up.
inline constexpr std::int32_t kPushTerms = 12;

class OthersPush {
 public:
  // A tip that pressed with force_N in the last tick, where it stands.
  void add(ElasticRow& row, Real force_N) PALPATE_RT {
    row_[count_] = &row;
    force_N_[count_++] = force_N;
  }
  std::int32_t count() const PALPATE_RT { return count_; }
  // No place comes out by more, where no mode shapes reach farther than reach_m_per_rootJ.
  Real most_m(const Model& model, Real reach_m_per_rootJ) const PALPATE_RT;
  // How far the surface under a tip comes out by the others of them.
  Real outwards_m(const Model& model, ElasticRow& row) const PALPATE_RT;

 private:
  std::int32_t count_ = 0;
  ElasticRow* row_[kMaxPieces];
  Real force_N_[kMaxPieces];
};

}  // namespace palpate
