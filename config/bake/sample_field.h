// Numbers that are known at samples of an elastic body's surface, anywhere on it: smoothly through the samples' values
// (radial functions of place and outlook, Matern 3/2 about the mean). A mean of near samples instead flattens the peak
// in the middle of a thin wall: an arch was 25 % too stiff under one finger (2026-11-22).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "config/elastic/surface.h"
#include "rt_core/vec.h"

namespace palpate {

class SampleField {
 public:
  // A row of `value` for every node; `spacing_m`: how far apart they are.
  SampleField(const elastic::Surface<3>& surface, const std::vector<int>& nodes, const Eigen::MatrixXd& value,
              double spacing_m);
  Eigen::RowVectorXd show(Vec3 p, Vec3 normal) const;

 private:
  struct Sample {
    Vec3 position, normal;
  };
  double likeness(const Sample& a, const Sample& b) const;
  std::vector<Sample> samples_;
  double length_;
  Eigen::RowVectorXd mean_;
  Eigen::MatrixXd weight_;
};

}  // namespace palpate
