#include "sim_host/view/far_field.h"

#include <algorithm>
#include <cmath>

#include "rt_core/contact/elastic/drawn_shapes.h"
#include "rt_core/surface/closest_point.h"

namespace palpate {

namespace {

constexpr int kRing = 8;  // places on each of two rings
constexpr double kMeanShare = 0.75;

}  // namespace

RestFoot rest_foot(const Model& model, const SmoothFoot& foot) {
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(foot.triangle)];
  RestFoot rest;
  for (std::size_t k = 0; k < 3; ++k) {
    rest.place_m += foot.weight[k] * model.vertex_m[static_cast<std::size_t>(triangle.vertex[k])];
    rest.normal += foot.weight[k] * model.vertex_normal[static_cast<std::size_t>(triangle.vertex[k])];
  }
  rest.normal = unit_or(rest.normal, foot.normal_w);
  return rest;
}

ElasticFarField::ElasticFarField(const Model& model)
    : model_(model), amplitude_m_(static_cast<std::size_t>(drawn_shapes::count(model))) {}

void ElasticFarField::add(const ElasticRow& row, double force_N) {
  const double square_N2 = force_N * force_N;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const Triangle& triangle = model_.triangle[static_cast<std::size_t>(row.foot.triangle)];
    const float* of = drawn_shapes::at(model_, triangle.vertex[corner]);
    for (double& amplitude : amplitude_m_) {
      amplitude +=
          row.foot.weight[corner] * (force_N * static_cast<double>(of[3]) + square_N2 * static_cast<double>(of[4]));
      of += elastic_layout::kDrawnFloats;
    }
  }
}

Vec3 ElasticFarField::at(std::int32_t triangle, const double* weight) const {
  Vec3 sum;
  for (std::size_t corner = 0; corner < 3; ++corner)
    sum +=
        weight[corner] * drawn_shapes::displacement_m(
                             model_, model_.triangle[static_cast<std::size_t>(triangle)].vertex[corner], amplitude_m_);
  return sum;
}

Vec3 ElasticFarField::near(std::int32_t triangle, Vec3 rest_m) const {
  const SurfacePoint place = closest_surface_point(model_, rest_m, kHuge, triangle);
  if (!place.found) return {};
  double weight[3];
  facet_weights(model_, place.triangle, place.closest_w, weight);
  return at(place.triangle, weight);
}

FarBelow ElasticFarField::below(const ElasticRow& row, double radius_m) const {
  const auto [rest_m, up] = rest_foot(model_, row.foot);
  const Vec3 one = unit_or(cross(up, axis_off(up)), {1, 0, 0}), two = cross(up, one);
  FarBelow below;
  double mean = 0, bent = 0;  // of the values, and of them times the share squared
  for (int i = 0; i < 2 * kRing; ++i) {
    const double share = i < kRing ? 0.5 : 1, angle = 2 * kPi * i / kRing;
    const Vec3 out = std::cos(angle) * one + std::sin(angle) * two;
    const Vec3 moved = near(row.foot.triangle, rest_m + share * radius_m * out);
    const double value_m = -dot(moved, row.foot.normal_w);
    below.out_m += dot(moved, out) / (2 * kRing * kMeanShare);
    mean += value_m / (2 * kRing);
    bent += share * share * value_m / (2 * kRing);
  }
  constexpr double kSquare = 0.625, kFourth = 0.53125;  // means of share^2 and share^4
  below.bend_m = (bent - kSquare * mean) / (kFourth - kSquare * kSquare);
  below.value_m = mean - kSquare * below.bend_m;
  return below;
}

}  // namespace palpate
