#include "sim_host/view/elastic_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/contact/elastic/drawn_shapes.h"
#include "rt_core/contact/elastic/linearised.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/view/contact_profile.h"
#include "sim_host/view/far_field.h"
#include "sim_host/view/surface_bend.h"

namespace palpate {

namespace {

using elastic_layout::kMaxTerms;

// A dent is not longer than this many times as wide: the contact of a rod on a flat.
constexpr double kLongest = 12;

struct TouchingTip {
  ElasticRow row;
  std::int32_t region = -1;
};

struct Amplitudes {
  explicit Amplitudes(const Model& model, const State& state) {
    soft_products(model.params.elastic_soft, state.elastic.soft_rootJ.data(), product);
  }
  std::int32_t looked = 0;
  Work work;
  double product[kMaxTerms];
};

// Every tip that touches, on the surface as the soft modes carry it.
std::vector<TouchingTip> touching_tips(const Model& model, const State& state, Amplitudes& amplitude) {
  const CarriedSurface carried{model, amplitude.product, &amplitude.looked, &amplitude.work};
  std::vector<TouchingTip> tips;
  for (std::int32_t i = 0; i < model.sizes.n_tool_point; ++i) {
    const PointState& point = state.point[i];
    if (point.region < 0 || point.triangle < 0 || !(point.gap_m < 0)) continue;
    const std::int32_t piece = model.tool_point[static_cast<std::size_t>(i)].piece;
    RoundTip round = round_tip(model, i, carrier_w(model, state, piece));
    round.come_near(point.closest_w);
    TouchingTip tip;
    tip.region = point.region;
    carried.place(round, point.triangle, point.closest_w, kHuge, root_box(model), tip.row);
    if (tip.row.foot.triangle >= 0) tips.push_back(tip);
  }
  return tips;
}

// A region's force is shared by its tips alike, as good as is known here.
double force_of(const TouchingTip& tip, const State& state, const std::vector<TouchingTip>& tips) {
  const auto sharing = std::ranges::count_if(tips, [&](const TouchingTip& t) { return t.region == tip.region; });
  return state.region[tip.region].normal_force_N / static_cast<double>(sharing);
}

constexpr double kNarrowest_m = 1e-9;
// Of a ball's radius: beyond, it is as high as there.
constexpr double kSteepest = 0.98;
// Of a contact's dent, at its edge: where the rings and the force do not fit one another.
constexpr double kLeastEdge = 0.25, kMostEdge = 0.8;
// Of a dent, what it must be less at its edge by to have its ball's shape.
constexpr double kLeastSag = 0.1;

// Where a body's bend is looked for, in radii of the contact, and what of a ball's a hollow may take.
constexpr double kBendReach = 2, kLeastBend = 0.25, kLongestBall = 1.5;

double contact_modulus_Pa(const Model& model, const ElasticRow& row) {
  const ModelParams& p = model.params;
  return row.modulus * p.youngs_modulus_Pa / (1 - p.poisson_ratio * p.poisson_ratio);
}

// How much higher a ball is at some distance from its lowest place.
double ball_sag_m(double ball_m, double from_m) {
  const double within_m = std::min(from_m, kSteepest * ball_m), square_m2 = within_m * within_m;
  return square_m2 / (ball_m + std::sqrt(ball_m * ball_m - square_m2));
}

// A ball's contact: as wide as makes the dent one at its edge, inside on the ball and outside by the force,
//   travel - far - sag of ball and body = 3 F / (8 E* a),
// the wider of two such places; the ball's sag where the edge has moved to.
struct BallContact {
  const ElasticRow& row;
  double travel_m, force_N, modulus_Pa, drawn_in_m2;  // the last: at the edge, times the radius

  double now_m(const FarBelow& far, double radius_m) const {
    return radius_m + std::max(far.out_m - drawn_in_m2 / radius_m, -0.5 * radius_m);
  }
  double body_bend_m(double radius_m) const { return 0.5 * row.curvature_1_per_m * radius_m * radius_m; }
  double inside_m(const FarBelow& far, double radius_m) const {
    return travel_m - far.value_m - far.bend_m - ball_sag_m(row.tip.margin_m, now_m(far, radius_m)) -
           body_bend_m(radius_m);
  }
  double outside_m(double radius_m) const { return 3 * force_N / (8 * modulus_Pa * radius_m); }
  // Looked for between half and 1.6 times the radius where the far field was told; that radius where there is none.
  double wide_m(const FarBelow& far, double told_m) const {
    const auto left_m = [&](double a) { return inside_m(far.at(a / told_m), a) - outside_m(a); };
    constexpr double kStep = 0.97;
    double low = std::min(1.6 * told_m, row.tip.margin_m), high = low;
    while (low > 0.5 * told_m && !(left_m(low) > 0)) high = low, low *= kStep;
    if (!(left_m(low) > 0) || low == high) return told_m;
    for (int i = 0; i < 30; ++i) (left_m(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    return low;
  }
};

// `v` with what turns one direction into another, by the shortest way.
Vec3 turned(Vec3 v, Vec3 from, Vec3 to) {
  const Vec3 axis = cross(from, to), once = cross(axis, v);
  return v + once + (1 / std::max(1 + dot(from, to), 1e-6)) * cross(axis, once);
}

TipDent dent_of(const Model& model, const ElasticRow& row, double depth_m) {
  TipDent dent;
  dent.depth_m = depth_m;
  dent.edge_m = 0.5 * depth_m;
  const double radius = row.tip.margin_m, body = std::max(1 + row.curvature_1_per_m * radius, 0.25);
  dent.across_m = dent.along_m = std::sqrt(depth_m * radius / body);
  const Vec3 axis = tangential_part(row.tip.half_axis_w, row.foot.normal_w), inward = -row.foot.normal_w;
  dent.now = {inward, unit_or(axis, unit_or(cross(inward, axis_off(inward)), {1, 0, 0}))};
  const RestFoot foot = rest_foot(model, row.foot);
  dent.foot_m = foot.place_m;
  dent.rest = {-foot.normal, turned(dent.now.along, inward, -foot.normal)};
  if (row.tip.is_plate()) {
    const double crest = std::max(row.curvature_1_per_m, 1e-9);
    dent.across_m = dent.along_m = std::min(std::sqrt(depth_m / crest), row.tip.flat_m);
  }
  if (!row.tip.is_line()) return dent;
  // As far as it is straight from where its force acts, and the body bends away.
  const double straight = dent.across_m + (1 - std::abs(row.tip.along)) * norm(row.tip.half_axis_w);
  const double longest = std::min(straight, kLongest * dent.across_m);
  dent.along_m = std::clamp(row.line.along_1_per_m > 0 ? std::sqrt(depth_m / row.line.along_1_per_m) : longest,
                            dent.across_m, longest);
  return dent;
}

// Gives a ball's dent its radius, and what it is at its edge.
void widen(const ElasticFarField& far, const BallContact& contact, TipDent& dent) {
  double radius_m = dent.across_m;
  for (int i = 0; i < 2; ++i)  // the second time with the rings where they belong
    radius_m = contact.wide_m(far.below(contact.row, radius_m), radius_m);
  dent.across_m = dent.along_m = radius_m;
  const FarBelow below = far.below(contact.row, radius_m);
  dent.edge_m = std::clamp(contact.inside_m(below, radius_m), kLeastEdge * dent.depth_m, kMostEdge * dent.depth_m);
  dent.ball_m = contact.row.tip.margin_m;
  dent.bend_m = below.bend_m + contact.body_bend_m(radius_m);
  dent.out_m = below.out_m;
}

// On a body that bends differently in two directions the contact is longer where it bends less: as far as keeps the
// same depth below the ball.
void lengthen(const Model& model, double ball_m, TipDent& dent) {
  const double radius_m = dent.across_m;
  const SurfaceBend bend = surface_bend(model, dent.foot_m, -dent.rest.inward, kBendReach * radius_m);
  const double least = kLeastBend / ball_m, most_1_per_m = std::max(1 / ball_m + bend.most_1_per_m, least),
               least_1_per_m = std::max(1 / ball_m + bend.least_1_per_m, least);
  const double ratio = std::min(std::sqrt(std::sqrt(most_1_per_m / least_1_per_m)), kLongestBall);
  dent.across_m = radius_m / ratio;
  dent.along_m = radius_m * ratio;
  dent.rest.along = unit_or(tangential_part(bend.along, dent.rest.inward), dent.rest.along);
  dent.now.along = turned(dent.rest.along, dent.rest.inward, dent.now.inward);
}

TipDent made_dent(const Model& model, const ElasticFarField& far, const ElasticRow& row, double travel_m,
                  double depth_m, double force_N) {
  TipDent dent = dent_of(model, row, depth_m);
  const double modulus_Pa = contact_modulus_Pa(model, row);
  const double drawn_in_m2 = contact_drawn_in_by_force(model.params.poisson_ratio) * force_N / modulus_Pa;
  if (row.tip.is_ball() && row.tip.margin_m > 0) {
    widen(far, {row, travel_m, force_N, modulus_Pa, drawn_in_m2}, dent);
    lengthen(model, row.tip.margin_m, dent);
  }
  const double width_m = std::max(std::sqrt(dent.across_m * dent.along_m), kNarrowest_m);
  dent.far_m = 3 * force_N / (4 * modulus_Pa * width_m);
  dent.mean_Pa = force_N / (kPi * width_m * width_m);
  dent.drawn_in_m = drawn_in_m2 / width_m;
  dent.poisson_ratio = model.params.poisson_ratio;
  // Under a line the pressure is less by as much as it is longer.
  dent.spread_m = force_N * dent.across_m / dent.along_m / (modulus_Pa * std::max(row.tip.margin_m, width_m));
  return dent;
}

// What the other tips' dents are at a tip's foot, from far away: the force over pi E* r.
double under_others_m(const Model& model, const TouchingTip& tip, const State& state,
                      const std::vector<TouchingTip>& tips, double reach_m) {
  const Vec3 foot_w = tip.row.foot.foot_w, up = tip.row.foot.normal_w;
  double sum_m = 0;
  for (const TouchingTip& other : tips) {
    if (&other == &tip) continue;
    const double r = norm(foot_w - other.row.foot.foot_w);
    const double least = std::sqrt(std::max(other.row.travel_m, 0.0) * other.row.tip.margin_m);
    sum_m += drawn_shapes::outlook(up, -other.row.foot.normal_w) * drawn_shapes::near(r, reach_m) *
             dot(up, other.row.foot.normal_w) * force_of(other, state, tips) /
             (kPi * contact_modulus_Pa(model, other.row) * std::max({r, least, kNarrowest_m}));
  }
  return sum_m;
}

}  // namespace

ElasticShape elastic_shape(const Model& model, const State& state) {
  Amplitudes soft(model, state);
  const std::vector<TouchingTip> tips = touching_tips(model, state, soft);
  ElasticFarField far(model);
  for (const TouchingTip& tip : tips) far.add(tip.row, force_of(tip, state, tips));
  const double reach_m = drawn_shapes::reach_m(model.vertex_m);
  const std::int32_t terms = elastic_layout::terms(model.params.elastic_soft);
  ElasticShape shape{{soft.product, soft.product + terms}, far.amplitude_m(), {}};
  for (const TouchingTip& tip : tips) {
    const double travel_m = tip.row.travel_m - under_others_m(model, tip, state, tips, reach_m);
    const Vec3 carried = far.at(tip.row.foot.triangle, tip.row.foot.weight);
    if (const double depth_m = travel_m + dot(carried, tip.row.foot.normal_w); depth_m > 0) {
      shape.dent.push_back(made_dent(model, far, tip.row, travel_m, depth_m, force_of(tip, state, tips)));
      shape.dent.back().reach_m = reach_m;
      shape.dent.back().mean_Pa *= state.live.stiffness;
    }
  }
  return shape;
}

std::vector<Vec3> mode_displacement_m(const Model& model, const ElasticShape& shape) {
  std::int32_t looked = 0;
  Work work;
  const CarriedSurface carried{model, shape.soft.data(), &looked, &work};
  std::vector<Vec3> displacement;
  for (std::int32_t v = 0; v < model.sizes.n_vertex; ++v)
    displacement.push_back(carried.displacement(v) + drawn_shapes::displacement_m(model, v, shape.drawn));
  return displacement;
}

double TipDent::sag_share(double rho) const {
  if (!(ball_m > 0)) return rho * rho;
  const double width_m = std::sqrt(across_m * along_m);
  const auto sag_m = [&](double at) {
    const double moved_m =
        spread_m * contact_spread(at, poisson_ratio) - drawn_in_m * contact_drawn_in(at) + out_m * at;
    return ball_sag_m(ball_m, std::max(at * width_m + moved_m, 0.0)) + bend_m * at * at;
  };
  const double edge = sag_m(1);
  return edge > kLeastSag * depth_m ? sag_m(rho) / edge : rho * rho;
}

Vec3 TipDent::at(Vec3 rest_m, Vec3 normal) const {
  // The whole distance: what lies far below the tip, as a ring's other side, is far from it.
  const Vec3 from = rest_m - foot_m;
  const double share = drawn_shapes::outlook(normal, rest.inward) * drawn_shapes::near(norm(from), reach_m);
  if (!(share > 0)) return {};
  const ContactEllipse ellipse{rest.along, across_m, along_m};
  const double inside = ellipse.radii(from), rho = inside < 1 ? inside : ellipse.radii_outside(from);
  const double outwards_m = spread_m * contact_spread(rho, poisson_ratio) - drawn_in_m * contact_drawn_in(rho);
  const double deep = rho < 1 ? depth_m - (depth_m - edge_m) * sag_share(rho)
                              : contact_profile(TipShape::kBall, rho) * (far_m + (2 * edge_m - far_m) / (rho * rho));
  // Towards the middle across the ellipse's lines of equal rho.
  const double narrow = across_m * across_m / (along_m * along_m);
  const Vec3 outward = narrow * dot(from, rest.along) * now.along + dot(from, rest.across()) * now.across();
  return share * (deep * now.inward + outwards_m * unit_or(outward, {0, 0, 0}));
}

double TipDent::pressure_Pa(Vec3 rest_m, Vec3 normal) const {
  if (!(dot(normal, rest.inward) < 0)) return 0;
  return mean_Pa *
         contact_pressure(TipShape::kBall, ContactEllipse{rest.along, across_m, along_m}.radii(rest_m - foot_m));
}

}  // namespace palpate
