#include "rt_core/contact/regions.h"

#include "rt_core/surface/body_box.h"
#include "rt_core/surface/four_queries.h"
#include "rt_core/surface/overlap.h"
#include "rt_core/surface/smooth_foot.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/tool/carrier_frames.h"
#include "rt_core/tool/two_tools.h"

namespace palpate {

namespace {

// Points up to this much farther off are measured in turn, one of kTurns each tick. A tool that comes near moves all
// its points by the same distance, and without turns they would all be due, and cold, in the same tick.
constexpr double kRefreshMargin_m = 2e-3;
constexpr std::uint64_t kTurns = 8;
// Cosine of the largest turn of the normal in one tick that still counts as the same face: a tip at 0.5 m/s turns by
// less than a degree per tick even on a body of 20 mm.
constexpr double kSameFace = 0.5;

// The last surface measurement does not hold: measure at the next opportunity.
void forget(PointState& point) PALPATE_RT {
  point.gap_m = 0;
  point.gap_bound_m = 0;
}

// Not measured: the gap is only known to be at least `gap_m`.
void skip(PointState& point, Real gap_m) PALPATE_RT {
  point.gap_m = gap_m;
  point.gap_bound_m = gap_m;
}

// A truncated search may have ended on a far part of the surface and got the side wrong. Signed distance changes by at
// most the distance moved, so a point that was farther than that from the surface is still on its side.
Real side_checked(Real signed_distance_m, const PointState& last, Real margin_m, Real moved_m) PALPATE_RT {
  if (last.gap_bound_m == 0) return signed_distance_m;  // nothing known from the last tick
  const Real before = last.gap_m + margin_m;
  if (before > moved_m) return abs_of(signed_distance_m);
  return before < -moved_m ? -abs_of(signed_distance_m) : signed_distance_m;
}

class Collider {
 public:
  Collider(const Model& model, State& state, Scratch& scratch) PALPATE_RT
      : model_(model),
        state_(state),
        scratch_(scratch),
        now_(lanes_of(RigidFrame(state.tool_w))),
        before_(lanes_of(RigidFrame(state.tool_previous_w))),
        root_(root_box(model)),
        share_(surface_work_share(model.params)),
        points_(state.point.data()),
        tool_points_(model.tool_point.data()) {
    smooth_ = !model.corner_normal.empty();
    const ArticulationState& a = state.articulation;
    if (is_articulated(model)) now_of_.place(state.tool_w, a.motion_tool.data(), a.motion_tool.size());
  }

  // The points of a piece from `from` on, or before it.
  void visit(std::size_t index, std::int32_t from, bool before) PALPATE_RT {
    const ToolPiece& piece = model_.piece[index];
    scratch_.work.pieces += 1;
    piece_ = static_cast<std::int32_t>(index);
    if (is_articulated(model_)) {
      now_ = now_of_.of(piece_);
      knows_before_ = false;
    }
    const Real gap = distance_to(root_, out_of(now_, piece.pose_tool.position_m)) - piece.bounding_radius_m;
    const std::int32_t last = piece.first_point + piece.point_count;
    const std::int32_t begin = before || piece.first_point > from ? piece.first_point : from;
    const std::int32_t end = before && from < last ? from : last;
    if (begin < end) scratch_.work.points += end - begin;
    for (std::int32_t i = begin; i < end; ++i) {  // bound: kMaxToolPoints over all pieces
      if (gap > kSearchMargin_m + kRefreshMargin_m) {
        skip(points_[i], gap);
      } else {
        visit_point(i);
      }
    }
    measure_due();
  }

  void finish() PALPATE_RT {
    state_.first_point = next_first_ < 0 ? 0 : next_first_;
    scratch_.surface_work = share_ - left_;
    scratch_.work.looks = scratch_.surface_work;
  }

 private:
  void visit_point(std::int32_t index) PALPATE_RT {
    PointState& point = points_[index];
    const Double4 at_w = out_of(now_, tool_points_[index].position_tool_m);
    const Vec3 p = vector_of(at_w);
    // Written so that a NaN in any term measures the point.
    if (point.gap_bound_m > kSearchMargin_m) {
      const Real bound = point.gap_bound_m - moved(index, p);
      const bool its_turn = (static_cast<std::uint64_t>(index) + state_.tick) % kTurns == 0;
      if (bound > kSearchMargin_m && !(its_turn && bound < kSearchMargin_m + kRefreshMargin_m))
        return skip(point, bound);
    }
    if (!(point.gap_m < 0)) {
      // Far from the body its box says as much as its surface, and costs nothing next to a cold search.
      const Real gap = distance_to(root_, at_w) - tool_points_[index].margin_m;
      if (gap > kSearchMargin_m + kRefreshMargin_m) return skip(point, gap);
    }
    due_[due_count_] = index;
    query_.p[due_count_] = p;
    query_.warm_triangle[due_count_] = point.triangle;
    if (++due_count_ == 4) measure_due();
  }

  // What of the points due, in their order, the tick's share of work is left for.
  void measure_due() PALPATE_RT {
    if (due_count_ == 0) return;
    FourSettled four;
    if (due_count_ > 1) four = settle_four(model_, query_, due_count_);
    for (std::int32_t k = 0; k < due_count_; ++k) {  // bound: 4
      const Vec3 p = query_.p[k];
      if (left_ > 0 && (four.settled >> k & 1) != 0) {
        settle(due_[k], p, four, static_cast<std::uint32_t>(k));
      } else if (left_ > 0) {
        search(due_[k], p);
      } else {
        wait(due_[k], p);
      }
    }
    due_count_ = 0;
  }

  // With no more boxes and triangles than are left; a point for which they do not suffice is the next tick's first, for
  // which its whole share must.
  void search(std::int32_t index, Vec3 p) PALPATE_RT {
    const std::int32_t most = left_ < 2 * kMaxSearched ? (left_ + 1) / 2 : kMaxSearched;  // of either
    const SurfacePoint surface = closest_surface_point(model_, p, kHuge, points_[index].triangle, most);
    if (!surface.truncated || left_ == share_ || most == kMaxSearched) return measure(index, p, surface);
    left_ -= surface.looked;
    wait(index, p);
  }

  void wait(std::int32_t index, Vec3 p) PALPATE_RT {
    scratch_.work.waiting += 1;
    if (next_first_ < 0) next_first_ = index;
    hold(index, p);
  }

  // The tick's share of work is spent. A point in contact stays on its plane (a god-object); another's gap has shrunk
  // by its motion at most.
  void hold(std::int32_t index, Vec3 p) PALPATE_RT {
    scratch_.status |= Status::kPointsHeld;
    PointState& point = points_[index];
    const ToolPoint& tool_point = tool_points_[index];
    const bool touched = point.gap_m < 0 && point.triangle >= 0;
    const Real gap =
        touched ? dot(p - point.closest_w, point.normal_w) - tool_point.margin_m : point.gap_bound_m - moved(index, p);
    if (!touched && gap > 0) return skip(point, gap);
    if (!touched || !(gap < 0)) return forget(point);
    point.gap_m = point.gap_bound_m = gap;
    if (smooth_) {
      SurfaceFoot& foot = scratch_.foot[tool_point.piece];
      foot = {};
      foot.centre_w = p;
      foot.triangle = point.triangle;
      facet_weights(model_, point.triangle, point.closest_w, foot.weight);
    }
    keep(index, point, tool_point);
  }

  Real moved(std::int32_t index, Vec3 p) PALPATE_RT {
    if (!knows_before_) look_back();
    return norm(p - vector_of(out_of(before_, tool_points_[index].position_tool_m)));
  }

  // Where the piece was: few ticks ask.
  void look_back() PALPATE_RT {
    const ArticulationState& a = state_.articulation;
    if (!knows_all_before_)
      before_of_.place(state_.tool_previous_w, a.motion_previous_tool.data(), a.motion_previous_tool.size());
    knows_all_before_ = knows_before_ = true;
    before_ = before_of_.of(piece_);
  }

  // measure() of one of four that is outside the body, with its nearest place proved.
  void settle(std::int32_t index, Vec3 p, const FourSettled& four, std::uint32_t k) PALPATE_RT {
    if (smooth_) return measure(index, p, settled_point(four, k));
    const ToolPoint& tool_point = tool_points_[index];
    PointState& point = points_[index];
    left_ -= looked_at(four, k);
    scratch_.work.queries += 1;
    point.closest_w = four.closest_w[k];
    point.normal_w = four.normal_w[k];
    point.triangle = four.triangle[k];
    point.gap_m = point.gap_bound_m = four.distance_m[k] - tool_point.margin_m;
    if (point.gap_m < 0) keep(index, point, tool_point);
  }

  void measure(std::int32_t index, Vec3 p, const SurfacePoint& surface) PALPATE_RT {
    const ToolPoint& tool_point = tool_points_[index];
    PointState& point = points_[index];
    left_ -= surface.looked;
    scratch_.work.queries += 1;
    if (surface.stack_high_water > state_.high_water.traversal_stack) {
      state_.high_water.traversal_stack = surface.stack_high_water;
    }
    if (!surface.found) return forget(point);
    if (smooth_) return touch_smooth(index, p, surface, tool_point);
    Real signed_distance = surface.signed_distance_m;
    point.normal_w = surface.normal_w;
    if (surface.truncated) {
      scratch_.status |= Status::kTraversalTruncated;
      signed_distance = side_checked(signed_distance, point, tool_point.margin_m, moved(index, p));
      if ((signed_distance < 0) != (surface.signed_distance_m < 0)) point.normal_w = -surface.normal_w;
    }
    point.closest_w = surface.closest_w;
    point.triangle = surface.triangle;
    point.gap_m = signed_distance - tool_point.margin_m;
    point.gap_bound_m = signed_distance < 0 ? point.gap_m : surface.lower_bound_m - tool_point.margin_m;
    if (point.gap_m < 0) keep(index, point, tool_point);
  }

  // Deep inside, past the middle of a thin body, the nearest surface is another face, whose force would pull the tip
  // through (seen 2026-11-21: a cone at 5 mm in a layer of 10 mm). A point in contact stays with its own face while
  // that has a foot for it or has just lost it in the focal surface.
  SmoothFoot followed(Vec3 p, const SurfacePoint& surface, const PointState& point,
                      const SmoothFoot& nearest) const PALPATE_RT {
    if (!(surface.signed_distance_m < 0 && point.gap_m < 0 && point.triangle >= 0)) return nearest;
    const Vec3 normal = nearest.state == FootState::kFound ? nearest.normal_w : surface.normal_w;
    if (dot(normal, point.normal_w) > kSameFace) return nearest;
    const SmoothFoot own = smooth_foot(model_, p, point.triangle);
    scratch_.work.feet += own.steps;
    return own.state == FootState::kFound || own.state == FootState::kFocal ? own : nearest;
  }

  // Contact with the smooth surface instead of its facets. Beyond a sharp edge the facet decides; below the focal
  // surface a point in contact keeps its last place (a god-object).
  void touch_smooth(std::int32_t index, Vec3 p, const SurfacePoint& surface, const ToolPoint& tool_point) PALPATE_RT {
    PointState& point = points_[index];
    SurfaceFoot& foot = scratch_.foot[tool_point.piece];
    if (surface.truncated) scratch_.status |= Status::kTraversalTruncated;
    const SmoothFoot nearest = smooth_foot(model_, p, surface.triangle);
    scratch_.work.feet += nearest.steps;
    const SmoothFoot smooth = followed(p, surface, point, nearest);
    foot = {};
    foot.centre_w = p;
    Real height = surface.signed_distance_m;
    if (smooth.state == FootState::kFound) {
      height = smooth.height_m;
      point.closest_w = smooth.foot_w;
      point.normal_w = smooth.normal_w;
      point.triangle = smooth.triangle;
      for (int k = 0; k < 3; ++k) {  // bound: 3
        foot.weight[k] = smooth.weight[k];
        foot.gradient_per_m[k] = smooth.gradient_per_m[k];
      }
    } else {
      const bool lost = smooth.state == FootState::kFocal || smooth.state == FootState::kFar;
      if (lost && point.gap_m < 0 && point.triangle >= 0) {
        scratch_.status |= Status::kFootHeld;
        height = dot(p - point.closest_w, point.normal_w);
      } else {
        point.closest_w = surface.closest_w;
        point.normal_w = surface.normal_w;
        point.triangle = surface.triangle;
      }
      facet_weights(model_, point.triangle, point.closest_w, foot.weight);
    }
    foot.triangle = point.triangle;
    point.gap_m = height - tool_point.margin_m;
    // The smooth surface may stand off the facets, towards the point, by the slack.
    const Real reach = surface.lower_bound_m - tool_point.margin_m - model_.params.smooth_slack_m;
    point.gap_bound_m = height < 0 ? point.gap_m : min_of(reach, point.gap_m);
    if (point.gap_m < 0) keep(index, point, tool_point);
  }

  // Adds a contact; when the pool is full the shallowest goes (ties: the higher index).
  void keep(std::int32_t index, const PointState& point, const ToolPoint& tool_point) PALPATE_RT {
    if (scratch_.contact_count == kMaxContacts) {
      Contact* const contact = scratch_.contact.data();
      scratch_.status |= Status::kContactsDropped;
      scratch_.work.pairs += kMaxContacts;
      std::int32_t shallowest = 0;
      for (std::int32_t i = 1; i < kMaxContacts; ++i) {  // bound: kMaxContacts
        if (contact[i].depth_m <= contact[shallowest].depth_m) shallowest = i;
      }
      if (!(-point.gap_m > contact[shallowest].depth_m)) return;
      for (std::int32_t i = shallowest; i + 1 < kMaxContacts; ++i) {  // bound: kMaxContacts
        contact[i] = contact[i + 1];
      }
      scratch_.contact_count -= 1;
    }
    place_in_order(scratch_, index) = {.row = index,
                                       .point = index,
                                       .piece = tool_point.piece,
                                       .previous = point.region,
                                       .hand = hand_of(model_, tool_point.piece),
                                       .position_w = point.closest_w,
                                       .normal_w = point.normal_w,
                                       .depth_m = -point.gap_m,
                                       .weight = tool_point.weight,
                                       .area_m2 = tool_point.area_m2};
  }

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  std::int32_t piece_ = 0;   // being visited
  RigidLanes now_, before_;  // of it
  CarrierFrames now_of_, before_of_;
  bool knows_before_ = true, knows_all_before_ = false;
  FourQueries query_;  // of its points that are due
  std::int32_t due_[4], due_count_ = 0;
  const Box root_;
  bool smooth_ = false;
  const std::int32_t share_;  // of surface work
  PointState* const points_;
  const ToolPoint* const tool_points_;
  std::int32_t left_ = share_;
  std::int32_t next_first_ = -1;  // first point held
};

// Tool point whose last surface point is nearest to where the region was, within the memory distance; or -1.
std::int32_t point_at(const Model& model, const State& state, const Region& region) PALPATE_RT {
  std::int32_t nearest = -1;
  double distance2 = kRegionMemoryDistance_m * kRegionMemoryDistance_m;
  const auto points = static_cast<std::int32_t>(model.tool_point.size());
  for (std::int32_t i = 0; i < points; ++i) {  // bound: kMaxToolPoints
    if (state.point[i].triangle < 0) continue;
    const double d2 = squared_norm(state.point[i].closest_w - region.centre_w);
    if (d2 < distance2 || (nearest < 0 && d2 == distance2)) {
      nearest = i;
      distance2 = d2;
    }
  }
  return nearest;
}

}  // namespace

void collide(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_count = 0;
  scratch.surface_work = scratch.support_calls = 0;
  if (!is_finite(state.tool_w)) {
    for (PointState& point : state.point) forget(point);  // bound: kMaxToolPoints
    return;
  }
  Collider collider(model, state, scratch);
  // Where the last tick's share ended goes first, so that nobody waits twice.
  const std::int32_t from = state.first_point;
  for (const bool before : {false, true}) {  // bound: 2
    if (before && from == 0) break;
    for (std::size_t i = 0; i < model.piece.size(); ++i) collider.visit(i, from, before);  // bound: kMaxPieces
  }
  collider.finish();
  HighWater& high_water = state.high_water;
  scratch.work.found += scratch.contact_count;
  if (scratch.contact_count > high_water.contacts) high_water.contacts = scratch.contact_count;
}

bool still_touching(const Model& model, State& state, Scratch& scratch, const Region& region) PALPATE_RT {
  const std::int32_t point = point_at(model, state, region);
  scratch.work.scans += static_cast<std::int32_t>(model.tool_point.size());
  if (point < 0) return false;
  const std::int32_t left = kGjkSupportBudget - scratch.support_calls;
  if (left < kLeastSupports) {
    scratch.status |= Status::kOverlapInconclusive;
    return true;
  }
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(state.point[point].triangle)];
  Vec3 corner[3];
  for (int k = 0; k < 3; ++k) corner[k] = model.vertex_m[static_cast<std::size_t>(triangle.vertex[k])];  // bound: 3
  const std::int32_t piece = model.tool_point[static_cast<std::size_t>(point)].piece;
  const OverlapResult result = overlap_piece_triangle(model, model.piece[static_cast<std::size_t>(piece)],
                                                      carrier_w(model, state, piece), corner, left);
  scratch.support_calls += result.support_calls;
  scratch.work.supports = scratch.support_calls;
  if (result.support_calls > state.high_water.gjk_support_calls) {
    state.high_water.gjk_support_calls = result.support_calls;
  }
  if (result.overlap == Overlap::kInconclusive) scratch.status |= Status::kOverlapInconclusive;
  if (result.overlap == Overlap::kHit) scratch.status |= Status::kTouchesBetween;
  return result.overlap != Overlap::kMiss;
}

}  // namespace palpate
