#include "rt_core/contact/elastic/body_rub.h"

namespace palpate {

namespace {

// Axes along a stretch of the spring and across it, with the forces of a spring stretched by `begun`.
void aim_along(Vec3 stretch, Vec3 begun, Vec3 normal_w, std::int32_t soft, BodyRub& rub) PALPATE_RT {
  const Vec3 any = tangential_part(axis_off(normal_w), normal_w);
  rub.axis[0].unit_w = unit_or(norm(stretch) > 1e-12 ? stretch : any, any);
  rub.axis[1].unit_w = cross(normal_w, rub.axis[0].unit_w);
  for (RubAxis& axis : rub.axis) {  // bound: 2 soft
    axis.stiffness_N_per_m = rub.spring_N_per_m;
    axis.force_N = rub.spring_N_per_m * dot(begun, axis.unit_w);
    for (std::int32_t a = 0; a < soft; ++a) axis.sweep[a] = dot(axis.unit_w, rub.sweep_w[a]);
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

void let_stick(const Model& model, const State& state, const ElasticRow& row, BodyRub& rub) PALPATE_RT {
  rub.sweep_w = row.sweep_w;
  if (!rub.is_on) return;
  const std::int32_t soft = model.params.elastic_soft;
  for (std::int32_t a = 0; a < soft; ++a) rub.moved_w += state.elastic.step_rootJ[a] * rub.sweep_w[a];
  const Vec3 stretch = tangential_part(rub.stretch_w - rub.moved_w, row.foot.normal_w);
  aim_along(stretch, stretch, row.foot.normal_w, soft, rub);
}

bool let_slip(const FrictionParameters& law, Vec3 normal_w, Real force_N, const Real* step, std::int32_t soft,
              BodyRub& rub) PALPATE_RT {
  if (!rub.is_on) return false;
  const Vec3 begun = tangential_part(rub.stretch_w - rub.moved_w, normal_w);
  Vec3 stretch = begun;
  for (std::int32_t a = 0; a < soft; ++a) stretch -= step[a] * tangential_part(rub.sweep_w[a], normal_w);
  const Real length = norm(stretch), sticking = static_limit_N(law, force_N);
  const Real sliding = is_presliding(law.law) ? sticking : sliding_limit_N(law, force_N);
  if (!(rub.spring_N_per_m * length > (rub.slides ? sliding : sticking))) return false;
  aim_along(stretch, begun, normal_w, soft, rub);
  // Of the length alone; across it the force turns with the stretch, from where it begins.
  rub.axis[0].force_N = sliding;
  rub.axis[0].stiffness_N_per_m = 0;
  rub.axis[1].stiffness_N_per_m = sliding / length;
  rub.axis[1].force_N = rub.axis[1].stiffness_N_per_m * dot(begun, rub.axis[1].unit_w);
  return true;
}

}  // namespace palpate
