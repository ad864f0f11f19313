// Model: the immutable scene, a set of typed views into one image file. Two tables describe everything in it; the
// writer, the loader, the validator, the dump and the documentation are all generated from them (docs/image_format.md).
#pragma once

#include <cstdint>
#include <span>

#include "rt_core/base.h"
#include "rt_core/laws.h"
#include "rt_core/limits.h"
#include "rt_core/status.h"
#include "rt_core/vec.h"

namespace palpate {

// X(type, name, unit, lowest, highest, meaning), in groups. All are finite; the loader checks every range; that of a
// choice is its table (rt_core/choice.h).
#define PALPATE_CHOICE_PARAM(X, Enum, name, meaning) X(Enum, name, "-", Enum{}, last_choice<Enum>(), meaning)
// The tick, and which method finds contact.
#define PALPATE_METHOD_PARAMS(X)                                                           \
  X(double, period_s, "s", 1e-5, 1e-1, "tick period")                                      \
  PALPATE_CHOICE_PARAM(X, Backend, backend, "who measures contact and makes force")        \
  PALPATE_CHOICE_PARAM(X, ResponseLaw, response_law, "what carries the normal force")      \
  PALPATE_CHOICE_PARAM(X, Articulation, articulation,                                      \
                       "whether pieces of the tool move against one another, and by what") \
  X(std::int32_t, surface_work_max, "-", 0, kMaxSurfaceWork,                               \
    "boxes and triangles a tick looks at, at most; 0: kMaxSurfaceWork")
// The body.
#define PALPATE_BODY_PARAMS(X)                                                                 \
  X(double, youngs_modulus_Pa, "Pa", 1, 1e13, "E")                                             \
  X(double, poisson_ratio, "-", -0.999, 0.5, "nu")                                             \
  X(double, body_mass_kg, "kg", 0, 1e9, "mass of the body: what a palm has to hold")           \
  X(double, body_centre_x_m, "m", -1e3, 1e3, "centre of the body's volume, world")             \
  X(double, body_centre_y_m, "m", -1e3, 1e3, "the same, y")                                    \
  X(double, body_centre_z_m, "m", -1e3, 1e3, "the same, z")                                    \
  X(double, surface_size_m, "m", 1e-6, 100, "largest extent of the body; scale of tolerances") \
  X(double, smooth_slack_m, "m", 0, 4e-4, "how far the smooth surface stands off its facets, at most")
// Tool points with springs.
#define PALPATE_POINT_PARAMS(X)                                                                    \
  PALPATE_CHOICE_PARAM(X, ContactWeight, contact_weight, "how sample forces are weighted")         \
  PALPATE_CHOICE_PARAM(X, EquivalentPoint, equivalent_point, "centre of a region")                 \
  X(double, k1_N_per_m, "N/m", 0, 1e9, "linear coefficient of the contact law, per unit weight")   \
  X(double, k3_N_per_m3, "N/m3", 0, 1e15, "cubic coefficient of the contact law, per unit weight") \
  X(double, max_depth_m, "m", 1e-6, 1, "depth beyond which the law continues by its tangent")
// Whole tips and tables.
#define PALPATE_TIP_PARAMS(X)                                                                          \
  PALPATE_CHOICE_PARAM(X, TableInterpolation, table_interpolation, "between the curves of the tables") \
  X(std::int32_t, response_root, "-", 0, 1, "1: the knots of the tables are roots of depths")
// Nodes of a finite-element body.
#define PALPATE_NODE_PARAMS(X)                                                                        \
  PALPATE_CHOICE_PARAM(X, NodalSolver, nodal_solver, "who finds the normal forces")                   \
  PALPATE_CHOICE_PARAM(X, NodalCarry, nodal_carry, "where gaps and normals are taken")                \
  X(std::int32_t, nodal_sweeps, "-", 0, 100, "Gauss-Seidel sweeps of the normal problem")             \
  X(std::int32_t, friction_sweeps, "-", 0, 20, "Gauss-Seidel sweeps of the problem with friction")    \
  X(double, contact_margin_m, "m", 0, 1, "nodes with a smaller gap take part in the contact problem") \
  X(double, regularisation, "-", 0, 0.1, "share added to the diagonal of the contact problem")        \
  X(double, wall_N_per_m, "N/m", 0, 1e9, "stiffness of the body's held nodes")                        \
  X(double, strain_limit, "-", 0, 10, "largest strain for which the linear body is trusted")          \
  X(double, proxy_speed_max_m_per_s, "m/s", 0, 100, "fastest motion of the tool in contact")
// Elastic body.
#define PALPATE_ELASTIC_PARAMS(X)                                                                      \
  X(std::int32_t, elastic_soft, "-", 0, kMaxSoftModes, "soft modes: nonlinear")                        \
  X(std::int32_t, elastic_linear, "-", 0, kMaxLinearModes, "linear modes: through which regions meet") \
  X(double, elastic_radius_rootJ, "J^1/2", 0, 1e6, "the soft energy is a quartic up to here, then goes on by tangents")
// Relaxation of the body (rt_core/contact/relaxation.h): up to three Prony terms, and what is lost at any rate.
#define PALPATE_RELAXATION_PARAMS(X)                                                                              \
  X(double, relax_share_1, "-", 0, 1, "part of the stiffness that relaxes with the first time constant; 0: none") \
  X(double, relax_share_2, "-", 0, 1, "with the second")                                                          \
  X(double, relax_share_3, "-", 0, 1, "with the third")                                                           \
  X(double, relax_kept_1, "-", 0, 1, "exp(-T / tau) of the first: kept from tick to tick")                        \
  X(double, relax_kept_2, "-", 0, 1, "of the second")                                                             \
  X(double, relax_kept_3, "-", 0, 1, "of the third")                                                              \
  X(double, lost_share, "-", 0, 0.5, "part of a press's work that its release does not give back, however slow")
// What rings at a touch (rt_core/safety/contact_transient.h).
#define PALPATE_TRANSIENT_PARAMS(X)                                                                             \
  X(double, transient_N_per_m_s, "N*s/m", 0, 1e6, "first value, of the speed of the touch; 0: nothing rings")   \
  X(double, transient_turn, "-", -2, 2, "2 exp(-decay T) cos(2 pi frequency T): of the last value in the next") \
  X(double, transient_kept, "-", 0, 1, "exp(-2 decay T): of the one before, which is taken off it")             \
  X(double, transient_most, "-", 0, 1, "largest first value, of force_max_N")                                   \
  X(std::int32_t, transient_ticks, "ticks", 0, 1'000'000, "until a hundredth is left: it ends, another may begin")
// Friction.
#define PALPATE_FRICTION_PARAMS(X)                                                                    \
  PALPATE_CHOICE_PARAM(X, FrictionLaw, friction_law, "limit and motion of friction")                  \
  PALPATE_CHOICE_PARAM(X, TangentialLaw, tangential_law,                                              \
                       "sticking force from each depth component by itself, or from the whole depth") \
  X(double, friction_k_N, "N^(1-beta)", 0, 1e6, "K of the static limit K F^beta")                     \
  X(double, friction_beta, "-", 0.5, 1, "exponent of the static limit")                               \
  X(double, friction_mu_dynamic, "-", 0, 10, "sliding coefficient")                                   \
  X(double, friction_slip_m, "m", 0, 1, "presliding_paper: stretch at which the contact slides")
// Regions, and how they influence one another.
#define PALPATE_REGION_PARAMS(X)                                                                \
  PALPATE_CHOICE_PARAM(X, CouplingLaw, coupling_law, "how regions influence one another")       \
  X(double, cluster_distance_m, "m", 1e-6, 1, "contact points nearer than this are one region") \
  X(double, far_field_radius_m, "m", 1e-6, 1, "core radius of the far-field kernel between regions")
// The shape as drawn, and beams.
#define PALPATE_SKELETON_PARAMS(X)                                                                 \
  PALPATE_CHOICE_PARAM(X, SkeletonLaw, skeleton_law, "beams from contact regions to anchors")      \
  PALPATE_CHOICE_PARAM(X, ShapeLaw, shape_law, "how anchor displacements spread over the surface") \
  PALPATE_CHOICE_PARAM(X, RbfTail, rbf_tail, "polynomial of the surface interpolation")            \
  PALPATE_CHOICE_PARAM(X, NeighbourhoodLaw, neighbourhood_law, "dent around a contact")            \
  X(double, neighbourhood_radius_m, "m", 1e-6, 1, "R of the local dent")
// Articulated tools.
#define PALPATE_JOINT_PARAMS(X)                                                                      \
  X(double, closing_rate_per_s, "1/s", 0, 1e3, "fastest change of a closing fraction")               \
  X(double, stop_force_N, "N", 0, 1e6, "a joint stops where it would press a part harder than this") \
  X(double, palm_radius_m, "m", 0, 1, "of the largest disc on the palm's face: where it can push")   \
  X(double, palm_face_m, "m", 0, 1, "from the tool's origin to that face")
// Coupling to the device, and safety.
#define PALPATE_DEVICE_PARAMS(X)                                                                                      \
  PALPATE_CHOICE_PARAM(X, HeldPart, held_part, "what the device moves")                                               \
  X(double, grip_x_m, "m", -10, 10, "held body: where the hand holds it, in its frame; or where a second tool rests") \
  X(double, grip_y_m, "m", -10, 10, "the same, y")                                                                    \
  X(double, grip_z_m, "m", -10, 10, "the same, z")                                                                    \
  X(double, coupling_N_per_m, "N/m", 1, 1e6, "translational stiffness of the virtual coupling")                       \
  X(double, coupling_Nm_per_rad, "N*m/rad", 1e-6, 1e4, "rotational stiffness of the virtual coupling")                \
  X(double, coupling_Ns_per_m, "N*s/m", 0, 1e4, "damping of the virtual coupling")                                    \
  X(double, delay_s, "s", 0, 0.1, "of the device, from sample to force, beyond the tick")                             \
  X(double, local_period_s, "s", 0, 0.1,                                                                              \
    "of the device's own evaluation of the local contact model; 0: it has none, forces are held")                     \
  X(double, encoder_step_m, "m", 0, 0.1, "of the device: within it the handle's position is observed")                \
  X(double, encoder_step_rad, "rad", 0, 1, "and its orientation")                                                     \
  PALPATE_CHOICE_PARAM(X, EncoderLaw, encoder_law_m, "how the position is observed")                                  \
  PALPATE_CHOICE_PARAM(X, EncoderLaw, encoder_law_rad, "how the orientation is")                                      \
  X(double, track_below_N_per_m, "N/m", 0, 1e6,                                                                       \
    "followed by its edges, the handle is on its track while it feels less than that")                                \
  X(double, force_max_N, "N", 0, kWireForceMax_N, "magnitude limit of the rendered force")                            \
  X(double, torque_max_Nm, "N*m", 0, kWireTorqueMax_Nm, "magnitude limit of the rendered torque")                     \
  X(double, force_rate_max_N_per_s, "N/s", 1, 1e7, "fault limiter of the force change")                               \
  X(double, ramp_in_s, "s", 0, 10, "force ramp after arming")                                                         \
  X(double, ramp_out_s, "s", 1e-3, 1, "force ramp to zero after a fault")                                             \
  X(double, speed_max_m_per_s, "m/s", 0.01, 100, "a device sample that implies a faster motion is rejected")          \
  X(double, acceleration_max_m_per_s2, "m/s2", 0, 1e6,                                                                \
    "a sample that implies a larger acceleration is rejected; 0: not asked")                                          \
  X(double, turn_max_rad_per_s, "rad/s", 0.1, 1000, "a device sample that implies a faster turn is rejected")         \
  X(std::int32_t, silence_hold_ticks, "ticks", 1, 500, "ticks the last sample is held")                               \
  X(std::int32_t, silence_passive_ticks, "ticks", 1, 2000, "ticks after which force ramps to zero")                   \
  X(std::int32_t, silence_fault_ticks, "ticks", 2, 100'000, "ticks of silence that latch a fault")                    \
  X(std::int32_t, late_ticks_max, "ticks", 2, 100'000, "ticks in a row that each missed deadlines: a fault")          \
  X(double, stall_max_s, "s", 1e-3, 1, "deadlines missed at one go for so long: a fault")

// G(title, parameters, methods that read them): the groups, for dumps and documents.
#define PALPATE_PARAM_GROUPS(G)                                                    \
  G("the tick, and which method finds contact", PALPATE_METHOD_PARAMS, kOfAll)     \
  G("the body", PALPATE_BODY_PARAMS, kOfAll)                                       \
  G("tool points with springs", PALPATE_POINT_PARAMS, kOfPoints)                   \
  G("whole tips and tables", PALPATE_TIP_PARAMS, kOfTips)                          \
  G("nodes of a finite-element body", PALPATE_NODE_PARAMS, kOfNodes)               \
  G("elastic body", PALPATE_ELASTIC_PARAMS, kOfElastic)                            \
  G("relaxation", PALPATE_RELAXATION_PARAMS, kOfPoints | kOfTips | kOfElastic)     \
  G("what rings at a touch", PALPATE_TRANSIENT_PARAMS, kOfAll)                     \
  G("friction", PALPATE_FRICTION_PARAMS, kOfAll)                                   \
  G("regions, and how they influence one another", PALPATE_REGION_PARAMS, kOfAll)  \
  G("the shape as drawn, and beams", PALPATE_SKELETON_PARAMS, kOfPoints | kOfTips) \
  G("articulated tools", PALPATE_JOINT_PARAMS, kOfAll)                             \
  G("coupling to the device, and safety", PALPATE_DEVICE_PARAMS, kOfAll)
#define PALPATE_MODEL_PARAMS(X) \
  PALPATE_METHOD_PARAMS(X)      \
  PALPATE_BODY_PARAMS(X)        \
  PALPATE_POINT_PARAMS(X)       \
  PALPATE_TIP_PARAMS(X)         \
  PALPATE_NODE_PARAMS(X)        \
  PALPATE_ELASTIC_PARAMS(X)     \
  PALPATE_RELAXATION_PARAMS(X)  \
  PALPATE_TRANSIENT_PARAMS(X)   \
  PALPATE_FRICTION_PARAMS(X)    \
  PALPATE_REGION_PARAMS(X)      \
  PALPATE_SKELETON_PARAMS(X)    \
  PALPATE_JOINT_PARAMS(X)       \
  PALPATE_DEVICE_PARAMS(X)

struct ModelParams {
#define PALPATE_FIELD(type, name, unit, lowest, highest, meaning) type name;
  PALPATE_MODEL_PARAMS(PALPATE_FIELD)
#undef PALPATE_FIELD
};

inline Method method_of(const ModelParams& params) PALPATE_RT {
  if (params.backend == Backend::kNodal) return Method::kNodes;
  if (params.backend == Backend::kElastic) return Method::kElastic;
  return params.response_law == ResponseLaw::kPoints ? Method::kPoints : Method::kTips;
}

// Element types of the image arrays. All trivially copyable, without padding.
struct Triangle {
  std::int32_t vertex[3];    // counter-clockwise seen from outside
  std::int32_t adjacent[3];  // triangle across edge (vertex[k], vertex[(k+1)%3])
  // Clearance: outside the ring (the triangles that share a vertex with this one) no surface point is nearer than
  // clear_radius_m to the point centroid + clear_scale_per_m * cross(edge 0, -edge 2). 0: unknown.
  float clear_scale_per_m = 0;
  float clear_radius_m = 0;
  // 1: no vertex of the ring lies above the plane of this triangle or of one across an edge of it; 2: nor above that of
  // any triangle of the ring; 3 and more: surface/ring_proof.h, where clear_* is of what rises above these planes.
  std::int32_t ring_convex = 0;
};
// Node of a 4-wide hierarchy over the triangles. Bounds are single precision, rounded outward. The normal cone of a
// child (axis, tangent of its half-angle) holds the normals of all its triangles and of their neighbours across edges
// and vertices; its radius is that of a sphere about the box centre that holds the child. A zero axis means "no cone":
// the child is then never skipped by direction.
struct BvhNode {
  float lower_m[3][4];
  float upper_m[3][4];
  float cone_axis[3][4];
  float cone_tangent[4];
  float cone_radius_m[4];
  std::int32_t child[4];  // count 0: inner node (>= 0) or empty (-1); count > 0: leaf, first triangle = ~child
  std::int32_t count[4];  // triangles in a leaf (1..4; they are contiguous), 0 for inner nodes and empty slots
};
// Convex piece of the tool: a core shape (tool frame) rounded by a margin, as in "sphere = point + radius".
struct ToolPiece {
  Pose pose_tool;           // piece frame in the tool frame; axis of revolution = piece z
  double half_extent_m[3];  // core: capsule (what its ends leave to a solid's edges, of 1; half length); cylinder, cone
                            // (radius, radius, half length); box half sides; a solid's plate (half sides, 0)
  double margin_m;          // rounding radius added to the core
  double bounding_radius_m;  // of core and margin, about pose_tool.position_m
  PieceShape shape;
  std::int32_t first_point, point_count;  // its tool points
  std::int32_t first_hull, hull_count;    // its hull vertices (kHull only)
  std::int32_t first_face, face_count;    // and the triangles between them; none where they span no volume
  std::int32_t plane_count;               // the first of them, one in each plane
  std::int32_t part;                      // label for telemetry: finger part, mallet head...
  std::int32_t joint = -1;                // that carries it; -1: fixed to the tool frame
  std::int32_t group =
      0;  // articulated tools: contacts of different groups (fingers, jaws, tools) never share a region
  std::int32_t curve_set = 0;  // tables: which of the sets of curves is its own
  double neighbourhood_m = 0;  // radius of the dent it makes; 0: the scene's
};
// One degree of freedom of an articulated tool. Its link's frame in the tool frame is
//   link = link(parent) * before * motion(q) * after,   motion = rotation about z or translation along z,
// which holds the standard Denavit-Hartenberg row Rz(theta) Tz(d) Tx(a) Rx(alpha) with theta = sign q and after = Tx(a)
// Rx(alpha). Pieces are described in the tool frame with every joint at zero.
struct Joint {
  Pose before;             // parent's link frame to the joint's axis
  Pose after;              // moved axis to the link's frame
  Pose zero_inverse;       // tool frame to the link's frame with every joint at zero
  double lowest, highest;  // rad or m
  double open, closed;     // where closing fractions 0 and 1 put it, within the limits
  double speed_max;        // rad/s or m/s
  double sign;             // +1 or -1
  std::int32_t parent;     // a lower joint, or -1: the tool frame
  JointKind kind;
  std::int32_t finger;  // whose closing fraction drives it
  std::int32_t reserved;
};
// Triangle of a hull piece's core, counter-clockwise seen from outside. All of the core lies in normal . x <= offset_m.
struct HullFace {
  Vec3 normal;
  double offset_m;
  Vec3 corner_m[3];
};
// Point of a piece's core: the centre of a small sphere of radius margin_m that carries a share of the contact.
struct ToolPoint {
  Vec3 position_tool_m;
  double margin_m;
  double area_m2;  // surface area it stands for
  double weight;   // area_m2 / reference area: multiplies the contact law in the Winkler weighting
  std::int32_t piece;
  // Elastic: a triangle of the one part of the surface that it touches, which ends at sharp edges; 0: it touches all.
  std::int32_t begins_at;
};
// Curvature-extremal point of the body with its straight beam's section.
struct Anchor {
  Vec3 position_m;
  Vec3 normal;
  double section_area_m2;
  double section_inertia_m4;
  double section_radius_m;
  double release_length_m;
  std::int32_t fixed;  // 1: clamped to the world, never moves
  std::int32_t reserved;
};
// Which three anchors span the patch a surface vertex lies in, and with which weights.
struct PatchWeight {
  std::int32_t anchor[3];
  std::int32_t reserved;
  double weight[3];
};
// A surface node of a finite-element body: vertex i of the surface, with the same index.
struct NodalVertex {
  double area_m2;        // a third of the areas of its triangles
  std::int64_t is_free;  // 0: held in some direction
  // Where the surface bends sharply between its nodes, the ball that fits it there: radius (0: none), the surface's
  // normal at the node on the bent side of any crease, and the cosine of the angle the node's share of it spans.
  double round_m = 0;
  Vec3 round_normal;
  double round_cosine = 1;
};

// Law of one tool tip, travel = local + c0 F + c1 F^2 (rt_core/contact/tips/tip_law.h): F(e) = coefficient
// e^(half_power/2) S(sqrt(e / depth_max_m)), e the local indentation; S, the exact factor of a layer or of a sphere, is
// a table.
struct TipLaw {
  double coefficient;         // N/m^(half_power/2)
  double depth_max_m;         // of e; beyond it everything continues by its tangent
  double limit_m;             // of e: a layer's plate, towards which it stiffens beyond depth_max_m; 0: none
  double force_max_N;         // at depth_max_m
  double c0_m_per_N;          // far field of the body
  double c1_m_per_N2;         // its geometric nonlinearity
  std::int32_t half_power;    // 2 flat punch, 3 sphere, 4 cone
  std::int32_t first_factor;  // kFactorKnots entries of factor from here; -1: S = 1
};
// S and dS/dx at x = k / (kFactorKnots - 1), and the energy of the law there.
struct FactorKnot {
  double value;
  double slope;
  double energy_J;
};
// How two tips influence one another through the body: W = c F_a F_b + (h_ab F_a + h_ba F_b) F_a F_b / 2.
struct TipPair {
  std::int32_t piece_a, piece_b;
  double c_m_per_N;
  double h_ab_m_per_N2, h_ba_m_per_N2;
};
// Unit normals of the smooth surface at a triangle's corners: those of the vertex, but split where the edge is sharp.
struct CornerNormals {
  Vec3 normal[3];
};
// What one stage of the tick may take at most, in instructions (rt_core/stage_cost.h).
struct StageCost {
  double instructions;
};
// Tabulated force at one knot of one curve; slope is that of the force over the table's variable.
struct ResponseKnot {
  double force_N;
  double slope;
  double energy_J;
};

// A circular (or other baked) beam from one surface vertex to one anchor. Beams are stored vertex by vertex, anchor by
// anchor: element vertex * n_anchor + anchor. A beam that could not be laid inside the body is all zeros.
struct BeamStiffness {
  double k_N_per_m[6];  // symmetric 3x3 (xx, xy, xz, yy, yz, zz), world: force on the tip per tip displacement
};
// The paper's ratios instead: F1 along f1_axis in proportion to f1_gain . D, F2 along f2_axis to f2_gain . D.
struct BeamRatio {
  Vec3 f1_axis, f1_gain_N_per_m, f2_axis, f2_gain_N_per_m;
};
// What one newton on the tip does at the anchor: rows to be multiplied by the tip force.
struct BeamResponse {
  Vec3 release_m_per_N[3];  // x, y, z displacement of the anchor released over its release length
  Vec3 inner_Pa_per_N;      // stress along the beam at the inner and outer fibre of the clamped section,
  Vec3 outer_Pa_per_N;      //
  Vec3 side_Pa_per_N;       // what bending out of the beam's plane adds at its sides,
  Vec3 axial_Pa_per_N;      // the mean, and the shear in the section's middle, in and out of the plane
  Vec3 shear_in_Pa_per_N, shear_out_Pa_per_N;
};

// X(element type, name, number of elements, frame, meaning). Sizes are fields of ModelSizes.
#define PALPATE_MODEL_ARRAYS(X)                                                                                 \
  X(Vec3, vertex_m, n_vertex, "world", "rest surface vertices")                                                 \
  X(Vec3, vertex_normal, n_vertex, "world", "outward angle-weighted unit normals")                              \
  X(Triangle, triangle, n_triangle, "-", "rest surface triangles, sorted by hierarchy leaf")                    \
  X(BvhNode, bvh, n_bvh, "world", "4-wide hierarchy; node 0 is the root, children after their parent")          \
  X(Anchor, anchor, n_anchor, "world", "skeleton anchors")                                                      \
  X(double, rbf_inverse, n_rbf2, "-", "inverse of the bordered RBF matrix, row-major, n_rbf x n_rbf")           \
  X(PatchWeight, patch, n_patch, "-", "patch of each vertex (displacement-angle interpolation only)")           \
  X(BeamStiffness, beam_stiffness, n_beam_stiffness, "world", "baked beams: vertex x anchor")                   \
  X(BeamRatio, beam_ratio, n_beam_ratio, "world", "baked beams of the paper's law: vertex x anchor")            \
  X(BeamResponse, beam_response, n_beam_response, "world", "anchors' response: vertex x anchor")                \
  X(ToolPiece, piece, n_piece, "tool", "convex pieces of the tool")                                             \
  X(ToolPoint, tool_point, n_tool_point, "tool", "sample points of the tool")                                   \
  X(Vec3, hull_vertex_m, n_hull, "piece", "vertices of hull pieces")                                            \
  X(HullFace, hull_face, n_hull_face, "piece", "triangles of hull pieces")                                      \
  X(NodalVertex, nodal_vertex, n_nodal, "-", "surface nodes of a finite-element body: one per vertex")          \
  X(float, compliance_f32, n_compliance_f32, "world",                                                           \
    "surface compliance, m/N: row-major (3 n_vertex)^2, held components zero")                                  \
  X(double, compliance_f64, n_compliance_f64, "world", "the same in double precision; one of the two is empty") \
  X(float, strain_gauge, n_strain_gauge, "world",                                                               \
    "strain per newton: 3 n_vertex rows of 6 components (xx yy zz xy yz zx) per gauge")                         \
  X(float, elastic_vertex, n_elastic_vertex, "world",                                                           \
    "elastic body: what a vertex of the surface shows of its modes (rt_core/contact/elastic/elastic_layout.h)") \
  X(double, elastic_cubic, n_elastic_cubic, "-", "its cubic energy, J^-1/2: elastic_soft columns of pairs")     \
  X(double, elastic_quartic, n_elastic_quartic, "-", "its quartic energy, 1/J: one column per pair")            \
  X(Joint, joint, n_joint, "tool", "joints of an articulated tool, parents first")                              \
  X(Pose, grasp_w, n_grasp, "world", "tool pose for which the closed joint positions were made: 0 or 1")        \
  X(CornerNormals, corner_normal, n_corner, "world", "smooth normals; empty where the facets are touched")      \
  X(TipLaw, tip_law, n_tip_law, "-", "law of each piece's tip (kTip only)")                                     \
  X(FactorKnot, factor, n_factor, "-", "factor tables of the tip laws, kFactorKnots each")                      \
  X(TipPair, tip_pair, n_tip_pair, "-", "coupling of pairs of pieces; others use the far field")                \
  X(double, knot, n_knot, "m or sqrt(m)", "depths (or their roots) of all curves, ascending from 0")            \
  X(ResponseKnot, response, n_response, "-", "curves, n_knot entries each (tables only)")                       \
  X(std::int32_t, vertex_response, n_vertex_response, "-", "curve of each vertex")                              \
  X(StageCost, stage_cost, n_stage, "instructions", "the worst tick, by stage in its order")

// X(name, lowest, highest, methods that have such an array; in a scene of another it is empty)
#define PALPATE_MODEL_SIZES(X)                      \
  X(n_vertex, 4, 1 << 26, kOfAll)                   \
  X(n_triangle, 4, 1 << 26, kOfAll)                 \
  X(n_bvh, 1, 1 << 26, kOfAll)                      \
  X(n_anchor, 0, kMaxAnchors, kOfAll)               \
  X(n_rbf, 0, kMaxAnchors + 4, kOfAll)              \
  X(n_rbf2, 0, 1 << 12, kOfAll)                     \
  X(n_patch, 0, 1 << 26, kOfAll)                    \
  X(n_beam_stiffness, 0, 1 << 26, kOfAll)           \
  X(n_beam_ratio, 0, 1 << 26, kOfAll)               \
  X(n_beam_response, 0, 1 << 26, kOfAll)            \
  X(n_piece, 1, kMaxPieces, kOfAll)                 \
  X(n_tool_point, 1, kMaxToolPoints, kOfAll)        \
  X(n_hull, 0, 1 << 16, kOfAll)                     \
  X(n_hull_face, 0, 1 << 16, kOfAll)                \
  X(n_nodal, 0, 1 << 26, kOfNodes)                  \
  X(n_compliance_f32, 0, 1 << 28, kOfNodes)         \
  X(n_compliance_f64, 0, 1 << 28, kOfNodes)         \
  X(n_strain_gauge, 0, 1 << 26, kOfNodes)           \
  X(n_elastic_vertex, 0, 1 << 28, kOfElastic)       \
  X(n_elastic_cubic, 0, 1 << 16, kOfElastic)        \
  X(n_elastic_quartic, 0, 1 << 16, kOfElastic)      \
  X(n_joint, 0, kMaxJoints, kOfAll)                 \
  X(n_grasp, 0, 1, kOfAll)                          \
  X(n_corner, 0, 1 << 26, kOfAll)                   \
  X(n_tip_law, 0, kMaxPieces, kOfTips | kOfElastic) \
  X(n_factor, 0, 1 << 16, kOfTips | kOfElastic)     \
  X(n_tip_pair, 0, kMaxTipPairs, kOfTips)           \
  X(n_knot, 0, kMaxResponseKnots, kOfTips)          \
  X(n_response, 0, 1 << 26, kOfTips)                \
  X(n_vertex_response, 0, 1 << 26, kOfTips)         \
  X(n_stage, kStageCount, kStageCount, kOfAll)

struct ModelSizes {
#define PALPATE_FIELD(name, lowest, highest, methods) std::int64_t name;
  PALPATE_MODEL_SIZES(PALPATE_FIELD)
#undef PALPATE_FIELD
};

// Read-only views; valid while the image bytes they point into live. Copy freely.
struct Model {
  ModelParams params{};
  ModelSizes sizes{};
  std::uint64_t scene_hash = 0;  // checksum of the whole image: what a recording names as its scene
  const char* name = "";         // zero-terminated, inside the image
#define PALPATE_FIELD(type, name, count, frame, meaning) std::span<const type> name;
  PALPATE_MODEL_ARRAYS(PALPATE_FIELD)
#undef PALPATE_FIELD
};

// Whether every tool point touches one part of the body's surface (ToolPoint::begins_at).
inline bool touches_in_parts(const Model& model) PALPATE_RT {
  return !model.tool_point.empty() && model.tool_point[0].begins_at > 0;
}

}  // namespace palpate
