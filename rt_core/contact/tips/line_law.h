// The normal law of a capsule's side on a half space: from a ball and Hertz' ellipse to a line with rounded ends.
#pragma once

#include "rt_core/contact/cubic_law.h"
#include "rt_core/lanes.h"

namespace palpate {

// How deep the tool's lowest line lies in the surface, x along the axis from where the tip stands:
//   d(x) = e - lowered + lean x - k x^2 / 2 on the straight part, and less c (x - end)^2 / 2R beyond either end,
// c = 1 of a round one, and more where the body ends before it.
// With J = int d^2 / 2, I = int d, l = int 1 over where d > 0, the energy stored is
//   E* C(L) (1 - X) J,   L = (1 + k_c R) I^5 / J^3 over a ball's,   X = 0.179 (J / I) / (R sqrt L),
// k_c the body's curvature across. L is Hertz' ratio of curvatures where no end is touched, and C what his integrals
// (1882) have it to be, sqrt 2 C = L^(-1/4) (1 + b z + c z^2) / (1 + a z), z = L^(1/4) + L^(-1/4) - 2: within 0.1 %
// for 1 <= L <= 1e4. X is a circle instead of a parabola. Forces, moment and stiffness are its slopes. Nothing is
// fitted to boundary elements, beside which the force is at most 2.1 % off for straight halves of 0 to 4 radii,
// curvatures along to 0.25 / R and depths of 0.02 to 0.3 R, leaning 7 % (2026-11-26, tests/elastic/test_line_law.cpp).
// Of a solid's edge, which meets others at its ends, J in the energy (not in L and X) is less by what it leaves to them
// of the ball there, as far as that goes beyond the end and back to the edge's middle: each of the edges that meet has
// one, and together they are to have one. The axis's own lean lowers the line towards the surface's tangent: lowered =
// (1 + k R) R lean^2 / 2, and d leans by (1 + k R) of it, so that one that leans far is the ball at its end, wherever
// it stands.
class LineLaw {
 public:
  // Of how deep it is: so near to a depth its tangent there tells the force within 1e-10 of it.
  static constexpr Real kNear = 1e-5;
  struct Shape {
    Real radius_m, left_m, right_m;      // straight so far on either side of where the tip stands
    Real left_end, right_end;            // c
    Real lean;                           // slope of the depth along the axis
    Real along_1_per_m, across_1_per_m;  // of the body; along not below zero
    bool is_circle;                      // otherwise a parabola
    // Of a solid's edge: what of the ball at either end other edges of that corner have where the edge does not lean.
    Real left_leaves = 0, right_leaves = 0;
  };
  // The share that an edge has of the ball at its end: `level` where it does not lean, and less the nearer it comes to
  // standing on that end, none within 12 degrees of it, so that such edges need not be looked at.
  static constexpr Real kStands = 0.04;
  static Real end_share(Real level, Real lean) PALPATE_RT {
    return level * max_of(1 - lean * lean - kStands, 0.0) * (1 / (1 - kStands));
  }
  struct Point {
    Real force_N, tangent_N_per_m, energy_J;
    Real root_force;  // cubic; a place's terms (line_energies) ask for it three times
  };
  struct Lean {
    Real to_pressure_m = 0;  // along the axis, from where the tip stands to where the force acts
    Real arm_m = 0;          // moment per lean and force about there, e held; C held, too
  };
  LineLaw() = default;  // of no shape yet
  // `modulus_Pa`: E*.
  LineLaw(const Shape& shape, Real modulus_Pa, Real depth_max_m) PALPATE_RT;
  // e: of a ball about the axis where the tip stands; beyond depth_max by the tangent. The last one is kept: a tick
  // asks for five of its sixteen twice and more.
  const Point& at(Real e_m) const PALPATE_RT {
    if (!(e_m == kept_at_m_)) keep(e_m);
    return kept_;
  }
  // The same, but kNear to the last by its tangent: what a last step of Newton's asks.
  Point near(Real e_m) const PALPATE_RT {
    if (!is_near(e_m)) return at(e_m);
    const Real more = e_m - kept_at_m_;
    const Point& p = kept_;
    return {p.force_N + more * p.tangent_N_per_m, p.tangent_N_per_m,
            p.energy_J + more * (p.force_N + 0.5 * more * p.tangent_N_per_m),
            p.root_force * (1.0 + more * p.tangent_N_per_m / (3.0 * p.force_N))};
  }
  Lean lean_at(Real e_m) const PALPATE_RT;
  Lean lean_near(Real e_m) const PALPATE_RT { return lean_at(is_near(e_m) ? kept_at_m_ : e_m); }
  // The same on the way back to where the line does not lean, at least arm_m: what is pressed at one end has next to no
  // moment to add by leaning farther, and all of it to lose by leaning back.
  Real arm_back_m(const Lean& leans, Real e_m) const PALPATE_RT;
  // Has Point::root_force, which is 0 otherwise.
  void tell_root() PALPATE_RT { needs_root_ = true; }
  // e at which the deepest place of the line touches.
  Real touches_at_m() const PALPATE_RT { return radius_m_ * touches_at_; }

 private:
  // Where the line is in the surface: lanes of the caps beyond the left and the right end, and the straight part.
  struct Spans {
    Double4 from, to;                        // caps: outwards from the end; straight: from where the tip stands
    Double4 depth;                           // at 0 there
    Real square, first, length, ends;        // 2 J, I, l, dl/de
    Real own_square, own_first, own_length;  // less what the ends leave of the balls there
    Double4 ball_half, ball_middle;          // outwards from the end
  };
  // Logarithms' slopes: of C by L's, and its second; X.
  struct Logs {
    Real energy;        // E / E* R^3
    Real falls, bends;  // -d ln C / d ln L, and its slope
    Real circle, left;  // X, 1 / (1 - X)
  };
  bool is_near(Real e_m) const PALPATE_RT {
    return abs_of(e_m - kept_at_m_) <= kNear * (kept_at_m_ - touches_at_m()) && kept_.force_N > 0;
  }
  void keep(Real e_m) const PALPATE_RT;
  bool measure(Real e) const PALPATE_RT;  // false: nothing of its own touches
  Spans spans_at(Real e) const PALPATE_RT;
  Logs logs_of(const Spans& spans) const PALPATE_RT;

  // Lengths in radii. Four numbers: left end, right end, and the straight part's left and right side.
  Real radius_m_, depth_max_, modulus_Pa_;
  Real left_, right_, tilt_, along_, rise_, across_, circle_;
  Real lowered_, touches_at_;
  Double4 beyond_, slope_, bend_, inverse_bend_;
  Double4 rises_, falls_;  // of the depth along a cap and the straight part: slope and half of the bend
  Double4 leaves_;         // of the balls at the ends, to others
  bool is_shared_, needs_root_ = false;
  mutable Real kept_at_m_, measured_at_;
  mutable Point kept_;
  mutable Spans spans_;
  mutable Logs logs_;
};

}  // namespace palpate
