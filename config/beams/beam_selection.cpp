#include "config/beams/beam_selection.h"

#include <algorithm>
#include <cmath>

namespace palpate {

namespace {

constexpr int kClearanceSamples = 9;  // per fibre
constexpr int kCircles = 24;          // of the family of circles through both points, evenly in their half angle
constexpr double kHalfAngle = 1.884;  // of the largest, 108 degrees: a dome's far rim is more than half a circle away
constexpr double kIntoWall = 1.5;     // widths by which a beam to an anchor of the hole ends inside the wall
constexpr int kPlanes = 6;            // turned about the chord
constexpr double kSharedUpTo = 0.2;   // relative difference of the two ways' lengths at which one carries all

// A unit vector normal to `along`, nearest to `wish`; zero where they are parallel (sine below 1e-3).
Vec3 normal_to(Vec3 along, Vec3 wish) {
  const Vec3 across = tangential_part(wish, along);
  return norm(across) > 1e-3 ? unit_or(across, {}) : Vec3{};
}

Vec3 any_normal_to(Vec3 along) {
  const double x = std::abs(along.x), y = std::abs(along.y), z = std::abs(along.z);
  const Vec3 least = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  return unit_or(tangential_part(least, along), {});
}

}  // namespace

BeamCurve arc_through(Vec3 tip, Vec3 anchor, Vec3 inside, double outer_m, bool long_way) {
  BeamCurve curve;
  curve.path = BeamPath::kArc;
  curve.tip_m = tip;
  curve.anchor_m = anchor;
  const Vec3 chord = anchor - tip;
  const double half = 0.5 * norm(chord);
  curve.outer_radius_m = std::max(outer_m, half * (1 + 1e-9));
  const double b = curve.outer_radius_m;
  const double height = std::sqrt(std::max(b * b - half * half, 0.0));
  const double side = long_way ? -1 : 1;
  curve.centre_m = 0.5 * (tip + anchor) + (side * height) * inside;
  const Vec3 along = unit_or(chord, {});
  curve.radial = (-half / b) * along - (side * height / b) * inside;
  curve.tangential = (side * height / b) * along - (half / b) * inside;
  curve.up = cross(curve.radial, curve.tangential);
  const double small = 2 * std::asin(std::min(half / b, 1.0));
  curve.angle = long_way ? 2 * kPi - small : small;
  curve.length_m = b * curve.angle;
  return curve;
}

BeamCurve straight_through(Vec3 tip, Vec3 anchor, Vec3 outward) {
  BeamCurve curve;
  curve.path = BeamPath::kStraight;
  curve.tip_m = tip;
  curve.anchor_m = anchor;
  curve.length_m = norm(anchor - tip);
  curve.tangential = unit_or(anchor - tip, {});
  curve.radial = normal_to(curve.tangential, outward);
  if (curve.radial == Vec3{}) curve.radial = any_normal_to(curve.tangential);
  curve.up = cross(curve.radial, curve.tangential);
  return curve;
}

Vec3 curve_point(const BeamCurve& curve, double fraction, double depth_m) {
  if (curve.path == BeamPath::kStraight || curve.path == BeamPath::kPoint)
    return curve.tip_m + fraction * (curve.anchor_m - curve.tip_m) - depth_m * curve.radial;
  const double angle = fraction * curve.angle, r = curve.outer_radius_m - depth_m;
  return curve.centre_m + r * (std::cos(angle) * curve.radial + std::sin(angle) * curve.tangential);
}

BeamSelector::BeamSelector(const Model& surface, const DistanceGrid& grid, const BeamRule& rule, double tolerance_m,
                           double mean_edge_m)
    : surface_(surface), grid_(grid), rule_(rule), tolerance_m_(tolerance_m), mean_edge_m_(mean_edge_m) {
  first_triangle_.assign(surface.vertex_m.size(), -1);
  for (std::size_t t = 0; t < surface.triangle.size(); ++t)
    for (const std::int32_t v : surface.triangle[t].vertex)
      if (first_triangle_[static_cast<std::size_t>(v)] < 0)
        first_triangle_[static_cast<std::size_t>(v)] = static_cast<std::int32_t>(t);
}

double BeamSelector::clearance_m(const BeamCurve& curve) const {
  // A straight beam between surfaces may lean either way: its middle line is what has to stay inside.
  const bool straight = curve.path == BeamPath::kStraight;
  double least = kHuge;
  for (int i = 1; i <= kClearanceSamples; ++i) {
    const double f = static_cast<double>(i) / (kClearanceSamples + 1);
    least = std::min(least, -grid_.at(curve_point(curve, f, 0)));
    if (!straight) least = std::min(least, -grid_.at(curve_point(curve, f, rule_.width_m)));
  }
  return least;
}

bool BeamSelector::fits(BeamCurve& curve) const {
  curve.clearance_m = clearance_m(curve);
  return curve.clearance_m >= -tolerance_m_;
}

// Outer radius 1/kappa + epsilon. A curve that is straight somewhere has no such circle.
BeamCurve BeamSelector::by_rule(Vec3 tip, Vec3 anchor, Vec3 inside, const SectionCurve& way) const {
  const double c = norm(anchor - tip);
  const double k =
      rule_.paper ? std::min(way.start_curvature_per_m, way.end_curvature_per_m) : way.least_curvature_per_m;
  if (!(k > 1e-6 / c)) return straight_through(tip, anchor, -inside);
  const double b = 1 / k + rule_.allowance_m;
  if (!(rule_.width_m <= 0.5 * b)) return {};
  // The rise of a circle's arc above its chord exceeds the radius when it is more than half of the circle.
  const bool more_than_half = dot(way.middle_m - 0.5 * (tip + anchor), -inside) > b;
  return arc_through(tip, anchor, inside, b, more_than_half);
}

BeamCurve BeamSelector::roomiest(Vec3 tip, Vec3 anchor, Vec3 inside) const {
  const double c = norm(anchor - tip);
  BeamCurve best;
  best.clearance_m = -kHuge;
  for (int j = 1; j <= kCircles; ++j) {
    const double half_angle = kHalfAngle * j / kCircles, b = 0.5 * c / std::sin(half_angle);
    if (!(rule_.width_m <= 0.5 * b)) continue;
    BeamCurve curve = arc_through(tip, anchor, inside, b, half_angle > 0.5 * kPi);
    curve.path = BeamPath::kFitted;
    fits(curve);
    if (curve.clearance_m > best.clearance_m) best = curve;
  }
  return best.clearance_m >= -tolerance_m_ ? best : BeamCurve{};
}

BeamCurve BeamSelector::turned(Vec3 tip, Vec3 anchor, Vec3 inside, Vec3 up) const {
  BeamCurve best;
  best.clearance_m = -kHuge;
  for (int plane = 1; plane < kPlanes; ++plane) {
    const double angle = kPi * plane / kPlanes;
    BeamCurve curve = roomiest(tip, anchor, std::cos(angle) * inside + std::sin(angle) * up);
    if (curve.path != BeamPath::kNone && curve.clearance_m > best.clearance_m + 1e-9) best = curve;
  }
  if (best.path != BeamPath::kNone) best.path = BeamPath::kTurned;
  return best;
}

// Along the section curve, where it reaches the anchor.
BeamSelector::BothWays BeamSelector::along_section(const SectionCurves& section, Vec3 tip, Vec3 anchor,
                                                   Vec3 inside) const {
  BothWays ways;
  if (!section.reaches) return ways;
  const double c = norm(anchor - tip);
  for (int way = 0; way < 2; ++way) {
    const SectionCurve& curve = section.way[way];
    // The centre lies opposite to the bulge of the curve. Between neighbouring vertices the mesh shows none.
    const Vec3 centre_side = dot(curve.middle_m - 0.5 * (tip + anchor), inside) <= 1e-6 * c ? inside : -inside;
    BeamCurve& side = ways.side[way];
    side = by_rule(tip, anchor, centre_side, curve);
    ways.length_m[way] = curve.length_m;
    const bool usable = side.path != BeamPath::kNone && (rule_.paper || fits(side));
    if (!usable) side = {};
  }
  if (rule_.paper) ways.side[ways.length_m[0] <= ways.length_m[1] ? 1 : 0] = {};
  return ways;
}

// Circles to either side of the chord, in the section's plane or, where none stays inside there, in one turned.
BeamSelector::BothWays BeamSelector::through_body(Vec3 tip, Vec3 anchor, Vec3 inside, Vec3 up) const {
  BothWays ways;
  ways.side[0] = roomiest(tip, anchor, inside);
  ways.side[1] = roomiest(tip, anchor, -inside);
  if (ways.none()) {
    ways.side[0] = turned(tip, anchor, inside, up);
    ways.side[1] = turned(tip, anchor, inside, -up);
    ways.turned = true;
  }
  for (int way = 0; way < 2; ++way) ways.length_m[way] = ways.side[way].length_m;
  return ways;
}

BeamChoice BeamSelector::share(const BothWays& ways) const {
  double weight[2] = {ways.side[0].path != BeamPath::kNone ? 1.0 : 0.0,
                      ways.side[1].path != BeamPath::kNone ? 1.0 : 0.0};
  if (weight[0] + weight[1] > 1.5) {
    // Turned planes go by room, so that mirror images of a body get mirror images of a beam.
    const double* length = ways.length_m;
    const double difference = ways.turned ? (ways.side[0].clearance_m - ways.side[1].clearance_m) / tolerance_m_
                                          : (length[1] - length[0]) / (kSharedUpTo * 0.5 * (length[0] + length[1]));
    weight[0] = std::clamp(0.5 + 0.5 * difference, 0.0, 1.0);
    weight[1] = 1 - weight[0];
  }
  BeamChoice choice;
  for (int way = 0; way < 2; ++way) {
    if (!(weight[way] > 0)) continue;
    choice.curve[choice.count] = ways.side[way];
    choice.weight[choice.count++] = weight[way];
  }
  return choice;
}

BeamChoice BeamSelector::choose(std::int32_t vertex, Vec3 anchor, Vec3 anchor_normal) const {
  const auto v = static_cast<std::size_t>(vertex);
  const Vec3 tip = surface_.vertex_m[v], normal = surface_.vertex_normal[v];
  const double c = norm(anchor - tip);
  if (!(c > 1e-6)) {
    BeamCurve point = straight_through(tip, anchor, normal);
    point.path = BeamPath::kPoint;
    return {1, {point}, {1, 0}};
  }
  const Vec3 along = (1.0 / c) * (anchor - tip);
  Vec3 inside = -normal_to(along, normal);
  if (inside == Vec3{}) inside = -normal_to(along, anchor_normal);
  if (inside == Vec3{}) inside = any_normal_to(along);
  const Vec3 up = cross(inside, along);

  const SectionCurves section = curves_between(trace_section(surface_, first_triangle_, vertex, up), anchor,
                                               3 * mean_edge_m_, 0.5 * mean_edge_m_, up, normal);
  BothWays ways = along_section(section, tip, anchor, inside);
  if (ways.none()) {
    BeamCurve straight = straight_through(tip, anchor, -inside);
    if (fits(straight)) return {1, {straight}, {1, 0}};
    ways = through_body(tip, anchor, inside, up);
    if (ways.none()) ways = into_wall(tip, normal, anchor - (kIntoWall * rule_.width_m) * anchor_normal);
  }
  return share(ways);
}

// Both ends of a beam lie on its outer side, so one that ends at an anchor of the hole would have its inner side in the
// hole: it ends inside the wall instead.
BeamSelector::BothWays BeamSelector::into_wall(Vec3 tip, Vec3 normal, Vec3 end) const {
  const Vec3 along = unit_or(end - tip, {});
  Vec3 inside = -normal_to(along, normal);
  if (inside == Vec3{}) inside = any_normal_to(along);
  BothWays ways;
  BeamCurve straight = straight_through(tip, end, -inside);
  if (!fits(straight)) return through_body(tip, end, inside, cross(inside, along));
  ways.side[0] = straight;
  ways.length_m[0] = straight.length_m;
  return ways;
}

}  // namespace palpate
