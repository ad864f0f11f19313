// Working memory of the nodal back-end within one tick: the nodes near the tool, how they move under one another's
// pushes, and the solution.
#pragma once

#include "rt_core/contact/nodes/friction_block.h"
#include "rt_core/contact/nodes/pivoting.h"
#include "rt_core/state.h"
#include "rt_core/vec.h"

namespace palpate {

// A surface node that may touch the tool. "Carried" means displaced by the far field of the last tick's forces.
struct ContactNode {
  std::int32_t vertex;
  std::int32_t piece;
  std::int32_t memory;  // its entry in State::nodal, or -1: not a candidate last tick
  std::int32_t region;  // slot of the last tick, or -1
  Vec3 rest_w;
  Vec3 carry_w;   // linear part of carried position minus rest
  Vec3 bend_w;    // the rest of it
  Vec3 normal_w;  // out of the tool, into the body
  Vec3 tangent_w[2];
  Vec3 arm_w;    // carried position minus the tool's origin
  double gap_m;  // of the carried position
  FrictionBlock block;
  double offset_m[2];  // tangential displacement relative to the tool without any push
  bool has_offset;
  Push push;
  Vec3 force_w;  // of the push, on the body: push_w() once it has been carried over to motion_m
};

// Four vertices that follow one another, some of them near the tool: what the search leaves for the choice of the
// problem's nodes. Meanings as in ContactNode; `position_w` is where a node and the tool meet.
struct NearFour {
  Vec3x4 carry_w, bend_w, position_w, normal_w;
  Double4 gap_m;
  std::int32_t piece[4];
  std::int32_t first;   // vertex
  std::uint32_t lanes;  // bit k: vertex first + k is near
};

// Normals of the nodes and their turns, arm x normal, as rows: for several nodes at a time. Zero past the last one.
struct Directions {
  alignas(32) double normal[3][kContactStride];
  alignas(32) double turn[3][kContactStride];
  alignas(32) float narrow[3][kContactStride];  // both in single precision
  alignas(32) float narrow_turn[3][kContactStride];
};

inline constexpr std::int32_t kMaxNearFours = whole_lanes(kMaxNodalVertices, 4) / 4;

struct ContactProblem {
  std::int32_t count = 0;
  ContactNode node[kMaxContacts];
  Directions directions;
  alignas(32) double offset_m[kContactStride];  // normal gaps without any push; zero past the last node
  NormalProblem normal;
  // influence[j][a][b][i]: displacement component b of node i per newton along a on node j. Single precision: half of
  // the sweeps' cost, and what the image usually holds.
  alignas(32) float influence[kMaxContacts][3][3][kContactStride];
  alignas(32) float motion_m[3][kContactStride];  // displacement of every node by the pushes so far
  Vec3 force_N, torque_Nm;                        // sum of the pushes on the body, about the tool's origin
  double per_N = 0, per_Nm = 0;                   // compliance of the virtual coupling; 0: the tool is held
  // Nodes within the margin of the tool, in the order of the vertices for a tool of one piece.
  std::int32_t near_count = 0;
  NearFour* near = nullptr;  // for all vertices, and one that is looked at
  // Which entry of State::nodal a vertex is, and which of `near` four vertices are; -1: none.
  std::int8_t* memory_of = nullptr;
  std::int16_t* near_of = nullptr;
};
static_assert(kMaxContacts <= 127 && kMaxNodalVertices <= 32767, "numbered in 8 and 16 bits");

// In the block of a Scratch made for the method.
inline ContactProblem& problem_of(Scratch& scratch) PALPATE_RT {
  return *reinterpret_cast<ContactProblem*>(scratch.own.data());
}
inline const ContactProblem& problem_of(const Scratch& scratch) PALPATE_RT {
  return *reinterpret_cast<const ContactProblem*>(scratch.own.data());
}

// What its push does to the body.
inline Vec3 push_w(const ContactNode& node) PALPATE_RT {
  return node.push.normal_N * node.normal_w + node.push.tangent_N[0] * node.tangent_w[0] +
         node.push.tangent_N[1] * node.tangent_w[1];
}
// Displacement of node i of the body by all pushes so far.
inline Vec3 motion_of(const ContactProblem& p, std::int32_t i) PALPATE_RT {
  return {static_cast<Real>(p.motion_m[0][i]), static_cast<Real>(p.motion_m[1][i]),
          static_cast<Real>(p.motion_m[2][i])};
}
// Displacement of node i relative to the tool by all pushes so far, world axes: the body's and, with a coupling that
// yields, the tool's.
inline Vec3 relative_motion(const ContactProblem& p, std::int32_t i) PALPATE_RT {
  return motion_of(p, i) + p.per_N * p.force_N + p.per_Nm * cross(p.torque_Nm, p.node[i].arm_w);
}

// Normal gaps of all nodes with the pushes so far. Bound: kMaxContacts.
void find_normal_gaps(const ContactProblem& problem, double (&gap_m)[kContactStride]) PALPATE_RT;
// Adds a push (N, world axes, on the body) at node j: its displacements and the sum of forces. Bound: kMaxContacts.
void add_push(ContactProblem& problem, std::int32_t j, Vec3 force_N) PALPATE_RT;
// Adds the displacements by many pushes (x, y, z of every node); the sum of forces is left to the caller. Bound:
// kMaxContacts^2.
void add_pushes(ContactProblem& problem, const float (&force_N)[3 * kMaxContacts]) PALPATE_RT;

}  // namespace palpate
