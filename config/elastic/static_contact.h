// Static equilibrium of the reduced body with rigid tools, frictionless. It minimises one energy over the soft modes,
//   V(q) + sum_k U_k,  with  travel_k(q) = local_k(F_k) + c_k F_k + c1_k F_k^2 + sum_(l != k) c_kl F_l,  F_k >= 0,
// c_k and c1_k the self terms, c_kl = sum over the linear modes of p_k p_l / lambda.
// Slopes and tool forces are central differences of that energy, so whatever R, the curvatures and the modes do as a
// contact slides is in the force: closed loops return their work.
#pragma once

#include "config/elastic/contact_places.h"

namespace palpate::elastic {

template <int kDim>
struct StaticState {
  bool converged = false;  // false too where the energy has a kink: facets meet at small angles
  double residual = 0;     // slope of the energy in the modes' own measure, over the root of the energy
  int newton_steps = 0;
  double energy_J = 0;  // all that is stored
  Eigen::VectorXd q_m2;
  std::vector<fem::Point<kDim>> force_on_tool_N;
  std::vector<ContactPlace<kDim>> places;
  std::vector<double> force_N;  // of the places
};

template <int kDim>
class StaticContact {
 public:
  StaticContact(const ElasticBody<kDim>& body, std::vector<fem::RigidTool> tools);
  // Where the tools start from, without contact.
  void place_tools(const std::vector<fem::Point<kDim>>& origin_m);
  // Equilibrium with the tools' origins at `origin_m`, from the last one along a straight path in short steps.
  StaticState<kDim> move_tools(const std::vector<fem::Point<kDim>>& origin_m);

 private:
  using Origins = std::vector<fem::Point<kDim>>;
  // Energy, contacts and a curvature for Newton's method at q.
  struct Trial {
    StaticState<kDim> state;
    Eigen::MatrixXd curvature;
  };
  // At the places where the tools touch, or at given ones carried along.
  Trial evaluate(const Eigen::VectorXd& q, const Origins& origin_m, const StaticState<kDim>* at = nullptr);
  Eigen::VectorXd slope(const StaticState<kDim>& at, const Origins& origin_m);
  fem::Point<kDim> force_on(std::size_t tool, const StaticState<kDim>& at, Origins origin_m);
  StaticState<kDim> settle(const Origins& origin_m);
  LocalLaw law(const ContactPlace<kDim>& place) const;
  Eigen::MatrixXd compliance(const std::vector<ContactPlace<kDim>>& places) const;
  void add_contacts(Trial& trial) const;
  Eigen::VectorXd step(const Eigen::MatrixXd& curvature, const Eigen::VectorXd& slope) const;

  const ElasticBody<kDim>& body_;
  PlaceFinder<kDim> finder_;
  Eigen::VectorXd q_, probe_m2_;
  Origins origin_m_;
};

}  // namespace palpate::elastic
