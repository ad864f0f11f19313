#include "rt_core/image_check.h"

#include "rt_core/contact/contact.h"
#include "rt_core/skeleton/beam_table.h"
#include "rt_core/stage_cost.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/surface/ring_proof.h"

namespace palpate {

namespace {

using std::int32_t;
using std::int64_t;

// Whether the fan about a corner ends. It is walked from its first triangle; the others stop where they meet a former.
bool fan_ends(const Model& model, std::size_t triangle, int corner) noexcept {
  const int32_t vertex = model.triangle[triangle].vertex[corner];
  int64_t at = model.triangle[triangle].adjacent[corner];
  for (int32_t steps = 1; steps < kMaxVertexTriangles; ++steps) {
    if (at <= static_cast<int64_t>(triangle)) return true;
    const Triangle& t = model.triangle[static_cast<std::size_t>(at)];
    at = t.adjacent[t.vertex[0] == vertex ? 0 : t.vertex[1] == vertex ? 1 : 2];
  }
  return at <= static_cast<int64_t>(triangle);
}

ImageResult check_fans(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.triangle.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (!fan_ends(model, i, k)) return {ImageError::kCombination, "triangle.fan", static_cast<int64_t>(i)};
  return {};
}

ImageResult check_surface(const Model& model) noexcept {
  if (model.vertex_m.size() != model.vertex_normal.size()) return broken("vertex_normal", 0);
  for (std::size_t i = 0; i < model.vertex_m.size(); ++i) {
    if (!is_finite(model.vertex_m[i])) return not_finite("vertex_m", i);
    if (!is_unit(model.vertex_normal[i])) return not_finite("vertex_normal", i);
  }
  for (std::size_t i = 0; i < model.triangle.size(); ++i) {
    const Triangle& t = model.triangle[i];
    for (int k = 0; k < 3; ++k) {
      if (!in_range(t.vertex[k], model.vertex_m.size())) return broken("triangle.vertex", i);
      if (!in_range(t.adjacent[k], model.triangle.size())) return broken("triangle.adjacent", i);
    }
    if (t.ring_convex < 0 || !in_range(ring_proof::lowest_about_hub(t), model.triangle.size()))
      return broken("triangle.ring_convex", i);
  }
  return {};
}

// One child slot of a node: kinds are told apart by count (see BvhNode). Adds the triangles of a leaf to `covered`.
ImageResult check_child(const Model& model, std::size_t i, int k, int64_t& covered) noexcept {
  const BvhNode& node = model.bvh[i];
  const int32_t child = node.child[k];
  if (node.count[k] == 0 && child < 0) return {};  // empty
  if (node.count[k] == 0) {
    if (child <= static_cast<int64_t>(i) || !in_range(child, model.bvh.size())) return broken("bvh.child", i);
  } else {
    const int64_t first = ~child;
    if (child >= 0 || node.count[k] < 0 || node.count[k] > 4) return broken("bvh.count", i);
    if (!in_range(first, model.triangle.size()) || !in_range(first + node.count[k] - 1, model.triangle.size()))
      return broken("bvh.child", i);
    covered += node.count[k];
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = static_cast<double>(node.lower_m[axis][k]);
    const double upper = static_cast<double>(node.upper_m[axis][k]);
    if (!is_finite(lower) || !is_finite(upper) || !(lower <= upper)) return not_finite("bvh.bounds", i);
  }
  return {};
}

// Walks the tree as a traversal would, so that a tree too deep for the tick's stack, or one whose nodes are shared or
// unreachable, is refused here.
ImageResult check_reachability(const Model& model) noexcept {
  int32_t stack[kMaxTraversalStack];
  int32_t top = 0;
  std::size_t visited = 0;
  stack[top++] = 0;
  while (top > 0) {  // bound: one visit per node, else refused
    const auto i = static_cast<std::size_t>(stack[--top]);
    if (++visited > model.bvh.size()) return broken("bvh.shared_node", i);
    for (int k = 0; k < 4; ++k) {
      if (model.bvh[i].child[k] < 0) continue;
      if (top == kMaxTraversalStack) return broken("bvh.depth", i);
      stack[top++] = model.bvh[i].child[k];
    }
  }
  return visited == model.bvh.size() ? ImageResult{} : broken("bvh.unreachable_node", visited);
}

ImageResult check_hierarchy(const Model& model) noexcept {
  int64_t covered = 0;
  for (std::size_t i = 0; i < model.bvh.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      const ImageResult result = check_child(model, i, k, covered);
      if (result.error != ImageError::kNone) return result;
    }
  }
  if (covered != static_cast<int64_t>(model.triangle.size())) return broken("bvh.coverage", model.bvh.size() - 1);
  return check_reachability(model);
}

ImageResult check_skeleton(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.anchor.size(); ++i) {
    const Anchor& a = model.anchor[i];
    if (!is_finite(a.position_m) || !is_unit(a.normal)) return not_finite("anchor", i);
    const double sizes[] = {a.section_area_m2, a.section_inertia_m4, a.section_radius_m, a.release_length_m};
    for (const double size : sizes)
      if (!(size > 0 && size < kHuge)) return not_finite("anchor.section", i);
    if (a.fixed != 0 && a.fixed != 1) return broken("anchor.fixed", i);
  }
  const int64_t n_anchor = model.sizes.n_anchor;
  if (model.params.coupling_law == CouplingLaw::kMutualPaper &&
      (n_anchor > kMaxMutualAnchors || uses_beam_table(model)))
    return broken("anchor.mutual", kMaxMutualAnchors);
  const int64_t tail = model.params.rbf_tail == RbfTail::kLinear ? 4 : 1;
  if (model.sizes.n_rbf != (n_anchor == 0 ? 0 : n_anchor + tail)) return broken("n_rbf", 0);
  if (model.sizes.n_rbf2 != model.sizes.n_rbf * model.sizes.n_rbf) return broken("n_rbf2", 0);
  for (std::size_t i = 0; i < model.rbf_inverse.size(); ++i)
    if (!is_finite(model.rbf_inverse[i])) return not_finite("rbf_inverse", i);
  if (model.sizes.n_patch != 0 && model.sizes.n_patch != model.sizes.n_vertex) return broken("n_patch", 0);
  if (model.params.shape_law == ShapeLaw::kDisplacementAnglePaper && n_anchor > 0 && model.sizes.n_patch == 0)
    return broken("n_patch", 0);
  for (std::size_t i = 0; i < model.patch.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (!in_range(model.patch[i].anchor[k], model.anchor.size())) return broken("patch.anchor", i);
      if (!is_finite(model.patch[i].weight[k])) return not_finite("patch.weight", i);
    }
  return {};
}

// Every array of beams holds all pairs of vertex and anchor, or none.
bool holds_all_pairs(const Model& model, int64_t size, bool needed) noexcept {
  return size == (needed ? model.sizes.n_vertex * model.sizes.n_anchor : 0);
}

ImageResult check_beams(const Model& model) noexcept {
  const auto law = model.params.skeleton_law;
  const bool circular = law == SkeletonLaw::kCircular, paper = law == SkeletonLaw::kCircularPaper;
  if (!holds_all_pairs(model, model.sizes.n_beam_stiffness, circular)) return broken("n_beam_stiffness", 0);
  if (!holds_all_pairs(model, model.sizes.n_beam_ratio, paper)) return broken("n_beam_ratio", 0);
  if (!holds_all_pairs(model, model.sizes.n_beam_response, circular || paper)) return broken("n_beam_response", 0);
  for (std::size_t i = 0; i < model.beam_stiffness.size(); ++i)
    for (const double k : model.beam_stiffness[i].k_N_per_m)
      if (!is_finite(k)) return not_finite("beam_stiffness", i);
  for (std::size_t i = 0; i < model.beam_ratio.size(); ++i) {
    const BeamRatio& r = model.beam_ratio[i];
    for (const Vec3& v : {r.f1_axis, r.f1_gain_N_per_m, r.f2_axis, r.f2_gain_N_per_m})
      if (!is_finite(v)) return not_finite("beam_ratio", i);
  }
  for (std::size_t i = 0; i < model.beam_response.size(); ++i) {
    const BeamResponse& r = model.beam_response[i];
    for (const Vec3& v :
         {r.release_m_per_N[0], r.release_m_per_N[1], r.release_m_per_N[2], r.inner_Pa_per_N, r.outer_Pa_per_N,
          r.side_Pa_per_N, r.axial_Pa_per_N, r.shear_in_Pa_per_N, r.shear_out_Pa_per_N})
      if (!is_finite(v)) return not_finite("beam_response", i);
  }
  return {};
}

bool is_face(const HullFace& f) noexcept {
  if (!is_unit(f.normal) || !is_finite(f.offset_m)) return false;
  for (int k = 0; k < 3; ++k)
    if (!is_finite(f.corner_m[k]) || !(squared_norm(f.corner_m[(k + 1) % 3] - f.corner_m[k]) > 0)) return false;
  return true;
}

ImageResult check_piece(const Model& model, std::size_t i) noexcept {
  const ToolPiece& p = model.piece[i];
  if (!is_finite(p.pose_tool) || !is_unit(p.pose_tool.orientation)) return not_finite("piece.pose_tool", i);
  for (const double extent : p.half_extent_m)
    if (!(extent >= 0 && extent < kHuge)) return not_finite("piece.half_extent_m", i);
  if (!(p.margin_m >= 0 && p.margin_m < kHuge)) return not_finite("piece.margin_m", i);
  if (!(p.bounding_radius_m > 0 && p.bounding_radius_m < kHuge)) return not_finite("piece.bounding_radius_m", i);
  if (!(p.neighbourhood_m >= 0 && p.neighbourhood_m < kHuge)) return not_finite("piece.neighbourhood_m", i);
  if (!is_choice(p.shape)) return broken("piece.shape", i);
  const int64_t last_point = int64_t{p.first_point} + p.point_count;
  if (p.first_point < 0 || p.point_count < 0 || last_point > model.sizes.n_tool_point)
    return broken("piece.first_point", i);
  const int64_t last_hull = int64_t{p.first_hull} + p.hull_count;
  if (p.first_hull < 0 || p.hull_count < 0 || last_hull > model.sizes.n_hull) return broken("piece.first_hull", i);
  if (p.shape == PieceShape::kHull && p.hull_count < 1) return broken("piece.hull_count", i);
  const int64_t last_face = int64_t{p.first_face} + p.face_count;
  if (p.first_face < 0 || p.face_count < 0 || p.face_count > kMaxHullFaces || last_face > model.sizes.n_hull_face)
    return broken("piece.first_face", i);
  if (p.plane_count < 0 || p.plane_count > p.face_count || (p.plane_count == 0 && p.face_count > 0))
    return broken("piece.plane_count", i);
  if (model.params.articulation != Articulation::kRigid && p.joint != -1 && !in_range(p.joint, model.joint.size()))
    return broken("piece.joint", i);
  for (int64_t k = p.first_point; k < last_point; ++k)
    if (model.tool_point[static_cast<std::size_t>(k)].piece != static_cast<int32_t>(i))
      return broken("piece.first_point", i);
  return {};
}

ImageResult check_tool(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.tool_point.size(); ++i) {
    const ToolPoint& p = model.tool_point[i];
    if (!is_finite(p.position_tool_m)) return not_finite("tool_point.position_tool_m", i);
    const double sizes[] = {p.margin_m, p.area_m2, p.weight};
    for (const double size : sizes)
      if (!(size >= 0 && size < kHuge)) return not_finite("tool_point", i);
    if (!in_range(p.piece, model.piece.size())) return broken("tool_point.piece", i);
  }
  for (std::size_t i = 0; i < model.hull_vertex_m.size(); ++i)
    if (!is_finite(model.hull_vertex_m[i])) return not_finite("hull_vertex_m", i);
  for (std::size_t i = 0; i < model.hull_face.size(); ++i)
    if (!is_face(model.hull_face[i])) return not_finite("hull_face", i);
  for (std::size_t i = 0; i < model.piece.size(); ++i)
    if (const ImageResult result = check_piece(model, i); result.error != ImageError::kNone) return result;
  return {};
}

// Parents come before their children, so that one pass places every link.
ImageResult check_joint(const Joint& joint, std::size_t i) noexcept {
  for (const Pose& pose : {joint.before, joint.after, joint.zero_inverse})
    if (!is_finite(pose) || !is_unit(pose.orientation)) return not_finite("joint.pose", i);
  const double lowest = joint.lowest, highest = joint.highest;
  if (!(lowest >= -kHuge && lowest <= highest && highest <= kHuge)) return not_finite("joint.limits", i);
  for (const double position : {joint.open, joint.closed})
    if (!(position >= lowest && position <= highest)) return not_finite("joint.open", i);
  if (!(joint.speed_max > 0 && joint.speed_max <= kHuge)) return not_finite("joint.speed_max", i);
  if (joint.sign != 1 && joint.sign != -1) return broken("joint.sign", i);
  if (joint.parent < -1 || joint.parent >= static_cast<int64_t>(i)) return broken("joint.parent", i);
  if (!is_choice(joint.kind)) return broken("joint.kind", i);
  if (joint.finger < 0 || joint.finger >= kMaxFingers) return broken("joint.finger", i);
  return {};
}

ImageResult check_articulation(const Model& model) noexcept {
  const Articulation articulation = model.params.articulation;
  const bool two_tools = articulation == Articulation::kTwoTools;
  if ((articulation != Articulation::kRigid && !two_tools) != (model.sizes.n_joint > 0)) return broken("n_joint", 0);
  if (two_tools != (model.params.held_part == HeldPart::kTwoTools)) return broken("held_part", 0);
  if (two_tools && method_of(model) == Method::kNodes) return broken("articulation", 0);
  for (std::size_t i = 0; i < model.piece.size(); ++i)
    if (two_tools && model.piece[i].group != 0 && model.piece[i].group != 1) return broken("piece.group", i);
  for (std::size_t i = 0; i < model.joint.size(); ++i)
    if (const ImageResult result = check_joint(model.joint[i], i); result.error != ImageError::kNone) return result;
  for (std::size_t i = 0; i < model.grasp_w.size(); ++i)
    if (!is_finite(model.grasp_w[i]) || !is_unit(model.grasp_w[i].orientation)) return not_finite("grasp_w", i);
  return {};
}

// Smooth normals: none, or three for every triangle.
ImageResult check_corners(const Model& model) noexcept {
  if (!model.corner_normal.empty() && model.corner_normal.size() != model.triangle.size()) return broken("n_corner", 0);
  for (std::size_t i = 0; i < model.corner_normal.size(); ++i)
    for (const Vec3& normal : model.corner_normal[i].normal)
      if (!is_unit(normal)) return not_finite("corner_normal", i);
  return {};
}

// What a tick takes at most was found by the baker and cannot be checked here; that it is more than a tick in contact
// takes at least, and no more than its capacities allow, can. Sums are rounded in another order elsewhere.
ImageResult check_cost(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.stage_cost.size(); ++i) {
    const double claimed = model.stage_cost[i].instructions;
    const auto stage = static_cast<Stage>(i);
    if (!(claimed >= 0.999 * least_stage_cost(model, stage) && claimed <= 1.001 * most_stage_cost(model, stage)))
      return {ImageError::kCombination, "stage_cost", static_cast<int64_t>(i)};
  }
  return {};
}

// Arrays of other methods than the scene's are empty.
ImageResult check_owners(const Model& model) noexcept {
  const unsigned own = bit_of(method_of(model.params));
#define PALPATE_CHECK(name, lowest, highest, methods) \
  if (((methods)&own) == 0 && model.sizes.name != 0) return broken(#name, 0);
  PALPATE_MODEL_SIZES(PALPATE_CHECK)
#undef PALPATE_CHECK
  return {};
}

}  // namespace

ImageResult check_method(const Model& model) noexcept {
  const Method method = method_of(model.params);
  if ((methods_of(model.params.friction_law) & bit_of(method)) == 0) return {ImageError::kCombination, "friction_law"};
  return contact_method(method).check_tool(model);
}

// In this order: what a later check indexes, an earlier one has seen.
ImageResult check_arrays(const Model& model) noexcept {
  using Check = ImageResult (*)(const Model&) noexcept;
  constexpr Check kChecks[] = {check_owners, check_surface, check_fans,         check_hierarchy, check_skeleton,
                               check_beams,  check_tool,    check_articulation, check_corners,   check_method};
  for (const Check check : kChecks)
    if (const ImageResult result = check(model); result.error != ImageError::kNone) return result;
  const ImageResult data = contact_method(method_of(model)).check_data(model);
  return data.error != ImageError::kNone ? data : check_cost(model);
}

}  // namespace palpate
