// The virtual coupling: a 6-DOF spring between the device handle and the virtual tool, never stiffer than the device
// admits, so that however stiff the object is, the hand feels at most the coupling (Colgate, Stanley & Brown 1995).
// The tool is massless; its equilibrium is tracked by a predictor (how far the tool follows the handle, with the last
// contact tangent) and one Newton correction per tick with the contact evaluated at the predicted pose. For a linear
// contact that is exact within the tick; for the cubic law it is Newton's method spread over ticks.
#pragma once

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Small rigid motion: translation of the tool origin (m) and rotation vector (rad), world axes.
struct Twist {
  Vec3 translation_m;
  Vec3 rotation_rad;
};

// Motion that carries `from` onto `to`. Valid for rotations well below a radian.
Twist twist_between(const Pose& from, const Pose& to) PALPATE_RT;
// `pose` moved by `twist`; its rotation is renormalised.
Pose moved(const Pose& pose, const Twist& twist) PALPATE_RT;

// Tool motion that follows a handle motion: (K_contact + K_coupling)^-1 K_coupling * handle, K_contact the tangent of
// `state`. A region that slips has no stiffness along its stretch, but only forwards: where the motion would turn it
// back its elastic stiffness counts. (Without that the tool, which has no mass, is thrown from one sense of sliding to
// the other in every tick, for ever: measured as 3.3 N at 500 Hz on the handle.) Returns false, with `tool` equal to
// `handle`, when the system is singular. Adds to `landings` what landing.h counts. Bound: kMaxRegions, two solves.
bool follow(const Model& model, const State& state, const Twist& handle, Twist& tool,
            std::int32_t& landings) PALPATE_RT;

// Newton correction of the tool pose: (K_contact + K_coupling)^-1 (contact wrench + coupling wrench), with the same
// care. Returns false, with `correction` zero, when the system is singular. Adds to `held`, if given, what landing.h
// holds the tool by.
bool correct(const Model& model, const State& state, const Wrench& contact_w, const Wrench& coupling_on_tool_w,
             Twist& correction, std::int32_t& landings, ContactStiffness* held) PALPATE_RT;

// Where the tool goes under this tick's contact wrench: scratch.tool_corrected_w. As it is when something drives it;
// where it was when the wrench is no number. Status: kCouplingSingular.
void balance_tool(const Model& model, const State& state, Scratch& scratch) PALPATE_RT;

// Where the coupling is held at its end: at the handle, or, where that would stretch it beyond the device's largest
// force or torque, as far from `tool_w` towards the handle as they reach. The force is limited where it arises: a hand
// that beats the motors presses the virtual tool with what they have, not with what the spring would make of it. (The
// coupling as a spring from the handle itself wound up to 104 N behind motors of 8.5 N, and the tool alternated, fell
// off crowns and went through plates; 2026-11-22.) Status: kForceClamped, kTorqueClamped. A device without torque has
// no such limit: its tool turns with the handle.
Pose held_end(const Model& model, const Pose& device_w, const Pose& tool_w, std::uint32_t& status) PALPATE_RT;

// Share of the coupling's largest stretch F_max / K by which the tool may move in a tick beyond the handle's own
// motion: what a slip or a snap makes of the force in one. 8 % left steps of 4.7 % (slips) to 8.8 % (snap_in_paper) on
// the scenes' own paths; 1 % leaves 1.0 % and 1.0 %, and a snap takes some ten ticks (2026-11-23). The laws of friction
// that give energy back keep kToolStepShare.
inline constexpr Real kCalmStepShare = 0.01;
// And no faster than so: of a coupling of 84 N/m behind 20 N 1 % is 2.4 mm, by which a tube that had slipped off one
// arm of a clip was inside the other in the next tick, and the model said 200 to 1,700 N (2026-11-26).
inline constexpr Real kCalmSpeed_m_per_s = 0.25;
// A fast hand's tool may go by itself as far as this share of the hand's way, up to kToolStepShare: with 1 % alone a
// tool pushed at 0.5 m/s through the thin clip of snap_in_paper lay up to 2 mm in it without contact, with a tenth 0.5
// mm (scenes.PushedThrough); with 0.4 the force alternated once in three scenes' pushes (2026-11-23).
inline constexpr Real kFollowShare = 0.25;

// The same as `tool_w`, or as far from where the last tick left the tool as it may go in one: by the handle's own
// motion and what these shares allow. A massless tool that slips or loses contact would be thrown into another state of
// contact, and back in the next tick. Status: kToolHeldBack.
Pose within_step(const Model& model, const State& state, const Pose& tool_w, std::uint32_t& status) PALPATE_RT;

// Wrench of the coupling spring on the handle, about the handle's origin: pulls the handle towards the tool.
Wrench coupling_wrench(const Model& model, const Pose& device_w, const Pose& tool_w) PALPATE_RT;

// How the coupling's force answers a motion of the handle's origin, its turn held: coupling and contact in series,
// Kc - Kc^2 [(K_contact + Kc)^-1] of the translations. Symmetric, positive semi-definite and below Kc by construction;
// with what is told besides contact's tangent (Scratch::told_besides); zero where the tool touches nothing and has come
// to nothing, and where nobody asks. Bound: one factor, three solves; price in work.h.
struct FeltStiffness {
  Vec3 along;   // xx, yy, zz
  Vec3 across;  // yz, xz, xy
};
inline Vec3 operator*(const FeltStiffness& felt, Vec3 way_m) PALPATE_RT {
  const Vec3 d = felt.along, o = felt.across, x = way_m;
  return {d.x * x.x + o.z * x.y + o.y * x.z, o.z * x.x + d.y * x.y + o.x * x.z, o.y * x.x + o.x * x.y + d.z * x.z};
}
inline FeltStiffness operator*(Real share, const FeltStiffness& felt) PALPATE_RT {
  return {share * felt.along, share * felt.across};
}
// A device that evaluates it, or a handle that may go on to its track.
inline bool asks_what_is_felt(const ModelParams& p) PALPATE_RT {
  return p.local_period_s > 0 || p.track_below_N_per_m > 0;
}
FeltStiffness felt_stiffness(const Model& model, const State& state, const Scratch& scratch) PALPATE_RT;

// Share of `felt` that the handle meets between two times of a motion that goes on as in the last tick, in ticks from
// now (-1: the sample before): the secant of a spring whose force ends at F_max. From 1 where all of the motion is
// below the limit to 0 where all of it lies beyond, and in between what is left before F_max.
Real share_below_limit(const Model& model, const State& state, const FeltStiffness& felt, Real from_ticks,
                       Real to_ticks) PALPATE_RT;

// What a device that evaluates F - K (x - p) is told. At F_max the handle is beyond the end at which the coupling is
// held: p is then that end, where the spring begins to let go, and the device's own limit cuts what would be more,
// which is the scene's (profile_contradictions of hal/device/device_profile.h). Farther beyond than it may come back
// while the command is in force K is 0. Where something takes from F_max (a brake, a setting, a ramp) p is the handle
// and K the share above. Before, K was 0 as soon as the force was at its limit, and a push at 0.5 m/s on
// tools_on_cylinder held F_max for the tick in which the hand had come back into the spring: a step of 20 %, and with
// 3 ms of delay 4.0 mJ to the hand in a tap (2026-11-25).
struct LocalFelt {
  FeltStiffness felt;
  Vec3 point_w_m;
};
LocalFelt local_felt(const Model& model, const State& state, const FeltStiffness& felt) PALPATE_RT;

}  // namespace palpate
