#include "rt_core/live_model.h"

namespace palpate {

namespace {

struct Range {
  double lowest, highest;
};

bool is_within(double x, Range range) PALPATE_RT { return x >= range.lowest && x <= range.highest; }

// `step`: the largest change. Ends at the wish itself.
void follow(double wanted, Range range, double step, double& now) PALPATE_RT {
  if (!is_within(wanted, range)) wanted = now;
  now = clamp_to(clamp_to(wanted, now - step, now + step), range.lowest, range.highest);
}

// A state spoilt in memory.
void mend(Range range, double& now) PALPATE_RT {
  if (!is_within(now, range)) now = 1;
}

#define PALPATE_FIELD(name, lowest, highest, key, meaning) constexpr Range kRange_##name{lowest, highest};
PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD

}  // namespace

void follow_settings(const LiveSettings& wanted, SettingsState& live) PALPATE_RT {
  live.moves = 0;
  if (live.changed == 0 && wanted == LiveSettings{}) return;
#define PALPATE_FIELD(name, lowest, highest, key, meaning) mend(kRange_##name, live.name);
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  const SettingsState before = live;
  const auto from = [](float x) PALPATE_RT { return static_cast<double>(x); };
  follow(from(wanted.stiffness), kRange_stiffness, kLiveStep * live.stiffness, live.stiffness);
  follow(from(wanted.friction), kRange_friction, kLiveStep, live.friction);
  follow(from(wanted.force_limit), kRange_force_limit, kLiveStep, live.force_limit);
  follow(from(wanted.coupling), kRange_coupling, kLiveStep * live.coupling, live.coupling);
  live.changed = 0;
#define PALPATE_FIELD(name, lowest, highest, key, meaning) \
  if (live.name != before.name) live.moves = 1;            \
  if (live.name != 1) live.changed = 1;
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
}

void apply(const SettingsState& live, ModelParams& params) PALPATE_RT {
  params.friction_k_N *= live.friction;
  params.friction_mu_dynamic *= live.friction;
  params.force_max_N *= live.force_limit;
  params.torque_max_Nm *= live.force_limit;
  params.coupling_N_per_m *= live.coupling;
  params.coupling_Nm_per_rad *= live.coupling;
  params.coupling_Ns_per_m *= live.coupling;
}

void apply_in_units_of_stiffness(const SettingsState& live, ModelParams& params) PALPATE_RT {
  apply(live, params);
  const double per_N = 1 / live.stiffness;
  params.force_max_N *= per_N;
  params.torque_max_Nm *= per_N;
  params.coupling_N_per_m *= per_N;
  params.coupling_Nm_per_rad *= per_N;
  params.coupling_Ns_per_m *= per_N;
  params.stop_force_N *= per_N;
  params.body_mass_kg *= per_N;
}

void to_newtons(const SettingsState& live, Scratch& scratch) PALPATE_RT {
  const double unit_N = live.stiffness;
  for (Wrench* wrench : {&scratch.contact_wrench_w, &scratch.other.contact_wrench_w, &scratch.palm_w}) {  // bound: 3
    wrench->force_N = unit_N * wrench->force_N;
    wrench->torque_Nm = unit_N * wrench->torque_Nm;
  }
  scratch.energy_J *= unit_N;
}

}  // namespace palpate
