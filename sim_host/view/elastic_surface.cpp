#include "sim_host/view/elastic_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/contact/elastic/linearised.h"
#include "rt_core/contact/elastic/near_field.h"
#include "rt_core/contact/region_solve.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/view/contact_profile.h"

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
  std::int32_t looked = 0, shown = 0;
  double product[kMaxTerms];
};

// Every tip that touches, on the surface as the soft modes carry it.
std::vector<TouchingTip> touching_tips(const Model& model, const State& state, Amplitudes& amplitude) {
  const CarriedSurface carried{model, amplitude.product, &amplitude.looked, &amplitude.shown};
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

// Of the linear modes, J^1/2.
std::array<double, kMaxLinearModes> linear_amplitudes(const Model& model, const State& state,
                                                      const std::vector<TouchingTip>& tips) {
  std::array<double, kMaxLinearModes> amplitude{};
  for (const TouchingTip& tip : tips) {
    const double force_N = force_of(tip, state, tips);
    double along[kMaxLinearModes];
    show_linear_modes(model, tip.row, along);
    for (std::int32_t m = 0; m < model.params.elastic_linear; ++m)
      amplitude[static_cast<std::size_t>(m)] -= force_N * along[m];
  }
  return amplitude;
}

Vec3 linear_displacement(const Model& model, std::int32_t vertex, const std::vector<double>& amplitude) {
  const float* shape = elastic_layout::linear_shapes(model, vertex);
  Vec3 sum;
  for (std::int32_t m = 0; m < model.params.elastic_linear; ++m)
    sum += amplitude[static_cast<std::size_t>(m)] * Vec3{static_cast<double>(shape[3 * m]),
                                                         static_cast<double>(shape[3 * m + 1]),
                                                         static_cast<double>(shape[3 * m + 2])};
  return sum;
}

// What the near field leaves of 1 / r.
double left_of_half_space(double by_cut) { return 1 - by_cut / std::sqrt(by_cut * by_cut + 1); }

TipDent dent_of(const TouchingTip& tip, double depth_m) {
  const ElasticRow& row = tip.row;
  TipDent dent;
  dent.foot_w = row.foot.foot_w;
  dent.inward = -row.foot.normal_w;
  dent.depth_m = depth_m;
  const double radius = row.tip.margin_m, body = std::max(1 + row.curvature_1_per_m * radius, 0.25);
  dent.across_m = dent.along_m = std::sqrt(depth_m * radius / body);
  const Vec3 axis = tangential_part(row.tip.half_axis_w, row.foot.normal_w);
  dent.along = unit_or(axis, unit_or(cross(dent.inward, axis_off(dent.inward)), {1, 0, 0}));
  if (row.tip.is_ball()) return dent;
  // As far as it is straight from where its force acts, and the body bends away.
  const double straight = dent.across_m + (1 - std::abs(row.tip.along)) * norm(row.tip.half_axis_w);
  const double longest = std::min(straight, kLongest * dent.across_m);
  dent.along_m = std::clamp(row.line.along_1_per_m > 0 ? std::sqrt(depth_m / row.line.along_1_per_m) : longest,
                            dent.across_m, longest);
  return dent;
}

}  // namespace

ElasticShape elastic_shape(const Model& model, const State& state) {
  Amplitudes soft(model, state);
  const std::vector<TouchingTip> tips = touching_tips(model, state, soft);
  const std::array<double, kMaxLinearModes> linear = linear_amplitudes(model, state, tips);
  ElasticShape shape{{soft.product, soft.product + elastic_layout::terms(model.params.elastic_soft)},
                     {linear.begin(), linear.begin() + model.params.elastic_linear},
                     {}};
  const NearField near{far_field_scale_m2_per_N(model.params.youngs_modulus_Pa, model.params.poisson_ratio)};
  for (const TouchingTip& tip : tips) {
    double along[kMaxLinearModes], given_m = 0, modes_m_per_N = 0;
    show_linear_modes(model, tip.row, along);
    for (std::int32_t m = 0; m < model.params.elastic_linear; ++m) {
      given_m -= along[m] * linear[static_cast<std::size_t>(m)];
      modes_m_per_N += along[m] * along[m];
    }
    const double depth_m = tip.row.travel_m - given_m;
    if (!(depth_m > 0)) continue;
    TipDent dent = dent_of(tip, depth_m);
    dent.mean_Pa = state.live.stiffness * force_of(tip, state, tips) / (kPi * dent.across_m * dent.along_m);
    dent.foot_w += given_m * dent.inward;
    dent.drawn_in_m = contact_drawn_in_share(model.params.poisson_ratio) * depth_m;
    dent.cut_1_per_m = near.cut_1_per_m(modes_m_per_N, tip.row.c_m_per_N);
    shape.dent.push_back(dent);
  }
  return shape;
}

std::vector<Vec3> mode_displacement_m(const Model& model, const ElasticShape& shape) {
  std::int32_t looked = 0, shown = 0;
  const CarriedSurface carried{model, shape.soft.data(), &looked, &shown};
  std::vector<Vec3> displacement;
  for (std::int32_t v = 0; v < model.sizes.n_vertex; ++v)
    displacement.push_back(carried.displacement(v) + linear_displacement(model, v, shape.linear));
  return displacement;
}

Vec3 TipDent::at(Vec3 point_w, Vec3 normal) const {
  const double facing = -dot(normal, inward);
  if (!(facing > 0)) return {};
  // The whole distance: what lies far below the tip, as a ring's other side, is far from it.
  const Vec3 from = point_w - foot_w;
  const double rho = ContactEllipse{along, across_m, along_m}.radii(from);
  const double fade = fade_out(rho, 0.5 * kDentReach, kDentReach);
  const double edge = across_m * cut_1_per_m,
               ends = left_of_half_space(std::max(rho, 1.0) * edge) / left_of_half_space(edge);
  const double deep = depth_m * contact_profile(TipShape::kBall, rho) * fade_out((rho - 1) * edge, 0, kModesTakeOver);
  // Towards the middle across the ellipse's lines of equal rho.
  const Vec3 aside = tangential_part(from, inward), length = dot(aside, along) * along;
  const Vec3 outward = unit_or((across_m * across_m / (along_m * along_m)) * length + (aside - length), {0, 0, 0});
  return (ends * fade * std::min(1.0, 2 * facing)) * (deep * inward - drawn_in_m * contact_drawn_in(rho) * outward);
}

double TipDent::pressure_Pa(Vec3 point_w, Vec3 normal) const {
  if (!(dot(normal, inward) < 0)) return 0;
  return mean_Pa * contact_pressure(TipShape::kBall, ContactEllipse{along, across_m, along_m}.radii(point_w - foot_w));
}

}  // namespace palpate
