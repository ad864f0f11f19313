#include "rt_core/contact/relaxation.h"

namespace palpate {

void relax(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  const ModelParams& p = model.params;
  if (!(p.relax_share_1 > 0)) return;
  Vec3& r = state.relaxed_rootJ;
  if (!is_finite(r)) r = {};  // a state spoilt in memory
  const Vec3 share{p.relax_share_1, p.relax_share_2, p.relax_share_3};
  const Vec3 kept{p.relax_kept_1, p.relax_kept_2, p.relax_kept_3};
  const Real pressed = square_root(clamp_to(2 * scratch.energy_J, 0, kHuge));
  const Real surface = max_of(pressed, dot(share, r));  // where the body's own surface is
  r = {kept.x * r.x + (1 - kept.x) * surface, kept.y * r.y + (1 - kept.y) * surface,
       kept.z * r.z + (1 - kept.z) * surface};
  const Real part = pressed > 0 ? max_of(0, 1 - dot(share, r) / pressed) : 0;
  scratch.contact_wrench_w = {part * scratch.contact_wrench_w.force_N, part * scratch.contact_wrench_w.torque_Nm};
  for (Region& region : state.region)  // bound: kMaxRegions
    region.wrench_w = {part * region.wrench_w.force_N, part * region.wrench_w.torque_Nm};
  const Vec3 held = Vec3{surface, surface, surface} - r;
  const Real yielding = share.x * held.x * held.x + share.y * held.y * held.y + share.z * held.z * held.z;
  scratch.energy_J = 0.5 * ((1 - (share.x + share.y + share.z)) * surface * surface + yielding);
}

}  // namespace palpate
