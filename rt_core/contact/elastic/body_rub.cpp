#include "rt_core/contact/elastic/body_rub.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// How the material at the foot moves along both axes by each amplitude.
void show_sweep(const Model& model, const Real* y, const ElasticRow& row, RubAxis (&axis)[2]) PALPATE_RT {
  const std::int32_t soft = model.params.elastic_soft;
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  const float* block[3];
  for (int k = 0; k < 3; ++k) block[k] = vertex_block(model, triangle.vertex[k]);  // bound: 3
  struct Along {
    Real of[2];
  };
  const auto along = [&](std::int32_t term) PALPATE_RT -> Along {
    Double4 u{};
    for (int k = 0; k < 3; ++k) u += splat4(row.foot.weight[k]) * widen4(block[k] + kTermFloats * term);  // bound: 3
    const Vec3 moved{u[0], u[1], u[2]};
    return {{dot(moved, axis[0].unit_w), dot(moved, axis[1].unit_w)}};
  };
  for (std::int32_t a = 0; a < soft; ++a) {
    const Along g = along(a);
    for (int i = 0; i < 2; ++i) axis[i].sweep[a] = g.of[i];  // bound: 2
  }
  std::int32_t pair = soft;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: pairs
    for (std::int32_t b = a; b < soft; ++b, ++pair) {
      const Along g = along(pair);
      for (int i = 0; i < 2; ++i) {  // bound: 2
        axis[i].sweep[a] += g.of[i] * y[b];
        axis[i].sweep[b] += g.of[i] * y[a];
      }
    }
  }
}

}  // namespace

BodyRub begin_rub(const Region& region, Vec3 motion_w) PALPATE_RT {
  BodyRub rub;
  const bool usable = is_finite(region.stretch_w) && is_finite(motion_w);
  rub.is_on = region.friction != FrictionMode::kFree && region.tangential_k_N_per_m > 0 && usable;
  if (!rub.is_on) return rub;
  rub.slides = region.friction == FrictionMode::kSlip;
  rub.spring_N_per_m = region.tangential_k_N_per_m;
  rub.stretch_w = region.stretch_w + motion_w;
  return rub;
}

void aim_rub(const Model& model, const Real* y, const FrictionParameters& law, const ElasticRow& row, Real force_N,
             bool is_first, BodyRub& rub) PALPATE_RT {
  if (!rub.is_on) return;
  const Vec3 n = row.foot.normal_w, trial = tangential_part(rub.stretch_w - rub.moved_w, n);
  const Real length = norm(trial);
  const Vec3 any = tangential_part(axis_off(n), n);
  rub.axis[0].unit_w = unit_or(length > 1e-12 ? trial : any, any);
  rub.axis[1].unit_w = cross(n, rub.axis[0].unit_w);
  rub.axis[0].force_N = rub.spring_N_per_m * length;
  rub.axis[1].force_N = 0;
  rub.axis[0].stiffness_N_per_m = rub.axis[1].stiffness_N_per_m = rub.spring_N_per_m;
  if (!is_first) {
    const Real sticking = static_limit_N(law, force_N);
    const Real sliding = is_presliding(law.law) ? sticking : sliding_limit_N(law, force_N);
    if (rub.axis[0].force_N > (rub.slides ? sliding : sticking)) {
      rub.axis[0].force_N = sliding;
      rub.axis[0].stiffness_N_per_m = 0;
      rub.axis[1].stiffness_N_per_m = sliding / length;
    }
  }
  show_sweep(model, y, row, rub.axis);
}

SurfaceUnderRub surface_under(const BodyRub& rub) PALPATE_RT {
  SurfaceUnderRub under;
  under.step_w = rub.moved_w;
  for (int i = 0; i < 2; ++i) {  // bound: 2
    // Its own spring taken out of what the surface gives: 1 / y = 1 / y0 + k. Never to less than a hundredth.
    const RubAxis& axis = rub.axis[i];
    const Real share = max_of(1 - axis.stiffness_N_per_m * axis.yield_m_per_N, 0.01);
    under.yield_m_per_N[i] = axis.yield_m_per_N / share;
  }
  return under;
}

}  // namespace palpate
