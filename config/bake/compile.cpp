#include "config/bake/compile.h"
#include "config/bake/time_params.h"

#include <algorithm>
#include <cmath>

#include "config/bake/bvh_build.h"
#include "config/bake/elastic_choice.h"
#include "config/bake/fem_body.h"
#include "config/bake/image_rules.h"
#include "config/bake/rbf_system.h"
#include "config/bake/tool_points.h"
#include "config/bake/worst_tick.h"
#include "config/body/anchors.h"
#include "config/body/body.h"
#include "config/body/patches.h"
#include "config/body/supports.h"
#include "config/hand/balanced_closing.h"
#include "config/hand/hand_model.h"
#include "config/hand/preshape.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"
#include "rt_core/image_check.h"

namespace palpate {

namespace {

// One bake: fills `image` and `report` step by step; later steps use what earlier ones wrote.
class Compiler {
 public:
  Compiler(const SceneDesc& scene, const BakeRun& run) : scene_(scene), run_(run) {}

  CompileResult run() {
    check_scene(scene_);
    report_.name = image_.name = scene_.name;
    report_.warnings = weak_keys(scene_);
    if (!scene_.default_model.empty()) report_.model.push_back(scene_.default_model);
    add_laws();
    add_tool();
    refuse(scene_, check_method(model_of(image_)));  // before the long computations
    if (is_nodal()) {
      add_finite_elements();
    } else {
      add_surface();
    }
    add_articulation();
    add_distances();
    bake_response(scene_, image_, report_.response, report_.warnings);
    add_device();
    add_skeleton();
    if (is_elastic()) report_.elastic = bake_elastic_body(scene_, image_, report_.warnings, run_);
    add_costs();
    report_.array = array_bytes(image_);
    CompileResult result{write_image(image_), std::move(report_)};
    check_bytes(scene_, result.bytes);
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw ConfigError(scene_.source.where(key) + ": " + what);
  }
  void warn(const std::string& text) { report_.warnings.push_back(text); }

  bool is_nodal() const { return scene_.contact.backend == Backend::kNodal; }
  bool is_elastic() const { return scene_.contact.backend == Backend::kElastic; }

  // Contact on finite elements: what the response back-end would use is left out.
  void add_nodal_laws() {
    ModelParams& p = image_.params;
    p.backend = Backend::kNodal;
    p.response_law = ResponseLaw::kPoints;
    p.skeleton_law = SkeletonLaw::kNone;
    p.neighbourhood_law = NeighbourhoodLaw::kNone;
    p.coupling_law = CouplingLaw::kNone;
    p.nodal_solver = scene_.nodal.solver;
    p.nodal_sweeps = scene_.nodal.sweeps;
    p.friction_sweeps = scene_.nodal.friction_sweeps;
    p.nodal_carry = scene_.nodal.carry;
    p.wall_N_per_m = scene_.nodal.wall_N_per_m;
    p.strain_limit = scene_.nodal.strain_limit;
    p.proxy_speed_max_m_per_s = scene_.nodal.proxy_speed_max_m_per_s;
    p.friction_mu_dynamic = scene_.friction.law == FrictionLaw::kCoulomb
                                ? (is_auto(scene_.friction.mu_ref) ? 0.5 : std::min(scene_.friction.mu_ref, 10.0))
                                : 0.0;
  }

  void add_finite_elements() {
    const FemBody body = make_fem_body(scene_, report_.warnings, run_.progress);
    mesh_ = body.condensed.surface;
    const BvhBuild bvh = add_nodal_body(body.condensed, body.precision, scene_.source.where("body.shape"), image_);
    image_.strain_gauge = body.strain_gauge;
    ModelParams& p = image_.params;
    const double edge = mean_edge_m(mesh_);
    p.contact_margin_m = is_auto(scene_.nodal.margin_m) ? 0.25 * edge : scene_.nodal.margin_m;
    // Singular where nodes are redundant; the table's own rounding sets how much regularisation it takes.
    p.regularisation = body.precision == CompliancePrecision::kDouble ? 1e-6 : 1e-5;
    cluster_distance_m_ = 3 * edge;
    report_surface(bvh);
    report_.fem_nodes = static_cast<std::int64_t>(body.mesh.node_m.size());
    report_.fem_elements = static_cast<std::int64_t>(body.mesh.tet.size());
    report_.fem_gauges = body.gauges;
    report_.compliance_bytes =
        image_.compliance_f32.size() * sizeof(float) + image_.compliance_f64.size() * sizeof(double);
    report_.single_precision = body.precision == CompliancePrecision::kSingle;
    report_.precision_error = body.precision_error;
  }

  void report_surface(const BvhBuild& bvh) {
    report_.volume_m3 = signed_volume_m3(mesh_);
    report_.surface_m2 = surface_area_m2(mesh_);
    report_.mass_kg = report_.volume_m3 * scene_.material.density_kg_per_m3;
    report_.vertices = static_cast<std::int64_t>(image_.vertex_m.size());
    report_.triangles = static_cast<std::int64_t>(image_.triangle.size());
    report_.bvh_nodes = static_cast<std::int32_t>(image_.bvh.size());
    report_.bvh_depth = bvh.depth;
    report_.traversal_stack = bvh.stack_high_water;
  }

  void add_laws() {
    ModelParams& p = image_.params;
    p.contact_weight = scene_.contact.weight;
    p.equivalent_point = scene_.contact.equivalent_point;
    p.friction_law = scene_.friction.law;
    p.tangential_law = scene_.friction.tangential;
    p.skeleton_law = scene_.skeleton.law;
    p.shape_law = scene_.shape.interpolation;
    p.neighbourhood_law = scene_.shape.neighbourhood;
    p.coupling_law = scene_.coupling.law;
    p.rbf_tail = scene_.shape.tail;
    p.youngs_modulus_Pa = scene_.material.youngs_modulus_Pa;
    p.poisson_ratio = effective_poisson_ratio(scene_.material);
    if (scene_.material.poisson_ratio > 0.5) warn("poisson_ratio 1.0 is impossible; 0.47 is used instead");

    report_.contact = contact_coefficients(scene_);
    p.k1_N_per_m = report_.contact.k1_N_per_m;
    p.k3_N_per_m3 = report_.contact.k3_N_per_m3;
    if (!(p.k1_N_per_m <= 1e9 && p.k3_N_per_m3 <= 1e15))
      fail("contact.law", "gives k1 = " + number_text(p.k1_N_per_m) + " N/m, k3 = " + number_text(p.k3_N_per_m3) +
                              " N/m3; allowed up to 1e9 and 1e15: soften the law");
    p.max_depth_m = scene_.contact.max_depth_m;
    p.neighbourhood_radius_m = scene_.shape.radius_m;

    report_.friction = friction_coefficients(scene_.friction);
    p.friction_k_N = report_.friction.k_N;
    p.friction_beta = report_.friction.beta;
    p.friction_slip_m = scene_.friction.slip_m;
    p.friction_mu_dynamic = report_.friction.mu_dynamic;
    if (scene_.contact.law == ContactLaw::kTool) p.response_law = ResponseLaw::kTip;
    if (scene_.contact.law == ContactLaw::kTable) p.response_law = ResponseLaw::kTable;
    p.table_interpolation = scene_.table.interpolation;
    if (is_nodal()) add_nodal_laws();
    if (!is_elastic()) return;
    p.backend = Backend::kElastic;
    p.skeleton_law = SkeletonLaw::kNone;
    p.neighbourhood_law = NeighbourhoodLaw::kNone;
    p.coupling_law = CouplingLaw::kNone;
  }

  void add_surface() {
    mesh_ = make_body(scene_, report_.warnings);
    report_.volume_m3 = signed_volume_m3(mesh_);
    report_.surface_m2 = surface_area_m2(mesh_);
    report_.mass_kg = report_.volume_m3 * scene_.material.density_kg_per_m3;
    image_.vertex_m = mesh_.vertex_m;
    image_.vertex_normal = vertex_normals(mesh_);
    image_.params.surface_size_m = bounds_of(mesh_).largest_m();
    BvhBuild bvh = build_bvh(image_.vertex_m, linked_triangles(mesh_));
    if (bvh.stack_high_water > kMaxTraversalStack)
      fail("body", "the hierarchy needs " + std::to_string(bvh.stack_high_water) + " stack entries; allowed " +
                       std::to_string(kMaxTraversalStack) + ": remesh the body");
    image_.triangle = std::move(bvh.triangle);
    image_.bvh = std::move(bvh.node);
    report_.vertices = static_cast<std::int64_t>(image_.vertex_m.size());
    report_.triangles = static_cast<std::int64_t>(image_.triangle.size());
    report_.bvh_nodes = static_cast<std::int32_t>(image_.bvh.size());
    report_.bvh_depth = bvh.depth;
    report_.traversal_stack = bvh.stack_high_water;
  }

  bool is_hand() const { return scene_.articulation == Articulation::kHand; }

  void add_tool() {
    if (is_hand()) hand_ = make_hand(scene_.hand);
    Tool tool;
    try {
      tool = make_tool(is_hand() ? hand_.piece : scene_.piece);
    } catch (const ConfigError& error) {
      throw ConfigError(scene_.source.file + ": " + error.what());
    }
    if (is_hand()) shape_hand_points(scene_.hand, tool);
    double total = 0;
    for (const ToolPoint& point : tool.point) total += point.area_m2;
    report_.reference_area_m2 = is_auto(scene_.contact.reference_area_m2)
                                    ? total / static_cast<double>(tool.point.size())
                                    : scene_.contact.reference_area_m2;
    for (ToolPoint& point : tool.point) point.weight = point.area_m2 / report_.reference_area_m2;
    report_.tool_points = static_cast<std::int32_t>(tool.point.size());
    report_.gap_m = tool.gap_m;
    for (std::size_t i = 0; i < tool.piece.size(); ++i) {
      const std::string label = "tool.piece[" + std::to_string(i) + "]";
      const ToolPiece& piece = tool.piece[i];
      if (piece.point_count == 0 || is_nodal() || is_tip_law(scene_.contact.law))
        continue;  // nodal: the exact pieces touch
      if (piece.margin_m < scene_.contact.max_depth_m)
        warn(label + ": its margin of " + number_text(1e3 * piece.margin_m) +
             " mm is below contact.max_depth_mm; deeper than the margin the direction of contact can jump");
      if (tool.gap_m[i] > piece.margin_m)
        warn(label + ": its surface is up to " + number_text(std::round(1e5 * tool.gap_m[i]) / 100) +
             " mm away from its tool points' spheres; add points or a larger margin");
    }
    put_tool(std::move(tool), image_);
  }

  void add_articulation() {
    image_.params.articulation = scene_.articulation;
    image_.params.body_mass_kg = report_.mass_kg;
    const Vec3 centre = volume_centre_m(mesh_);
    image_.params.body_centre_x_m = centre.x;
    image_.params.body_centre_y_m = centre.y;
    image_.params.body_centre_z_m = centre.z;
    if (scene_.articulation == Articulation::kGripper) add_gripper();
    if (is_hand()) add_hand();
    set_hands(scene_, image_);
    report_.joints = static_cast<std::int32_t>(image_.joint.size());
  }

  // Each finger part is a piece on its joint; what contacts of different fingers must not do is share a region.
  void add_hand() {
    const HandDesc& desc = scene_.hand;
    image_.params.closing_rate_per_s = 1 / desc.closing_s;
    image_.params.stop_force_N = desc.stop_force_N;
    set_palm(hand_, image_.params);
    for (std::size_t i = 0; i < image_.piece.size(); ++i) {
      image_.piece[i].joint = hand_.piece_joint[i];
      image_.piece[i].group = hand_.piece_finger[i];
      const std::int32_t part = image_.piece[i].part;
      if (part <= kHandParts && !scene_.source.has("shape.radius_mm"))
        image_.piece[i].neighbourhood_m = hand_parts()[static_cast<std::size_t>(part - 1)].neighbourhood_radius_m;
    }
    image_.joint = hand_.joint;
    image_.grasp_w.push_back({desc.grasp_position_m, rotation_of(desc.grasp_rotation_rad)});
    std::vector<double> stretched;
    for (const Joint& joint : image_.joint) stretched.push_back(joint.open);
    const Preshape plan = plan_preshape(model_of(image_), desc, stretched);
    for (std::size_t j = 0; j < image_.joint.size(); ++j) {
      image_.joint[j].open = plan.open[j];
      image_.joint[j].closed = plan.closed[j];
    }
    report_.parts_touching = plan.parts_touching;
    report_.clearance_m = plan.clearance_m;
    if (!plan.warning.empty()) warn("hand: " + plan.warning);
  }

  // One sliding joint per jaw: closed where the pieces are described, open a slide away.
  void add_gripper() {
    image_.params.closing_rate_per_s = 1 / scene_.gripper.closing_s;
    image_.params.stop_force_N = scene_.gripper.stop_force_N;
    std::vector<Vec3> slides;
    for (std::size_t i = 0; i < image_.piece.size(); ++i) {
      const Vec3 slide = scene_.piece[i].slide_m;
      const auto known = std::ranges::find(slides, slide) - slides.begin();
      const bool moves = norm(slide) > 0;
      if (moves && known == std::ssize(slides)) slides.push_back(slide);
      image_.piece[i].joint = moves ? static_cast<std::int32_t>(known) : -1;
      image_.piece[i].group = image_.piece[i].joint;
    }
    for (const Vec3 slide : slides) {
      Joint joint{};
      joint.before.orientation = rotation_between({0, 0, 1}, unit_or(slide, {0, 0, 1}));
      if (slide.z < 0 && slide.x == 0 && slide.y == 0) joint.before.orientation = {0, 1, 0, 0};  // half a turn
      joint.zero_inverse = {{}, conjugate(joint.before.orientation)};
      joint.highest = joint.open = norm(slide);
      joint.speed_max = joint.open / scene_.gripper.closing_s;
      joint.sign = 1;
      joint.parent = -1;
      joint.kind = JointKind::kSlide;
      image_.joint.push_back(joint);
    }
  }

  // Mean distance of a piece's tool points to their nearest neighbours; the smallest over the pieces; 0 without pairs.
  double point_spacing_m() const {
    double spacing = 0;
    for (const ToolPiece& piece : image_.piece) {
      if (piece.point_count < 2) continue;
      const auto first = image_.tool_point.begin() + piece.first_point, last = first + piece.point_count;
      double sum = 0;
      for (auto a = first; a != last; ++a) {
        double nearest = kHuge;
        for (auto b = first; b != last; ++b)
          if (a != b) nearest = std::min(nearest, norm(a->position_tool_m - b->position_tool_m));
        sum += nearest;
      }
      const double mean = sum / piece.point_count;
      spacing = spacing > 0 ? std::min(spacing, mean) : mean;
    }
    return spacing;
  }

  // Tips are regions of their own: regions split at 1.5 times the distance within which they join.
  double tip_distance_m() const { return clamp_to(0.5 * std::min(0.020, nearest_points_m(image_)), 1e-6, 1.0); }

  void add_distances() {
    ModelParams& p = image_.params;
    const double spacing = point_spacing_m();
    // Tips of an elastic body lean on one another through it, each a region of its own.
    p.cluster_distance_m = is_elastic()                                  ? 1e-6
                           : !is_auto(scene_.contact.cluster_distance_m) ? scene_.contact.cluster_distance_m
                           : is_tip_law(scene_.contact.law)              ? tip_distance_m()
                           : is_nodal()                                  ? clamp_to(cluster_distance_m_, 1e-6, 1.0)
                           : spacing > 0                                 ? clamp_to(2 * spacing, 1e-6, 1.0)
                                                                         : 0.010;
    report_.cluster_distance_m = p.cluster_distance_m;
    p.far_field_radius_m = is_auto(scene_.coupling.radius_m)
                               ? clamp_to(square_root(report_.reference_area_m2 / kPi), 1e-6, 1.0)
                               : scene_.coupling.radius_m;
  }

  // The coupling a scene states, refused above the bound; or its share of the bound.
  double coupling(double stated, double share, const StiffnessBound& bound, double lowest, const char* key,
                  const char* unit) const {
    const double value = is_auto(stated) ? share * bound.value : stated;
    if (!(value <= bound.value))
      fail(key, number_text(stated) + " " + unit + " is above what the device admits, " + number_text(bound.value) +
                    " " + unit + " = " + reason_of(bound) +
                    "; lower it, or state a device with more damping or less delay");
    if (!(value >= lowest))
      fail(key, "the device admits only " + number_text(bound.value) + " " + unit + " = " + reason_of(bound) +
                    "; it cannot render this scene: check its damping, friction, encoder step and delay");
    return std::min(value, 1e6);
  }

  // A limit of time in ticks of the scene's period, to the nearest.
  std::int32_t ticks_of(double limit_s, std::int32_t least) const {
    return std::max(least, static_cast<std::int32_t>(std::lround(limit_s / scene_.device.period_s)));
  }

  void add_device() {
    ModelParams& p = image_.params;
    const DeviceDesc& d = scene_.device;
    // Of two handles on one body half of one's damping acts on their distance, which two encoders tell.
    const double hands = d.holds == HeldPart::kBoth ? 2 : 1;
    report_.bound = admissible_stiffness(d.damping_Ns_per_m / hands, d.friction_N, hands * d.encoder_step_m, d.period_s,
                                         d.delay_s, d.local_Hz);
    report_.rotational_bound = admissible_stiffness(d.damping_Nms_per_rad / hands, d.friction_Nm,
                                                    hands * d.encoder_step_rad, d.period_s, d.delay_s);
    p.coupling_N_per_m =
        coupling(d.coupling_N_per_m, coupling_share(d.local_Hz), report_.bound, 1, "device.coupling_N_per_m", "N/m");
    if (is_auto(d.coupling_N_per_m))
      p.coupling_N_per_m = std::min(p.coupling_N_per_m, impact_coupling_N_per_m(d.local_Hz, d.delay_s, d.force_max_N));
    p.coupling_Nm_per_rad = std::min(coupling(d.coupling_Nm_per_rad, coupling_share(0), report_.rotational_bound, 1e-6,
                                              "device.coupling_Nm_per_rad", "N m/rad"),
                                     1e4);
    report_.coupling_N_per_m = p.coupling_N_per_m;
    report_.coupling_Nm_per_rad = p.coupling_Nm_per_rad;
    report_.smoothing = smoothing_of(d, p.coupling_N_per_m, p.coupling_Nm_per_rad);
    p.period_s = d.period_s;
    p.delay_s = d.delay_s;
    set_times(scene_, p);
    p.force_max_N = d.force_max_N;
    p.torque_max_Nm = d.torque_max_Nm;
    // All of it within 5 ms: above what a hand's tap on a wall asks for, and still able to act on a device of any size.
    constexpr double kFullForce_s = 5e-3;
    p.force_rate_max_N_per_s =
        is_auto(d.force_rate_max_N_per_s) ? d.force_max_N / kFullForce_s : d.force_rate_max_N_per_s;
    p.ramp_in_s = d.ramp_in_s;
    p.ramp_out_s = d.ramp_out_s;
    p.silence_hold_ticks = ticks_of(d.silence_hold_s, 1);
    p.silence_passive_ticks = ticks_of(d.silence_passive_s, p.silence_hold_ticks);
    p.silence_fault_ticks = ticks_of(d.silence_fault_s, p.silence_passive_ticks + 1);
    p.late_ticks_max = ticks_of(d.late_max_s, 2);
    p.stall_max_s = d.stall_max_s;
    p.speed_max_m_per_s = d.speed_max_m_per_s;
    p.acceleration_max_m_per_s2 = d.acceleration_max_m_per_s2;
    p.turn_max_rad_per_s = d.turn_max_rad_per_s;
  }

  void add_skeleton() {
    if (image_.params.skeleton_law == SkeletonLaw::kNone) return;
    report_.exact_anchors = scene_.skeleton.anchors == AnchorSource::kShape && has_exact_anchors(scene_.body.shape) &&
                            scene_.body.axis != BodyAxis::kX;
    std::vector<AnchorPoint> anchors = report_.exact_anchors ? exact_anchors(scene_.body) : mesh_anchors(mesh_);
    limit_anchors(mesh_, scene_.skeleton.anchors_min, scene_.skeleton.anchors_max, anchors);
    add_anchors(anchors);
    if (anchors.empty()) return;
    add_beams();
    add_interpolation(anchors);
  }

  // Circular beams: their table, and the anchors' sections from it.
  void add_beams() {
    const SkeletonLaw law = scene_.skeleton.law;
    if (law != SkeletonLaw::kCircular && law != SkeletonLaw::kCircularPaper) return;
    const BeamTableRule rule{law == SkeletonLaw::kCircularPaper, scene_.skeleton.beam_width_m,
                             scene_.skeleton.beam_thickness_m, scene_.skeleton.beam_allowance_m};
    try {
      report_.beams = build_beam_table(rule, report_.volume_m3, image_);
    } catch (const ConfigError& error) {
      fail("skeleton.beam_width_mm", error.what());
    }
    report_.baked_beams = true;
    report_.section_radius_m = image_.anchor[0].section_radius_m;
    const BeamTableReport& beams = report_.beams;
    for (std::size_t a = 0; a < beams.dropped_by_anchor.size(); ++a)
      if (beams.dropped_by_anchor[a] == report_.vertices)
        warn("anchor " + std::to_string(a) + " at " + position_text(image_.anchor[a].position_m) +
             ": no beam reaches it inside the body; lower skeleton.beam_width_mm or remove the anchor "
             "(skeleton.anchors_max)");
    if (beams.lonely_vertices > 0)
      warn(std::to_string(beams.lonely_vertices) +
           " surface vertices have no beam at all; contacts there move no anchor: lower skeleton.beam_width_mm");
  }

  // Sections: the beams share the body's volume, S = V / sum of lengths, lengths from the volume's centre; release
  // length s = pi r (1 - nu^2) / 2, which gives the beam's end the compliance of a rigid circular foot on a half space.
  void add_anchors(const std::vector<AnchorPoint>& anchors) {
    const Vec3 centre = volume_centre_m(mesh_);
    const double lowest = bounds_of(mesh_).lower_m.y;
    double length = 0;
    for (const AnchorPoint& a : anchors) length += norm(a.position_m - centre);
    const double radius = is_auto(scene_.skeleton.section_radius_m)
                              ? square_root(report_.volume_m3 / (length > 0 ? length : 1.0) / kPi)
                              : scene_.skeleton.section_radius_m;
    const double area = kPi * radius * radius, nu = image_.params.poisson_ratio;
    for (const AnchorPoint& a : anchors) {
      Anchor anchor{};
      anchor.position_m = a.position_m;
      anchor.normal = a.normal;
      anchor.section_area_m2 = area;
      anchor.section_inertia_m4 = 0.25 * area * radius * radius;
      anchor.section_radius_m = radius;
      anchor.release_length_m = 0.5 * kPi * radius * (1 - nu * nu);
      anchor.fixed = is_fixed(scene_, a.position_m, lowest) ? 1 : 0;
      image_.anchor.push_back(anchor);
      report_.fixed_anchors += anchor.fixed;
    }
    report_.anchors = static_cast<std::int32_t>(anchors.size());
    report_.section_radius_m = radius;
    if (report_.fixed_anchors == 0)
      warn("no anchor lies where body.fixed holds; raise its base_height_mm if the body should rest on its base");
    if (report_.fixed_anchors == report_.anchors)
      warn("every anchor is fixed, so the drawn shape moves only near contacts; make body.fixed smaller");
  }

  void add_costs() {
    image_.params.surface_work_max = kMaxSurfaceWork;
    state_most_costs(image_);
    check_bytes(scene_, write_image(image_));  // what is not sound must not be ticked
    if (is_hand() && scene_.hand.closing == HandClosing::kBalanced) balance_hand();
    report_.cost = bake_costs(image_);
    if (const std::string wrong = cost_refusal(report_.cost, image_.params.period_s); !wrong.empty())
      fail("device.period_ms", wrong);
  }

  void balance_hand() {
    const BalancedClosing grip = close_balanced(image_, scene_.hand);
    for (std::size_t j = 0; j < image_.joint.size(); ++j) image_.joint[j].closed = grip.closed[j];
    report_.grip_N = grip.normal_N;
    report_.grip_left_N = grip.left_N;
    if (!grip.warning.empty()) warn("hand: " + grip.warning);
  }

  void add_interpolation(const std::vector<AnchorPoint>& anchors) {
    std::vector<Vec3> position;
    for (const AnchorPoint& a : anchors) position.push_back(a.position_m);
    const auto n = static_cast<std::size_t>(report_.anchors + rbf_tail_size(scene_.shape.tail));
    image_.rbf_inverse.resize(n * n);
    if (!invert_rbf_system(position, scene_.shape.tail, image_.rbf_inverse))
      fail("shape.tail", "the interpolation through " + std::to_string(report_.anchors) +
                             " anchors is singular (coinciding, or coplanar with tail = \"linear\"); use \"constant\" "
                             "or raise skeleton.anchors_min");
    if (scene_.shape.interpolation != ShapeLaw::kDisplacementAnglePaper) return;
    if (report_.anchors < 3)
      fail("shape.interpolation", "\"displacement_angle_paper\" needs 3 anchors and the body has " +
                                      std::to_string(report_.anchors) + "; raise skeleton.anchors_min");
    image_.patch = make_patches(mesh_.vertex_m, anchors, volume_centre_m(mesh_));
  }

  const SceneDesc& scene_;
  const BakeRun& run_;
  double cluster_distance_m_ = 0;  // nodal
  SurfaceMesh mesh_;
  ImageContents image_;
  HandTool hand_;
  CompileReport report_;
};

}  // namespace

CompileResult compile_image(const SceneDesc& scene, const BakeRun& run) { return Compiler(scene, run).run(); }

}  // namespace palpate
