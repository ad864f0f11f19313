// What an elastic body's tips do to its whole surface (rt_core/contact/elastic/drawn_shapes.h).
#pragma once

#include <cstdint>
#include <vector>

#include "rt_core/contact/elastic/elastic_row.h"

namespace palpate {

// What a contact of some radius meets of the far field: along its inward normal value_m + bend_m (r / radius)^2,
// outwards along the surface out_m r / radius.
struct FarBelow {
  double value_m = 0, bend_m = 0, out_m = 0;
  FarBelow at(double share) const { return {value_m, share * share * bend_m, share * out_m}; }
};

// A foot on the carried surface, where its material is at rest.
struct RestFoot {
  Vec3 place_m, normal;
};
RestFoot rest_foot(const Model& model, const SmoothFoot& foot);

class ElasticFarField {
 public:
  explicit ElasticFarField(const Model& model);
  // A tip's force where its row stands.
  void add(const ElasticRow& row, double force_N);
  // m, of the drawn shapes.
  const std::vector<double>& amplitude_m() const { return amplitude_m_; }
  // Displacement there.
  Vec3 at(std::int32_t triangle, const double* weight) const;
  // By least squares over two rings about the row's foot, half and all of the radius wide.
  FarBelow below(const ElasticRow& row, double radius_m) const;

 private:
  Vec3 near(std::int32_t triangle, Vec3 rest_m) const;

  const Model& model_;
  std::vector<double> amplitude_m_;
};

}  // namespace palpate
