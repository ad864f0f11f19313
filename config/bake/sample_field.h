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

// The same of numbers of which a few may be many times the rest, as what a place gives is towards the rim of what is
// held. A smooth field through such samples swings far around them: on an organ that lies on a ball, 12 mm from where
// beta is -487 it was 81 between samples of 2 and 5, and the force half as large again as it should be (elements of
// 3.5 mm, 2026-11-27). Samples of a number end at twenty times the middle one's size.
SampleField tame_field(const elastic::Surface<3>& surface, const std::vector<int>& nodes, const Eigen::MatrixXd& value,
                       double spacing_m);

}  // namespace palpate
