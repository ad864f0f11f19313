// What a scene file says, in SI units, with defaults. One struct per TOML table; the keys, their units, ranges and
// meanings are the table in config/scene/schema.cpp, from which the reader's checks and docs/scene_format.md are made.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/body/procedural.h"
#include "config/response/layer_contact.h"
#include "config/scene/choices.h"
#include "rt_core/device_profile.h"
#include "rt_core/model.h"

namespace palpate {

// A number the scene leaves to the baker ("auto" in the file).
inline constexpr double kAuto = std::numeric_limits<double>::quiet_NaN();
inline bool is_auto(double x) { return std::isnan(x); }

struct BodyDesc {
  BodyShape shape = BodyShape::kEllipsoid;
  Vec3 half_axes_m{0.040, 0.030, 0.025};
  double radius_m = 0.030;
  double height_m = 0.060;
  Vec3 size_m{0.060, 0.060, 0.060};
  double width_m = 0.080;
  double wall_m = 0.010;
  double e1 = 1, e2 = 1;
  BodyAxis axis = BodyAxis::kY;
  SpherePattern pattern = SpherePattern::kGeodesic;
  std::vector<ProfilePoint> profile;
  std::string mesh;
  double scale = 1e-3;
  bool fix_orientation = false;
  std::int32_t triangles = 3000;
  Vec3 position_m;
  Vec3 rotation_rad;  // rotation vector
};
// Finite elements of a body (contact.backend = "nodal").
struct FemDesc {
  FemOrder order = FemOrder::kQuadratic;
  FemPrecision precision = FemPrecision::kByError;
  double edge_m = kAuto;
  std::int32_t level = 1;
  std::int32_t strain_gauges = 8;
  Vec3 zone_from_m{kAuto, kAuto, kAuto}, zone_to_m{kAuto, kAuto, kAuto};  // mixed order: quadratic in this box
  std::int32_t zone_layers = 1;
};
// Modes of a body (contact.backend = "elastic").
struct ElasticDesc {
  std::int32_t soft = 0;  // 0: chosen by the check presses
  std::int32_t linear = 20;
  std::int32_t check_presses = -1;  // -1: the baker's
  double check_error = 0.03;
};
struct MaterialDesc {
  double youngs_modulus_Pa = 3e6;
  double poisson_ratio = 0.5;
  double density_kg_per_m3 = 1100;
  Vec3 relaxation_share{0, 0, 0};
  Vec3 relaxation_s{1, 1, 1};
  double lost_share = 0;
  bool legacy_paper_material = false;
};
// One place of another material; see config/bake/element_materials.h.
struct MaterialRegionDesc {
  MaterialShape region = MaterialShape::kBox;
  Vec3 from_m{kAuto, kAuto, kAuto}, to_m{kAuto, kAuto, kAuto};
  Vec3 centre_m{kAuto, kAuto, kAuto};
  double radius_m = kAuto;
  std::string group;
  double youngs_modulus_Pa = kAuto, poisson_ratio = kAuto;
};
// One place where the body is held; see config/body/supports.h.
struct FixedDesc {
  FixedRegion region = FixedRegion::kBase;
  double base_height_m = 0.002;
  Vec3 from_m{kAuto, kAuto, kAuto}, to_m{kAuto, kAuto, kAuto};
  Vec3 centre_m{kAuto, kAuto, kAuto};
  double radius_m = kAuto;
  HeldComponents holds = HeldComponents::kAll;
  double stiffness_N_per_m3 = kAuto;  // of an elastic bed; unset: rigid
  std::vector<std::int32_t> vertices;
  std::string vertices_file;
};

struct SkeletonDesc {
  SkeletonLaw law = SkeletonLaw::kStiffness;
  AnchorSource anchors = AnchorSource::kShape;
  std::int32_t anchors_min = 6;
  std::int32_t anchors_max = kMaxAnchors;
  double section_radius_m = kAuto;
  double beam_width_m = kAuto;
  double beam_thickness_m = kAuto;
  double beam_allowance_m = 0.5e-3;
};

struct ContactDesc {
  ContactLaw law = ContactLaw::kDuffing;
  ContactWeight weight = ContactWeight::kWinkler;
  EquivalentPoint equivalent_point = EquivalentPoint::kPressure;
  ContactSurface surface = ContactSurface::kFacets;
  double reference_area_m2 = kAuto;
  double max_depth_m = 0.006;
  double cluster_distance_m = kAuto;
  Backend backend = Backend::kResponse;
};
struct NodalDesc {
  NodalSolver solver = NodalSolver::kPivoting;
  std::int32_t sweeps = 20;
  std::int32_t friction_sweeps = 4;
  NodalCarry carry = NodalCarry::kFarField;
  double margin_m = kAuto;
  double wall_N_per_m = 5e4;
  double strain_limit = 0.1;
  double proxy_speed_max_m_per_s = 0.5;
};
// What rings at a touch; see rt_core/safety/contact_transient.h.
struct TransientDesc {
  double amplitude_N_per_m_s = 0;
  double frequency_Hz = 0;
  double decay_per_s = 0;
};
// Defaults: Luo & Xiao 2006, section VII, read in millimetres and newtons.
struct DuffingDesc {
  double mass_kg = 1.0;
  double omega0 = 0.2;
  double beta0sq_eps = 0.4;
  DuffingCoefficient coefficient = DuffingCoefficient::kStatic;
};
struct CubicDesc {
  double k1_N_per_m = 0;
  double k3_N_per_m3 = 0;
};
struct HertzDesc {
  double tool_radius_m = 0.010;
  double fit_depth_m = 0.002;
};

// contact.law = "tool": the response of each piece's own tip.
struct TipLawDesc {
  double radius_m = kAuto;
  double half_angle_rad = kAuto;
  SphereLaw sphere = SphereLaw::kExact;
  double body_radius_1_m = kAuto;
  double body_radius_2_m = kAuto;
};
struct LayerDesc {
  double thickness_m = 0;
  LayerBase base = LayerBase::kBonded;
};
struct SeriesDesc {
  double c0_m_per_N = 0;
  double c1_m_per_N2 = 0;
};
struct PairDesc {
  std::int32_t piece_a = 0, piece_b = 1;
  double c_m_per_N = 0;
  double h_ab_m_per_N2 = 0, h_ba_m_per_N2 = 0;
};
// Where the curves of contact.law = "table" come from: a CSV of measured presses, or presses the baker makes.
struct TableDesc {
  TableSource source = TableSource::kFile;
  TableInterpolation interpolation = TableInterpolation::kEnergy;
  std::string file;
  bool smooth = false;
};

struct FrictionDesc {
  FrictionLaw law = FrictionLaw::kReturnMap;
  TangentialLaw tangential = TangentialLaw::kSeparable;
  double mu_ref = kAuto;  // auto: 0.5 unless K is given
  double reference_force_N = 5;
  double k = kAuto;
  double beta = 0.75;
  double mu_dynamic = kAuto;
  double slip_m = 1e-4;
};

struct ShapeDesc {
  ShapeLaw interpolation = ShapeLaw::kRbf;
  RbfTail tail = RbfTail::kConstant;
  NeighbourhoodLaw neighbourhood = NeighbourhoodLaw::kPunch;
  double radius_m = 0.012;
};
struct CouplingDesc {
  CouplingLaw law = CouplingLaw::kCoupled;
  double radius_m = kAuto;
};

struct PieceDesc {
  PieceShape shape = PieceShape::kSphere;
  TouchingEnd touches = TouchingEnd::kAll;
  Vec3 position_m;
  Vec3 rotation_rad;  // rotation vector
  double radius_m = kAuto;
  double length_m = kAuto;
  Vec3 size_m{kAuto, kAuto, kAuto};
  std::vector<Vec3> vertices_m;
  bool is_mesh = false;  // until it is cut into hulls (config/tool/tool_mesh.h)
  std::string mesh;
  double scale = 1e-3;
  double margin_m = kAuto;
  std::int32_t points = 1;
  std::int32_t part = 0;
  std::int32_t hand = 1;   // 2: of the tool in the second hand, device.holds = "two_tools"
  std::string table_file;  // contact.law = "table": the presses made with this tip; empty: the scene's
  Vec3 slide_m;            // gripper: how far it has moved when the gripper is open; described where it is when closed
  // Of a box or hull that was taken apart (config/tool/rounded_solid.h): a capsule along an edge, with what its lower
  // and upper end leave to the other edges there, or a box without thickness on a face, a flat tip of radius_m.
  bool is_of_solid = false;
  double end_left[2] = {0, 0};
};

// Of thumb, index, middle, ring and little finger.
using FingerNumbers = std::array<double, kMaxFingers>;

// Which fingers a hand's grasp uses: thumb and index; with the middle finger; all.
struct HandDesc {
  GraspFingers fingers = GraspFingers::kFive;
  HandSide side = HandSide::kRight;
  HandContact contact = HandContact::kCapsules;
  HandClosing closing = HandClosing::kDepth;
  Vec3 grasp_position_m;  // palm's middle, when the hand holds the body
  Vec3 grasp_rotation_rad;
  FingerNumbers squeeze_m{0.003, 0.003, 0.003, 0.003, 0.003};
  FingerNumbers grip_N{1, 1, 1, 1, 1};
  double clearance_m = 0.0015;
  double closing_s = 1.0;
  double stop_force_N = 5;
  double joint_speed_rad_per_s = 3.14159265358979323846 / 180 * 1000;  // a degree per tick
  std::int32_t points_per_part = 4;
  double thumb_spread_rad = 3.14159265358979323846 / 180 * 25;
};

struct GripperDesc {
  double closing_s = 0.5;
  double stop_force_N = 5;
};

// A simulated device: the numbers its coupling stiffness and limits follow from.
struct DeviceDesc {
  std::string name = "sim-6dof";
  HeldPart holds = HeldPart::kTool;
  Vec3 grip_m;
  double period_s = 1e-3;
#define PALPATE_KEY(member, key, value, lowest, highest, scale, meaning) double member = value;
  PALPATE_PROFILE_KEYS(PALPATE_KEY)
#undef PALPATE_KEY
  std::optional<bool> smooth_encoder;  // none: where the device's friction holds the handle
  double force_rate_max_N_per_s = kAuto;
  double coupling_N_per_m = kAuto;
  double coupling_Nm_per_rad = kAuto;
  double coupling_Ns_per_m = kAuto;
  double ramp_in_s = 0.1;
  double ramp_out_s = 0.05;
  double silence_hold_s = 3e-3;
  double silence_passive_s = 5e-3;
  double silence_fault_s = 50e-3;
  double late_max_s = 10e-3;
  double stall_max_s = 20e-3;
  double speed_max_m_per_s = 5;
  double acceleration_max_m_per_s2 = 200;
  double turn_max_rad_per_s = 30;
};

// The demonstration: what the simulated hand does. Not part of the image.
struct PathPoint {
  double time_s = 0;
  Vec3 position_m;
  Vec3 rotation_rad;                 // rotation vector
  std::vector<double> closing = {};  // of each finger, or one for all; empty: as at the point before
};
struct PathDesc {
  double hand_stiffness_N_per_m = 800;
  double hand_damping_Ns_per_m = 8;
  double hand_stiffness_Nm_per_rad = 0.5;
  double hand_damping_Nms_per_rad = 0.01;
  std::vector<PathPoint> point;
  std::vector<PathPoint> second;  // of the second of two hands that hold a tool each
};

// Where the scene came from, so that later checks can still name file and line.
struct SceneSource {
  std::string file = "scene";
  std::string directory;                       // of the file, with a trailing slash; mesh paths are relative to it
  std::map<std::string, std::string> overlay;  // file of the keys that an overlay gave
  std::map<std::string, int> line;             // "contact.max_depth_mm" -> line; only keys present in the file
  bool has(const std::string& key) const { return line.count(key) != 0; }
  // Whether something was laid over the scene (--with, --set friction.law=none), and not this key nor what is in its
  // table. What is then out of work in the scene's own file is no mistake of the file's.
  bool is_overruled(const std::string& key) const;
  // "file:line: key" for an error text; without a line when the key is absent.
  std::string where(const std::string& key) const;
};

struct SceneDesc {
  std::string name = "scene";
  std::int32_t budget_instructions = 0;
  std::string error_target;   // "3 %"; empty: none
  std::string default_model;  // what was taken for a law that the scene leaves open, in words; empty: it names one
  BodyDesc body;
  FemDesc fem;
  MaterialDesc material;
  std::vector<MaterialRegionDesc> material_region;
  std::vector<FixedDesc> fixed;  // none: the default base
  SkeletonDesc skeleton;
  ContactDesc contact;
  NodalDesc nodal;
  TransientDesc transient;
  ElasticDesc elastic;
  DuffingDesc duffing;
  CubicDesc cubic;
  HertzDesc hertz;
  TipLawDesc tip;
  LayerDesc layer;
  SeriesDesc series;
  std::vector<PairDesc> pair;
  TableDesc table;
  FrictionDesc friction;
  ShapeDesc shape;
  CouplingDesc coupling;
  std::vector<PieceDesc> piece;
  Articulation articulation = Articulation::kRigid;  // set by the presence of [gripper] or [hand]
  GripperDesc gripper;
  HandDesc hand;
  DeviceDesc device;
  PathDesc path;
  SceneSource source;
};

// What is laid over a scene, in order: files that hold some of its tables (another tool, another material), then single
// keys, "body.material.youngs_modulus_Pa=1e6". Tables are merged; values and lists, [[tool.piece]] among them, replace.
struct SceneOverlays {
  std::vector<std::string> file;
  std::vector<std::string> setting;
};

// Reads and checks a scene file. Throws ConfigError: "FILE:LINE: KEY: what is wrong; what is allowed; what to do".
SceneDesc load_scene(const std::string& path, const SceneOverlays& overlays = {});
// The same from text; `file` names it in errors.
SceneDesc parse_scene(const std::string& text, const std::string& file);

// Checks that need more than one key (exclusive keys, material rules, tool dimensions, path order). Part of load_scene;
// call it for a SceneDesc made or changed in code.
void check_scene(const SceneDesc& scene);
// error_target as a share, 0.03; kAuto where there is none or it is no percentage.
double error_target_share(const SceneDesc& scene);
// Refuses keys of the file that would do nothing beside the others (scene_effect.cpp). Part of load_scene alone: code
// that switches friction off does not take back its coefficient.
void check_effects(const SceneDesc& scene);
// Keys that do less than who wrote them will think, as sentences: the baker warns of them.
std::vector<std::string> weak_keys(const SceneDesc& scene);

// The schema as Markdown, one table per TOML table: the generated part of docs/scene_format.md.
std::string schema_markdown();

}  // namespace palpate
