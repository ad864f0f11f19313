#include "rt_core/contact/friction.h"

#include "rt_core/contact/cubic_law_lanes.h"
#include "rt_core/contact/friction_lanes.h"
#include "rt_core/limits.h"
#include "rt_core/math.h"
#include "rt_core/tool/pose_lanes.h"

namespace palpate {

namespace {

// Stretches below this have no direction: a picometre.
constexpr Real kNoStretch_m = 1e-12;
// A force that equals the limit but for rounding still sticks.
constexpr Real kLimitSlack = 1.0 + 1e-12;

// What slides sticks again below this share of the sliding limit. At the limit itself it would stick in the first tick
// in which the encoder shows no motion, and then had to build up the static limit to break loose: 27 drops of 0.4 N in
// one slide of ellipsoid_mallet, more of them the finer the tick; with an exact encoder one.
constexpr Real kSticksAgain = 0.8;

// Shorter steps have no direction: a femtometre.
constexpr Real kNoStep_m = 1e-15;
// A stretch longer than the slip distance by rounding alone has not slid.
constexpr Real kRounding = 1.0 + 1e-12;

// Stretch after sliding by `distance` along unit vector e, from a point of the circle on its forward half. With the
// half-angle's tangent no angle is needed: cos = (1 - t^2)/(1 + t^2), sin = 2 t/(1 + t^2).
Vec3 dragged(Vec3 stretch, Vec3 e, Real distance, Real slip) PALPATE_RT {
  const Real along = clamp_to(dot(stretch, e) / slip, 0.0, 1.0);
  const Vec3 side = stretch - dot(stretch, e) * e;
  const Real aside = norm(side);
  if (!(aside > kNoStep_m)) return slip * e;
  const Real half = aside / slip / (1.0 + along) * math::exp(-min_of(distance / slip, 700.0));
  const Real scale = 1.0 / (1.0 + half * half);
  return slip * (scale * (1.0 - half * half) * e + (2.0 * half * scale / aside) * side);
}

// The tangential spring at a given normal depth: magnitude f(R) along the displacement, R^2 = depth^2 + stretch^2, of
// which the tangential component is f(R) stretch/R. Depth zero is the separable law f(stretch).
struct TangentialSpring {
  CubicLaw law;
  Real depth_m = 0;
};

Real reach_m(const TangentialSpring& spring, Real stretch) PALPATE_RT {
  return spring.depth_m > 0 ? square_root(spring.depth_m * spring.depth_m + stretch * stretch) : stretch;
}
// The spring at a stretch; asked for once, used for its force, stiffness and energy.
struct StretchedSpring {
  Real stretch = 0, reach = 0;
  LawPoint law;
  Real secant_N_per_m = 0;  // f(R)/R, with its limit k1 at zero
};
StretchedSpring stretched(const TangentialSpring& spring, Real stretch) PALPATE_RT {
  StretchedSpring at;
  at.stretch = stretch;
  at.reach = reach_m(spring, stretch);
  at.law = law_at(spring.law, at.reach);
  at.secant_N_per_m = at.reach > kNoStretch_m ? at.law.force_N / at.reach : spring.law.k1_N_per_m;
  return at;
}
Real force_N(const StretchedSpring& at) PALPATE_RT { return at.secant_N_per_m * at.stretch; }
Real tangent_N_per_m(const TangentialSpring& spring, const StretchedSpring& at) PALPATE_RT {
  if (!(at.reach > kNoStretch_m)) return spring.law.k1_N_per_m;
  const Real cosine = at.stretch / at.reach, sine = spring.depth_m / at.reach;
  return at.law.tangent_N_per_m * cosine * cosine + at.secant_N_per_m * sine * sine;
}
Real normal_gain_N(const TangentialSpring& spring, Real stretch) PALPATE_RT {
  if (!(spring.depth_m > 0)) return 0.0;
  return stretched(spring, stretch).secant_N_per_m * spring.depth_m - law_force_N(spring.law, spring.depth_m);
}

// Stretch at which the spring carries `force`. At fixed depth, and within the law's range, the tangential component
// (k1 + k3 (depth^2 + s^2)) s is again a cubic law. Beyond the range it is convex and increasing in s, and the cubic's
// root lies below its root, so Newton's first step lands above it and the rest fall onto it.
Real spring_stretch_m(const TangentialSpring& spring, Real force) PALPATE_RT {
  if (!(spring.depth_m > 0)) return law_depth_m(spring.law, force);
  const CubicLaw at_depth{spring.law.k1_N_per_m + spring.law.k3_N_per_m3 * spring.depth_m * spring.depth_m,
                          spring.law.k3_N_per_m3, kHuge};
  Real stretch = law_depth_m(at_depth, force);
  if (reach_m(spring, stretch) <= spring.law.max_depth_m) return stretch;
  for (std::int32_t i = 0; i < kInverseLawIterations; ++i) {  // bound: kInverseLawIterations
    const StretchedSpring at = stretched(spring, stretch);
    const Real tangent = tangent_N_per_m(spring, at);
    if (tangent > 0) stretch -= (force_N(at) - force) / tangent;
  }
  return max_of(stretch, 0.0);
}

// Mindlin's stiffness of this tick. When it grows the stretch shrinks so that the force is kept; when it falls the
// stretch stays.
Real follow_stiffness(const FrictionParameters& parameters, const FrictionLoad& load,
                      FrictionMemory& memory) PALPATE_RT {
  const Real stiffness = parameters.mindlin_ratio * max_of(load.tangent_N_per_m, 0.0);
  if (stiffness > memory.stiffness_N_per_m) {
    memory.stretch_w = (memory.stiffness_N_per_m / stiffness) * memory.stretch_w;
  }
  memory.stiffness_N_per_m = stiffness;
  return stiffness;
}

TangentialSpring tangential_spring(const FrictionParameters& parameters, const FrictionLoad& load,
                                   FrictionMemory& memory) PALPATE_RT {
  if (parameters.law != FrictionLaw::kMindlin) {
    return {parameters.contact, parameters.tangential == TangentialLaw::kRadial ? max_of(load.depth_m, 0.0) : 0.0};
  }
  return {{follow_stiffness(parameters, load, memory), 0.0, kHuge}, 0.0};
}

// K F^beta; roots instead of a general power for the exponents in common use.
Real power_law(Real k, Real force, Real beta) PALPATE_RT {
  if (beta == 1.0) return k * force;
  if (beta == 0.75) {
    const Real root = square_root(force);
    return k * (root * square_root(root));
  }
  return k * math::pow(force, beta);
}

FrictionForce spring_response(const TangentialSpring& spring, const StretchedSpring& at, Real depth_rate,
                              Vec3 direction) PALPATE_RT {
  FrictionForce result;
  result.force_w = -force_N(at) * direction;
  result.normal_gain_N = depth_rate * normal_gain_N(spring, at.stretch);
  result.energy_J = law_energy_J(spring.law, at.reach) - law_energy_J(spring.law, spring.depth_m);
  result.along_N_per_m = tangent_N_per_m(spring, at);
  result.across_N_per_m = at.secant_N_per_m;
  result.direction_w = direction;
  return result;
}

FrictionForce presliding_step(const FrictionParameters& parameters, const FrictionLoad& load, Vec3 step,
                              FrictionMemory& memory) PALPATE_RT {
  const Real limit = static_limit_N(parameters, load.force_N);
  const bool paper = parameters.law == FrictionLaw::kPreslidingPaper;
  const Real stiffness =
      paper ? (parameters.slip_m > 0 ? limit / parameters.slip_m : 0.0) : follow_stiffness(parameters, load, memory);
  const Real slip = paper ? parameters.slip_m : stiffness > 0 ? limit / stiffness : 0.0;
  const Presliding moved = preslide(tangential_part(memory.stretch_w, load.normal_w), step, slip);
  memory.stretch_w = moved.stretch_w;
  memory.mode = moved.sliding ? FrictionMode::kSlip : FrictionMode::kStick;
  const Real length = norm(moved.stretch_w);
  FrictionForce result;
  result.force_w = -stiffness * moved.stretch_w;
  result.energy_J = 0.5 * stiffness * length * length;
  result.direction_w = length > kNoStretch_m ? (1.0 / length) * moved.stretch_w : Vec3{};
  result.along_N_per_m = moved.ends_sliding ? 0.0 : stiffness;
  result.reversal_N_per_m = moved.ends_sliding ? stiffness : 0.0;
  result.across_N_per_m = stiffness;
  return result;
}

// static_limit_N() and, of those slipping, sliding_limit_N().
Double4 limits_N(const FrictionParameters& parameters, const Double4& normal_N, std::uint32_t slipping) PALPATE_RT {
  Double4 holds{};
  const Double4 huge = splat4(kHuge), normal = normal_N < huge ? normal_N : huge, root = square_root(normal);
  if (parameters.beta == 0.75)
    holds = splat4(parameters.k_N) * (root * square_root(root));
  else
    for (std::uint32_t k = 0; k < 4; ++k) holds[k] = power_law(parameters.k_N, normal[k], parameters.beta);  // bound: 4
  Double4 limit = where((normal_N > Double4{}) & (holds > Double4{}), holds, Double4{});
  for (; slipping != 0; slipping &= slipping - 1) {  // bound: 4
    const auto k = static_cast<std::uint32_t>(__builtin_ctz(slipping));
    limit[k] = sliding_limit_N(parameters, normal_N[k]);
  }
  return limit;
}

}  // namespace

Presliding preslide(Vec3 stretch, Vec3 step, Real slip_m) PALPATE_RT {
  if (!(slip_m > kNoStep_m)) return {{}, norm(step) > kNoStep_m, norm(step) > kNoStep_m};
  Presliding result{stretch, false};
  const Real before = norm(stretch);
  if (before > slip_m) {
    result.stretch_w = (slip_m / before) * stretch;
    result.sliding = before > slip_m * kRounding;
  }
  const Real length = norm(step);
  if (!(length > kNoStep_m)) return result;
  const Vec3 e = (1.0 / length) * step;
  const Real along = dot(result.stretch_w, e);
  const Real room = square_root(along * along - squared_norm(result.stretch_w) + slip_m * slip_m) - along;
  if (length <= room) {
    result.stretch_w += step;
    return result;
  }
  result.stretch_w = dragged(result.stretch_w + max_of(room, 0.0) * e, e, length - max_of(room, 0.0), slip_m);
  result.sliding = result.ends_sliding = true;
  return result;
}

FrictionParameters friction_parameters(const ModelParams& params) PALPATE_RT {
  FrictionParameters p;
  p.law = params.friction_law;
  p.tangential = params.tangential_law;
  p.k_N = params.friction_k_N;
  p.beta = params.friction_beta;
  p.mu_dynamic = params.friction_mu_dynamic;
  p.slip_m = params.friction_slip_m;
  p.mindlin_ratio = 2.0 * (1.0 - params.poisson_ratio) / (2.0 - params.poisson_ratio);
  p.contact = contact_law(params);
  return p;
}

Real static_limit_N(const FrictionParameters& parameters, Real normal_N) PALPATE_RT {
  if (!(normal_N > 0)) return 0.0;
  return max_of(power_law(parameters.k_N, min_of(normal_N, kHuge), parameters.beta), 0.0);
}

Real sliding_limit_N(const FrictionParameters& parameters, Real normal_N) PALPATE_RT {
  if (!(normal_N > 0)) return 0.0;
  return max_of(min_of(parameters.mu_dynamic * normal_N, static_limit_N(parameters, normal_N)), 0.0);
}

Real share_before_slip(const FrictionParameters& parameters, const FrictionForce& friction, Real normal_N,
                       Real way_m) PALPATE_RT {
  const Real more_N = friction.along_N_per_m * way_m;
  const Real left_N = static_limit_N(parameters, normal_N) - norm(friction.force_w);
  return more_N > left_N ? max_of(left_N, 0.0) / more_N : 1.0;
}

FrictionForce friction_step(const FrictionParameters& parameters, const FrictionLoad& load,
                            FrictionMemory& memory) PALPATE_RT {
  if (parameters.law == FrictionLaw::kNone) {
    memory = {};
    return {};
  }
  const bool first_touch = memory.mode == FrictionMode::kFree || !is_finite(memory.stretch_w);
  if (first_touch) memory = {{}, 0.0, FrictionMode::kStick};
  const Vec3 step = first_touch || !is_finite(load.step_w) ? Vec3{} : tangential_part(load.step_w, load.normal_w);
  if (is_presliding(parameters.law)) return presliding_step(parameters, load, step, memory);
  const TangentialSpring spring = tangential_spring(parameters, load, memory);
  const Vec3 start = tangential_part(memory.stretch_w, load.normal_w);
  const Vec3 trial = start + step;
  const Real length = norm(trial);
  const Vec3 direction = length > kNoStretch_m ? (1.0 / length) * trial : Vec3{};

  const bool paper = parameters.law == FrictionLaw::kPaper;
  const Real normal = load.force_N + load.depth_rate * normal_gain_N(spring, length);
  const bool sliding_on = memory.mode == FrictionMode::kSlip && !paper;
  const Real limit = sliding_on ? sliding_limit_N(parameters, normal) : static_limit_N(parameters, normal);
  const StretchedSpring tried = stretched(spring, length);
  const Real force = force_N(tried);
  if (force <= limit * kLimitSlack) {
    memory.mode = sliding_on && force > kSticksAgain * limit ? FrictionMode::kSlip : FrictionMode::kStick;
    memory.stretch_w = trial;
    return spring_response(spring, tried, load.depth_rate, direction);
  }
  memory.mode = FrictionMode::kSlip;
  // The radial law's normal force falls as the stretch is cut; where sliding is plain mu F the cut ends at mu depth.
  const Real cut = spring.depth_m > 0 ? min_of(length, parameters.mu_dynamic * spring.depth_m) : length;
  const Real sliding = sliding_limit_N(parameters, load.force_N + load.depth_rate * normal_gain_N(spring, cut));
  Vec3 slip_direction = direction;
  if (paper) {
    memory.stretch_w = start;
    slip_direction = unit_or(start, direction);
  } else {
    memory.stretch_w = spring_stretch_m(spring, sliding) * direction;
  }
  const Real kept = norm(memory.stretch_w);
  FrictionForce result = spring_response(spring, stretched(spring, kept), load.depth_rate, slip_direction);
  result.force_w = -sliding * slip_direction;
  result.reversal_N_per_m = result.along_N_per_m;
  result.along_N_per_m = 0.0;
  result.across_N_per_m = min_of(result.across_N_per_m, sliding / max_of(kept, kNoStretch_m));
  return result;
}

bool sticks_by_fours(const FrictionParameters& parameters) PALPATE_RT {
  return parameters.law == FrictionLaw::kReturnMap && parameters.tangential == TangentialLaw::kSeparable;
}

Sticking4 stick_four(const FrictionParameters& parameters, const FrictionLoad4& load, const Vec3x4& stretch_w,
                     std::uint32_t touched, std::uint32_t slipping) PALPATE_RT {
  const Vec3x4 start = tangential_part(stretch_w, load.normal_w), step = tangential_part(load.step_w, load.normal_w);
  const Vec3x4 trial = start + step;
  const Double4 length = length_of(trial), k1 = splat4(parameters.contact.k1_N_per_m);
  const Mask4 has_way = length > splat4(kNoStretch_m);
  const LawPoint4 tried = law_at(parameters.contact, length);
  const Double4 secant = where(has_way, tried.force_N / length, k1), force = secant * length;
  const Double4 limit = limits_N(parameters, load.force_N, slipping);
  Sticking4 four;
  four.which = touched & bits_of(force <= limit * splat4(kLimitSlack));
  four.slip = slipping & bits_of(force > splat4(kSticksAgain) * limit);
  four.stretch_w = trial;
  four.direction_w = where(has_way, (splat4(1.0) / length) * trial, Vec3x4{});
  four.force_w = -force * four.direction_w;
  four.energy_J = law_energy_J(parameters.contact, length);
  four.along_N_per_m = where(has_way, tried.tangent_N_per_m, k1);
  four.across_N_per_m = secant;
  return four;
}

}  // namespace palpate
