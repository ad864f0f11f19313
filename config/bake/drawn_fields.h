// Gathers how the whole surface answers a press at every sample, and packs it into the few shapes that an image holds
// for drawing (rt_core/contact/elastic/drawn_shapes.h).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "config/bake/facet_foot.h"
#include "config/elastic/elastic_body.h"

namespace palpate {

class DrawnFields {
 public:
  // What is given must outlive this. `depth_m`: of the deepest press, which says what F^2 weighs beside F.
  DrawnFields(const elastic::RestBody<3>& rest, const std::vector<FacetFoot>& feet, std::span<const Vec3> vertex_m,
              std::span<const Vec3> vertex_normal, double depth_m);
  void add(const elastic::PressedPlace& place);
  // Appends their number and every vertex's floats, less what the body's soft modes have of the fields.
  void append(const elastic::ElasticBody<3>& body, double spacing_m, std::vector<float>& floats) const;

 private:
  struct Place {
    int node = 0;
    double sigma_m[2] = {}, force_N = 0;     // the force: what presses to the deepest depth, in a linear body
    Eigen::VectorXf first_mpN, second_mpN2;  // [vertex * 3 + component]
  };
  Eigen::VectorXd at_vertices(const Eigen::VectorXd& field) const;
  Eigen::VectorXd less_half_space(const elastic::PressedPlace& place, int patch) const;
  void smooth_core(const elastic::PressedPlace& place, Eigen::VectorXd& field) const;
  Eigen::MatrixXf fields(const elastic::ElasticBody<3>& body) const;

  const elastic::RestBody<3>& rest_;
  const std::vector<FacetFoot>& feet_;
  std::vector<Vec3> vertex_m_, vertex_normal_;
  double depth_m_, reach_m_;
  std::vector<Place> place_;
};

}  // namespace palpate
