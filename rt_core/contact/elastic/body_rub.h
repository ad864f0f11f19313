// Friction between one region and a body that it moves: the spring of friction.h with its far end on the moving
// surface. Within a linearisation of the tick it is linear in the step dp of the amplitudes,
//   force on the body = sum_i e_i (f_i - k_i g_i . dp),   g_ia = e_i . dx/dp_a,   e_1, e_2 tangential,
// so that a tip which sticks holds the body as stiffly as its spring, whatever the body's own stiffness is: with the
// last tick's friction as a load, every body softer than the spring would swing from tick to tick.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"
#include "rt_core/contact/friction.h"
#include "rt_core/contact/region_load.h"

namespace palpate {

struct RubAxis {
  Vec3 unit_w;
  Real force_N = 0;            // f: on the body
  Real stiffness_N_per_m = 0;  // k
  Real sweep[kMaxSoftModes];   // g
};

struct BodyRub {
  bool is_on = false;             // the region has a memory of friction
  bool slides = false;            // did in the last tick
  Vec3 stretch_w;                 // of the spring, had the surface held still: the last tick's and what the tool moved
  Vec3 moved_w;                   // by the surface
  Real spring_N_per_m = 0;        // of the last tick
  const Vec3* sweep_w = nullptr;  // ElasticRow::sweep_w; of a first touch too
  RubAxis axis[2];                // along the spring's stretch; across it
};

// Before the first linearisation. `motion_w`: of the tool's material since the last tick.
BodyRub begin_rub(const Region& region, Vec3 motion_w) PALPATE_RT;
// Axes, forces and stiffnesses of a tip that sticks: only the body's answer tells whether it slips.
void let_stick(const Model& model, const State& state, const ElasticRow& row, BodyRub& rub) PALPATE_RT;
// Those of one that slips, if it does by the law at `force_N` where the answer `step` puts it. False: it sticks.
bool let_slip(const FrictionParameters& law, Vec3 normal_w, Real force_N, const Real* step, std::int32_t soft,
              BodyRub& rub) PALPATE_RT;

}  // namespace palpate
