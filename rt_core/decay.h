// Where a number that decays ends. What is left of a velocity, a stretch or a count is kept times some share from tick
// to tick, and what is left of a tool's way to its balance is squared; neither ever reaches zero, but after a second or
// a minute at rest, the smallest numbers there are. Those are flushed (float_mode.h), and there processors differ:
// x86-64 asks after rounding whether a result is too small, AArch64 before, so that one that rounds up to 2^-1022 is
// kept by the one and zero by the other (tools_on_layer, 271 of 24,000 ticks, 2026-11-23). And a hand that keeps still
// should feel nothing change.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// In m, m/s, N or as a share: fifteen orders below what an addition to anything felt would round off (1e-3 m, 1e-16 of
// it), and its fourth power is still a normal number.
inline constexpr Real kNothing = 1e-30;

inline Real settled(Real x) PALPATE_RT { return x < kNothing && x > -kNothing ? 0.0 : x; }
inline Vec3 settled(Vec3 v) PALPATE_RT { return {settled(v.x), settled(v.y), settled(v.z)}; }
inline Quat settled(Quat q) PALPATE_RT { return {q.w, settled(q.x), settled(q.y), settled(q.z)}; }

}  // namespace palpate
