#include "hal/device/local_handle.h"

#include "rt_core/safety/local_device.h"
#include "rt_core/safety/smoothing_friction.h"

namespace palpate {

namespace {

// Ten thousand times a second without delay the track asks for a fifth more than the controller's: handles of 0.05 to
// 0.4 kg, damping of 0.05 to 6 N s/m, four hands, 200 to 4000 N/m, kicks as there: all 30,240 come to rest within 6 s;
// with a tenth more 31 do not (2026-11-27).
constexpr double kAskedForMore = 1.2;

// What commands add along the way of their points, by least squares: a slip, or a turn of the handle, changes the force
// as well, but not by the way. Forgotten by a fiftieth with each, half a tremor's cycle at 1 kHz; ways of less than a
// hundredth of an encoder's step of 30 um tell no slope.
constexpr double kKept = 0.98, kLeastWay_m = 3e-7;

}  // namespace

void LocalHandle::obey(Vec3 force_N, const LocalModel& model) noexcept {
  if (model.valid_s > 0 && model_.valid_s > 0) {
    const Vec3 way_m = model.point_m - model_.point_m;
    added_Nm_ = kKept * added_Nm_ + dot(local_force_N(force_N_, model_, model.point_m) - force_N, way_m);
    way_m2_ = kKept * way_m2_ + squared_norm(way_m);
  }
  force_N_ = force_N;
  model_ = model;
  to_track_ = rests_on_track();
}

// Between two contacts not: what is met next may be stiff.
bool LocalHandle::rests_on_track() const noexcept {
  const Options& o = options_;
  if (!(model_.valid_s > 0)) return false;
  const double told_N_per_m = stiffness_size(model_.along_N_per_m, model_.across_N_per_m);
  const double stiffness_N_per_m = told_N_per_m + max_of(0, added_Nm_) / max_of(way_m2_, kLeastWay_m * kLeastWay_m);
  return told_N_per_m > 0 &&
         o.friction_N >= kAskedForMore * friction_to_smooth(EncoderLaw::kMotion, kSmoothedPosition, stiffness_N_per_m,
                                                            o.encoder_m, o.mass_kg);
}

Vec3 LocalHandle::next(Vec3 told_m) noexcept {
  const Options& o = options_;
  const Vec3 change_m = told_m - told_m_;
  told_m_ = told_m;
  if (!(o.encoder_m > 0)) return told_m;
  const Vec3 by_edges_m = told_m + between_edges(o.encoder_m, o.period_s, change_m, edges_);
  return on_track(gains_, o.encoder_m, o.period_s, told_m, change_m, by_edges_m, to_track_, motion_, track_);
}

}  // namespace palpate
