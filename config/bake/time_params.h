// What of a scene's parameters follows from times: the device's own loop, the damping of its coupling, and how the body
// relaxes from tick to tick.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/scene/scene.h"
#include "rt_core/model.h"
#include "rt_core/safety/smoothing_friction.h"

namespace palpate {

// Share of what a device admits that "auto" takes for its motions along lines. With a loop of its own the spring that
// the device closes is coupling and object in series, always softer than the coupling that the bound is compared with:
// 0.93 with it, which doubles what is felt of hollow_cylinder (3.00 of 1.46 N/mm; 2.89 with 0.9, 2.84 with 0.8), and
// 1,438 of 1,440 drawn runs of all scenes but snap_in are good with a seed that nobody had seen (61, 2026-11-26).
inline double coupling_share(double local_Hz) { return local_Hz > 0 ? 0.93 : 0.8; }

// Stiffest coupling that "auto" gives a device with a loop of its own: it learns of a contact tau late and has
// gone v tau into it for nothing, whose K (v tau)^2 / 2 comes back, and as much again while its slope makes up for it
// (1 + K v / slope times as much). With 0.2 of the largest force met at 0.3 m/s what comes back is braked away on the
// way out; with 0.3, 3148 N/m at 2.7 ms, 0.9 mJ reached a drawn hand of 316 N/m where b was 0.33 N s/m, and with 0.45,
// 4250 N/m at 3 ms, 2.6 mJ a medium one at 0.5 (tools_on_cylinder, 2026-11-25).
inline double impact_coupling_N_per_m(double local_Hz, double delay_s, double force_max_N) {
  constexpr double kTap_m_per_s = 0.3, kForceShare = 0.2;
  return local_Hz > 0 && delay_s > 0 ? kForceShare * force_max_N / (kTap_m_per_s * delay_s) : kHuge;
}

// Whether the handle is smoothed within the encoder's step: as the scene says, or where the friction that the device is
// stated to have holds it at rest. A held body's steps are not the handle's.
struct Smoothing {
  SmoothingNeed of_position, of_angle;
  double has_N = 0, has_Nm = 0;
  bool position = false, angle = false;
};
inline Smoothing smoothing_of(const DeviceDesc& d, double coupling_N_per_m, double coupling_Nm_per_rad) {
  Smoothing s{smoothing_need(kSmoothedPosition, coupling_N_per_m, d.encoder_step_m, d.mass_kg, d.friction_N),
              smoothing_need(d.local_Hz > 0 ? kSmoothedFirmAngle : kSmoothedAngle, coupling_Nm_per_rad,
                             d.encoder_step_rad, d.inertia_kg_m2, d.friction_Nm),
              d.friction_N, d.friction_Nm};
  const bool own_steps = d.holds == HeldPart::kTool || d.holds == HeldPart::kTwoTools;
  s.position = own_steps && d.encoder_step_m > 0 && d.smooth_encoder.value_or(d.friction_N >= s.of_position.friction);
  s.angle = own_steps && d.encoder_step_rad > 0 && d.smooth_encoder.value_or(d.friction_Nm >= s.of_angle.friction);
  return s;
}

// The stiffest that a handle with that friction is held on its track at (rt_core/safety/handle_track.h): what is asked
// for grows with the stiffness, by its three-halves' power between two shares that bound it.
inline double track_stiffness_N_per_m(double friction_N, double step_m, double mass_kg) {
  double below = 0, above = 1e6;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (below + above);
    const double asked_N = friction_to_smooth(EncoderLaw::kMotion, kSmoothedPosition, middle, step_m, mass_kg);
    (asked_N <= friction_N ? below : above) = middle;
  }
  return below;
}

// What rings at a touch, as the resonator that a tick steps (rt_core/safety/contact_transient.h). Of A exp(-decay t)
// sin(w t) a tick changes at most A |1 - r exp(i w)|, w and r those of a tick: the height is lowered to where that is
// kRingStep of the largest force, half of what an output may change, for the contact itself changes it too.
inline void set_transient(const TransientDesc& t, double period_s, ModelParams& p) {
  constexpr double kRingStep = 0.05, kLeft = 0.01;
  if (!(t.amplitude_N_per_m_s > 0)) return;
  const double w = 2 * std::numbers::pi * t.frequency_Hz * period_s, r = std::exp(-t.decay_per_s * period_s);
  const double first = r * std::sin(w), step = std::sqrt(1 - 2 * r * std::cos(w) + r * r);
  p.transient_N_per_m_s = t.amplitude_N_per_m_s * first;
  p.transient_turn = 2 * r * std::cos(w);
  p.transient_kept = r * r;
  p.transient_most = std::min(1.0, kRingStep / step) * first;
  p.transient_ticks =
      static_cast<std::int32_t>(std::min(1e6, std::ceil(-std::log(kLeft) / (t.decay_per_s * period_s))));
}

// Needs p.coupling_N_per_m and p.coupling_Nm_per_rad.
inline void set_times(const SceneDesc& scene, ModelParams& p) {
  const DeviceDesc& d = scene.device;
  p.local_period_s = d.local_Hz > 0 ? 1 / d.local_Hz : 0;
  const Smoothing smoothing = smoothing_of(d, p.coupling_N_per_m, p.coupling_Nm_per_rad);
  // A device with a loop of its own smooths by itself, always.
  p.encoder_step_m = smoothing.position || d.local_Hz > 0 ? d.encoder_step_m : 0;
  p.encoder_step_rad = smoothing.angle ? d.encoder_step_rad : 0;
  p.encoder_law_m = smoothing.position && !(d.local_Hz > 0) ? smoothing.of_position.law : EncoderLaw::kMotion;
  if (p.encoder_law_m == EncoderLaw::kEdges)
    p.track_below_N_per_m = track_stiffness_N_per_m(d.friction_N, d.encoder_step_m, d.mass_kg);
  p.encoder_law_rad = smoothing.angle ? smoothing.of_angle.law : EncoderLaw::kMotion;
  const double late_s = d.local_Hz > 0 ? 0.5 * p.local_period_s : 0.5 * d.period_s + d.delay_s;
  p.coupling_Ns_per_m = is_auto(d.coupling_Ns_per_m) ? p.coupling_N_per_m * late_s : d.coupling_Ns_per_m;
  const Vec3 share = scene.material.relaxation_share, time_s = scene.material.relaxation_s;
  p.lost_share = scene.material.lost_share;
  const auto kept = [&](double s) { return std::exp(-d.period_s / s); };
  p.relax_share_1 = share.x, p.relax_share_2 = share.y, p.relax_share_3 = share.z;
  p.relax_kept_1 = kept(time_s.x), p.relax_kept_2 = kept(time_s.y), p.relax_kept_3 = kept(time_s.z);
  set_transient(scene.transient, d.period_s, p);
}

}  // namespace palpate
