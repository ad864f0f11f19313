// What a scene may choose among in the core, each with its words in one table (rt_core/choice.h).
#pragma once

#include "rt_core/base.h"
#include "rt_core/choice.h"

namespace palpate {

// Weight of a tool point: A_i / A_ref, A_i / sum of A, 1 / n.
#define PALPATE_CONTACT_WEIGHTS(X) X(kWinkler, winkler) X(kArea, area) X(kPaper, paper)
PALPATE_CHOICE(ContactWeight, PALPATE_CONTACT_WEIGHTS);

// Where a region's force acts as if it were one point's: the centre of pressure, or the geometric centre.
#define PALPATE_EQUIVALENT_POINTS(X) X(kPressure, pressure) X(kPaper, paper)
PALPATE_CHOICE(EquivalentPoint, PALPATE_EQUIVALENT_POINTS);

// Between tabulated curves: the gradient of the interpolated energy, or sum n_i f_i U_i as printed.
#define PALPATE_TABLE_INTERPOLATIONS(X) X(kEnergy, energy) X(kPaper, paper)
PALPATE_CHOICE(TableInterpolation, PALPATE_TABLE_INTERPOLATIONS);

// Who finds contact and makes force: springs at the tool's points; one law per whole tip, or curves tabulated over the
// surface; nodes of a finite-element body; whole tips on the surface of a body that gives as its modes do.
// X(enumerator, word): the method itself is WORD_method (contact/contact.h).
#define PALPATE_METHODS(X) X(kPoints, points) X(kTips, tips) X(kNodes, nodes) X(kElastic, elastic)
PALPATE_CHOICE(Method, PALPATE_METHODS);

// To say which of them takes a law or an array.
constexpr unsigned bit_of(Method method) { return 1u << static_cast<unsigned>(method); }
inline constexpr unsigned kOfPoints = bit_of(Method::kPoints);
inline constexpr unsigned kOfTips = bit_of(Method::kTips);
inline constexpr unsigned kOfNodes = bit_of(Method::kNodes);
inline constexpr unsigned kOfElastic = bit_of(Method::kElastic);
inline constexpr unsigned kOfAll = ~0u;

// X(enumerator, word, methods that take it): those of points alone stretch the springs of tool points.
#define PALPATE_FRICTION_LAWS(X)                               \
  X(kNone, none, kOfPoints | kOfTips | kOfNodes | kOfElastic)  \
  X(kReturnMap, return_map, kOfPoints)                         \
  X(kPaper, paper, kOfPoints)                                  \
  X(kMindlin, mindlin, kOfPoints | kOfTips | kOfElastic)       \
  X(kCoulomb, coulomb, kOfNodes)                               \
  X(kPresliding, presliding, kOfPoints | kOfTips | kOfElastic) \
  X(kPreslidingPaper, presliding_paper, kOfPoints | kOfTips)
PALPATE_CHOICE(FrictionLaw, PALPATE_FRICTION_LAWS);

constexpr unsigned methods_of(FrictionLaw law) {
#define PALPATE_TAKEN_BY(name, word, methods) methods,
  constexpr unsigned kMethods[] = {PALPATE_FRICTION_LAWS(PALPATE_TAKEN_BY)};
#undef PALPATE_TAKEN_BY
  return kMethods[static_cast<std::int32_t>(law)];
}

constexpr bool is_presliding(FrictionLaw law) {
  return law == FrictionLaw::kPresliding || law == FrictionLaw::kPreslidingPaper;
}

// What carries the normal force: cubic springs at the tool points, one scalar law per tool tip, or curves tabulated
// over the surface.
#define PALPATE_RESPONSE_LAWS(X) X(kPoints, points) X(kTip, tip) X(kTable, table)
PALPATE_CHOICE(ResponseLaw, PALPATE_RESPONSE_LAWS);

#define PALPATE_TANGENTIAL_LAWS(X) X(kSeparable, separable) X(kRadial, radial)
PALPATE_CHOICE(TangentialLaw, PALPATE_TANGENTIAL_LAWS);

// kPaper: equations (6) to (8) of Luo & Xiao 2006 with the printed length; kPaperGuarded: with one that stays above
// zero where the contact is at an anchor.
#define PALPATE_SKELETON_LAWS(X) \
  X(kNone, none)                 \
  X(kStiffness, stiffness)       \
  X(kPaper, paper) X(kCircular, circular) X(kCircularPaper, circular_paper) X(kPaperGuarded, paper_guarded)
PALPATE_CHOICE(SkeletonLaw, PALPATE_SKELETON_LAWS);

#define PALPATE_SHAPE_LAWS(X) X(kRbf, rbf) X(kDisplacementAnglePaper, displacement_angle_paper)
PALPATE_CHOICE(ShapeLaw, PALPATE_SHAPE_LAWS);

// Polynomial part of the rbf interpolation.
#define PALPATE_RBF_TAILS(X) X(kConstant, constant) X(kLinear, linear)
PALPATE_CHOICE(RbfTail, PALPATE_RBF_TAILS);

#define PALPATE_NEIGHBOURHOOD_LAWS(X) X(kNone, none) X(kLogPaper, log_paper) X(kLogC1, log_c1) X(kPunch, punch)
PALPATE_CHOICE(NeighbourhoodLaw, PALPATE_NEIGHBOURHOOD_LAWS);

#define PALPATE_COUPLING_LAWS(X) \
  X(kNone, none) X(kCoupled, coupled) X(kTemporalPaper, temporal_paper) X(kMutualPaper, mutual_paper)
PALPATE_CHOICE(CouplingLaw, PALPATE_COUPLING_LAWS);

// The papers' laws, by which skeletons carry the force of one region over to others in the tick.
constexpr bool carries_over(CouplingLaw law) PALPATE_RT {
  return law == CouplingLaw::kTemporalPaper || law == CouplingLaw::kMutualPaper;
}

// What hands move by devices: the tool; the body, against a tool that is fixed in the world; one hand the tool by one
// device and the other the body by a second; or each hand a tool of its own, both on one body.
#define PALPATE_HELD_PARTS(X) X(kTool, tool) X(kBody, body) X(kBoth, both) X(kTwoTools, two_tools)
PALPATE_CHOICE(HeldPart, PALPATE_HELD_PARTS);
constexpr bool has_two_devices(HeldPart part) PALPATE_RT {
  return part == HeldPart::kBoth || part == HeldPart::kTwoTools;
}

// Two tools: pieces of the second hand's, which its own device moves against those of the first.
#define PALPATE_ARTICULATIONS(X) X(kRigid, rigid) X(kGripper, gripper) X(kHand, hand) X(kTwoTools, two_tools)
PALPATE_CHOICE(Articulation, PALPATE_ARTICULATIONS);

// Where a handle is between two steps of its encoder: tracked as a motion through a dead zone
// (safety/encoder_observer.h), or from the edges it passed (safety/edge_observer.h).
#define PALPATE_ENCODER_LAWS(X) X(kMotion, motion) X(kEdges, edges)
PALPATE_CHOICE(EncoderLaw, PALPATE_ENCODER_LAWS);

// Who measures contact and makes force. Response: tool points on the rest surface, one law per region. Nodal: surface
// nodes of a finite-element body against the tool's pieces (rt_core/contact/nodes). Elastic: whole tips on a body that
// gives as its modes do (rt_core/contact/elastic).
#define PALPATE_BACKENDS(X) X(kResponse, response) X(kNodal, nodal) X(kElastic, elastic)
PALPATE_CHOICE(Backend, PALPATE_BACKENDS);

#define PALPATE_NODAL_SOLVERS(X) X(kPivoting, pivoting) X(kGaussSeidel, gauss_seidel)
PALPATE_CHOICE(NodalSolver, PALPATE_NODAL_SOLVERS);

// Where the tool's gap and normal are taken: at the node carried by the body's far field, at rest, or carried by the
// far field's finite rotation.
#define PALPATE_NODAL_CARRIES(X) X(kFarField, far_field) X(kRest, rest) X(kTurned, turned)
PALPATE_CHOICE(NodalCarry, PALPATE_NODAL_CARRIES);

// X(enumerator, word, type): the type is the shape in the tick (rt_core/tool/shape), and NAME_piece in config/tool what
// it is to a scene.
#define PALPATE_PIECE_SHAPES(X)         \
  X(kSphere, sphere, SphereShape)       \
  X(kCapsule, capsule, CapsuleShape)    \
  X(kCylinder, cylinder, CylinderShape) \
  X(kCone, cone, ConeShape)             \
  X(kBox, box, BoxShape)                \
  X(kHull, hull, HullShape)             \
  X(kTorus, torus, TorusShape)
PALPATE_CHOICE(PieceShape, PALPATE_PIECE_SHAPES);

#define PALPATE_JOINT_KINDS(X) X(kTurn, turn) X(kSlide, slide)
PALPATE_CHOICE(JointKind, PALPATE_JOINT_KINDS);

}  // namespace palpate
