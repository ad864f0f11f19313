// Whether a hand holds a body: balance of wrenches within friction cones at the forces it presses with, and force
// closure (Ferrari & Canny 1992), both on cones of eight edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/record.h"
#include "rt_core/state.h"

namespace palpate {

// A contact of the hand on the body: it pushes along `push_w` (into the body) with normal_N and holds by friction up to
// friction_N across it.
struct GraspContact {
  Vec3 position_w, push_w;
  double normal_N = 0, friction_N = 0;
};

// What holds a body: fingers, a palm that pushes as hard as need be, and the body's weight.
struct Grasp {
  std::vector<GraspContact> finger;
  std::vector<GraspContact> palm;  // corners of its face; normal_N and friction_N are those of 1 N of push
  Vec3 centre_w;                   // moments are taken about it
  Vec3 weight_N;                   // acts there
  double length_m = 1;             // by which moments are divided to compare with forces
};

// Where a hand presses: a region's centre, the surface's outward normal there, the normal force.
struct PressedPlace {
  Vec3 centre_w, normal_w;
  double normal_N = 0;
};
// The grasp of a hand at `tool_w`: one finger contact per place with the friction that the scene's law allows; the palm
// as a face of eight corners with the same law at the push that it gives. Of a state, and of a tick as it was told or
// recorded.
Grasp grasp_of(const Model& model, const Pose& tool_w, std::span<const PressedPlace> places);
Grasp grasp_of(const Model& model, const State& state);
Grasp grasp_of(const Model& model, const TickRecord& record);

struct GraspStability {
  bool holds = false;          // forces within all cones balance the weight at the fingers' normal forces
  double imbalance_N = 0;      // what is left over otherwise, moments over the body's length
  double friction_needed = 0;  // all friction limits times this just hold; kHuge: no friction would
  bool closed = false;         // force closure: the cones' edges span all wrenches, so that harder fingers resist any
  // Radius of the largest ball of wrenches about zero in the convex hull of the edges, each of unit push, lies between
  // these (the largest multiples of the six axes in the hull; over root 6).
  double quality_least = 0, quality_most = 0;
};
GraspStability judge(const Grasp& grasp);
// The first of these alone, at a hundredth of the work: can they balance the weight?
bool holds(const Grasp& grasp);

// What friction has to hold of the fingers' normal forces: what is left of their wrench by the palm's push, without the
// body's weight (N, moments over the body's length).
double left_for_friction_N(const Grasp& grasp);

// Can forces within the cones, friction limits times `scale`, balance the weight? Returns what is left over (N).
double imbalance_N(const Grasp& grasp, double scale);

}  // namespace palpate
