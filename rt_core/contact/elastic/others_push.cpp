#include "rt_core/contact/elastic/others_push.h"

namespace palpate {

Real OthersPush::most_m(const Model& model, Real reach_m_per_rootJ) const PALPATE_RT {
  if (count_ == 0) return 0;
  Double4 square{};
  for (std::int32_t k = 0; k < count_; ++k) show_linear_modes(model, *row_[k]);  // bound: kMaxPieces
  for (std::int32_t m = 0; m < model.params.elastic_linear; m += 4) {            // bound: kMaxLinearModes / 4
    Double4 sum{};
    for (std::int32_t k = 0; k < count_; ++k) sum += splat4(force_N_[k]) * load4(row_[k]->along + m);
    square += sum * sum;
  }
  return square_root(palpate::sum(square)) * reach_m_per_rootJ;
}

Real OthersPush::outwards_m(const Model& model, ElasticRow& row) const PALPATE_RT {
  show_linear_modes(model, row);
  Double4 out{};
  for (std::int32_t m = 0; m < model.params.elastic_linear; m += 4) {  // bound: kMaxLinearModes kMaxPieces / 4
    for (std::int32_t k = 0; k < count_; ++k)
      if (row_[k] != &row) out -= splat4(force_N_[k]) * load4(row_[k]->along + m) * load4(row.along + m);
  }
  return max_of(sum(out), 0.0);
}

}  // namespace palpate
