#include "hal/device/local_model.h"

#include "hal/bus/codec.h"

namespace palpate {

namespace {

// Three entries of a row are off by half a step of the wire each, so an eigenvalue by 3/2 of a step at most: what a
// rounded contact without friction, which is stiff in one direction, may seem to push in the others. Without this
// allowance 29 to 86 % of its directions were dropped at 100 to 5,000 N/m (2026-11-24), and the force held.
constexpr double kRounding_N_per_m = 1.5 * wire::kStiffnessStep_N_per_m;

// No principal minor of K + small I is below zero.
bool is_semi_definite(Vec3 d, Vec3 o, double small) noexcept {
  const double x = d.x + small, y = d.y + small, z = d.z + small;
  const double xy = x * y - o.z * o.z, xz = x * z - o.y * o.y, yz = y * z - o.x * o.x;
  const double all = x * yz - o.z * (o.z * z - o.x * o.y) + o.y * (o.z * o.x - y * o.y);
  return x >= 0 && y >= 0 && z >= 0 && xy >= 0 && xz >= 0 && yz >= 0 && all >= 0;
}

double slope_N_per_s(const LocalLoop& loop, const LocalModel& model) noexcept {
  const double per_share = 1e3 * loop.force_max_N;
  return per_share * local_slope_share_per_ms(loop.slope_N_per_s / per_share,
                                              stiffness_size(model.along_N_per_m, model.across_N_per_m),
                                              loop.encoder_step_m, loop.force_max_N);
}

}  // namespace

LocalModel bounded_model(const LocalModel& model, double most_N_per_m) noexcept {
  const Vec3 d = model.along_N_per_m, o = model.across_N_per_m;
  const bool is_number = is_finite(model.point_m) && is_finite(d) && is_finite(o);
  if (!is_number || !(model.valid_s > 0 && model.valid_s <= kLocalValid_s)) return {};
  if (!is_semi_definite(d, o, 1e-6 * max_of(d.x + d.y + d.z, 0) + kRounding_N_per_m)) return {};
  const double size = stiffness_size(d, o);
  const double scale = size > most_N_per_m ? most_N_per_m / size : 1;
  LocalModel bounded = model;
  bounded.along_N_per_m = scale * d;
  bounded.across_N_per_m = scale * o;
  return bounded;
}

Vec3 local_force_N(Vec3 force_N, const LocalModel& model, Vec3 position_m) noexcept {
  const Vec3 d = model.along_N_per_m, o = model.across_N_per_m, x = position_m - model.point_m;
  const Vec3 change{d.x * x.x + o.z * x.y + o.y * x.z, o.z * x.x + d.y * x.y + o.x * x.z,
                    o.y * x.x + o.x * x.y + d.z * x.z};
  return not_turned_round(force_N - change, force_N);
}

Vec3 moved_force_N(const LocalLoop& loop, Vec3 force_N, const LocalModel& model, const LocalWay& way) noexcept {
  return shortened(local_force_N(force_N, model, way.to_m), loop.force_max_N) -
         shortened(local_force_N(force_N, model, way.from_m), loop.force_max_N);
}

Vec3 next_force_N(const LocalLoop& loop, Vec3 rendered_N, Vec3 force_N, const LocalModel& model,
                  const LocalWay& way) noexcept {
  const Vec3 wanted_N = shortened(local_force_N(force_N, model, way.to_m), loop.force_max_N);
  if (!(loop.slope_N_per_s > 0)) return wanted_N;
  const double farthest_m = kLocalFastest_m_per_s * loop.period_s;
  const bool jumped = squared_norm(way.to_m - way.from_m) > farthest_m * farthest_m;
  const Vec3 moved_N = jumped ? rendered_N : rendered_N + moved_force_N(loop, force_N, model, way);
  const Vec3 next_N = moved_N + shortened(wanted_N - moved_N, slope_N_per_s(loop, model) * loop.period_s);
  return shortened(turned_no_farther(next_N, rendered_N, force_N), loop.force_max_N);
}

}  // namespace palpate
