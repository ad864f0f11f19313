#include "config/scene/schema_keys.h"

#include <array>

namespace palpate {

namespace {

using namespace schema;

const KeySpec kTop[] = {
    text<&SceneDesc::name>("name", kNameBytes - 1, "name stored in the image and shown everywhere", true),
    integer<&SceneDesc::budget_instructions>("budget_instructions", 0, 10'000'000,
                                             "most instructions a tick may take in tests/bench, "
                                             "counted by callgrind; 0: none stated"),
    text<&SceneDesc::error_target>(
        "error_target", 16,
        "\"3 %\": take the cheapest model that errs by no more; so by default where the material is stated "
        "and no model is; \"none\": no press; see docs/models_elastic.md"),
};

const KeySpec kSkeleton[] = {
    choice<&SkeletonDesc::law>("law",
                               "beam skeleton: stiffness = sum of straight beams' stiffnesses; paper = the ratios of "
                               "Luo & Xiao 2006, eqs. 6-8; paper_guarded = the same, finite at an anchor; circular = "
                               "circular beams where straight ones would leave "
                               "the body (objects with holes), sum of stiffnesses; circular_paper = the circular beams "
                               "and force ratios as printed in 2009 (docs/models_circular_beams.md)"),
    choice<&SkeletonDesc::anchors>("anchors",
                                   "auto: exact curvature-extremal points of the shape, from the mesh where the shape "
                                   "is a mesh or a heart; mesh: always from the mesh"),
    integer<&SkeletonDesc::anchors_min>("anchors_min", 0, kMaxAnchors, "add extreme points until there are this many"),
    integer<&SkeletonDesc::anchors_max>("anchors_max", 1, kMaxAnchors, "keep the most persistent"),
    number_or_auto<&SkeletonDesc::section_radius_m>(
        "section_radius_mm", 0.01, 5000, kMilli,
        "radius of the beams' circular section; auto: the beams share the body's volume, S = V / sum of lengths"),
    number_or_auto<&SkeletonDesc::beam_width_m>(
        "beam_width_mm", 0.01, 5000, kMilli,
        "circular: width of the beams in their plane, below the thinnest wall; auto: a quarter of it"),
    number_or_auto<&SkeletonDesc::beam_thickness_m>(
        "beam_thickness_mm", 0.01, 5000, kMilli,
        "circular: thickness across the plane; auto: the beams share the body's volume"),
    number<&SkeletonDesc::beam_allowance_m>("beam_allowance_mm", 0, 1000, kMilli,
                                            "circular: epsilon, added to the radius of curvature of the surface"),
};
const KeySpec kContact[] = {
    choice<&ContactDesc::law>(
        "law",
        "force per unit weight of each tool point, f = k1 D + k3 D^3: from Duffing parameters, "
        "given directly, or fitted to Hertz' contact; or the response of the whole tip: of the "
        "piece's own shape (tool), or curves of presses (table). Another default where E is stated: above"),
    choice<&ContactDesc::weight>("weight",
                                 "weight of a tool point: area / reference area (force continuous as points enter and "
                                 "leave), share of the area in contact, or 1/n"),
    choice<&ContactDesc::equivalent_point>("equivalent_point",
                                           "a region's centre: of its pressure, or geometric (paper)"),
    choice<&ContactDesc::surface>("surface",
                                  "what a tool point touches: the triangles, whose edges are felt by a tool of few "
                                  "points; or the smooth surface they stand for, about 1,400 instructions more a "
                                  "point. laws tool and table: always smooth"),
    number_or_auto<&ContactDesc::reference_area_m2>(
        "reference_area_mm2", 1e-3, 1e8, kMilliSquared,
        "winkler: contact area over which the law holds as stated; auto: mean area of a tool point"),
    number<&ContactDesc::max_depth_m>(
        "max_depth_mm", 0.001, 1000, kMilli,
        "deepest penetration of the law; beyond it the law continues by its tangent. Whole tips: of "
        "the dent under a tip alone, and left out at most a sphere's radius, where its "
        "law ends"),
    number_or_auto<&ContactDesc::cluster_distance_m>(
        "cluster_distance_mm", 0.001, 1000, kMilli,
        "contact points nearer than this are one region; auto: twice the "
        "spacing of the tool points; nodal: three edges; elastic: every tip is one"),
    choice<&ContactDesc::backend>(
        "backend",
        "response: tool points with a force law each; nodal: finite elements against the tool's "
        "exact pieces (docs/models_contact_lcp.md); elastic: whole tips on a body that gives as its modes do "
        "(docs/models_elastic.md)"),
};
const KeySpec kNodal[] = {
    choice<&NodalDesc::solver>("solver",
                               "normal forces: exact, by block principal pivoting; or approximate, by sweeps"),
    integer<&NodalDesc::sweeps>("sweeps", 1, 100, "gauss_seidel: sweeps per tick"),
    integer<&NodalDesc::friction_sweeps>("friction_sweeps", 1, 20,
                                         "sweeps per tick of the problem with friction; each costs about 30,000 "
                                         "instructions for 45 contacts"),
    choice<&NodalDesc::carry>("carry",
                              "where gaps and normals are taken: on the surface carried by its far field, at rest, or "
                              "carried by the far field's finite rotation (clips: 4.6 % instead of 8.8 %)"),
    number_or_auto<&NodalDesc::margin_m>("margin_mm", 0.001, 100, kMilli,
                                         "nodes nearer to the tool take part; auto: a quarter of a mean edge"),
    number<&NodalDesc::wall_N_per_m>("wall_N_per_m", 1, 1e9, 1, "stiffness of held nodes"),
    number<&NodalDesc::strain_limit>("strain_limit", 1e-6, 10, 1, "strain above which a tick says so"),
    number<&NodalDesc::proxy_speed_max_m_per_s>("proxy_speed_max_m_per_s", 0.001, 100, 1,
                                                "the tool in contact moves no faster than the handle and this: what a "
                                                "snap may jump in a tick"),
};
const KeySpec kTransient[] = {
    number<&TransientDesc::amplitude_N_per_m_s>("amplitude_N_per_m_s", 0, 1e5, 1,
                                                "height of the decaying sinusoid at a touch, of the speed of the "
                                                "touch; 0: nothing rings. Lowered where it would "
                                                "change the force by more than 5 % of force_max_N in a tick"),
    number<&TransientDesc::frequency_Hz>("frequency_Hz", 0, 5000, 1,
                                         "of it; at most 0.4 of the device's sample rate. 0: not stated"),
    number<&TransientDesc::decay_per_s>("decay_per_s", 0, 1e4, 1, "of its envelope, exp(-decay t). 0: not stated"),
};
const KeySpec kDuffing[] = {
    number<&DuffingDesc::mass_kg>("mass_kg", 1e-6, 1e6, 1, "m; with the two below in mm and N: k1 = m omega0^2 N/mm"),
    number<&DuffingDesc::omega0>("omega0", 0, 1e3, 1, "omega0 of Luo & Xiao 2006"),
    number<&DuffingDesc::beta0sq_eps>("beta0sq_eps", 0, 1e6, 1,
                                      "beta0^2 epsilon; k3 = coefficient m beta0^2 eps N/mm^3"),
    choice<&DuffingDesc::coefficient>("coefficient",
                                      "static: 1, the equilibrium under a constant force; paper: 3/4, the mean over an "
                                      "oscillation (Luo & Xiao 2006, eq. 3)"),
};
const KeySpec kCubic[] = {
    number<&CubicDesc::k1_N_per_m>("k1_N_per_m", 0, 1e9, 1, "linear coefficient"),
    number<&CubicDesc::k3_N_per_m3>("k3_N_per_m3", 0, 1e15, 1, "cubic coefficient"),
};
const KeySpec kHertz[] = {
    number<&HertzDesc::tool_radius_m>("tool_radius_mm", 0.01, 1e4, kMilli, "radius of the spherical tool"),
    number<&HertzDesc::fit_depth_m>("fit_depth_mm", 0.001, 1000, kMilli,
                                    "depth at which value and slope match; within 6.8 % of Hertz up to 1.25 times it"),
};
const KeySpec kTip[] = {
    number_or_auto<&TipLawDesc::radius_m>("radius_mm", 0.001, 1e4, kMilli,
                                          "radius of sphere or flat punch; auto: the piece's"),
    number_or_auto<&TipLawDesc::half_angle_rad>("half_angle_deg", 1, 89, kDegree,
                                                "cone: angle between axis and side; auto: the piece's"),
    choice<&TipLawDesc::sphere>("sphere",
                                "shape of the sphere: true, or the parabola of Hertz (1882) and of the paper"),
    number_or_auto<&TipLawDesc::body_radius_1_m>("body_radius_1_mm", -1e5, 1e5, kMilli,
                                                 "sphere: principal radius of the body where it is touched; 0 flat, "
                                                 "negative hollow; auto: of a cylinder, sphere or box"),
    number_or_auto<&TipLawDesc::body_radius_2_m>("body_radius_2_mm", -1e5, 1e5, kMilli, "the other principal radius"),
};
const KeySpec kLayer[] = {
    number<&LayerDesc::thickness_m>("thickness_mm", 0, 1e4, kMilli,
                                    "the body is a layer this thick on a rigid base; 0: as thick as it needs to be"),
    choice<&LayerDesc::base>("base", "how the layer is held by its base"),
};
const KeySpec kSeries[] = {
    number_or_auto<&SeriesDesc::c0_m_per_N>(
        "c0_mm_per_N", -1e3, 1e3, kMilli,
        "far-field compliance c0; auto: from a large-strain press by finite elements (bodies of revolution)"),
    number_or_auto<&SeriesDesc::c1_m_per_N2>("c1_mm_per_N2", -1e3, 1e3, kMilli,
                                             "its change with the force, c1; auto: from one large-strain press"),
};
const KeySpec kPair[] = {
    integer<&PairDesc::piece_a>("piece_a", 0, kMaxPieces - 1, "a tool piece, counted from 0"),
    integer<&PairDesc::piece_b>("piece_b", 0, kMaxPieces - 1, "another"),
    number_or_auto<&PairDesc::c_m_per_N>(
        "c_mm_per_N", -1e3, 1e3, kMilli,
        "travel of one per newton on the other; auto: from presses by finite elements (standing cylinders, boxes)"),
    number_or_auto<&PairDesc::h_ab_m_per_N2>(
        "h_ab_mm_per_N2", -1e3, 1e3, kMilli,
        "second order: energy h_ab F_a^2 F_b / 2 + h_ba F_b^2 F_a / 2; auto: likewise"),
    number_or_auto<&PairDesc::h_ba_m_per_N2>("h_ba_mm_per_N2", -1e3, 1e3, kMilli,
                                             "second order, the other way round; auto: likewise"),
};
const KeySpec kTable[] = {
    choice<&TableDesc::source>("source",
                               "a CSV of measured presses, or presses by finite elements when the scene is baked "
                               "(standing cylinder, box, sphere, ellipsoid of revolution about y)"),
    text<&TableDesc::file>(
        "file", 4096,
        "CSV of presses, relative to the scene file: depth_mm,force_N, or with x_mm,y_mm,z_mm before "
        "them for presses at several places; each starts at 0,0"),
    choice<&TableDesc::interpolation>(
        "interpolation",
        "energy = gradient of the interpolated energies; paper = sum n_i f_i U_i, Mahvash & Hayward 2002, eq. 3"),
    boolean<&TableDesc::smooth>("smooth", "pool rows whose force falls instead of refusing them"),
};
const KeySpec kFriction[] = {
    choice<&FrictionDesc::law>("law", "friction law; coulomb: nodal only, with the coefficient mu_ref"),
    choice<&FrictionDesc::tangential>("tangential",
                                      "sticking force from each depth component by itself, or from the whole depth"),
    number_or_auto<&FrictionDesc::mu_ref>("mu_ref", 0, 100, 1,
                                          "static friction coefficient at the reference force, K = mu_ref F_ref^(1 - "
                                          "beta); auto: 0.5; not with k"),
    number<&FrictionDesc::reference_force_N>("reference_force_N", 1e-3, 1e4, 1, "F_ref"),
    number_or_auto<&FrictionDesc::k>("k", 0, 1e6, 1,
                                     "K of the static limit K F^beta, in N^(1 - beta); not with mu_ref"),
    number<&FrictionDesc::beta>("beta", 0.5, 1, 1, "exponent of the static limit; 2/3 for truly elastic contact"),
    number_or_auto<&FrictionDesc::mu_dynamic>("mu_dynamic", 0, 10, 1,
                                              "sliding coefficient; auto: 0.8 of the static one at F_ref"),
    number<&FrictionDesc::slip_m>("slip_distance_mm", 1e-6, 100, kMilli,
                                  "presliding_paper: displacement at which the contact slides"),
};
const KeySpec kShape[] = {
    choice<&ShapeDesc::interpolation>("interpolation", "how anchor displacements spread over the surface"),
    choice<&ShapeDesc::tail>("tail", "polynomial of the rbf; linear needs 4 anchors not in a plane"),
    choice<&ShapeDesc::neighbourhood>("neighbourhood", "dent around a contact"),
    number<&ShapeDesc::radius_m>("radius_mm", 0.001, 1000, kMilli,
                                 "radius R of the dent; a hand whose scene leaves it out takes that of each finger "
                                 "part from Cui & Xiao 2008, Table I"),
};
const KeySpec kCoupling[] = {
    choice<&CouplingDesc::law>("law",
                               "how contact regions influence one another: not; by a conservative far field; in the "
                               "order they appeared (Cui & Xiao 2008); each by beams to all others (Luo & Xiao 2006)"),
    number_or_auto<&CouplingDesc::radius_m>("radius_mm", 0.001, 1000, kMilli,
                                            "core radius of the far field; auto: sqrt(reference area / pi)"),
};
// The shapes of the core, and "mesh", which the reader cuts into hulls.
constexpr std::int32_t kMeshWord = ChoiceOf<PieceShape>::kCount;
constexpr std::array<const char*, kMeshWord + 1> piece_words() {
  std::array<const char*, kMeshWord + 1> words{};
  for (std::size_t i = 0; i < kMeshWord; ++i) words[i] = ChoiceOf<PieceShape>::kWord[i];
  words[kMeshWord] = "mesh";
  return words;
}
constexpr auto kPieceWords = piece_words();
void set_piece_shape(void* table, std::int32_t value) {
  PieceDesc& piece = *static_cast<PieceDesc*>(table);
  piece.is_mesh = value == kMeshWord;
  piece.shape = piece.is_mesh ? PieceShape::kHull : static_cast<PieceShape>(value);
}
std::int32_t get_piece_shape(const void* table) {
  const PieceDesc& piece = *static_cast<const PieceDesc*>(table);
  return piece.is_mesh ? kMeshWord : static_cast<std::int32_t>(piece.shape);
}

const KeySpec kPiece[] = {
    {"shape", KeyKind::kChoice, 0, 0, 1, true, kPieceWords,
     "kind of piece, see the shapes below; its axis is its z axis; a cone's apex is at +z; mesh: the convex hulls that "
     "make up the surface in a file, so many of the tool's pieces",
     nullptr, set_piece_shape, get_piece_shape},
    choice<&PieceDesc::touches>("touches",
                                "part that carries tool points: all of it, or only the end face (with its rounding) at "
                                "the +z or -z end; only shapes with ends"),
    list<&PieceDesc::position_m>(kVec3, "position_mm", -1e4, 1e4, kMilli, "centre in the tool frame"),
    list<&PieceDesc::rotation_rad>(kVec3, "rotation_deg", -360, 360, kDegree, "rotation vector (axis times angle)"),
    number<&PieceDesc::radius_m>("radius_mm", 0.01, 5000, kMilli,
                                 "radius, where the shape has one: see the shapes below"),
    number<&PieceDesc::length_m>("length_mm", 0.01, 10000, kMilli, "length along the axis: see the shapes below"),
    list<&PieceDesc::size_m>(kVec3, "size_mm", 0.01, 10000, kMilli, "outer sides: see the shapes below"),
    list<&PieceDesc::vertices_m>(KeyKind::kPoints, "vertices_mm", -1e4, 1e4, kMilli,
                                 "corners of the core: see the shapes below"),
    text<&PieceDesc::mesh>("mesh", 4096,
                           "mesh: file (.obj, .stl, .ply), relative to the scene file; margin_mm is added to it"),
    number<&PieceDesc::scale>("scale", 1e-9, 1e6, 1, "mesh: metres per unit of the file"),
    number_or_auto<&PieceDesc::margin_m>("margin_mm", 0.01, 5000, kMilli,
                                         "rounding radius, where the shape has one to choose (see below); contact is "
                                         "exact while penetration stays below "
                                         "it"),
    integer<&PieceDesc::points>(
        "points", 0, kMaxToolPoints,
        "most tool points to spread; each costs about 800 instructions a tick; sphere: 1; box: 8 or more, with "
        "contact.backend = \"elastic\" left out; 0: never touches"),
    text<&PieceDesc::table_file>("table_file", 4096, "its own presses, instead of contact.table.file"),
    integer<&PieceDesc::hand>("hand", 1, 2, "with device.holds = \"two_tools\": the hand that holds the piece"),
    integer<&PieceDesc::part>("part", 0, 1 << 20, "label in recordings"),
    list<&PieceDesc::slide_m>(kVec3, "slide_mm", -1000, 1000, kMilli,
                              "gripper: how far the piece moves away when the gripper opens; it is described where it "
                              "is when closed. Pieces with the same value are one jaw"),
};
const KeySpec kHand[] = {
    choice<&HandDesc::fingers>("fingers",
                               "that take part: thumb and index; with the middle finger; all. The others stay "
                               "stretched out"),
    choice<&HandDesc::side>(
        "side", "left: the mirror image of the right hand in y = 0 of its frame, so the thumb's side is -y"),
    choice<&HandDesc::contact>("contact",
                               "what of a part touches: capsules, a round rod of the part's width; mesh, the palm's "
                               "side of the surface that is drawn, 9 points a part and more also beside its middle"),
    choice<&HandDesc::closing>(
        "closing",
        "where fingers end: depth, each part squeeze_mm deep; balanced, each finger at grip_N and "
        "the thumb at the force that balances them"),
    list<&HandDesc::grasp_position_m>(kVec3, "grasp_mm", -1e4, 1e4, kMilli,
                                      "the palm's middle when the hand holds the body; the preshape is made for it"),
    list<&HandDesc::grasp_rotation_rad>(
        kVec3, "grasp_deg", -360, 360, kDegree,
        "rotation vector of the hand there; x to the fingertips, y to the thumb's side, "
        "z out of the back of the hand"),
    list<&HandDesc::squeeze_m>(KeyKind::kNumberOrFingers, "squeeze_mm", 0.01, 20, kMilli,
                               "depth below the rest surface to which each finger part closes; a list: of each "
                               "finger's parts, thumb to little finger, also of fingers that take no part"),
    list<&HandDesc::grip_N>(KeyKind::kNumberOrFingers, "grip_N", 0.01, 100, 1,
                            "with closing = \"balanced\": normal force of each finger, shared evenly by its parts; a "
                            "list: of thumb to little finger. The thumb's is not used: it opposes the others"),
    number<&HandDesc::clearance_m>("clearance_mm", 0, 100, kMilli,
                                   "gap of the open hand to the body on its way in, along the palm's normal"),
    number<&HandDesc::closing_s>("closing_s", 0.01, 100, 1, "shortest time from open to closed"),
    number<&HandDesc::stop_force_N>("stop_force_N", 0.01, 1e4, 1,
                                    "a joint stops where it would press a finger part harder than this"),
    number<&HandDesc::joint_speed_rad_per_s>("joint_speed_deg_per_s", 1, 1e5, kDegree, "fastest turn of a joint"),
    number<&HandDesc::thumb_spread_rad>("thumb_spread_deg", 0, 60, kDegree,
                                        "of the thumb's root: 25 bends it in the plane of the fingers, more brings it "
                                        "over to the little finger"),
    integer<&HandDesc::points_per_part>("points_per_part", 2, 100, "tool points along each of the 15 finger parts"),
};
const KeySpec kGripper[] = {
    number<&GripperDesc::closing_s>("closing_s", 0.01, 100, 1, "shortest time from open to closed"),
    number<&GripperDesc::stop_force_N>("stop_force_N", 0.01, 1e4, 1,
                                       "a jaw stops where it would press a piece harder than this"),
};
const KeySpec kDevice[] = {
    text<&DeviceDesc::name>("name", 63, "name of the device"),
    choice<&DeviceDesc::holds>(
        "holds",
        "what hands move: tool; body, past a fixed tool; both, by two devices; two_tools, by two devices on "
        "one body"),
    list<&DeviceDesc::grip_m>(kVec3, "grip_mm", -1e4, 1e4, kMilli, "where the hand holds the body, in its own frame"),
    number<&DeviceDesc::period_s>("period_ms", 0.01, 100, kMilli, "tick period T"),
#define PALPATE_KEY(member, key, value, lowest, highest, scale, meaning) \
  number<&DeviceDesc::member>(key, lowest, highest, scale, meaning),
    PALPATE_PROFILE_KEYS(PALPATE_KEY)
#undef PALPATE_KEY
        number_or_auto<&DeviceDesc::force_rate_max_N_per_s>(
            "force_rate_max_N_per_s", 1, 1e7, 1,
            "fault limiter of the force change; auto: force_max_N in 5 ms. In no tick more than 10 % of force_max_N"),
    boolean_or_auto<&DeviceDesc::smooth_encoder>(
        "smooth_encoder",
        "smooth the handle within the encoder's step, at most two steps late; auto: where the device's friction "
        "holds it at rest all the same"),
    number_or_auto<&DeviceDesc::coupling_N_per_m>("coupling_N_per_m", 1, 1e6, 1,
                                                  "virtual coupling; auto: 0.8 (with local_kHz 0.9) of what the device "
                                                  "admits, min(2b / (T + 2 tau), 2 f_c / Delta)"),
    number_or_auto<&DeviceDesc::coupling_Nm_per_rad>("coupling_Nm_per_rad", 1e-6, 1e4, 1,
                                                     "rotational virtual coupling; auto: by the same rule"),
    number_or_auto<&DeviceDesc::coupling_Ns_per_m>(
        "coupling_Ns_per_m", 0, 1e4, 1,
        "damping of the coupling; auto: what sampling and delay take from it, coupling_N_per_m (T / 2 + tau)"),
    number<&DeviceDesc::ramp_in_s>("ramp_in_s", 0, 10, 1, "force ramp after arming"),
    number<&DeviceDesc::ramp_out_s>("ramp_out_s", 1e-3, 1, 1, "force ramp to zero after a fault"),
    number<&DeviceDesc::silence_hold_s>("silence_hold_ms", 0.01, 5, kMilli,
                                        "silence that is bridged: force held, handle moving on; a tick at least"),
    number<&DeviceDesc::silence_passive_s>("silence_passive_ms", 0.01, 20, kMilli,
                                           "silence after which force ramps to zero"),
    number<&DeviceDesc::silence_fault_s>("silence_fault_ms", 0.02, 1000, kMilli,
                                         "silence that latches a fault; two ticks at least"),
    number<&DeviceDesc::late_max_s>("late_max_ms", 0.02, 1000, kMilli,
                                    "ticks in a row that each missed deadlines, for so long: a fault; two at least"),
    number<&DeviceDesc::stall_max_s>("stall_max_ms", 1, 1000, kMilli,
                                     "deadlines missed at one go for so long: a fault; at least two periods count"),
    number<&DeviceDesc::speed_max_m_per_s>("speed_max_m_per_s", 0.01, 100, 1,
                                           "a sample that implies a faster motion is rejected"),
    number<&DeviceDesc::acceleration_max_m_per_s2>("acceleration_max_m_per_s2", 0, 1e6, 1,
                                                   "a sample that implies more is rejected; 0: not asked"),
    number<&DeviceDesc::turn_max_rad_per_s>("turn_max_rad_per_s", 0.1, 1000, 1,
                                            "a sample that implies a faster turn is rejected"),
};
const KeySpec kPath[] = {
    number<&PathDesc::hand_stiffness_N_per_m>("hand_stiffness_N_per_m", 1, 1e5, 1, "impedance of the simulated hand"),
    number<&PathDesc::hand_damping_Ns_per_m>("hand_damping_Ns_per_m", 0, 1e4, 1, "damping of the simulated hand"),
    number<&PathDesc::hand_stiffness_Nm_per_rad>("hand_stiffness_Nm_per_rad", 1e-4, 1e3, 1, "rotational stiffness"),
    number<&PathDesc::hand_damping_Nms_per_rad>("hand_damping_Nms_per_rad", 0, 100, 1, "rotational damping"),
};
const KeySpec kPathPoint[] = {
    number<&PathPoint::time_s>("time_s", 0, 1e5, 1, "time from the start; increasing, the first is 0", true),
    list<&PathPoint::position_m>(kVec3, "position_mm", -1e4, 1e4, kMilli, "where the hand wants the tool frame, world"),
    list<&PathPoint::rotation_rad>(kVec3, "rotation_deg", -360, 360, kDegree, "rotation vector of the tool frame"),
    list<&PathPoint::closing>(
        KeyKind::kFingers, "closing", 0, 1, 1,
        "articulated tools: 0 open to 1 closed, as [all] or [thumb, index, middle, ring, little]; "
        "default: as at the point before"),
};

template <auto member>
void* open(SceneDesc& scene) {
  return &(scene.*member);
}
void* open_top(SceneDesc& scene) { return &scene; }
void* open_fixed(SceneDesc& scene) { return &scene.fixed.emplace_back(); }
void* open_region(SceneDesc& scene) { return &scene.material_region.emplace_back(); }
void* open_piece(SceneDesc& scene) { return &scene.piece.emplace_back(); }
void* open_pair(SceneDesc& scene) { return &scene.pair.emplace_back(); }
void* open_point(SceneDesc& scene) { return &scene.path.point.emplace_back(); }
void* open_second_point(SceneDesc& scene) { return &scene.path.second.emplace_back(); }
void* open_hand(SceneDesc& scene) {
  scene.articulation = Articulation::kHand;
  return &scene.hand;
}
void* open_gripper(SceneDesc& scene) {
  scene.articulation = Articulation::kGripper;
  return &scene.gripper;
}

const TableSpec kTables[] = {
    {"", kOne, "Top level.", kTop, open_top},
    {"body", kOne, "The elastic object.", body_keys(), open<&SceneDesc::body>},
    {"body.fem", kOne, "Finite elements, with contact.backend = \"nodal\" or \"elastic\".", fem_keys(),
     open<&SceneDesc::fem>},
    {"body.elastic", kOne, "Its modes, with contact.backend = \"elastic\".", elastic_keys(), open<&SceneDesc::elastic>},
    {"body.material", kOne, "Homogeneous, isotropic.", material_keys(), open<&SceneDesc::material>},
    {"body.material_region", TableCount::kList,
     "Places of other materials, on an elastic body; where they overlap the last counts.", material_region_keys(),
     open_region},
    {"body.fixed", TableCount::kOneOrList,
     "What holds the body: one table, or several of [[body.fixed]]. Heights, boxes, balls and points are those of the "
     "world.",
     fixed_keys(), open_fixed},
    {"skeleton", kOne, "Beams from each contact region to the anchors.", kSkeleton, open<&SceneDesc::skeleton>},
    {"contact", kOne, "The contact law.", kContact, open<&SceneDesc::contact>},
    {"contact.duffing", kOne, "With law = \"duffing\".", kDuffing, open<&SceneDesc::duffing>},
    {"contact.cubic", kOne, "With law = \"cubic\".", kCubic, open<&SceneDesc::cubic>},
    {"contact.hertz", kOne, "With law = \"hertz\".", kHertz, open<&SceneDesc::hertz>},
    {"contact.tip", kOne, "With law = \"tool\".", kTip, open<&SceneDesc::tip>},
    {"contact.layer", kOne, "With law = \"tool\": exact response of a thin body.", kLayer, open<&SceneDesc::layer>},
    {"contact.series", kOne, "With law = \"tool\": the body's own give, travel = tip's + c0 F + c1 F^2.", kSeries,
     open<&SceneDesc::series>},
    {"contact.pair", TableCount::kList,
     "With law = \"tool\": how two tips lean on one another; other pairs use the far field.", kPair, open_pair},
    {"contact.table", kOne, "With law = \"table\": presses, measured or computed.", kTable, open<&SceneDesc::table>},
    {"contact.nodal", kOne, "With backend = \"nodal\".", kNodal, open<&SceneDesc::nodal>},
    {"contact.transient", kOne,
     "What a hard object does at a touch beside pushing back: it rings (after Okamura, Cutkosky & Dennerlein 2001). "
     "Off "
     "by default.",
     kTransient, open<&SceneDesc::transient>},
    {"friction", kOne, "Friction per contact region.", kFriction, open<&SceneDesc::friction>},
    {"shape", kOne, "How the deformed surface is drawn. No effect on forces.", kShape, open<&SceneDesc::shape>},
    {"coupling", kOne, "Several contact regions at once.", kCoupling, open<&SceneDesc::coupling>},
    {"tool.piece", TableCount::kList, "The rigid tool: convex pieces, at least one with points.", kPiece, open_piece},
    {"hand", kOne, "Makes the tool a human hand of 21 joints; there are no tool pieces then.", kHand, open_hand},
    {"gripper", kOne, "Makes the tool a gripper: pieces with slide_mm move by the closing of path or device.", kGripper,
     open_gripper},
    {"device", kOne, "The haptic device: what it admits and where it must be stopped.", kDevice,
     open<&SceneDesc::device>},
    {"path", kOne, "What the simulated hand does in the demonstration. Not stored in the image.", kPath,
     open<&SceneDesc::path>},
    {"path.point", TableCount::kList, "Points of the path, joined smoothly in time.", kPathPoint, open_point},
    {"path.second", TableCount::kList,
     "Points of the second hand's path, with device.holds = \"two_tools\"; it is as firm as the first.", kPathPoint,
     open_second_point},
};

}  // namespace

std::span<const TableSpec> scene_schema() { return kTables; }

}  // namespace palpate
