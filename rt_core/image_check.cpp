#include "rt_core/image_check.h"

namespace palpate {

namespace {

using std::int32_t;
using std::int64_t;

bool in_range(int64_t index, std::size_t size) noexcept { return index >= 0 && index < static_cast<int64_t>(size); }
bool is_unit(Vec3 v) noexcept { return squared_norm(v) > 0.99 && squared_norm(v) < 1.01; }
bool is_unit(Quat q) noexcept {
  const Real s = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return s > 0.99 && s < 1.01;
}

ImageResult broken(const char* field, std::size_t index) noexcept {
  return {ImageError::kCrossReference, field, static_cast<int64_t>(index)};
}
ImageResult not_finite(const char* field, std::size_t index) noexcept {
  return {ImageError::kNotFinite, field, static_cast<int64_t>(index)};
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
  const int64_t tail = model.params.rbf_tail == 1 ? 4 : 1;
  if (model.sizes.n_rbf != (n_anchor == 0 ? 0 : n_anchor + tail)) return broken("n_rbf", 0);
  if (model.sizes.n_rbf2 != model.sizes.n_rbf * model.sizes.n_rbf) return broken("n_rbf2", 0);
  for (std::size_t i = 0; i < model.rbf_inverse.size(); ++i)
    if (!is_finite(model.rbf_inverse[i])) return not_finite("rbf_inverse", i);
  if (model.sizes.n_patch != 0 && model.sizes.n_patch != model.sizes.n_vertex) return broken("n_patch", 0);
  if (static_cast<ShapeLaw>(model.params.shape_law) == ShapeLaw::kDisplacementAngle && n_anchor > 0 &&
      model.sizes.n_patch == 0)
    return broken("n_patch", 0);
  for (std::size_t i = 0; i < model.patch.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (!in_range(model.patch[i].anchor[k], model.anchor.size())) return broken("patch.anchor", i);
      if (!is_finite(model.patch[i].weight[k])) return not_finite("patch.weight", i);
    }
  return {};
}

ImageResult check_piece(const Model& model, std::size_t i) noexcept {
  const ToolPiece& p = model.piece[i];
  if (!is_finite(p.pose_tool) || !is_unit(p.pose_tool.orientation)) return not_finite("piece.pose_tool", i);
  for (const double extent : p.half_extent_m)
    if (!(extent >= 0 && extent < kHuge)) return not_finite("piece.half_extent_m", i);
  if (!(p.margin_m >= 0 && p.margin_m < kHuge)) return not_finite("piece.margin_m", i);
  if (!(p.bounding_radius_m > 0 && p.bounding_radius_m < kHuge)) return not_finite("piece.bounding_radius_m", i);
  if (p.shape < 0 || p.shape > static_cast<int32_t>(PieceShape::kHull)) return broken("piece.shape", i);
  const int64_t last_point = int64_t{p.first_point} + p.point_count;
  if (p.first_point < 0 || p.point_count < 0 || last_point > model.sizes.n_tool_point)
    return broken("piece.first_point", i);
  const int64_t last_hull = int64_t{p.first_hull} + p.hull_count;
  if (p.first_hull < 0 || p.hull_count < 0 || last_hull > model.sizes.n_hull) return broken("piece.first_hull", i);
  if (p.shape == static_cast<int32_t>(PieceShape::kHull) && p.hull_count < 1) return broken("piece.hull_count", i);
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
  for (std::size_t i = 0; i < model.piece.size(); ++i)
    if (const ImageResult result = check_piece(model, i); result.error != ImageError::kNone) return result;
  return {};
}

// Factor tables and the range of each tip law, so that the tick may index and divide.
ImageResult check_tip_laws(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.tip_law.size(); ++i) {
    const TipLaw& law = model.tip_law[i];
    if (law.half_power < 2 || law.half_power > 4) return broken("tip_law.half_power", i);
    const bool has_factor = law.first_factor >= 0;
    if (law.first_factor < -1 || (has_factor && int64_t{law.first_factor} + kFactorKnots > model.sizes.n_factor))
      return broken("tip_law.first_factor", i);
    const double sizes[] = {law.coefficient, law.depth_max_m, law.force_max_N};
    for (const double size : sizes)
      if (!(size > 0 && size < kHuge)) return not_finite("tip_law", i);
    if (!is_finite(law.c0_m_per_N) || !is_finite(law.c1_m_per_N2)) return not_finite("tip_law.c0_m_per_N", i);
  }
  for (std::size_t i = 0; i < model.factor.size(); ++i) {
    const FactorKnot& knot = model.factor[i];
    if (!is_finite(knot.value) || !is_finite(knot.slope) || !is_finite(knot.energy_J)) return not_finite("factor", i);
  }
  for (std::size_t i = 0; i < model.tip_pair.size(); ++i) {
    const TipPair& pair = model.tip_pair[i];
    if (!in_range(pair.piece_a, model.piece.size()) || !in_range(pair.piece_b, model.piece.size()))
      return broken("tip_pair.piece", i);
    if (!is_finite(pair.c_m_per_N) || !is_finite(pair.h_ab_m_per_N2) || !is_finite(pair.h_ba_m_per_N2))
      return not_finite("tip_pair", i);
  }
  return {};
}

// Curves: knots strictly ascending from zero, whole rows, forces that start at zero and never fall.
ImageResult check_tables(const Model& model) noexcept {
  const std::size_t knots = model.knot.size();
  if (knots < 2 || model.knot[0] != 0) return broken("knot", 0);
  for (std::size_t i = 1; i < knots; ++i)
    if (!(model.knot[i] > model.knot[i - 1] && model.knot[i] < kHuge)) return not_finite("knot", i);
  if (model.response.empty() || model.response.size() % knots != 0) return broken("n_response", 0);
  const bool root = static_cast<ResponseLaw>(model.params.response_law) == ResponseLaw::kRootTable;
  for (std::size_t i = 0; i < model.response.size(); ++i) {
    const ResponseKnot& r = model.response[i];
    const bool first = i % knots == 0;
    if (!(r.force_N >= 0 && r.force_N < kHuge && r.slope >= 0 && r.slope < kHuge && is_finite(r.energy_J)))
      return not_finite("response", i);
    // In the root of the depth a slope at zero would be an infinite stiffness.
    if (first ? r.force_N != 0 || (root && r.slope != 0) : r.force_N < model.response[i - 1].force_N)
      return broken("response", i);
  }
  if (model.vertex_response.size() != model.vertex_m.size()) return broken("vertex_response", 0);
  for (std::size_t i = 0; i < model.vertex_response.size(); ++i)
    if (!in_range(model.vertex_response[i], model.response.size() / knots)) return broken("vertex_response", i);
  return {};
}

ImageResult check_response(const Model& model) noexcept {
  for (std::size_t i = 0; i < model.corner_normal.size(); ++i)
    for (const Vec3& normal : model.corner_normal[i].normal)
      if (!is_unit(normal)) return not_finite("corner_normal", i);
  const auto law = static_cast<ResponseLaw>(model.params.response_law);
  if (!model.corner_normal.empty() && model.corner_normal.size() != model.triangle.size()) return broken("n_corner", 0);
  if (law == ResponseLaw::kPoints) return {};
  if (model.corner_normal.empty()) return broken("n_corner", 0);
  // One tip per piece: the stage has room for kMaxPieces.
  for (std::size_t i = 0; i < model.piece.size(); ++i)
    if (model.piece[i].point_count > 1) return broken("piece.point_count", i);
  if (law != ResponseLaw::kTip) return check_tables(model);
  if (model.tip_law.size() != model.piece.size()) return broken("n_tip_law", 0);
  return check_tip_laws(model);
}

}  // namespace

ImageResult check_arrays(const Model& model) noexcept {
  if (const ImageResult result = check_surface(model); result.error != ImageError::kNone) return result;
  if (const ImageResult result = check_hierarchy(model); result.error != ImageError::kNone) return result;
  if (const ImageResult result = check_skeleton(model); result.error != ImageError::kNone) return result;
  if (const ImageResult result = check_tool(model); result.error != ImageError::kNone) return result;
  return check_response(model);
}

}  // namespace palpate
