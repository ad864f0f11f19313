#include "rt_core/contact/friction/presliding.h"

#include "rt_core/math.h"

namespace palpate {

namespace {

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

}  // namespace palpate
