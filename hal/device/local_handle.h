// Where a device that evaluates the local model takes its handle to be within its encoder's step, ten thousand times a
// second. The same choice as the controller's (rt_core/safety/smoothing_friction.h), by what the device is told now:
// where its friction holds a handle on its track at that stiffness, on the track, which is quiet; where the object is
// stiffer, by the encoder's edges, which ask for less friction and leave three times the noise.
//
// What commands add to the stiffness counts with it: of an object of nodes they tell only what its normals make, and
// where friction holds the tool as well a handle on its track went to and fro by 18 um, 66 mN (pinch_block_nodal,
// 2026-11-27).
#pragma once

#include "hal/device/local_model.h"
#include "rt_core/safety/handle_track.h"

namespace palpate {

class LocalHandle {
 public:
  struct Options {
    double encoder_m = 0;  // 0: what is told
    double period_s = 1e-4;
    double mass_kg = 0, friction_N = 0;  // of the handle; what smoothing_friction.h asks for is asked of them
  };
  LocalHandle(const Options& options, Vec3 at_m) noexcept
      : options_(options),
        gains_(observer_gains(kObservedPosition, options.encoder_m, options.period_s)),
        told_m_(at_m),
        track_{at_m, 0} {}

  // A command begins to act; {}: without a model.
  void obey(Vec3 force_N, const LocalModel& model) noexcept;
  // `told_m` by the encoder, a period after the last time.
  Vec3 next(Vec3 told_m) noexcept;

 private:
  bool rests_on_track() const noexcept;

  Options options_;
  ObserverGains gains_;
  EdgeMemory edges_;
  ObservedMotion motion_;
  Vec3 told_m_;
  HandleTrack track_;
  Vec3 force_N_;                      // of the last command,
  LocalModel model_;                  // and its model
  double added_Nm_ = 0, way_m2_ = 0;  // against the way between commands' points beyond the model's slope; lately
  bool to_track_ = false;             // since that command
};

}  // namespace palpate
