// One tip on the carried surface x = X + u(X; p) of an elastic body.
#pragma once

#include "rt_core/contact/elastic/soft_energy.h"
#include "rt_core/contact/tips/line_law.h"
#include "rt_core/state.h"
#include "rt_core/surface/body_box.h"
#include "rt_core/surface/smooth_foot.h"

namespace palpate {

// What one tip's look for the surface may open of its hierarchy: a place it comes near to needs less, and one in the
// middle of the body, where every face is as near, has no face of its own. What is found counts, and the next tick goes
// on from there; how far the surface is at least stays true.
inline constexpr std::int32_t kMaxTipSearched = 32;
// Boxes and triangles that a tick may have looked at when another look for the surface is begun, which goes on to its
// end. A tip that waits has its turn in the next ticks.
inline constexpr std::int32_t kMostBefore = 36;

// Of the deepest depth: where a line's law is told as a power of the depth.
inline constexpr Real kTold = 0.25;

// A rounded tip: a ball, or a capsule whose side touches where it is nearest.
struct RoundTip {
  Vec3 middle_w;
  Vec3 half_axis_w;  // zero: a ball
  Real margin_m = 0;
  Real modulus_Pa = 0, depth_max_m = 0;  // of a capsule's law: E*
  Real along = 0;                        // where on the axis it touches, -1 to 1
  std::int32_t begins_at = 0;            // ToolPoint::begins_at
  // Of a solid (config/tool/rounded_solid.h): what its ends leave to other edges; or a plate, the other half axis, on
  // both of which a flat tip of flat_m stands where the body meets it.
  Real leaves[2] = {0, 0};
  Vec3 half_across_w;
  Real flat_m = 0, across = 0;
  PlaceStep step;

  bool is_of_part() const PALPATE_RT { return begins_at > 0; }
  bool is_plate() const PALPATE_RT { return flat_m > 0; }
  bool is_edge() const PALPATE_RT { return leaves[0] > 0 || leaves[1] > 0; }
  bool is_of_solid() const PALPATE_RT { return is_plate() || is_edge(); }
  // Whether an edge stands on its end, where others have all of the ball.
  bool stands_on_end(Vec3 normal_w) const PALPATE_RT {
    const Real lean = dot(normal_w, half_axis_w), level = (1 - LineLaw::kStands) * squared_norm(half_axis_w);
    return leaves[lean < 0 ? 1 : 0] > 0 && lean * lean > level;
  }
  // A plate that the body leans away from by 60 degrees, below which it stands back (line_place.h).
  bool turns_away(Vec3 normal_w) const PALPATE_RT {
    const Vec3 out_w = cross(half_axis_w, half_across_w);
    const Real facing = dot(normal_w, out_w);
    return is_plate() && !(facing < 0 && 4 * facing * facing > squared_norm(out_w));
  }
  Vec3 centre_w() const PALPATE_RT { return middle_w + along * half_axis_w + across * half_across_w; }
  bool is_ball() const PALPATE_RT { return !(squared_norm(half_axis_w) > 0); }
  bool is_line() const PALPATE_RT { return squared_norm(half_axis_w) > 0 && !is_plate(); }
  // `step` with how far along each axis the tip stands from `w`.
  PlaceStep step_beside(Vec3 w) const PALPATE_RT {
    PlaceStep out = step;
    out.beside_m[0] = dot(centre_w() - w, unit_or(half_axis_w, {}));
    out.beside_m[1] = dot(centre_w() - w, unit_or(half_across_w, {}));
    return out;
  }
  Vec3 beside(Vec3 w) const PALPATE_RT {
    return w + step.beside_m[0] * unit_or(half_axis_w, {}) + step.beside_m[1] * unit_or(half_across_w, {});
  }
  void come_near(Vec3 w) PALPATE_RT {
    if (!is_ball()) along = clamp_to(dot(w - middle_w, half_axis_w) / squared_norm(half_axis_w), -1.0, 1.0);
    if (is_plate()) across = clamp_to(dot(w - middle_w, half_across_w) / squared_norm(half_across_w), -1.0, 1.0);
  }
};

struct ElasticRow {
  SmoothFoot foot;           // on the carried surface
  RoundTip tip;              // where the next tick takes it
  Vec3 placed_w;             // its centre here
  LineLaw::Shape line;       // of a capsule, where the next tick takes it
  Real arm_m;                // and LineLaw::Lean there
  LineLaw::Point told;       // at the depth kTold, whatever leans
  Real dent_m;               // how deep about the line is under the force that it had; 0: had none
  Real travel_m;             // how far the carried surface and the tip overlap; < 0 apart
  Real leads_m;              // of a part or solid: how much sooner than that a capsule touches that leans; else 0
  Real pull[kMaxSoftModes];  // d travel / d p
  Real turn[elastic_layout::kMaxPairs];  // d2 travel / d p2, with the foot's slide
  Vec3 sweep_w[kMaxSoftModes];           // of the material at the foot, by each amplitude
  // Of a ball or flat tip that had a force, on the smooth surface or an edge: the foot's area coordinates 1 and 2 by
  // each amplitude, the other way; and of c, c1, the curvature and beta in those two the slopes, and the bends 11, 12
  // and 22.
  bool has_slide;
  bool has_along;  // is in `along`, of each linear mode in lanes of four: how far it moves the surface along the normal
  Real slide[2][kMaxSoftModes];
  Real number_slope[2][elastic_layout::kOwnSlopes], number_bend[3][elastic_layout::kOwnSlopes];
  Real modulus_slope[2];
  Real c_m_per_N, c1_m_per_N2, curvature_1_per_m, beta_1_per_mN;  // there; config/elastic/self_terms.h, width_law.h
  Real modulus;  // contact modulus there, of that of the parameters; its gradient is zero on bodies of one material
  Vec3 modulus_gradient;
  Vec3 rise;  // gradient of the tip's height: the normal but for the facets' share
  Vec3 c_gradient, c1_gradient, curvature_gradient, beta_gradient;
  alignas(32) Real along[kMaxLinearModes];  // m/J^1/2

  // A line is told so deep, and its force, above zero, grows with that power of the depth there: 1 as flat to 1.5 as a
  // ball's.
  Real told_m() const PALPATE_RT { return kTold * tip.depth_max_m; }
  Real told_power() const PALPATE_RT { return clamp_to(told.tangent_N_per_m * told_m() / told.force_N, 1.0, 1.5); }
};

// What a term of a tip's pull costs where the foot slides, and one less where it does not (Work::shapes).
inline constexpr std::int32_t kMostOfShapes = 3;
// The surface with the soft modes at given amplitudes.
struct CarriedSurface {
  const Model& model;
  const Real* y;         // soft_products
  std::int32_t* looked;  // boxes and triangles this tick has looked at
  Work* work;            // counts what the tick does beside

  // Displacement of a vertex.
  Vec3 displacement(std::int32_t vertex) const PALPATE_RT;
  // Puts the tip on the surface, starting at `triangle`, where `near_w` is above it. A capsule moves along its axis by
  // one step to where it is deepest, and the travel is that of there, to second order. Beyond a sharp edge on that
  // (carried_edge.h); below the focal surface on the facet nearest to the centre as it was before the body moved, with
  // foot.triangle -1 where the tick's share of surface work is used up. One of a part that is not found there is kFar,
  // with the triangle from which to go on. A tip that is still apart when the surface
  // comes `nearer_m` towards it gets its foot and travel alone, and one without a force in the last tick no slide.
  void place(const RoundTip& tip, std::int32_t triangle, Vec3 near_w, Real nearer_m, const Box& box, ElasticRow& row,
             Real force_N = 0) const PALPATE_RT;

 private:
  bool place_on_facet(Vec3 centre_w, std::int32_t triangle, ElasticRow& row) const PALPATE_RT;
};

// Writes row.along, once a place. The travel at one row per newton at another is the product of both.
void show_linear_modes(const Model& model, ElasticRow& row) PALPATE_RT;

}  // namespace palpate
