// Which tips may touch an elastic body, and where.
#include "rt_core/contact/elastic/carried_edge.h"
#include "rt_core/contact/elastic/linearised.h"
#include "rt_core/contact/elastic/others_push.h"
#include "rt_core/contact/regions.h"
#include "rt_core/surface/body_box.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/tool/two_tools.h"

namespace palpate {

namespace {

using namespace elastic_layout;

// A tip that went farther in one tick, 4 m/s at 1 kHz, has left the facets that its foot is followed over.
constexpr Real kFollowed_m = 4e-3;
// Walks to a part's foot that was lost: a tip that is thrown.
constexpr std::int32_t kFurtherWalks = 1;
// Between a facet and a capsule's axis, to where it is right above.
constexpr std::int32_t kTurnsOfAxis = 2;
// How far the tool goes before a part is looked at again that it is behind.
constexpr Real kBehind_m = 5e-4;
constexpr Real kLeastLean = 0.01;
// A part that is farther off than so, let go, is not placed.
constexpr Real kNearPart_m = 4e-3;
// Of half a capsule's axis.
constexpr Real kThird = 1.0 / 3;
// Another place on the axis is looked for where it is nearer by more. Of a jaw that comes down along a block's edge all
// three are equally near, and to find that out two of them looked at 109 boxes and triangles of the 96 that a tick
// might; now at 48 (2026-11-26).
constexpr Real kNearer_m = 1e-6;
// Between two looks at a part of a solid that cannot press as it lies.
constexpr std::uint64_t kTurns = 16;

// A body under load is looked for where it may have come to: this far a surface of amplitudes y stands from its place
// at rest at most.
Real most_moved_m(const Model& model, const ElasticWork& work) PALPATE_RT {
  Real sum = 0;
  for (std::int32_t t = 0; t < terms(model.params.elastic_soft); ++t) sum += abs_of(work.y[t]) * work.reach_m[t];
  return sum;
}

// How far a surface let go moves at most, and as much again for what its normals turn.
Real most_let_go_m(const Model& model, const ElasticWork& work, const Real* reach_m, const Real* step) PALPATE_RT {
  const std::int32_t soft = model.params.elastic_soft;
  Real sum = 0;
  std::int32_t pair = soft;
  for (std::int32_t a = 0; a < soft; ++a) {  // bound: pairs
    sum += abs_of(step[a]) * reach_m[a];
    for (std::int32_t b = a; b < soft; ++b, ++pair)
      sum += (abs_of(step[a] * work.y[b]) + abs_of(step[b] * work.y[a])) * reach_m[pair];
  }
  return 2 * sum;
}

// The body where it goes if it moves on as in the last tick.
CarriedSurface look_ahead(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  const std::int32_t soft = model.params.elastic_soft;
  soft_products(soft, state.elastic.soft_rootJ.data(), work_of(scratch).y_begun);
  for (std::int32_t a = 0; a < soft; ++a) state.elastic.soft_rootJ[a] += state.elastic.step_rootJ[a];
  return look(model, state, scratch);
}

class Finder {
 public:
  Finder(const Model& model, State& state, Scratch& scratch) PALPATE_RT : model_(model),
                                                                          state_(state),
                                                                          scratch_(scratch),
                                                                          work_(work_of(scratch)),
                                                                          surface_(look_ahead(model, state, scratch)),
                                                                          box_(root_box(model)),
                                                                          moved_m_(most_moved_m(model, work_)) {
    let_go(model, work_.energy, let_go_);
    nearer_m_ = most_let_go_m(model, work_, work_.reach_m, let_go_);
  }

  // A tip that touched in the last tick, then all others. Whether the first do is told when all of them stand
  // somewhere: what they press comes out towards one another.
  bool has_touched(std::int32_t index) const PALPATE_RT {
    return state_.point[index].triangle >= 0 && state_.point[index].gap_m < 0;
  }
  void stand(std::int32_t index) PALPATE_RT {
    const Real force_N = force_of(index);
    nearer_m_ = kHuge;  // asks how far the body let go comes only when it has lifted off
    bound_m_[index] = 0;
    stands_[index] = is_of_part(index) ? place_part(index, true) : place_touched(index);
    if (!(stands_[index] && force_N > 0)) return;
    push_.add(work_.row_of(index), force_N);
  }
  void settle(std::int32_t index) PALPATE_RT {
    if (!stands_[index]) return;
    if (!is_of_part(index)) return settle_row(index);
    nearer_m_ = let_go_there_m(work_.row_of(index).foot.triangle);
    settle_part(index);
  }
  // `all_overlap`: nobody has to be looked for, or is held by others alone.
  void meet_others(bool all_overlap) PALPATE_RT {
    nearer_m_ = most_let_go_m(model_, work_, work_.reach_m, let_go_);
    if (all_overlap) return;
    scratch_.work.shown += push_.count() * kPushTerms;
    push_m_ = push_.most_m(model_, work_.linear_reach_m);
  }
  bool overlaps(std::int32_t index) const PALPATE_RT { return stands_[index] && work_.row_of(index).travel_m > 0; }
  void visit(std::int32_t index) PALPATE_RT {
    bound_m_[index] = 0;
    if (is_of_part(index)) {
      if (place_part(index, false)) settle_part(index);
      return;
    }
    const RoundTip tip = tip_at(index);
    if (cannot_press(index, tip)) return;
    if (is_far(index, tip) && !(tip.is_of_solid() && has_turn(index))) return;
    // Of one that was thrown the last place is of no use: from there a walk looked at 24 to 60 boxes and triangles
    // in vain.
    const bool is_thrown = tool_moved_m(index, tip) > kFollowed_m;
    if (look_for(index, tip, is_thrown ? -1 : state_.point[index].triangle)) settle_row(index);
  }

 private:
  bool is_of_part(std::int32_t index) const PALPATE_RT {
    return model_.tool_point[static_cast<std::size_t>(index)].begins_at > 0;
  }
  Real force_of(std::int32_t index) const PALPATE_RT {
    const std::int32_t region = state_.point[index].region;
    return region >= 0 ? state_.region[region].normal_force_N : 0.0;
  }
  bool place_touched(std::int32_t index) PALPATE_RT {
    PointState& point = state_.point[index];
    RoundTip tip = tip_at(index);
    if (cannot_press(index, tip)) return false;
    tip.step = state_.elastic.place[index];
    tip.come_near(tip.beside(point.closest_w));
    const bool followed = has_stayed(point, tip);
    if (followed) {
      surface_.place(tip, point.triangle, point.closest_w, nearer_m_, box_, work_.row_of(index), force_of(index));
      if (work_.row_of(index).foot.triangle >= 0) return !stands_by(point, tip, work_.row_of(index));
    }
    return look_for(index, tip, followed ? point.triangle : -1);
  }
  bool look_for(std::int32_t index, RoundTip tip, std::int32_t warm) PALPATE_RT {
    PointState& point = state_.point[index];
    ElasticRow& row = work_.row_of(index);
    if (!search(tip, point, warm)) return false;
    surface_.place(tip, point.triangle, point.closest_w, nearer_m_ + push_m_, box_, row, force_of(index));
    // Of a solid's part as far as its deepest end is above the tangent of its foot, which only what is hollow rises
    // over; for that it is looked at in its turn.
    bound_m_[index] = tip.is_of_solid() ? kHuge : reach_m_;
    return row.foot.triangle >= 0 ? !stands_by(point, tip, row) : hold(point);
  }
  void settle_row(std::int32_t index) PALPATE_RT {
    // Lifted off where its foot was followed: looked for from the next tick on.
    const ElasticRow& row = work_.row_of(index);
    const Real depth_m = free_depth(index);
    depth_m > 0 ? keep(index, row, depth_m) : let_lift(state_.point[index], row, depth_m, bound_m_[index]);
  }

  // A part of the surface is not looked for among all facets: a foot that touches is followed from where it was, over
  // as many as a walk takes, one that is apart comes near (part_search.h). Until it is there the part does not touch.
  bool place_part(std::int32_t index, bool touched) PALPATE_RT {
    PointState& point = state_.point[index];
    RoundTip tip = tip_at(index);
    if (!touched && stays_apart(index, tip, point)) return false;
    if (!touched && part_looks_ >= kPartShare) return wait_for_turn(point);
    if (touched) {
      stand_above(point.closest_w, point.normal_w, tip);
      tip.step = state_.elastic.place[index];
    } else if (!come_near_part(index, tip, point)) {
      return false;
    }
    ElasticRow& row = work_.row_of(index);
    const Vec3 near = touched ? point.closest_w : tip.centre_w();
    const Real force_N = force_of(index);
    scratch_.work.part_visits += 1;
    surface_.place(tip, point.triangle, near, nearer_m_ + push_m_, box_, row, force_N);
    for (std::int32_t i = 0; i < kFurtherWalks && row.foot.state == FootState::kFar; ++i)
      surface_.place(tip, row.foot.triangle, tip.centre_w(), nearer_m_ + push_m_, box_, row, force_N);
    point.triangle = row.foot.triangle;
    point.closest_w = row.foot.foot_w;
    if (row.foot.state == FootState::kFar) {
      point.closest_w = displaced(point.triangle);
      return wait_for_turn(point);
    }
    // From behind: another part is in between.
    if (!touched && row.foot.height_m < 0) {
      let_be(point);
      return false;
    }
    return true;
  }
  void settle_part(std::int32_t index) PALPATE_RT {
    PointState& point = state_.point[index];
    const ElasticRow& row = work_.row_of(index);
    const Real depth_m = free_depth(index);
    if (depth_m > 0) return keep(index, row, depth_m);
    let_lift(point, row, depth_m, 0);
    point.gap_m = -(row.travel_m + row.leads_m);
  }
  // A capsule's place right above one of a part; one that leans more stands over the rim that it leans to, where its
  // axis is nearest. Told to stand above the face there its force had no share along the axis, and a tube that barely
  // touched both rims of a clip turned to and fro in 29 ticks (2026-11-26).
  static void stand_above(Vec3 place_w, Vec3 normal_w, RoundTip& tip) PALPATE_RT {
    const Vec3 axis = unit_or(tip.half_axis_w, {});
    const Real lean = dot(normal_w, axis);
    tip.come_near(place_w + (abs_of(lean) < kLeastLean ? tip.margin_m * lean : 0.0) * axis);
  }
  // Farther off than tool and body have moved since its foot was looked for.
  bool stays_apart(std::int32_t index, const RoundTip& tip, PointState& point) PALPATE_RT {
    const Real moved = tool_moved_m(index, tip) + state_.elastic.swept_m;
    point.gap_bound_m -= moved;
    point.gap_m -= moved;
    return point.triangle >= 0 && point.gap_bound_m > 0;
  }
  Real tool_moved_m(std::int32_t index, const RoundTip& tip) PALPATE_RT {
    if (!(tip_moved_m_ < 0)) return tip_moved_m_;
    const RoundTip before = round_tip(model_, index, carrier_previous_w(model_, state_, piece_of(index)));
    tip_moved_m_ = norm(tip.middle_w - before.middle_w) + norm(tip.half_axis_w - before.half_axis_w);
    if (tip.is_plate()) tip_moved_m_ += norm(tip.half_across_w - before.half_across_w);
    return tip_moved_m_;
  }
  // The same for every part of the surface that a piece touches: carried once.
  RoundTip tip_at(std::int32_t index) PALPATE_RT {
    const ToolPoint& point = model_.tool_point[static_cast<std::size_t>(index)];
    if (tip_of_ >= 0 && is_of_part(index) && is_of_part(tip_of_)) {
      const ToolPoint& last = model_.tool_point[static_cast<std::size_t>(tip_of_)];
      if (point.piece == last.piece && point.position_tool_m == last.position_tool_m) {
        tip_of_ = index;
        tip_.begins_at = point.begins_at;
        tip_.margin_m = point.margin_m;
        return tip_;
      }
    }
    tip_of_ = index;
    tip_moved_m_ = -1;
    return tip_ = round_tip(model_, index, carrier_w(model_, state_, point.piece));
  }
  bool wait_for_turn(PointState& point) PALPATE_RT {
    hold(point);
    let_be(point);
    return false;
  }
  static void let_be(PointState& point, Real apart_m = 0) PALPATE_RT {
    point.gap_m = kHuge;
    point.gap_bound_m = apart_m;
  }
  // To the facet of a part that the tip apart from it is above. Returns whether it is there, and may touch: farther off
  // the facet tells how far it is, which is what a tool that comes to it asks (Landing).
  bool come_near_part(std::int32_t index, RoundTip& tip, PointState& point) PALPATE_RT {
    if (point.triangle < 0) {
      point.triangle = model_.tool_point[static_cast<std::size_t>(index)].begins_at;
      point.closest_w = displaced(point.triangle);
    }
    tip.come_near(point.closest_w);
    const Vec3 moved_m = displaced(point.triangle) - foot::RestCorners(model_, point.triangle).v[0];
    const PartPlace place = come_down(model_, work_.seeds_of(index), tip.centre_w() - moved_m, point.triangle);
    point.triangle = place.triangle;
    part_looks_ += place.looked;
    scratch_.work.part_looks = part_looks_;
    const foot::RestCorners facet(model_, place.triangle);
    const Vec3 *v = facet.v, up = unit_or(cross(v[1] - v[0], v[2] - v[0]), {});
    for (std::int32_t i = 0; i < kTurnsOfAxis; ++i) {  // bound: kTurnsOfAxis
      const Vec3 centre = tip.centre_w() - moved_m, closest = closest_on_triangle(centre, v[0], v[1], v[2]).point;
      point.closest_w = closest + moved_m;
      stand_above(point.closest_w, up, tip);
    }
    const Vec3 out = tip.centre_w() - point.closest_w;
    const Real apart_m = norm(out) - tip.margin_m;
    nearer_m_ = let_go_there_m(place.triangle);
    const bool is_above = place.is_there && dot(out, up) > kGrazing * norm(out);
    if (is_above && !(apart_m - nearer_m_ - push_m_ > kNearPart_m)) return true;
    if (!is_above) {
      let_be(point, place.is_there ? kBehind_m : 0.0);
      return false;
    }
    point.gap_bound_m = apart_m - nearer_m_ - push_m_ - kNearPart_m;
    point.gap_m = apart_m;
    point.normal_w = unit_or(out, up);
    return false;
  }
  // As most_let_go_m(), about a triangle: the seat of a clip hardly moves with its arms.
  Real let_go_there_m(std::int32_t triangle) const PALPATE_RT {
    Real reach[kMaxTerms] = {};
    for (const std::int32_t v : model_.triangle[static_cast<std::size_t>(triangle)].vertex)  // bound: 3 kMaxTerms
      for (std::int32_t t = 0; t < terms(model_.params.elastic_soft); ++t) {
        const Double4 u = widen4(vertex_block(model_, v) + kTermFloats * t);
        reach[t] = max_of(reach[t], squared_norm(Vec3{u[0], u[1], u[2]}));
      }
    for (std::int32_t t = 0; t < terms(model_.params.elastic_soft); ++t) reach[t] = square_root(reach[t]);
    return most_let_go_m(model_, work_, reach, let_go_);
  }
  Vec3 displaced(std::int32_t triangle) const PALPATE_RT {
    const std::int32_t vertex = model_.triangle[static_cast<std::size_t>(triangle)].vertex[0];
    return model_.vertex_m[static_cast<std::size_t>(vertex)] + surface_.displacement(vertex);
  }

  std::int32_t piece_of(std::int32_t index) const PALPATE_RT {
    return model_.tool_point[static_cast<std::size_t>(index)].piece;
  }
  // Edges and plates of a solid as it lies on the body: not looked for, but one tick in kTurns each, since the tool
  // turns in less time than the body's normal does. A box pressed flat took 113,000 instructions, with it 82,000 (mean,
  // 2026-11-26).
  bool cannot_press(std::int32_t index, const RoundTip& tip) const PALPATE_RT {
    const PointState& point = state_.point[index];
    if (!tip.is_of_solid() || point.triangle < 0 || has_turn(index)) return false;
    return tip.stands_on_end(point.normal_w) || tip.turns_away(point.normal_w);
  }
  bool has_turn(std::int32_t index) const PALPATE_RT {
    return ((state_.tick + static_cast<std::uint64_t>(index)) & (kTurns - 1)) == 0;
  }
  // An edge that stands on its end has no share of the corner: followed, but no contact.
  static bool stands_by(PointState& point, const RoundTip& tip, const ElasticRow& row) PALPATE_RT {
    if (!tip.stands_on_end(row.foot.normal_w)) return false;
    point.closest_w = row.foot.foot_w;
    point.normal_w = row.foot.normal_w;
    point.triangle = row.foot.triangle;
    point.gap_m = point.gap_bound_m = -row.travel_m;
    return true;
  }
  // On the body let go; or as it stands, where friction or another finger holds it towards the tip. By the linear modes
  // the others hold it, too: told by the soft modes' surface alone, a thumb's tip that the squeeze of fingers pressed
  // with 0.4 N touched in every other tick (2026-11-26).
  Real free_depth(std::int32_t index) const PALPATE_RT {
    ElasticRow& row = work_.row_of(index);
    const Real depth = row.travel_m + row.leads_m;
    if (!(depth + nearer_m_ + push_m_ > 0)) return depth + nearer_m_ + push_m_;
    const Real alone = depth + max_of(dot(row.pull, let_go_, model_.params.elastic_soft), 0.0);
    if (alone > 0 || !(alone + push_m_ > 0)) return alone;
    scratch_.work.shown += kPushTerms;
    return alone + push_.outwards_m(model_, row);
  }

  // About where its foot was.
  static bool has_stayed(const PointState& point, const RoundTip& tip) PALPATE_RT {
    const Real reach = abs_of(point.gap_bound_m + tip.margin_m) + kFollowed_m;
    return squared_norm(tip.centre_w() - point.closest_w) < reach * reach;
  }

  // As far as it was less what tool and body have moved, or as far as the body's box less what the body may stand out
  // of it.
  bool is_far(std::int32_t index, const RoundTip& tip) PALPATE_RT {
    PointState& point = state_.point[index];
    const Real half = norm(tip.half_axis_w) + (tip.is_plate() ? norm(tip.half_across_w) : 0.0);
    const Real tool_m = tool_moved_m(index, tip);
    const Real box = distance_to(box_, tip.middle_w) - tip.margin_m - half - moved_m_;
    const Real bound = max_of(point.gap_bound_m - tool_m - state_.elastic.swept_m, box);
    // Parts of one solid press the body away from one another, not out between them.
    if (!(bound > (tip.is_of_solid() ? 0 : push_m_) + kSearchMargin_m)) return false;
    point.gap_m = point.gap_bound_m = bound;
    return true;
  }

  // The facet nearest to the centre on the body at rest, as the surface about the last place has moved. A capsule: from
  // the place above where it was found last, which comes nearer from tick to tick, or in the middle of either other
  // third of its axis, which need to look no farther. From three thirds alone a rod of 150 mm went 20 mm into a tube
  // before it touched (2026-11-29). `warm`: a triangle to begin with, or -1. False: no part of the body is in reach.
  bool search(RoundTip& tip, PointState& point, std::int32_t warm) PALPATE_RT {
    Vec3 moved;
    if (point.triangle >= 0)
      moved = surface_.displacement(model_.triangle[static_cast<std::size_t>(point.triangle)].vertex[0]);
    tip.come_near(point.closest_w);
    const std::int32_t places = tip.is_line() ? 3 : 1, last = tip.along < -kThird ? 0 : tip.along > kThird ? 2 : 1;
    const Real third_m = norm(tip.half_axis_w) * kThird;
    SurfacePoint best;
    Real along = tip.along, bound = kHuge;
    for (std::int32_t i = 0; i < places; ++i) {  // bound: 3
      if (i > 0) tip.along = ((i <= last ? i - 1 : i) - 1) * (2 * kThird);
      const std::int32_t left = surface_work_share(model_.params) - scratch_.surface_work;
      if (i == 0 && (left <= 0 || scratch_.surface_work > kMostBefore)) return hold(point);
      if (left <= 0) {  // what was found counts, and nothing is known to be apart
        bound = 0;
        break;
      }
      const bool beside = best.found && best.signed_distance_m > kNearer_m;
      const std::int32_t most = left < kMaxTipSearched ? left : kMaxTipSearched;
      const Vec3 rest = tip.centre_w() - moved;
      const SurfacePoint here = beside ? nearer_surface_point(model_, rest, best.signed_distance_m - kNearer_m, most)
                                       : closest_surface_point(model_, rest, kHuge, warm, most);
      scratch_.surface_work += here.looked;
      scratch_.work.queries += 1;
      if (here.truncated) scratch_.status |= Status::kTraversalTruncated;
      bound = min_of(bound, here.lower_bound_m - (i == 0 ? third_m : 0.0));  // its own third is up to two away
      if (!here.found || (i > 0 && !(here.signed_distance_m < best.signed_distance_m))) continue;
      best = here;
      along = tip.along;
    }
    if (!best.found) return hold(point);
    tip.along = along;
    tip.come_near(best.closest_w + moved);
    point.triangle = best.triangle;
    point.closest_w = best.closest_w + moved;
    point.normal_w = best.normal_w;
    const Real beside_m = tip.is_plate() ? 2 * (norm(tip.half_axis_w) + norm(tip.half_across_w)) : third_m;
    reach_m_ = bound - tip.margin_m - beside_m - model_.params.smooth_slack_m -
               (state_.elastic.moved != 0 ? moved_m_ + norm(moved) : 0.0);
    if (best.signed_distance_m < 0 || !(reach_m_ > nearer_m_ + push_m_ + kSearchMargin_m)) return true;
    point.gap_m = point.gap_bound_m = reach_m_ - nearer_m_;
    return false;
  }

  // Neither apart nor touching: unknown until there is work to spare.
  bool hold(PointState& point) PALPATE_RT {
    scratch_.status |= Status::kPointsHeld;
    point.gap_m = point.gap_bound_m = 0;
    return false;
  }

  void let_lift(PointState& point, const ElasticRow& row, Real depth_m, Real bound_m) const PALPATE_RT {
    point.closest_w = row.foot.foot_w;
    point.normal_w = row.foot.normal_w;
    point.triangle = row.foot.triangle;
    point.gap_m = -depth_m;
    point.gap_bound_m = min_of(bound_m, point.gap_m);
  }

  void keep(std::int32_t index, const ElasticRow& row, Real depth_m) PALPATE_RT {
    PointState& point = state_.point[index];
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(index)];
    Contact& contact = place_in_order(scratch_, index);  // a solid's parts take turns
    contact = Contact{};
    contact.row = contact.point = index;
    contact.piece = tool_point.piece;
    contact.hand = hand_of(model_, contact.piece);
    contact.previous = point.region;
    contact.position_w = row.foot.foot_w;
    // Below where a line or plate was found to press, with which the next tick begins.
    point.closest_w = row.foot.foot_w + tangential_part(row.tip.centre_w() - row.placed_w, row.foot.normal_w);
    if (!row.tip.is_ball()) state_.elastic.place[index] = row.tip.step_beside(point.closest_w);
    contact.normal_w = point.normal_w = row.foot.normal_w;
    contact.depth_m = depth_m;
    contact.weight = tool_point.weight;
    contact.area_m2 = tool_point.area_m2;
    point.triangle = row.foot.triangle;
    point.gap_m = -depth_m;
    point.gap_bound_m = -(row.travel_m + row.leads_m);
  }

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ElasticWork& work_;
  const CarriedSurface surface_;
  const Box box_;
  const Real moved_m_;
  Real let_go_[kMaxSoftModes];
  Real nearer_m_;  // no place of the body let go comes nearer than by this
  Real reach_m_ = 0;
  OthersPush push_;
  Real push_m_ = 0;  // nor by more than this for what tips press
  RoundTip tip_{};   // of the point visited last
  std::int32_t tip_of_ = -1;
  Real tip_moved_m_ = -1;  // in this tick; below 0: not asked
  std::int32_t part_looks_ = 0;
  bool stands_[kMaxPieces];
  Real bound_m_[kMaxPieces];
};

}  // namespace

void find_elastic_tips(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_count = scratch.surface_work = 0;
  if (!is_finite(state.tool_w)) {
    for (PointState& point : state.point) point.gap_m = point.gap_bound_m = 0;  // bound: kMaxToolPoints
    return;
  }
  Finder finder(model, state, scratch);
  const auto points = static_cast<std::int32_t>(model.tool_point.size()),
             pieces = static_cast<std::int32_t>(model.piece.size());
  bool touched[kMaxPieces], all_overlap = true;
  for (std::int32_t i = 0; i < points; ++i) {  // bound: kMaxPieces
    touched[i] = finder.has_touched(i);
    if (touched[i]) finder.stand(i);
    all_overlap = all_overlap && (points == 1 || (touched[i] && finder.overlaps(i)));
  }
  finder.meet_others(all_overlap);
  // Tips take turns: near a crest all edges of a solid are about as near, and with the first ones first what a tick may
  // look at never came to the face that lay on it (2026-11-26).
  const auto first = static_cast<std::int32_t>(state.tick % static_cast<std::uint64_t>(points));
  for (std::int32_t i = 0; i < points; ++i) {  // bound: kMaxPieces
    const std::int32_t index = first + i < points ? first + i : first + i - points;
    touched[index] ? finder.settle(index) : finder.visit(index);
  }
  state.high_water.contacts =
      state.high_water.contacts < scratch.contact_count ? scratch.contact_count : state.high_water.contacts;
  scratch.work.points += points > pieces ? points : pieces;
  scratch.work.found += scratch.contact_count;
  scratch.work.looks = scratch.surface_work;
  group_points(model, state, scratch, nullptr);
}

}  // namespace palpate
