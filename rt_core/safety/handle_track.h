// A handle smoothed by its encoder's edges (edge_observer.h) goes on to its track (encoder_observer.h), which is
// quieter, while what it feels is soft enough for its friction to hold it there (smoothing_friction.h): that asks for
// more of a stiff object, and edges leave three times the noise. One rule for the controller and for a device with a
// loop of its own (hal/device/local_handle.h).
#pragma once

#include "rt_core/safety/edge_observer.h"
#include "rt_core/safety/encoder_observer.h"
#include "rt_core/safety/local_device.h"

namespace palpate {

// From one to the other in a time that is not felt: a step's force within 50 ms lies below what a tremor's makes. To
// the edges sooner, for an object that stiffens asks for their friction.
inline constexpr Real kToTrack_s = 50e-3, kToEdges_s = 10e-3;

// X(type, name, initial, what)
#define PALPATE_HANDLE_TRACK(X)                       \
  X(Vec3, at_m, {}, "where the track has the handle") \
  X(Real, share, 0, "the handle is taken to be between where the edges and the track have it")

struct HandleTrack {
  PALPATE_STATE_FIELDS_OF(PALPATE_HANDLE_TRACK)
};

// Where the handle is: `told_m` by the encoder of that step, `elapsed_s` and `change_m` after the last time, by its
// edges at `by_edges_m`. `rests`: friction holds it on its track at what it feels.
inline Vec3 on_track(const ObserverGains& gains, Real step_m, Real elapsed_s, Vec3 told_m, Vec3 change_m,
                     Vec3 by_edges_m, bool rests, ObservedMotion& motion, HandleTrack& track) PALPATE_RT {
  // What no handle does carries the track along, and is no speed of it (as between_edges()).
  const Real fastest_m = step_m + kLocalFastest_m_per_s * elapsed_s;
  if (squared_norm(change_m) > fastest_m * fastest_m) track.at_m += change_m;
  track.at_m += observe(gains, told_m - track.at_m, motion);
  // A state spoilt in memory carries no handle away: a track is never farther than that from what is told.
  const auto near = [&](Real at, Real told) PALPATE_RT { return told + clamp_to(at - told, -gains.most, gains.most); };
  track.at_m = {near(track.at_m.x, told_m.x), near(track.at_m.y, told_m.y), near(track.at_m.z, told_m.z)};
  track.share = clamp_to(track.share + (rests ? elapsed_s / kToTrack_s : -elapsed_s / kToEdges_s), 0.0, 1.0);
  return by_edges_m + track.share * (track.at_m - by_edges_m);
}

}  // namespace palpate
