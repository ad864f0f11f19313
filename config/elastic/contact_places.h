// Where rigid tools touch the carried surface x = X + u_soft(X; q), and what the reduced body shows there.
#pragma once

#include <vector>

#include "config/elastic/elastic_body.h"
#include "config/elastic/local_law.h"
#include "config/fem/rigid_tool.h"

namespace palpate::elastic {

// One region: a place where the gap of one tool has a minimum over the surface.
template <int kDim>
struct ContactPlace {
  int tool = 0, facet = 0;
  FacetPlace at;
  Vector<kDim> rest_m, rest_normal;      // of the body's surface
  Vector<kDim> x_m, normal;              // carried; the normal points from the body to the tool
  double travel_m = 0;                   // how far the carried surface overlaps the tool
  double body_curvature_1pm = 0;         // at rest, mean
  double self_mpN = 0, second_mpN2 = 0;  // c and c1
  Eigen::VectorXd pull;                  // d travel / d q
  Eigen::MatrixXd turn;                  // normal . theta: d2 travel / d q2 at a fixed place and normal
  Eigen::MatrixXd slide;                 // d x / d q, one column per soft mode
  Eigen::VectorXd linear;                // rest normal . phi of the linear modes
};

template <int kDim>
class PlaceFinder {
 public:
  // Balls and planes. Throws ConfigError for other tools.
  PlaceFinder(const ElasticBody<kDim>& body, std::vector<fem::RigidTool> tools);
  const std::vector<fem::RigidTool>& tools() const { return tools_; }
  // Up to two places per tool, deepest first, among those nearer than `reach_m`; two minima count as two when they are
  // four edges apart.
  std::vector<ContactPlace<kDim>> find(const Eigen::VectorXd& q, const std::vector<fem::Point<kDim>>& origin_m,
                                       double reach_m);
  // The same places at another q near by: each settles anew on its own facet.
  std::vector<ContactPlace<kDim>> follow(const Eigen::VectorXd& q, const std::vector<fem::Point<kDim>>& origin_m,
                                         const std::vector<ContactPlace<kDim>>& places);

 private:
  Vector<kDim> displacement(int node, const Eigen::VectorXd& q) const;
  void carry(const std::vector<int>& nodes, const Eigen::VectorXd& q);
  void place_tools(const std::vector<fem::Point<kDim>>& origin_m);
  fem::Gap<kDim> gap(int tool, const Vector<kDim>& x_m) const;
  // With its first and second derivatives in the facet's parameters, where asked for.
  double gap_on_facet(int tool, int facet, const FacetPlace& at, Eigen::Vector2d* slope,
                      Eigen::Matrix2d* curvature) const;
  // The least gap on one facet, by Newton's method with clamped steps.
  double settle(int tool, int facet, FacetPlace& at) const;
  std::vector<int> minima(int tool) const;
  ContactPlace<kDim> describe(int tool, int facet, const FacetPlace& at, const Eigen::VectorXd& q) const;

  const ElasticBody<kDim>& body_;
  std::vector<fem::RigidTool> tools_;
  std::vector<std::vector<int>> neighbours_;  // per contact node: contact nodes of shared facets
  std::vector<Vector<kDim>> carried_m_;       // per node of the body; contact nodes only
  std::vector<Vector<kDim>> origin_m_;
};

}  // namespace palpate::elastic
