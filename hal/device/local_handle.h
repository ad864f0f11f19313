// Where a device that evaluates the local model takes its handle to be within its encoder's step, ten thousand times a
// second. The same choice as the controller's (rt_core/safety/smoothing_friction.h), by what the device is told now:
// where its friction holds a handle on its track at that stiffness, on the track, which is quiet; where the object is
// stiffer, by the encoder's edges, which ask for less friction and leave three times the noise.
#pragma once

#include "rt_core/safety/edge_observer.h"
#include "rt_core/safety/encoder_observer.h"

namespace palpate {

class LocalHandle {
 public:
  struct Options {
    double encoder_m = 0;  // 0: what is told
    double period_s = 1e-4;
    double mass_kg = 0, friction_N = 0;  // of the handle; what smoothing_friction.h asks for is asked of them
  };
  LocalHandle(const Options& options, Vec3 at_m) noexcept : options_(options), told_m_(at_m), track_m_(at_m) {}

  // `told_m` by the encoder, a period after the last time, while it evaluates a stiffness of so much; 0: none.
  Vec3 next(Vec3 told_m, double stiffness_N_per_m) noexcept;

 private:
  bool rests_on_track(double stiffness_N_per_m) const noexcept;

  Options options_;
  EdgeMemory edges_;
  ObservedMotion motion_;
  Vec3 told_m_, track_m_;
  double track_share_ = 0;  // the handle is taken to be between where the edges and the track have it
};

}  // namespace palpate
