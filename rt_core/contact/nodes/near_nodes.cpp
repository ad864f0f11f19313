#include "rt_core/contact/nodes/nodes.h"
#include "rt_core/contact/nodes/region_motion.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/shapes.h"

namespace palpate {

namespace {

// A node whose outward normal points the same way as the tool's is on the far side of a thin body.
constexpr Real kFacing = 0.3;
// A region moves as one body, to within this share of its motion.
constexpr Real kCarryShare = 0.05;
// A rounded node's ball fades at this many times the node's share of the bend, both as 1 - cosine.
constexpr Real kFades = 2.25;

// Finds the nodes near the tool, four at a time, in the order of the vertices: their rest position says for most that
// nothing can carry them to the tool, and eight instructions a node are less than any search of a hierarchy takes for
// those around a clip's tube (2026-11-21).
class NodeSearch {
 public:
  NodeSearch(const Model& model, State& state, Scratch& scratch) PALPATE_RT : model_(model),
                                                                              state_(state),
                                                                              problem_(problem_of(scratch)),
                                                                              work_(scratch.work),
                                                                              near_(problem_.near),
                                                                              near_of_(problem_.near_of) {
    problem_.near_count = 0;
    const auto vertices = static_cast<std::size_t>(model.sizes.n_vertex);
    __builtin_memset(problem_.memory_of, 0xff, vertices * sizeof problem_.memory_of[0]);
    __builtin_memset(problem_.near_of, 0xff, (vertices + 3) / 4 * sizeof problem_.near_of[0]);
    for (std::int32_t m = 0; m < state.nodal.count; ++m) {  // bound: kMaxContacts
      problem_.memory_of[state.nodal.contact[m].vertex] = static_cast<std::int8_t>(m);
    }
    list_regions();
    const Real moved = norm(state.tool_w.position_m - state.tool_previous_w.position_m);
    margin_m_ = model.params.contact_margin_m + 2 * min_of(moved, model.params.contact_margin_m);
    reach_m_ = margin_m_ + (1 + kCarryShare) * carry_max_m_;
  }

  void visit(std::int32_t piece) PALPATE_RT {
    piece_ = piece;
    const ToolPiece& shape = model_.piece[static_cast<std::size_t>(piece)];
    face_ = faces_of(model_, shape);
    const RigidFrame frame(carrier_w(model_, state_, piece) * shape.pose_tool);
    work_.pieces += 1;
    if (!body_within_reach(shape, frame)) return;
    const auto vertices = static_cast<std::int32_t>(model_.sizes.n_vertex);
    work_.fours += vertices / 4 + 1;
    work_.planes += shape.plane_count * (vertices / 4 + 5);
    for (std::int32_t first = 0; first < vertices; first += 4) {  // bound: kMaxNodalVertices / 4
      const Vec3x4 rest = four_of(model_.vertex_m.data(), first, vertices);
      const Double4 gap_m = least_gap(shape, into(frame, rest), face_);
      const Double4 bulge = bulge_of(first, vertices);
      if (bits_of(gap_m - bulge > reach_m_) != 15) visit_four(shape, frame, first, rest, bulge);
    }
  }

 private:
  // None where none of them moves: with far_share 0, say.
  void list_regions() PALPATE_RT {
    bool still = true;
    for (std::int32_t s = 0; s < kMaxRegions; ++s) {  // bound: kMaxRegions
      const Region& region = state_.region[s];
      if (region.id == 0 || region.lost_ticks > 0) continue;
      const RegionMotion& motion = state_.nodal.motion[s];
      const Real turn = norm(motion.rotation_rad), carry = norm(motion.translation_m) + turn * motion.reach_m;
      still = still && carry == 0;
      region_[regions_++] = motion;
      carry_max_m_ = max_of(carry_max_m_, (1 + motion.finite * (0.5 * turn + abs_of(motion.growth))) * carry);
    }
    if (still) regions_ = 0;
  }

  // Whether the tool is near any of the root's boxes, by balls around them.
  bool body_within_reach(const ToolPiece& shape, const RigidFrame& frame) const PALPATE_RT {
    const BvhNode& root = model_.bvh[0];
    for (int k = 0; k < 4; ++k) {  // bound: 4
      if (root.count[k] == 0 && root.child[k] < 0) continue;
      const auto middle = [&](int a) PALPATE_RT {
        return 0.5 * (static_cast<Real>(root.lower_m[a][k]) + static_cast<Real>(root.upper_m[a][k]));
      };
      const auto half = [&](int a) PALPATE_RT {
        return 0.5 * (static_cast<Real>(root.upper_m[a][k]) - static_cast<Real>(root.lower_m[a][k]));
      };
      const Real radius = norm({half(0), half(1), half(2)});
      const Vec3 centre{middle(0), middle(1), middle(2)};
      if (!(least_gap(shape, into(frame, centre), face_) - radius > reach_m_)) return true;
    }
    return false;
  }

  // Four that follow one another, of one for each vertex; past the last one, the last.
  static Vec3x4 four_of(const Vec3* of_vertex, std::int32_t first, std::int32_t vertices) PALPATE_RT {
    const Vec3* from = of_vertex + first;
    if (first + 4 <= vertices) return load4(from);
    Vec3 last[4];
    for (std::int32_t k = 0; k < 4; ++k) last[k] = from[first + k < vertices ? k : vertices - 1 - first];  // bound: 4
    return load4(last);
  }

  // How far the surface between the nodes may stand out beyond them: see round_off().
  Double4 bulge_of(std::int32_t first, std::int32_t vertices) const PALPATE_RT {
    const NodalVertex* node = model_.nodal_vertex.data();
    const auto at = [&](std::int32_t k) PALPATE_RT -> const NodalVertex& {
      return node[first + k < vertices ? first + k : vertices - 1];
    };
    const Double4 radius{at(0).round_m, at(1).round_m, at(2).round_m, at(3).round_m};
    if (bits_of(radius > 0) == 0) return radius;  // most: flat there, or bent little
    const Double4 cosine{at(0).round_cosine, at(1).round_cosine, at(2).round_cosine, at(3).round_cosine};
    return (kFades * radius) * (1 - cosine);
  }

  // Each node is carried by the nearest region that reaches it, or by none.
  void visit_four(const ToolPiece& shape, const RigidFrame& frame, std::int32_t first, const Vec3x4& rest,
                  const Double4& bulge) PALPATE_RT {
    work_.near += 1;
    work_.near_regions += regions_;
    Double4 nearest = splat4(kHuge);
    Vec3x4 carry = splat4(Vec3{}), bend = carry, rotation = carry;
    for (std::int32_t r = 0; r < regions_; ++r) {  // bound: kMaxRegions
      const RegionMotion& motion = region_[r];
      const Vec3x4 arm = rest - splat4(motion.centre_w);
      const Double4 distance2 = dot(arm, arm);
      const Mask4 taken = (distance2 < nearest) & (distance2 <= motion.reach_m * motion.reach_m);
      if (bits_of(taken) == 0) continue;
      const Vec3x4 linear = carry_at(motion, arm);
      nearest = taken ? distance2 : nearest;
      carry = where(taken, linear, carry);
      bend = where(taken, bend_of(motion, linear), bend);
      rotation = where(taken, splat4(motion.rotation_rad), rotation);
    }
    const Vec3x4 carried = rest + carry + bend;
    const Vec3x4 at = into(frame, carried);
    const Double4 margin = margin_m_ + kCarryShare * square_root(dot(carry, carry));
    if (!face_.empty()) {  // most are far from its planes
      work_.planes += shape.plane_count;
      if (bits_of(least_gap(shape, at, face_) - bulge < margin) == 0) return;
      work_.faces += static_cast<std::int32_t>(face_.size());
    }
    const PieceGapOf<Vec3x4> gap = piece_gap(shape, at, face_);
    if (bits_of(gap.gap_m - bulge < margin) == 0) return;
    NearFour& near = near_[problem_.near_count];
    near.carry_w = carry;
    near.bend_w = bend;
    near.position_w = carried;
    near.normal_w = direction_out(frame, gap.normal);
    near.gap_m = gap.gap_m;
    near.first = first;
    for (std::int32_t& piece : near.piece) piece = piece_;  // bound: 4
    const auto vertices = static_cast<std::int32_t>(model_.sizes.n_vertex);
    if (bits_of(bulge > 0) != 0) round_off(shape, frame, rotation, vertices, near);
    const Vec3x4 outward = four_of(model_.vertex_normal.data(), first, vertices);
    near.lanes = bits_of((near.gap_m < margin) & (dot(outward, near.normal_w) <= kFacing));
    if (first + 4 > vertices) near.lanes &= (1u << (vertices - first)) - 1;
    if (near.lanes != 0) keep(near);
  }

  // Between the nodes of a sharp bend the surface bulges out; a convex tool would roll over the chords as over a
  // polygon (a clip's force jumps by 12 % from node to node, 2026-11-21). Within the node's own share of the bend the
  // tool meets the ball that fits it; beyond it, fading, the node itself.
  void round_off(const ToolPiece& shape, const RigidFrame& frame, const Vec3x4& rotation, std::int32_t vertices,
                 NearFour& near) const PALPATE_RT {
    for (std::uint32_t k = 0; k < 4; ++k) {  // bound: 4
      const std::int32_t vertex = near.first + static_cast<std::int32_t>(k);
      if (vertex >= vertices) return;
      const NodalVertex& node = model_.nodal_vertex[static_cast<std::size_t>(vertex)];
      if (!(node.round_m > 0)) continue;
      work_.rounded += 1;
      work_.faces += static_cast<std::int32_t>(face_.size());
      const Vec3 outward = unit_or(node.round_normal + cross(rotation[k], node.round_normal), node.round_normal);
      const Vec3 position = near.position_w[k], centre = position - node.round_m * outward;
      const PieceGap ball = piece_gap(shape, into(frame, centre), face_);
      const Vec3 normal = direction_out(frame, ball.normal);
      const Real turn = 1 + dot(outward, normal), share = 1 - node.round_cosine;  // 1 - cosines
      const Real weight = clamp_to((kFades * share - turn) / ((kFades - 1) * share), 0, 1);
      if (weight == 0) continue;
      near.gap_m[k] += weight * (ball.gap_m - node.round_m - near.gap_m[k]);
      near.normal_w.set(k, unit_or(near.normal_w[k] + weight * (normal - near.normal_w[k]), normal));
      near.position_w.set(k, position + weight * (centre - node.round_m * normal - position));
    }
  }

  // `found` stands in the first free place. A vertex near several pieces meets the one that is nearest.
  void keep(const NearFour& found) PALPATE_RT {
    std::int16_t& at = near_of_[found.first / 4];
    if (at < 0) {
      at = static_cast<std::int16_t>(problem_.near_count);
      problem_.near_count += 1;
      return;
    }
    NearFour& near = near_[at];
    for (std::uint32_t k = 0; k < 4; ++k) {  // bound: 4
      if ((found.lanes >> k & 1) == 0 || ((near.lanes >> k & 1) != 0 && !(found.gap_m[k] < near.gap_m[k]))) continue;
      near.lanes |= 1u << k;
      near.carry_w.set(k, found.carry_w[k]);
      near.bend_w.set(k, found.bend_w[k]);
      near.position_w.set(k, found.position_w[k]);
      near.normal_w.set(k, found.normal_w[k]);
      near.gap_m[k] = found.gap_m[k];
      near.piece[k] = found.piece[k];
    }
  }

  const Model& model_;
  State& state_;
  ContactProblem& problem_;
  Work& work_;
  NearFour* const near_;
  std::int16_t* const near_of_;
  RegionMotion region_[kMaxRegions];
  std::int32_t regions_ = 0;
  std::int32_t piece_ = 0;
  std::span<const HullFace> face_;  // of the piece
  Real margin_m_ = 0, carry_max_m_ = 0, reach_m_ = 0;
};

}  // namespace

void find_near_nodes(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  NodeSearch search(model, state, scratch);
  const auto pieces = static_cast<std::int32_t>(model.piece.size());
  for (std::int32_t i = 0; i < pieces; ++i) {  // bound: kMaxPieces
    if (model.piece[static_cast<std::size_t>(i)].point_count > 0) search.visit(i);
  }
}

}  // namespace palpate
