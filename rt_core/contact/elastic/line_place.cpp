#include "rt_core/contact/elastic/line_place.h"

#include "rt_core/contact/elastic/damped_step.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

// Of a capsule's radius: how deep it is at least to tell where its force acts, and how stiff it is against leaning.
constexpr Real kLeastDepth = 1e-3, kLeastArmDepth = 1e-2;
constexpr Real kMostBend = 0.9;      // of 1 / R, of the height's bend along the axis
constexpr Real kMostSlide_m = 4e-3;  // in one step: the foot there is told by a parabola, and looked for from here
// A place of a part stands on it, whatever the line that leans does beyond: on the rim it would have no side.
constexpr Real kInset_m = 1e-5;
constexpr Real kSkewed = 1e-3;  // an axis that leaves a side of the body's box slower than so does not
// A plate is the flat tip of one that lies on it: from a lean of 30 degrees on it stands back, by two radii at 60.
constexpr Real kLeansAway = 0.25, kStandsBack = 4;
constexpr Real kLeastLevel = 0.5, kLeastAcross = 1e-3;  // where a plate has turned away; squared sine
// Beyond the body an end is that of the body: steeper than round by so much for every radius that is cut off.
constexpr Real kSteeper = 10, kSteepest = 10;

// How far the body goes on from the foot, towards either end. A body ends where its box about the rest shape does,
// moved as the foot is; `room`: by how much more than that along each of the box's axes.
struct Reach {
  Real left_m = kHuge, right_m = kHuge;
};
void limit(Real axis, Real foot_m, Real lower_m, Real upper_m, Real room_m, Reach& reach) PALPATE_RT {
  const Real along = abs_of(axis);
  if (!(along > kSkewed)) return;
  const Real inverse = 1.0 / along;
  const Real up = (max_of(upper_m - foot_m, 0.0) + room_m) * inverse,
             down = (max_of(foot_m - lower_m, 0.0) + room_m) * inverse;
  reach.right_m = min_of(reach.right_m, axis > 0 ? up : down);
  reach.left_m = min_of(reach.left_m, axis > 0 ? down : up);
}
Reach reach_with(const Model& model, const Box& box, Vec3 axis, Vec3 room, const ElasticRow& row) PALPATE_RT {
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(row.foot.triangle)];
  Vec3 rest;
  for (int k = 0; k < 3; ++k)  // bound: 3
    rest += row.foot.weight[k] * model.vertex_m[static_cast<std::size_t>(triangle.vertex[k])];
  Reach reach;
  limit(axis.x, rest.x, box.lower.x, box.upper.x, room.x, reach);
  limit(axis.y, rest.y, box.lower.y, box.upper.y, room.y, reach);
  limit(axis.z, rest.z, box.lower.z, box.upper.z, room.z, reach);
  return reach;
}
// Under a capsule: across the axis a round body leaves its box sooner, by a radius at most.
Reach reach_of(const Model& model, const Box& box, Vec3 axis, Real radius, const ElasticRow& row) PALPATE_RT {
  const auto room = [&](Real along) PALPATE_RT { return radius * (1 - along * along); };
  return reach_with(model, box, axis, {room(axis.x), room(axis.y), room(axis.z)}, row);
}
// Under a plate: as the surface goes on from the foot, not as the plate leans. A side of the box that the surface lies
// along is none of its ends: a crest is on one, and as a plate is drawn over it that side came and went.
Reach reach_under(const Model& model, const Box& box, Vec3 axis, const ElasticRow& row) PALPATE_RT {
  const Vec3 n = row.foot.normal_w, size = box.upper - box.lower;
  const Vec3 level = tangential_part(axis, n);
  const Real flat = max_of(norm(level), kLeastLevel);
  const auto room = [](Real normal, Real side_m) PALPATE_RT {
    const Real square = normal * normal;
    return side_m * square / max_of(1 - square, kLeastAcross);
  };
  Reach reach =
      reach_with(model, box, (1.0 / flat) * level, {room(n.x, size.x), room(n.y, size.y), room(n.z, size.z)}, row);
  reach.left_m *= 1.0 / flat;
  reach.right_m *= 1.0 / flat;
  return reach;
}

// `end`: of the line where it is cut.
Real cut(Real reach_m, Real radius_m, Real& side_m) PALPATE_RT {
  const Real over = max_of(side_m - reach_m, 0.0);
  side_m -= over;
  return min_of(1 + kSteeper * over / radius_m, kSteepest);
}

// How deep the line is under the force that it had, from where it is told, by the law's power there. What the
// place and the body give is not of the dent: with the travel less c F jaws over a block's edge, where the other jaw
// takes most of that back, swung from end to end (2026-11-26).
Real dent_m(const ElasticRow& row, Real force_N) PALPATE_RT {
  const Real ratio = clamp_to(force_N / row.told.force_N, 1e-3, 1e3), root = math::cbrt(ratio * ratio);
  return row.told_m() * (ratio + 2 * (row.told_power() - 1) * (root - ratio));
}

// The same a Newton step nearer, for the solver to begin with: 5 % off it took a law more.
Real nearer_dent_m(const LineLaw& law, Real dent_m, Real force_N) PALPATE_RT {
  const LineLaw::Point& there = law.at(law.touches_at_m() + dent_m);
  const Real by = (force_N - there.force_N) / (there.tangent_N_per_m * dent_m);
  return abs_of(by) < 1 ? dent_m * (1 + by) : dent_m;
}

}  // namespace

Real stand_on_line(const Model& model, const Box& box, Real bend_1_per_m, Real force_N, ElasticRow& row) PALPATE_RT {
  const Real half = norm(row.tip.half_axis_w), radius = row.tip.margin_m, before = row.tip.along;
  const Vec3 axis = (1.0 / half) * row.tip.half_axis_w;
  const Real bend = min_of(bend_1_per_m, kMostBend / radius), lean = -dot(row.rise, axis);
  const Real along = bend / (1.0 - bend * clamp_to(row.foot.height_m, 0.0, radius));
  const Reach reach = reach_of(model, box, axis, radius, row);
  LineLaw::Shape& line = row.line;
  line = {
      radius, (1 + before) * half, (1 - before) * half, 1, 1, lean, along, 2 * row.curvature_1_per_m - along, false, 0,
      0};
  // The line stands beside the foot where it leans.
  line.left_end = cut(reach.left_m - radius * lean, radius, line.left_m);
  line.right_end = cut(reach.right_m + radius * lean, radius, line.right_m);
  // An end that the body leaves is no corner of its own.
  line.left_leaves = row.tip.leaves[0] * clamp_to(2 - line.left_end, 0.0, 1.0);
  line.right_leaves = row.tip.leaves[1] * clamp_to(2 - line.right_end, 0.0, 1.0);
  line.right_m = max_of(line.right_m, -line.left_m);
  // On a part's edge that it crosses: a ball.
  if (row.tip.is_of_part() && row.foot.state == FootState::kEdge) line.left_m = line.right_m = line.lean = 0;
  const LineLaw law(line, row.tip.modulus_Pa * row.modulus, kHuge);
  if (row.tip.is_of_part() || row.tip.is_edge()) row.leads_m = max_of(-law.touches_at_m(), 0.0);
  row.told = law.at(row.told_m() + law.touches_at_m());
  const bool had = force_N > 0 && row.told.force_N > 0;
  row.dent_m = had ? dent_m(row, force_N) : 0.0;
  const Real deep = max_of(had ? row.dent_m : row.travel_m - law.touches_at_m(), kLeastDepth * radius);
  if (had && row.tip.is_of_part()) row.dent_m = nearer_dent_m(law, row.dent_m, force_N);
  const LineLaw::Lean stands = law.lean_at(law.touches_at_m() + deep);
  row.arm_m = stands.arm_m * min_of(deep / (kLeastArmDepth * radius), 1.0);
  Real way_m = stands.to_pressure_m;
  if (row.tip.is_of_part()) {
    const Reach on_face = reach_of(model, box, axis, 0, row);
    way_m = clamp_to(way_m, min_of(kInset_m - on_face.left_m, 0.0), max_of(on_face.right_m - kInset_m, 0.0));
  }
  way_m = clamp_to(way_m, max_of(-kMostSlide_m, (-1 - before) * half), min_of(kMostSlide_m, (1 - before) * half));
  row.tip.along = before + way_m * damp(way_m, row.tip.step.along_m) / half;
  const Real step = (row.tip.along - before) * half;
  row.travel_m += step * (lean - 0.5 * step * bend);
  line.lean = lean - bend * step;
  line.left_m += step;
  line.right_m -= step;
  return step;
}

// The plate's tip is to be where it is deepest, on a tangent paraboloid; the plate itself, tilted on what is flat,
// bears beside its middle by 2/3 b^2 tilt / e, as a round punch does, which is a paraboloid of its own.
void stand_on_plate(const Model& model, const Box& box, const PlateBends& plate, Real force_N, ElasticRow& row,
                    PlateAxis (&axes)[2]) PALPATE_RT {
  RoundTip& tip = row.tip;
  const Real square = tip.flat_m * tip.flat_m, dent = force_N / (2 * tip.modulus_Pa * row.modulus * tip.flat_m);
  const Vec3 out = unit_or(cross(tip.half_axis_w, tip.half_across_w), {});
  const Real own = 1.5 * max_of(dent, kLeastDepth * tip.flat_m) / square;
  const auto go = [&](Vec3 half_w, Real bend, Real leant, DampedStep& memory, Real& at) PALPATE_RT {
    const Real half = norm(half_w), lean = -dot(row.rise, half_w) / half - leant, from = at * half;
    const Real bends = min_of(bend, kMostBend / tip.margin_m);
    // What of it the body is under, and the middle of that.
    const Reach reach = reach_under(model, box, (1.0 / half) * half_w, row);
    const Real first = clamp_to(from - reach.left_m + kInset_m, -half, from),
               last = clamp_to(from + reach.right_m - kInset_m, from, half), middle = 0.5 * (first + last);
    const Real wish = middle + (lean + bends * (from - middle)) / (bends + own), end = clamp_to(wish, first, last);
    const Real asked = clamp_to(end - from, -kMostSlide_m, kMostSlide_m);
    const Real step = end == wish ? asked : asked * damp(asked, memory), to = from + step;
    row.travel_m += step * (lean - 0.5 * bends * step) - 0.5 * own * (to - middle) * (to - middle);
    at = to / half;
    return PlateAxis{step, bends, end == wish ? 1.0 / (bends + own) : 0.0};
  };
  const Real lean2 = 1 - dot(row.rise, out) * dot(row.rise, out);
  row.leads_m = 0;
  row.travel_m -= kStandsBack * tip.flat_m * max_of(lean2 - kLeansAway, 0.0);
  axes[0] = go(tip.half_axis_w, plate.along_1_per_m, 0, tip.step.along_m, tip.along);
  axes[1] =
      go(tip.half_across_w, plate.across_1_per_m, plate.mixed_1_per_m * axes[0].step_m, tip.step.across_m, tip.across);
}

}  // namespace palpate
