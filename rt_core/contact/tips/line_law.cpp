#include "rt_core/contact/tips/line_law.h"

#include "rt_core/math.h"

namespace palpate {

namespace {

// Of Hertz' C.
constexpr Real kA = 0.231289, kB = 0.557922, kC = 0.0467396;
constexpr Real kRoot2 = 1.4142135623730951;
// I^5 / J^3 of a ball: (4/3 sqrt 2)^5 / (8/15 sqrt 2)^3.
constexpr Real kBall =
    2.0 * (4.0 / 3) * (4.0 / 3) * (4.0 / 3) * (4.0 / 3) * (4.0 / 3) / ((8.0 / 15) * (8.0 / 15) * (8.0 / 15));
// A ball's force is 4/3 D^1.5 (1 - D / 10): half of 5/14 of J / I = 2/5 D in the energy.
constexpr Real kCircle = 2.5 / 14;
constexpr Real kLeast = 1e-12;
constexpr Real kPlace = 0.7745966692414834;  // of Gauss' three points, sqrt 0.6

Double4 at_least(const Double4& a, Real b) PALPATE_RT { return a > b ? a : splat4(b); }

// Of spans whose depth is d + rises t + falls t^2, each: int d and int d^2.
struct Integrals {
  Double4 first, square;
  Integrals(const Double4& half, const Double4& middle, const Double4& depth, const Double4& rises,
            const Double4& falls) PALPATE_RT {
    // From the middle the depth is d0 + d1 x + d2 x^2, x from -1 to 1.
    const Double4 bent = falls * middle, d0 = depth + middle * (rises + bent), d1 = half * (rises + 2 * bent);
    const Double4 d2 = half * half * falls;
    first = half * (2 * d0 + (2.0 / 3) * d2);
    square = half * (2 * d0 * d0 + (2.0 / 3) * (d1 * d1 + 2 * d0 * d2) + 0.4 * d2 * d2);
  }
};

// use(share, place t, depth there) at Gauss' three places of every span.
template <class Use>
void at_gauss_places(const Double4& half, const Double4& middle, const Double4& depth, const Double4& rises,
                     const Double4& falls, const Use& use) PALPATE_RT {
  for (const Real k : {-kPlace, 0.0, kPlace}) {  // bound: 3
    const Double4 t = middle + k * half;
    use(k == 0 ? 8.0 / 9 : 5.0 / 9, t, depth + t * (rises + t * falls));
  }
}

}  // namespace

LineLaw::LineLaw(const Shape& s, Real modulus_Pa, Real depth_max_m) PALPATE_RT {
  const Real inverse = 1.0 / s.radius_m;
  kept_at_m_ = measured_at_ = kHuge;
  kept_ = {};
  radius_m_ = s.radius_m;
  modulus_Pa_ = modulus_Pa;
  depth_max_ = depth_max_m * inverse;
  left_ = s.left_m * inverse;
  right_ = s.right_m * inverse;
  along_ = s.along_1_per_m * s.radius_m;
  across_ = max_of(1 + s.across_1_per_m * s.radius_m, 0.25);
  circle_ = s.is_circle ? kCircle : 0.0;
  is_shared_ = s.left_leaves > 0 || s.right_leaves > 0;
  leaves_ = Double4{s.left_leaves > 0 ? 1 - end_share(1 - s.left_leaves, s.lean) : 0.0,
                    s.right_leaves > 0 ? 1 - end_share(1 - s.right_leaves, s.lean) : 0.0, 0, 0};
  rise_ = 1 + along_;
  tilt_ = rise_ * s.lean;
  lowered_ = 0.5 * rise_ * s.lean * s.lean;
  const Real off_left = -left_ * (tilt_ + 0.5 * along_ * left_), off_right = right_ * (tilt_ - 0.5 * along_ * right_);
  const Real g_left = -tilt_ - along_ * left_, g_right = tilt_ - along_ * right_;
  beyond_ = Double4{off_left, off_right, off_left, off_right};
  slope_ = Double4{g_left, g_right, -g_left, -g_right};
  bend_ = Double4{along_ + s.left_end, along_ + s.right_end, along_, along_};
  inverse_bend_ = Double4{1.0 / bend_[0], 1.0 / bend_[1], 0, 0};
  rises_ = Double4{g_left, g_right, tilt_, 0};
  falls_ = -0.5 * Double4{bend_[0], bend_[1], along_, 0};
  // The deepest place: on the cap that the line falls towards, or before it.
  const Real g = tilt_ > 0 ? g_right : g_left, off = tilt_ > 0 ? off_right : off_left;
  const Real by_end = tilt_ > 0 ? inverse_bend_[1] : inverse_bend_[0];
  const Real peak = g > 0 ? off + 0.5 * g * g * by_end : along_ > 0 ? 0.5 * tilt_ * tilt_ / along_ : 0.0;
  touches_at_ = lowered_ - peak;
}

// Roots of the parabolas, 2 A + 2 B t - bend t^2 = 0 with the depth A and the slope B outwards at either end.
LineLaw::Spans LineLaw::spans_at(Real e) const PALPATE_RT {
  const Real here = e - lowered_;
  const Double4 at_end = splat4(here) + beyond_;
  const Double4 root = square_root(at_least(slope_ * slope_ + 2 * bend_ * at_end, 0.0));
  // Caps: both roots, outwards. Straight part: how far the surface is left before the end.
  const Double4 near = at_least(inverse_bend_ * (slope_ - root), 0.0);
  const Double4 far = at_least(inverse_bend_ * (slope_ + root), 0.0);
  const Double4 above = at_least(-at_end, 0.0), before = 2 * above / at_least(slope_ + root, kLeast);
  const Real whole = left_ + right_, left = min_of(before[2], whole) - left_, right = right_ - min_of(before[3], whole);
  Spans s;
  // The fourth span is empty, at `left` and not at 0: for (left, 0) the assembler may write vmovq as 0F D6 between two
  // registers, which valgrind 3.19 does not know, and the gates that count instructions stop there.
  s.from = Double4{near[0], near[1], left, left};
  s.to = Double4{max_of(far[0], near[0]), max_of(far[1], near[1]), max_of(right, left), left};
  s.depth = Double4{at_end[0], at_end[1], here, 0};
  const Double4 half = 0.5 * (s.to - s.from);
  const Integrals all(half, 0.5 * (s.to + s.from), s.depth, rises_, falls_);
  s.own_first = s.first = sum(all.first);
  s.own_square = s.square = sum(all.square);
  s.own_length = s.length = 2 * sum(half);
  if (is_shared_) {
    const Double4 from = at_least(inverse_bend_ * (slope_ - root), -0.5 * whole), to = inverse_bend_ * (slope_ + root);
    s.ball_half = 0.5 * (at_least(to - from, 0.0));
    s.ball_middle = from + s.ball_half;
    const Integrals balls(s.ball_half, s.ball_middle, s.depth, rises_, falls_);
    s.own_first -= sum(leaves_ * balls.first);
    s.own_square -= sum(leaves_ * balls.square);
    s.own_length -= 2 * sum(leaves_ * s.ball_half);
  }
  const Double4 inverse = 1.0 / at_least(root, kLeast);
  const bool straight = s.to[2] > s.from[2];
  // Caps that are met, twice where both roots are beyond the end; sides of a straight part that ends before it.
  s.ends = (s.to[0] > s.from[0] ? (near[0] > 0 ? 2.0 : 1.0) * inverse[0] : 0.0) +
           (s.to[1] > s.from[1] ? (near[1] > 0 ? 2.0 : 1.0) * inverse[1] : 0.0) +
           (straight && above[2] > 0 ? inverse[2] : 0.0) + (straight && above[3] > 0 ? inverse[3] : 0.0);
  return s;
}

LineLaw::Logs LineLaw::logs_of(const Spans& s) const PALPATE_RT {
  const Real j = 0.5 * s.square, i2 = s.first * s.first;
  const Real ratio = across_ * i2 * i2 * s.first / (kBall * j * j * j);
  const Real root = square_root(ratio), w = square_root(root), inverse = 1.0 / w, z = w + inverse - 2;
  const Real over = 1 + kA * z, under = 1 + z * (kB + kC * z), ua = kA / over, ub = (kB + 2 * kC * z) / under;
  const Real z1 = 0.25 * (w - inverse), z2 = 0.0625 * (w + inverse);  // slopes of z in ln L
  Logs l;
  l.circle = circle_ * j / (s.first * root);
  const Real less = 1 - l.circle;
  l.left = 1.0 / less;
  l.energy = inverse * under / (over * kRoot2) * less * (0.5 * s.own_square);
  l.falls = 0.25 + z1 * (ua - ub);
  l.bends = z2 * (ua - ub) - z1 * z1 * (ua * ua + 2 * kC / under - ub * ub);
  return l;
}

bool LineLaw::measure(Real e) const PALPATE_RT {
  if (!(e == measured_at_)) {
    measured_at_ = e;
    spans_ = spans_at(e);
    if (spans_.own_first > 0 && spans_.own_square > 0) logs_ = logs_of(spans_);
  }
  return spans_.own_first > 0 && spans_.own_square > 0;
}

void LineLaw::keep(Real e_m) const PALPATE_RT {
  const Real whole = min_of(e_m, kHuge) / radius_m_, e = min_of(whole, depth_max_), beyond = whole - e;
  Point& out = kept_;
  kept_at_m_ = e_m;
  out = {};
  if (!measure(e)) return;
  const Spans& s = spans_;
  const Logs& l = logs_;
  // ln E = ln C + ln J + ln (1 - X), q = J / I, ln L = 5 ln I - 3 ln J, ln X = ln q - ln L / 2; its own J only in the
  // second term.
  const Real i1 = 1.0 / s.first, q = 0.5 * s.square * i1, lq = 1.0 / q, li = s.length * i1;
  const Real ratio1 = 5 * li - 3 * lq, q1 = 1 - li * q;             // q': of q
  const Real li1 = s.ends * i1 - li * li, q2 = -li1 * q - li * q1;  // q''
  const Real lq1 = -q1 * lq * lq, ratio2 = 5 * li1 - 3 * lq1;
  const Real x1 = q1 * lq - 0.5 * ratio1, x2 = (q2 - q1 * q1 * lq) * lq - 0.5 * ratio2;
  const Real x = l.circle * l.left;
  Real own = lq, own1 = lq1;
  if (is_shared_) {
    const Real per_j = 2.0 / s.own_square;
    own = s.own_first * per_j;
    own1 = s.own_length * per_j - own * own;
  }
  const Real by = -l.falls * ratio1 + own - x * x1;
  const Real by2 = -l.falls * ratio2 - l.bends * ratio1 * ratio1 + own1 - x * (x2 + x1 * x1 * l.left);
  const Real unit = modulus_Pa_ * radius_m_, force = l.energy * by, tangent = l.energy * (by * by + by2);
  out.tangent_N_per_m = unit * tangent;
  out.force_N = unit * radius_m_ * (force + tangent * beyond);
  if (needs_root_) out.root_force = math::cbrt(out.force_N);
  out.energy_J = unit * radius_m_ * radius_m_ * (l.energy + beyond * (force + 0.5 * tangent * beyond));
}

LineLaw::Lean LineLaw::lean_at(Real e_m) const PALPATE_RT {
  Lean out;
  if (!measure(min_of(min_of(e_m, kHuge) / radius_m_, depth_max_))) return out;
  const Spans& s = spans_;
  const Logs& l = logs_;
  const Double4 place = {-left_, right_, 0, 0}, way = {-1, 1, 1, 0};
  const Double4 half = 0.5 * (s.to - s.from), middle = 0.5 * (s.to + s.from);
  Double4 moment{}, arm{}, square{};
  const auto add = [&](Real share, const Double4& t, const Double4& d) PALPATE_RT {
    const Double4 x = place + way * t, w = share * x;
    arm += w;
    moment += w * d;
    square += w * x;
  };
  at_gauss_places(half, middle, s.depth, rises_, falls_, add);
  const Real j = 0.5 * s.square, i1 = 1.0 / s.first, by_i = i1 * sum(half * arm), by_j = sum(half * moment) / j;
  const Real li = s.length * i1, lq = s.first / j, x = l.circle * l.left, own_j = 0.5 * s.own_square;
  const auto slope = [&](Real of_i, Real of_j, Real of_own) PALPATE_RT {
    return of_own - l.falls * (5 * of_i - 3 * of_j) - x * (2.5 * of_j - 3.5 * of_i);
  };
  Real own = by_j;
  if (is_shared_) {
    Double4 less{};
    const auto add_ball = [&](Real share, const Double4& t, const Double4& d)
                              PALPATE_RT { less += share * d * (place + way * t); };
    at_gauss_places(s.ball_half, s.ball_middle, s.depth, rises_, falls_, add_ball);
    own = (sum(half * moment) - sum(leaves_ * s.ball_half * less)) / own_j;
  }
  const Real force = slope(li, lq, is_shared_ ? s.own_first / own_j : lq), pressed = slope(by_i, by_j, own) / force;
  out.to_pressure_m = radius_m_ * (rise_ * pressed - tilt_);
  const Real spread = sum(half * square) - pressed * (2 * sum(half * arm) - pressed * s.length);
  out.arm_m = radius_m_ * max_of(rise_ * (rise_ * spread * i1 - 1), 0.0);
  return out;
}

// A chord of the pressure's place over the lean, which bends from its ends towards the level: no step along the chord
// goes beyond. Level, what touches is h to either side and d deep, and the arm that of a bed of springs, h^2 / 3 d, or
// up to 1.3 times as much, for the depth changes with the lean where the force is held: no chord is steeper than 1.5.
Real LineLaw::arm_back_m(const Lean& leans, Real e_m) const PALPATE_RT {
  const Real deep = min_of(e_m / radius_m_, depth_max_) - touches_at_, lean = tilt_ / rise_, slope = abs_of(lean);
  if (!(deep > 0)) return leans.arm_m;
  const Real wet = along_ > 0 ? square_root(2 * deep / along_) : kHuge;
  const Real left = min_of(left_, wet), right = min_of(right_, wet), half = 0.5 * (left + right);
  const Real off = leans.to_pressure_m - 0.5 * radius_m_ * (right - left), rise = half * slope;
  if (!(off * lean > 0)) return leans.arm_m;
  const Real level = deep > 2 * rise ? deep - rise : deep * deep / (4 * rise);
  return max_of(leans.arm_m, min_of(off / lean, radius_m_ * half * half / (2 * level)));
}

}  // namespace palpate
