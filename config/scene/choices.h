// What a scene may choose among beside the laws of the core (rt_core/laws.h), each with its words in one table.
#pragma once

#include "rt_core/choice.h"

namespace palpate {

#define PALPATE_BODY_SHAPES(X)        \
  X(kEllipsoid, ellipsoid)            \
  X(kSphere, sphere)                  \
  X(kCylinder, cylinder)              \
  X(kBox, box)                        \
  X(kRevolution, revolution)          \
  X(kHeart, heart)                    \
  X(kMesh, mesh)                      \
  X(kHalfShell, half_shell)           \
  X(kRing, ring)                      \
  X(kHollowCylinder, hollow_cylinder) \
  X(kClip, clip)                      \
  X(kTets, tets)                      \
  X(kSuperellipsoid, superellipsoid)
PALPATE_CHOICE(BodyShape, PALPATE_BODY_SHAPES);

#define PALPATE_FEM_ORDERS(X) X(kQuadratic, quadratic) X(kLinear, linear) X(kMixed, mixed)
PALPATE_CHOICE(FemOrder, PALPATE_FEM_ORDERS);

#define PALPATE_FEM_PRECISIONS(X) X(kByError, auto) X(kSingle, single) X(kDouble, double)
PALPATE_CHOICE(FemPrecision, PALPATE_FEM_PRECISIONS);

// Where an entry of body.fixed holds, and which components of the displacement.
#define PALPATE_FIXED_REGIONS(X) X(kBase, base) X(kBox, box) X(kBall, ball) X(kPatch, patch) X(kVertices, vertices)
PALPATE_CHOICE(FixedRegion, PALPATE_FIXED_REGIONS);

#define PALPATE_HELD_COMPONENTS(X) \
  X(kAll, all) X(kX, x) X(kY, y) X(kZ, z) X(kXy, xy) X(kXz, xz) X(kYz, yz) X(kNormal, normal)
PALPATE_CHOICE(HeldComponents, PALPATE_HELD_COMPONENTS);

// Where an entry of body.material_region is.
#define PALPATE_MATERIAL_SHAPES(X) X(kBox, box) X(kBall, ball) X(kGroup, group)
PALPATE_CHOICE(MaterialShape, PALPATE_MATERIAL_SHAPES);

#define PALPATE_ANCHOR_SOURCES(X) X(kShape, auto) X(kMesh, mesh)
PALPATE_CHOICE(AnchorSource, PALPATE_ANCHOR_SOURCES);

#define PALPATE_CONTACT_LAWS(X) X(kDuffing, duffing) X(kCubic, cubic) X(kHertz, hertz) X(kTool, tool) X(kTable, table)
PALPATE_CHOICE(ContactLaw, PALPATE_CONTACT_LAWS);
// Whether pieces press with whole tips instead of many tool points.
constexpr bool is_tip_law(ContactLaw law) { return law == ContactLaw::kTool || law == ContactLaw::kTable; }

// What a tool point touches. Laws of a whole tip (kTool, kTable) always have the smooth surface.
#define PALPATE_CONTACT_SURFACES(X) X(kFacets, facets) X(kSmooth, smooth)
PALPATE_CHOICE(ContactSurface, PALPATE_CONTACT_SURFACES);

#define PALPATE_DUFFING_COEFFICIENTS(X) X(kStatic, static) X(kPaper, paper)
PALPATE_CHOICE(DuffingCoefficient, PALPATE_DUFFING_COEFFICIENTS);

#define PALPATE_SPHERE_LAWS(X) X(kExact, exact) X(kParabola, parabola)
PALPATE_CHOICE(SphereLaw, PALPATE_SPHERE_LAWS);

// Where the curves of contact.law = "table" come from: a CSV of measured presses, or presses the baker makes.
#define PALPATE_TABLE_SOURCES(X) X(kFile, file) X(kFem, fem)
PALPATE_CHOICE(TableSource, PALPATE_TABLE_SOURCES);

#define PALPATE_TOUCHING_ENDS(X) X(kAll, all) X(kPlusZ, plus_z) X(kMinusZ, minus_z)
PALPATE_CHOICE(TouchingEnd, PALPATE_TOUCHING_ENDS);

// Which fingers a hand's grasp uses: thumb and index; with the middle finger; all.
#define PALPATE_GRASP_FINGERS(X) X(kTwo, two) X(kThree, three) X(kFive, five)
PALPATE_CHOICE(GraspFingers, PALPATE_GRASP_FINGERS);

#define PALPATE_HAND_SIDES(X) X(kRight, right) X(kLeft, left)
PALPATE_CHOICE(HandSide, PALPATE_HAND_SIDES);

// What of a finger part touches: the rounded rod of the table's width, or the surface of the hand's mesh.
#define PALPATE_HAND_CONTACTS(X) X(kCapsules, capsules) X(kMesh, mesh)
PALPATE_CHOICE(HandContact, PALPATE_HAND_CONTACTS);

// Where a hand's fingers end: each part at a stated depth, or each finger at a stated force and the thumb at the one
// that balances them.
#define PALPATE_HAND_CLOSINGS(X) X(kDepth, depth) X(kBalanced, balanced)
PALPATE_CHOICE(HandClosing, PALPATE_HAND_CLOSINGS);

}  // namespace palpate
