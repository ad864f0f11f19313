// Friction of one contact region: a tangential spring (the stretch of the body's surface) that slips at a limit.
#pragma once

#include "rt_core/contact/cubic_law.h"
#include "rt_core/state.h"
#include "rt_core/vec.h"

namespace palpate {

struct FrictionParameters {
  FrictionLaw law = FrictionLaw::kReturnMap;
  TangentialLaw tangential = TangentialLaw::kSeparable;
  Real k_N = 0;            // K of the static limit K F^beta, N^(1 - beta)
  Real beta = 1;           // 2/3 (Hertz area times constant shear strength) to 1 (Coulomb)
  Real mu_dynamic = 0;     // of sliding
  Real slip_m = 1e-4;      // stretch at which kPreslidingPaper slides
  Real mindlin_ratio = 1;  // tangential over normal stiffness, 2 (1 - nu)/(2 - nu): Mindlin 1949
  CubicLaw contact;        // law of the tangential spring, the same as the normal one (Luo & Xiao 2006)
};

FrictionParameters friction_parameters(const ModelParams& params) PALPATE_RT;

// What survives a tick.
struct FrictionMemory {
  Vec3 stretch_w;              // tangential: material point minus origin of deformation, m
  Real stiffness_N_per_m = 0;  // of the last tick (Mindlin variant)
  FrictionMode mode = FrictionMode::kFree;
};

// This tick's normal contact. kFree in the memory means first touch: the stretch starts at zero.
struct FrictionLoad {
  Vec3 step_w;               // tangential motion of the tool material since the last tick, m
  Vec3 normal_w;             // unit
  Real force_N = 0;          // normal force of the contact law, >= 0
  Real depth_m = 0;          // equivalent normal depth: law_depth_m(force_N)
  Real tangent_N_per_m = 0;  // normal stiffness (Mindlin variant)
  Real depth_rate = 1;       // change of depth_m per unit of normal approach (radial law); 1 for a single point
};

struct FrictionForce {
  Vec3 force_w;               // on the tool, tangential
  Real normal_gain_N = 0;     // added to the normal force (radial law: the stretch stiffens the normal direction too)
  Real energy_J = 0;          // stored by the stretch
  Real along_N_per_m = 0;     // tangent stiffness along the stretch; zero while slipping
  Real across_N_per_m = 0;    // and across it, in the tangent plane
  Real reversal_N_per_m = 0;  // while slipping: along the stretch, for motion back; else 0
  Vec3 direction_w;           // unit vector of the stretch; zero where it has none
};

// Largest tangential force before slip, K F^beta, and while slipping, min(mu_dynamic F, K F^beta). Zero for F <= 0,
// NaN.
Real static_limit_N(const FrictionParameters& parameters, Real normal_N) PALPATE_RT;
Real sliding_limit_N(const FrictionParameters& parameters, Real normal_N) PALPATE_RT;

// What sticks slips before long: the share of its stiffness along the stretch that a motion of `way_m` along the
// surface meets on the whole, from 1 where it ends below the static limit.
Real share_before_slip(const FrictionParameters& parameters, const FrictionForce& friction, Real normal_N,
                       Real way_m) PALPATE_RT;

// One tick of the stick/slip machine.
// kReturnMap (default): on slip the stretch is shortened, along itself, to the length that carries the sliding limit,
// so
//   friction turns with the motion; never gives back more energy than was put in. What slides goes on under the sliding
//   limit, however small its steps, until the force has fallen below 0.8 of it.
// kPaper (Luo & Xiao 2006): on slip the origin moves by the whole step, so the stretch keeps its direction for ever.
//   Kept to reproduce the paper's figures: friction on a circular path does almost no work.
// kMindlin: linear tangential spring, a fixed ratio of the normal stiffness. When the stiffness grows the stretch
// shrinks
//   so that the force is kept; when it falls the stretch stays. The plain product k_t(D) s would be active: shifting
//   under low load and back under high load gives energy away.
// kPresliding: kMindlin's spring, but the stretch saturates at the limit over its stiffness by the exact rule of
//   preslide(): independent of the step, free of drift, passive when the normal force changes. It slides at the
//   static limit.
// kPreslidingPaper (Hayward & Armstrong 2000, as Mahvash & Hayward 2002 use it): a constant slip distance, with the
//   force proportional to limit and stretch. Active when the load changes: kappa (F_2 - F_1) s^2 / 2 of each loop.
FrictionForce friction_step(const FrictionParameters& parameters, const FrictionLoad& load,
                            FrictionMemory& memory) PALPATE_RT;

// Pre-sliding in two tangential dimensions: an elastic displacement that saturates, after Dahl (1976) and Hayward &
// Armstrong (2000), in the form that neither drifts nor depends on the number of steps.
struct Presliding {
  Vec3 stretch_w;             // elastic displacement, |stretch| <= slip
  bool sliding = false;       // some of the step slid, or the limit fell below the stretch
  bool ends_sliding = false;  // the step's end slid: further motion along it meets no stiffness
};

// Moves the contact by `step` in the tangent plane with the elastic displacement bounded by slip_m >= 0. Exact for a
// straight step at constant slip distance, hence the same for any division of it: first the elastic part, up to the
// circle |stretch| = slip, then the tractrix along which a point dragged at that distance follows, tan(phi'/2) =
// tan(phi/2) exp(-r / slip), phi the angle from step to stretch, r the sliding part. (A radial return is of first
// order only: after a turn by 90 degrees it errs by up to 14 % of the slip distance.) The adhesion point does not move
// at all below slip: encoder dither cannot make it creep, as it does under Dahl's law. `stretch` and `step` must be
// finite.
Presliding preslide(Vec3 stretch, Vec3 step, Real slip_m) PALPATE_RT;

}  // namespace palpate
