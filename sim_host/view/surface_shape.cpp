#include "sim_host/view/surface_shape.h"

#include <memory>

#include "rt_core/contact/contact.h"
#include "rt_core/contact/regions.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/view/anchors.h"
#include "sim_host/view/displacement_angle.h"
#include "sim_host/view/surface_bend.h"

namespace palpate {
namespace {

bool uses_angles(const Model& model) { return model.params.shape_law == ShapeLaw::kDisplacementAnglePaper; }

// The patch of a vertex, or nullptr where the displacement-angle law cannot be used.
const PatchWeight* patch_of(const Model& model, std::int32_t vertex) {
  if (!uses_angles(model) || vertex < 0) return nullptr;
  const auto at = static_cast<std::size_t>(vertex);
  return at < model.patch.size() && at < model.vertex_normal.size() ? &model.patch[at] : nullptr;
}

// Area for which the contact law holds per unit weight: the same for every tool point by construction of the weights.
Real reference_area_m2(const Model& model) {
  if (model.tool_point.empty() || !(model.tool_point[0].weight > 0)) return 0;
  return model.tool_point[0].area_m2 / model.tool_point[0].weight;
}

Vec3 dent_of(const Model& model, const Region& region) {
  const Vec3 force = region.normal_force_N * region.normal_w + region.friction_force_w;
  const Real omega = region_size_factor(region.area_m2, reference_area_m2(model));
  const Vec3 dent = (-omega * region.depth_equivalent_m) * unit_or(force, region.normal_w);
  return is_finite(dent) ? dent : Vec3{};
}

// Adds the contact point as an interpolation node that moves by d_c: u += psi(x) (d_c - u(p)), spread over
// coefficients.
void add_contact_node(const Model& model, const Vec3 (&own)[kMaxRbf], ShapeRegion& r, ShapeField& field) {
  make_rbf_contact(model, r.contact_w, r.node);
  const auto n = static_cast<std::int32_t>(model.sizes.n_rbf);
  if (r.node.at_anchor >= 0) {
    // The contact is that anchor: it moves by d_c instead.
    const Vec3 change = r.dent_w - r.anchor_displacement_w[r.node.at_anchor];
    r.anchor_displacement_w[r.node.at_anchor] = r.dent_w;
    const double* row = model.rbf_inverse.data() + r.node.at_anchor * n;  // the inverse is symmetric
    for (std::int32_t k = 0; k < n; ++k) field.coefficient_w[k] += row[k] * change;
    return;
  }
  RbfVector g{};
  rbf_terms(model, r.contact_w, g);
  r.node_coefficient_w = r.node.inverse_s * (r.dent_w - rbf_value(model, g, own));
  for (std::int32_t k = 0; k < n; ++k) field.coefficient_w[k] -= r.node.q[k] * r.node_coefficient_w;
}

// Radius of a region's dent: the largest of its parts' own, else the scene's.
Real reach_of(const Model& model, const State& state, std::int32_t slot) {
  Real reach = 0;
  if (!is_articulated(model)) return model.params.neighbourhood_radius_m;
  for (std::size_t p = 0; p < model.piece.size(); ++p) {  // bound: kMaxToolPoints over all pieces
    const ToolPiece& piece = model.piece[p];
    for (std::int32_t i = piece.first_point; i < piece.first_point + piece.point_count; ++i) {
      if (state.point[i].region == slot) reach = max_of(reach, piece.neighbourhood_m);
    }
  }
  return reach > 0 ? reach : model.params.neighbourhood_radius_m;
}

// The tool point that touches in a region alone, or -1.
std::int32_t only_point_of(const Model& model, const State& state, std::int32_t slot) {
  std::int32_t only = -1;
  for (std::int32_t i = 0; i < model.sizes.n_tool_point; ++i) {
    if (state.point[i].region != slot) continue;
    if (only >= 0) return -1;
    only = i;
  }
  return only;
}

TipShape tip_shape(const ToolPiece& piece) {
  if (piece.shape == PieceShape::kSphere || piece.shape == PieceShape::kCapsule) return TipShape::kBall;
  return piece.shape == PieceShape::kCone ? TipShape::kCone : TipShape::kFlat;
}

// The dent of a region by the profile of what presses. One tip alone has its own, with its true radius: a ball by the
// depth that the global shape leaves of it, a whole tip's flat end by its face. Many points, and a rounded face that
// touches by one of them, are a flat face of the area that touches.
Neighbourhood punch_of(const Model& model, const State& state, const ShapeRegion& r, Real reach_m) {
  const Region& region = state.region[r.slot];
  const Real by_area_m = contact_radius_m(region.area_m2, reach_m);
  const Neighbourhood face = make_neighbourhood(NeighbourhoodLaw::kPunch, by_area_m, reach_m);
  const std::int32_t point = only_point_of(model, state, r.slot);
  const Real depth_m = norm(r.local_amplitude_w);
  if (point < 0 || !(depth_m > 0) || !(reach_m > 0)) return face;
  const ToolPoint& tip = model.tool_point[static_cast<std::size_t>(point)];
  const ToolPiece& piece = model.piece[static_cast<std::size_t>(tip.piece)];
  const Vec3 normal = region.normal_w, across = unit_or(tangential_part(axis_off(normal), normal), {1, 0, 0});
  if (tip_shape(piece) == TipShape::kBall)
    return punch_neighbourhood(
        TipShape::kBall,
        ball_contact(depth_m, tip.margin_m, surface_bend(model, region.centre_w, normal, 0.5 * reach_m)), reach_m);
  if (method_of(model) != Method::kTips) return face;
  const Real end_m = piece.half_extent_m[0], tall_m = 2 * piece.half_extent_m[2];
  // Of a cone: depth = pi/2 a / tan(angle).
  const Real radius_m = tip_shape(piece) == TipShape::kCone ? 2 / kPi * depth_m * end_m / tall_m : end_m;
  return punch_neighbourhood(tip_shape(piece), {across, radius_m, radius_m}, reach_m);
}

void press_of(const Model& model, const State& state, Real reach_m, ShapeRegion& r) {
  if (method_of(model) != Method::kTips) return;
  r.press = r.local.law == NeighbourhoodLaw::kPunch ? r.local : punch_of(model, state, r, reach_m);
  const Real area_m2 = kPi * r.press.edge.across_m * r.press.edge.along_m;
  if (r.press.law != NeighbourhoodLaw::kPunch || !(area_m2 > 0)) return;
  r.mean_Pa = state.live.stiffness * state.region[r.slot].normal_force_N / area_m2;
}

void prepare_region(const Model& model, const State& state, const AnchorField& anchors, std::int32_t slot,
                    ShapeField& field) {
  const Region& region = state.region[slot];
  ShapeRegion& r = field.region[field.count++];
  r = {};
  r.slot = slot;
  r.contact_w = region.centre_w;
  r.dent_w = dent_of(model, region);
  r.local_amplitude_w = r.dent_w;
  const Real reach_m = reach_of(model, state, slot);
  r.local = make_neighbourhood(model.params.neighbourhood_law, contact_radius_m(region.area_m2, reach_m), reach_m);
  for (std::int32_t i = 0; i < anchors.count; ++i) r.anchor_displacement_w[i] = anchors.by_region_w[slot][i];
  if (!field.interpolated) {
    if (r.local.law == NeighbourhoodLaw::kPunch) r.local = punch_of(model, state, r, reach_m);
    return press_of(model, state, reach_m, r);
  }

  Vec3 own[kMaxRbf];
  rbf_coefficients(model, r.anchor_displacement_w, own);
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(model.sizes.n_rbf); ++k) field.coefficient_w[k] += own[k];
  if (r.local.law == NeighbourhoodLaw::kNone) {
    add_contact_node(model, own, r, field);
  } else {
    RbfVector g{};
    rbf_terms(model, r.contact_w, g);
    r.local_amplitude_w = r.dent_w - rbf_value(model, g, own);
    if (r.local.law == NeighbourhoodLaw::kPunch) r.local = punch_of(model, state, r, reach_m);
  }
  press_of(model, state, reach_m, r);
}

// One region by displacement angles. The global value at the contact point is not a vertex's, so the blend runs towards
// d_c from the value at x: u + (d_c - u) g, equally exact at the contact and equally zero beyond the reach.
Vec3 displacement_by_patch(const Model& model, const ShapeRegion& r, const PatchWeight& patch, const RbfVector& g,
                           Vec3 x, Vec3 normal) {
  PatchCorner corner[3];
  for (std::int32_t k = 0; k < 3; ++k) {
    const std::int32_t a = patch.anchor[k];
    if (a < 0 || a >= kMaxAnchors || static_cast<std::size_t>(a) >= model.anchor.size()) continue;  // weight 0
    corner[k] = {r.anchor_displacement_w[a], model.anchor[static_cast<std::size_t>(a)].normal, patch.weight[k]};
  }
  const Vec3 global = displacement_by_angle(corner, normal);
  const Real blend = r.local.law == NeighbourhoodLaw::kNone ? rbf_contact_weight(model, r.node, g, x)
                                                            : neighbourhood_blend(r.local, x - r.contact_w);
  return global + blend * (r.dent_w - global);
}

}  // namespace

void prepare_shape(const Model& model, const State& state, ShapeField& field) {
  field.count = 0;
  field.interpolated = rbf_available(model);
  const auto anchors = std::make_unique<AnchorField>(anchors_of(model, state));
  for (Vec3& c : field.coefficient_w) c = {};
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {
    const Region& region = state.region[slot];
    if (is_in_contact(region) && is_finite(region.centre_w)) prepare_region(model, state, *anchors, slot, field);
  }
}

Real pressure_at(const ShapeField& field, Vec3 rest_point_w) {
  Real sum = 0;
  for (std::int32_t i = 0; i < field.count; ++i) {  // <= kMaxRegions
    const ShapeRegion& r = field.region[i];
    if (!(r.mean_Pa > 0)) continue;
    const Real rho = r.press.edge.radii(rest_point_w - r.contact_w);
    sum += r.mean_Pa * min_of(contact_pressure(r.press.tip, rho), kMostPressure);
  }
  return sum;
}

Vec3 displacement_at(const Model& model, const ShapeField& field, Vec3 rest_point_w, std::int32_t vertex) {
  if (field.count == 0) return {};
  RbfVector g{};
  if (field.interpolated) rbf_terms(model, rest_point_w, g);
  Vec3 sum;
  if (const PatchWeight* patch = patch_of(model, vertex)) {
    const Vec3 normal = model.vertex_normal[static_cast<std::size_t>(vertex)];
    for (std::int32_t i = 0; i < field.count; ++i) {  // <= kMaxRegions
      sum += displacement_by_patch(model, field.region[i], *patch, g, rest_point_w, normal);
    }
    return sum;
  }
  if (field.interpolated) sum = rbf_value(model, g, field.coefficient_w);
  for (std::int32_t i = 0; i < field.count; ++i) {
    const ShapeRegion& r = field.region[i];
    const Vec3 from = rest_point_w - r.contact_w;
    sum += norm(from) * r.node_coefficient_w + neighbourhood_blend(r.local, from) * r.local_amplitude_w;
  }
  return sum;
}

}  // namespace palpate
