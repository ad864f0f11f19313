#include "rt_core/contact/relaxation.h"

#include "rt_core/decay.h"

namespace palpate {

namespace {

// How far what rubs inside follows: within this share of s.
constexpr Real kFollows = 0.2;

// Takes the wrenches' part that is left.
void keep_part(State& state, Scratch& scratch, Real part) PALPATE_RT {
  for (Wrench* wrench : {&scratch.contact_wrench_w, &scratch.other.contact_wrench_w})  // bound: 2
    *wrench = {part * wrench->force_N, part * wrench->torque_Nm};
  for (Region& region : state.region)  // bound: kMaxRegions
    region.wrench_w = {part * region.wrench_w.force_N, part * region.wrench_w.torque_Nm};
}

// What rubs inside the body at s: its force as a part of the elastic one, 0 while s grows, -loss while it falls; its
// energy goes into `energy_J`.
Real rub(const ModelParams& p, Real s, State& state, Real& energy_J) PALPATE_RT {
  Real& q = state.followed_rootJ;
  if (!(q >= 0 && q < kHuge)) q = 0;  // a state spoilt in memory
  q = clamp_to(q, (1 - kFollows) * s, (1 + kFollows) * s);
  const Real loss = p.lost_share * ((1 + kFollows) / (1 - kFollows));
  energy_J += 0.5 * loss * (0.5 / kFollows * (s - q) * (s - q) - 0.5 * s * s);
  return s > 0 ? 0.5 * loss * ((s - q) / (kFollows * s) - 1) : 0;
}

}  // namespace

void relax(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  const ModelParams& p = model.params;
  if (!(p.relax_share_1 > 0 || p.lost_share > 0)) return;
  Vec3& r = state.relaxed_rootJ;
  if (!is_finite(r)) r = {};  // a state spoilt in memory
  const Vec3 share{p.relax_share_1, p.relax_share_2, p.relax_share_3};
  const Vec3 kept{p.relax_kept_1, p.relax_kept_2, p.relax_kept_3};
  const Real pressed = square_root(clamp_to(2 * scratch.energy_J, 0, kHuge));
  const Real surface = max_of(pressed, dot(share, r));  // where the body's own surface is
  r = settled(Vec3{kept.x * r.x + (1 - kept.x) * surface, kept.y * r.y + (1 - kept.y) * surface,
                   kept.z * r.z + (1 - kept.z) * surface});
  const Vec3 held = Vec3{surface, surface, surface} - r;
  const Real yielding = share.x * held.x * held.x + share.y * held.y * held.y + share.z * held.z * held.z;
  scratch.energy_J = 0.5 * ((1 - (share.x + share.y + share.z)) * surface * surface + yielding);
  Real part = pressed > 0 ? 1 - dot(share, r) / pressed : 0;
  if (p.lost_share > 0) part += rub(p, pressed, state, scratch.energy_J);
  keep_part(state, scratch, max_of(0, part));
}

}  // namespace palpate
