// Which tips may touch an elastic body, and where.
#include "rt_core/contact/elastic/linearised.h"
#include "rt_core/contact/regions.h"
#include "rt_core/surface/body_box.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

using namespace elastic_layout;

class Finder {
 public:
  Finder(const Model& model, State& state, Scratch& scratch) PALPATE_RT
      : model_(model),
        state_(state),
        scratch_(scratch),
        work_(work_of(scratch)),
        surface_(look(model, state, scratch, scratch.work.soft_pairs, scratch.work.shown)),
        box_(root_box(model)) {
    let_go(model, work_.energy, let_go_);
    is_moved_ = state.elastic.moved != 0;
  }

  void visit(std::int32_t index) PALPATE_RT {
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(index)];
    PointState& point = state_.point[index];
    const Vec3 p = transform(carrier_w(model_, state_, tool_point.piece), tool_point.position_tool_m);
    const bool touched = point.triangle >= 0 && point.gap_m < 0;
    if (!touched && is_far(index, p)) return;
    ElasticRow& row = work_.row[tool_point.piece];
    if (touched) {
      surface_.place(p, tool_point.margin_m, point.triangle, point.closest_w, row);
      if (row.foot.triangle >= 0 && free_depth(row) > 0) return keep(index, row);
    }
    search(p, tool_point.margin_m, point, row);
    if (row.foot.triangle < 0) {
      scratch_.status |= Status::kPointsHeld;
      point.gap_m = point.gap_bound_m = 0;
      return;
    }
    const Real depth = free_depth(row);
    point.closest_w = row.foot.foot_w;
    point.normal_w = row.foot.normal_w;
    point.triangle = row.foot.triangle;
    point.gap_m = -depth;
    point.gap_bound_m = min_of(reach_m_, -depth);
    if (depth > 0) keep(index, row);
  }

 private:
  // On the body let go; or as it stands, where friction or another finger holds it towards the tip.
  Real free_depth(const ElasticRow& row) const PALPATE_RT {
    return row.travel_m + max_of(dot(row.pull, let_go_, model_.params.elastic_soft), 0.0);
  }

  // Not in reach, and the body at rest: as far as it was less what it moved, or as far as the body's box.
  bool is_far(std::int32_t index, Vec3 p) PALPATE_RT {
    PointState& point = state_.point[index];
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(index)];
    const Real box = distance_to(box_, p) - tool_point.margin_m;
    if (is_moved_) {
      if (!(box > kBulge * model_.params.surface_size_m)) return false;
      point.gap_m = point.gap_bound_m = 0;
      return true;
    }
    const Vec3 before = transform(carrier_previous_w(model_, state_, tool_point.piece), tool_point.position_tool_m);
    const Real bound = max_of(point.gap_bound_m - norm(p - before), box);
    if (!(bound > kSearchMargin_m)) return false;
    point.gap_m = point.gap_bound_m = bound;
    return true;
  }

  // From the facet nearest to the centre on the body at rest, as the surface about the last place has moved.
  void search(Vec3 p, Real margin_m, const PointState& point, ElasticRow& row) PALPATE_RT {
    row.foot.triangle = -1;
    if (scratch_.surface_work >= surface_work_share(model_.params)) return;
    Vec3 moved;
    if (is_moved_ && point.triangle >= 0)
      moved = surface_.displacement(model_.triangle[static_cast<std::size_t>(point.triangle)].vertex[0]);
    const SurfacePoint nearest = closest_surface_point(model_, p - moved, kHuge, point.triangle);
    scratch_.surface_work += nearest.looked;
    scratch_.work.queries += 1;
    reach_m_ = nearest.lower_bound_m - margin_m - model_.params.smooth_slack_m;
    if (nearest.truncated) scratch_.status |= Status::kTraversalTruncated;
    if (nearest.found) surface_.place(p, margin_m, nearest.triangle, p, row);
  }

  void keep(std::int32_t index, const ElasticRow& row) PALPATE_RT {
    const ToolPoint& tool_point = model_.tool_point[static_cast<std::size_t>(index)];
    PointState& point = state_.point[index];
    Contact& contact = scratch_.contact[scratch_.contact_count++];
    contact = Contact{};
    contact.row = contact.point = index;
    contact.piece = tool_point.piece;
    contact.previous = point.region;
    contact.position_w = point.closest_w = row.foot.foot_w;
    contact.normal_w = point.normal_w = row.foot.normal_w;
    contact.depth_m = free_depth(row);
    contact.weight = tool_point.weight;
    contact.area_m2 = tool_point.area_m2;
    point.triangle = row.foot.triangle;
    point.gap_m = point.gap_bound_m = -contact.depth_m;
  }

  // A body under load may stand out of its box at rest by this share of its size; farther off nothing is looked for.
  static constexpr Real kBulge = 0.25;

  const Model& model_;
  State& state_;
  Scratch& scratch_;
  ElasticWork& work_;
  const CarriedSurface surface_;
  const Box box_;
  Real let_go_[kMaxSoftModes];
  Real reach_m_ = 0;
  bool is_moved_;
};

}  // namespace

void find_elastic_tips(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  scratch.contact_count = scratch.surface_work = 0;
  if (!is_finite(state.tool_w)) {
    for (PointState& point : state.point) point.gap_m = point.gap_bound_m = 0;  // bound: kMaxToolPoints
    return;
  }
  Finder finder(model, state, scratch);
  for (const ToolPiece& piece : model.piece) {  // bound: kMaxPieces, one point each at most
    if (piece.point_count > 0) finder.visit(piece.first_point);
  }
  state.high_water.contacts =
      state.high_water.contacts < scratch.contact_count ? scratch.contact_count : state.high_water.contacts;
  scratch.work.points += static_cast<std::int32_t>(model.piece.size());
  scratch.work.found += scratch.contact_count;
  scratch.work.looks = scratch.surface_work;
  group_points(model, state, scratch, nullptr);
}

}  // namespace palpate
