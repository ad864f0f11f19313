// The series law as the tick evaluates it (rt_core/contact/tips/travel.h), for one sphere with given coefficients.
#pragma once

#include <vector>

#include "config/fem/series_fit.h"
#include "config/response/tip_bake.h"
#include "rt_core/contact/tips/travel.h"

namespace palpate::fem {

class RunTimeLaw {
 public:
  // `radius_m`: effective radius of tool and body. Local law: exact sphere (depths below its radius) or parabola.
  RunTimeLaw(TipProfile profile, double radius_m, double modulus_Pa, double depth_max_m,
             const SeriesCoefficients& c = {}) {
    TipDesc tip;
    tip.modulus_Pa = modulus_Pa;
    tip.depth_max_m = depth_max_m;
    tip.indenter = {profile, radius_m, 0};
    tip.c0_m_per_N = c.c0_m_per_N;
    tip.c1_m_per_N2 = c.c1_m_per_N2;
    law_ = make_tip_law(tip, factor_);
  }
  LocalLaw local() const { return {&law_, law_.first_factor < 0 ? nullptr : factor_.data()}; }
  DepthOfForce local_depth() const {
    return inverse_of([this](double depth) { return local_at(local(), depth).force_N; }, law_.depth_max_m);
  }
  double force_N(double travel_m) const {
    const Tip tip{local(), {}, TipKind::kPower, travel_m};
    const TipRegion region{&tip, 1, {law_.c0_m_per_N, law_.c1_m_per_N2, law_.force_max_N}};
    return region_at(region, solve_travel(region).shift_m).force_N;
  }

 private:
  TipLaw law_{};
  std::vector<FactorKnot> factor_;
};

}  // namespace palpate::fem
