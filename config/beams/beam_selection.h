// Which curve the beam from a surface vertex to an anchor follows: the selection rules for objects with holes.
#pragma once

#include <vector>

#include "config/beams/distance_grid.h"
#include "config/beams/section_curve.h"
#include "rt_core/model.h"

namespace palpate {

enum class BeamPath : std::int32_t {
  kNone = 0,      // no curve stays inside: the beam is dropped
  kPoint = 1,     // the vertex is the anchor
  kStraight = 2,  // the chord stays inside (anchors on another surface), or the surface between is not curved
  kArc = 3,       // circle through both with the outer radius from the least curvature between them
  kFitted = 4,    // circle in the same plane with the most room, because the one by the rule leaves the body
  kTurned = 5,    // circle with the most room in a plane turned about the chord, to one side or both
};
inline constexpr int kBeamPaths = 6;

// The middle line of a beam is `width / 2` inside the circle: both ends lie on the outer radius.
struct BeamCurve {
  BeamPath path = BeamPath::kNone;
  Vec3 tip_m, anchor_m;
  Vec3 centre_m;                // of the circle
  Vec3 radial, tangential, up;  // frame at the tip; tangential points towards the anchor along the curve
  double outer_radius_m = 0;
  double angle = 0;
  double length_m = 0;
  double clearance_m = 0;  // least distance of its fibres from the surface, inside positive
};

// Circle of outer radius `outer_m` through tip and anchor whose centre lies on the side of `inside` (unit, normal to
// the chord); `long_way`: more than half of it. Where outer_m is less than half the chord, half the chord is taken.
BeamCurve arc_through(Vec3 tip, Vec3 anchor, Vec3 inside, double outer_m, bool long_way);
BeamCurve straight_through(Vec3 tip, Vec3 anchor, Vec3 outward);
// Point of the curve at `fraction` of its length from the tip, `depth_m` inside its outer side.
Vec3 curve_point(const BeamCurve& curve, double fraction, double depth_m);

struct BeamRule {
  double width_m = 0;
  double allowance_m = 0.5e-3;  // epsilon: added to the radius of curvature
  bool paper = false;           // curvature at the two ends only, and no test that the beam stays inside
};

// Up to two curves with weights that add up to 1: where the way round the one side is about as long as round the other,
// both carry, so that the beam does not jump from side to side as the contact moves (equal lengths: half each; a fifth
// longer: nothing).
struct BeamChoice {
  int count = 0;
  BeamCurve curve[2];
  double weight[2] = {0, 0};
};

class BeamSelector {
 public:
  BeamSelector(const Model& surface, const DistanceGrid& grid, const BeamRule& rule, double tolerance_m,
               double mean_edge_m);
  // The beam from a surface vertex to an anchor. Its plane holds the vertex's normal, along which a frictionless
  // contact pushes: independent of the force, so that beams keep still when the force turns. Where the normal is along
  // the chord: the anchor's normal; where that is too, any.
  BeamChoice choose(std::int32_t vertex, Vec3 anchor, Vec3 anchor_normal) const;
  // Least distance of both fibres from the surface, inside positive, sampled away from the ends.
  double clearance_m(const BeamCurve& curve) const;

 private:
  // A curve to either side of the chord, or kNone, and how long that way is.
  struct BothWays {
    BeamCurve side[2];
    double length_m[2] = {0, 0};
    bool turned = false;  // out of the section's plane
    bool none() const { return side[0].path == BeamPath::kNone && side[1].path == BeamPath::kNone; }
  };
  BothWays along_section(const SectionCurves& section, Vec3 tip, Vec3 anchor, Vec3 inside) const;
  BothWays through_body(Vec3 tip, Vec3 anchor, Vec3 inside, Vec3 up) const;
  BothWays into_wall(Vec3 tip, Vec3 normal, Vec3 end) const;
  BeamChoice share(const BothWays& ways) const;
  bool fits(BeamCurve& curve) const;
  BeamCurve by_rule(Vec3 tip, Vec3 anchor, Vec3 inside, const SectionCurve& way) const;
  BeamCurve roomiest(Vec3 tip, Vec3 anchor, Vec3 inside) const;
  BeamCurve turned(Vec3 tip, Vec3 anchor, Vec3 inside, Vec3 up) const;

  const Model& surface_;
  const DistanceGrid& grid_;
  BeamRule rule_;
  double tolerance_m_;
  double mean_edge_m_;
  std::vector<std::int32_t> first_triangle_;
};

}  // namespace palpate
