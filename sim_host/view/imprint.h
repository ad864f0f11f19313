// What the hand presses into the surface that is drawn: a contact region takes the shape of the part that touches it,
// a region of several parts that of the joint between them too, and the palm flattens what lies against it (Cui & Xiao
// 2008, sections IV.A and IV.B). Drawing only: forces come from the rest surface.
#pragma once

#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// A straight piece of finger: all points nearer to the segment than its radius, which goes from one end's to the
// other's.
struct FingerShape {
  Vec3 root_w, tip_w;
  double root_radius_m = 0, tip_radius_m = 0;
  Vec3 into_body_w;  // unit: against its region's normal
  bool joint = false;
};
double distance_m(const FingerShape& shape, Vec3 point_w);  // signed, < 0 inside

// Parts in contact, root to tip, and the joints between neighbours that share a region. Empty for other tools.
std::vector<FingerShape> finger_shapes(const Model& model, const State& state);

// Moves points that lie inside a finger out of it, into the body, and points beyond the palm's face, within its
// breadth, back to it. `position_m` are points of the surface displaced by the scene's shape models.
void imprint(const Model& model, const State& state, std::vector<Vec3>& position_m);

}  // namespace palpate
