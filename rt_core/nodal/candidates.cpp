#include "rt_core/articulate/carrier.h"
#include "rt_core/nodal/nodal.h"
#include "rt_core/nodal/piece_gap.h"

namespace palpate {

namespace {

// A node whose outward normal points the same way as the tool's is on the far side of a thin body.
constexpr Real kFacing = 0.3;
// A region moves as one body, to within this share of its motion.
constexpr Real kCarryShare = 0.05;

// Where a node and the tool meet.
struct Touch {
  Vec3 position_w, normal_w;
  Real gap_m;
};

class NodeSearch {
 public:
  NodeSearch(const Model& model, State& state, Scratch& scratch) PALPATE_RT : model_(model),
                                                                              state_(state),
                                                                              scratch_(scratch),
                                                                              problem_(scratch.nodal) {
    problem_.count = 0;
    const auto vertices = static_cast<std::size_t>(model.sizes.n_vertex);
    __builtin_memset(problem_.memory_of, 0xff, vertices);
    __builtin_memset(problem_.node_of, 0xff, vertices);
    for (std::int32_t m = 0; m < state.nodal.count; ++m) {  // bound: kMaxContacts
      problem_.memory_of[state.nodal.contact[m].vertex] = static_cast<std::int8_t>(m);
    }
    list_regions();
    const Real moved = norm(state.tool_w.position_m - state.tool_previous_w.position_m);
    margin_m_ = model.params.contact_margin_m + 2 * min_of(moved, model.params.contact_margin_m);
  }

  void visit(std::int32_t piece) PALPATE_RT {
    piece_ = piece;
    const ToolPiece& shape = model_.piece[static_cast<std::size_t>(piece)];
    const PieceFrame frame(carrier_w(model_, state_, piece) * shape.pose_tool);
    std::int32_t stack[kMaxTraversalStack];
    std::int32_t top = 0;
    stack[top++] = 0;
    while (top > 0) {  // bound: every hierarchy node once
      const BvhNode& node = model_.bvh[static_cast<std::size_t>(stack[--top])];
      const Balls balls = balls_around(node);
      for (int k = 3; k >= 0; --k) {  // bound: 4
        if (node.count[k] == 0 && node.child[k] < 0) continue;
        if (node.count[k] == 0 && !may_touch(shape, frame, {balls.x[k], balls.y[k], balls.z[k]}, balls.radius[k]))
          continue;
        if (node.count[k] > 0) {
          visit_leaf(shape, frame, ~node.child[k], node.count[k]);
        } else if (top < kMaxTraversalStack) {
          stack[top++] = node.child[k];
        } else {
          scratch_.status |= Status::kTraversalTruncated;
        }
      }
    }
  }

 private:
  void list_regions() PALPATE_RT {
    for (std::int32_t s = 0; s < kMaxRegions; ++s) {  // bound: kMaxRegions
      const Region& region = state_.region[s];
      if (region.id == 0 || region.lost_ticks > 0) continue;
      const RegionMotion& motion = state_.nodal.motion[s];
      region_[regions_++] = motion;
      const Real turn = norm(motion.rotation_rad), carry = norm(motion.translation_m) + turn * motion.reach_m;
      carry_max_m_ = max_of(carry_max_m_, (1 + motion.finite * (0.5 * turn + abs_of(motion.growth))) * carry);
    }
  }

  // Balls around the four boxes of a node.
  struct Balls {
    Double4 x, y, z, radius;
  };
  static Balls balls_around(const BvhNode& node) PALPATE_RT {
    const auto middle = [&](int axis)
                            PALPATE_RT { return 0.5 * (widen4(node.lower_m[axis]) + widen4(node.upper_m[axis])); };
    const auto half = [&](int axis)
                          PALPATE_RT { return 0.5 * (widen4(node.upper_m[axis]) - widen4(node.lower_m[axis])); };
    const Double4 x = half(0), y = half(1), z = half(2);
    return {middle(0), middle(1), middle(2), square_root(x * x + y * y + z * z)};
  }

  // Whether a node in the ball can come within reach of the piece, at rest or carried by a region that reaches the
  // ball.
  bool may_touch(const ToolPiece& shape, const PieceFrame& frame, Vec3 centre, Real radius) const PALPATE_RT {
    const Real gap = piece_gap(shape, frame.into(centre)).gap_m - radius - margin_m_;
    if (!(gap > 0)) return true;
    if (gap > (1 + kCarryShare) * carry_max_m_) return false;
    for (std::int32_t r = 0; r < regions_; ++r) {  // bound: kMaxRegions
      if (!(norm(centre - region_[r].centre_w) <= region_[r].reach_m + radius)) continue;
      const Vec3 linear = carry_at(region_[r], centre), carry = linear + bend_of(region_[r], linear);
      const Real spread = norm(region_[r].rotation_rad) * radius + kCarryShare * carry_max_m_;
      if (!(piece_gap(shape, frame.into(centre + carry)).gap_m - radius - spread > margin_m_)) return true;
    }
    return false;
  }

  void visit_leaf(const ToolPiece& shape, const PieceFrame& frame, std::int32_t first, std::int32_t count) PALPATE_RT {
    const Triangle* triangle = model_.triangle.data() + first;
    const NodalVertex* node = model_.nodal_vertex.data();
    for (std::int32_t t = first; t < first + count; ++t, ++triangle) {  // bound: 4
      for (int k = 0; k < 3; ++k) {                                     // bound: 3
        if (node[triangle->vertex[k]].owner == t) visit_vertex(shape, frame, triangle->vertex[k]);
      }
    }
  }

  // The nearest region that carries the point, or none.
  const RegionMotion* carrier(Vec3 rest) const PALPATE_RT {
    const RegionMotion* found = nullptr;
    Real nearest = kHuge;
    for (std::int32_t r = 0; r < regions_; ++r) {  // bound: kMaxRegions
      const Real distance2 = squared_norm(rest - region_[r].centre_w);
      if (!(distance2 < nearest && distance2 <= region_[r].reach_m * region_[r].reach_m)) continue;
      nearest = distance2;
      found = &region_[r];
    }
    return found;
  }

  void visit_vertex(const ToolPiece& shape, const PieceFrame& frame, std::int32_t vertex) PALPATE_RT {
    const auto v = static_cast<std::size_t>(vertex);
    const Vec3 rest = model_.vertex_m[v];
    const RegionMotion* motion = carrier(rest);
    const Vec3 carry = motion != nullptr ? carry_at(*motion, rest) : Vec3{};
    const Vec3 bend = motion != nullptr ? bend_of(*motion, carry) : Vec3{}, carried = rest + carry + bend;
    const Real margin = margin_m_ + (problem_.memory_of[vertex] < 0 ? kCarryShare * norm(carry) : 0.0);
    const NodalVertex& node = model_.nodal_vertex[v];
    const PieceGap gap = piece_gap(shape, frame.into(carried));
    if (!(gap.gap_m - node.round_m < margin)) return;
    Touch touch{carried, frame.direction_out(gap.normal), gap.gap_m};
    if (node.round_m > 0) {
      const Vec3 turn = motion != nullptr ? cross(motion->rotation_rad, node.round_normal) : Vec3{};
      round_off(shape, frame, node, unit_or(node.round_normal + turn, node.round_normal), touch);
    }
    if (!(touch.gap_m < margin) || dot(model_.vertex_normal[v], touch.normal_w) > kFacing) return;
    keep(vertex, rest, carry, bend, touch);
  }

  // Between the nodes of a sharp bend the surface bulges out; a convex tool would roll over the chords as over a
  // polygon (a clip's force jumps by 12 % from node to node, 2026-11-21). Within the node's own share of the bend the
  // tool meets the ball that fits it; beyond it, fading, the node itself.
  static void round_off(const ToolPiece& shape, const PieceFrame& frame, const NodalVertex& node, Vec3 outward,
                        Touch& touch) PALPATE_RT {
    const Vec3 centre = touch.position_w - node.round_m * outward;
    const PieceGap ball = piece_gap(shape, frame.into(centre));
    const Vec3 normal = frame.direction_out(ball.normal);
    const Real turn = 1 + dot(outward, normal), share = 1 - node.round_cosine;  // 1 - cosines
    const Real weight = clamp_to((2.25 * share - turn) / (1.25 * share), 0, 1);
    if (weight == 0) return;
    touch.gap_m += weight * (ball.gap_m - node.round_m - touch.gap_m);
    touch.normal_w = unit_or(touch.normal_w + weight * (normal - touch.normal_w), normal);
    touch.position_w += weight * (centre - node.round_m * normal - touch.position_w);
  }

  bool pushed(std::int32_t vertex) const PALPATE_RT { return problem_.memory_of[vertex] >= 0; }

  // Rank when the pool is full: nodes that pushed last tick stay, then the deepest; ties: first come.
  Real rank(std::int32_t vertex, Real gap_m) const PALPATE_RT { return pushed(vertex) ? gap_m - 1.0 : gap_m; }

  void keep(std::int32_t vertex, Vec3 rest, Vec3 carry, Vec3 bend, const Touch& touch) PALPATE_RT {
    const Real gap_m = touch.gap_m;
    std::int32_t at = problem_.node_of[vertex];
    if (at >= 0) {  // another piece was nearer or is now
      if (!(gap_m < problem_.node[at].gap_m)) return;
    } else if (problem_.count < kMaxContacts) {
      at = problem_.count++;
    } else {
      if (worst_ < 0) find_worst();
      if (gap_m < 0 && worst_rank_ < 0) scratch_.status |= Status::kContactsDropped;
      if (!(rank(vertex, gap_m) < worst_rank_)) return;
      at = worst_;
      worst_ = -1;
      problem_.node_of[problem_.node[at].vertex] = -1;
    }
    problem_.node_of[vertex] = static_cast<std::int8_t>(at);
    ContactNode& node = problem_.node[at];
    node.vertex = vertex;
    node.piece = piece_;
    node.memory = problem_.memory_of[vertex];
    node.region = node.memory >= 0 ? state_.nodal.contact[node.memory].region : -1;
    node.rest_w = rest;
    node.carry_w = carry;
    node.bend_w = bend;
    node.normal_w = touch.normal_w;
    node.arm_w = touch.position_w - state_.tool_w.position_m;
    node.gap_m = gap_m;
  }

  void find_worst() PALPATE_RT {
    worst_rank_ = -kHuge;
    for (std::int32_t i = 0; i < problem_.count; ++i) {  // bound: kMaxContacts
      const Real value = rank(problem_.node[i].vertex, problem_.node[i].gap_m);
      if (!(value > worst_rank_)) continue;
      worst_rank_ = value;
      worst_ = i;
    }
  }

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ContactProblem& problem_;
  RegionMotion region_[kMaxRegions];
  std::int32_t regions_ = 0;
  std::int32_t piece_ = 0;
  Real margin_m_ = 0, carry_max_m_ = 0;
  std::int32_t worst_ = -1;
  Real worst_rank_ = 0;
};

}  // namespace

void collide_nodal(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_count = 0;
  scratch.nodal.count = 0;
  if (!is_finite(state.tool_w)) return;
  NodeSearch search(model, state, scratch);
  const auto pieces = static_cast<std::int32_t>(model.piece.size());
  for (std::int32_t i = 0; i < pieces; ++i) {  // bound: kMaxPieces
    if (model.piece[static_cast<std::size_t>(i)].point_count > 0) search.visit(i);
  }
  if (scratch.nodal.count > state.high_water.contacts) state.high_water.contacts = scratch.nodal.count;
}

}  // namespace palpate
