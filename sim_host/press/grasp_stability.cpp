#include "sim_host/press/grasp_stability.h"

#include <algorithm>
#include <cmath>

#include "config/hand/cone_combination.h"
#include "rt_core/contact/friction.h"
#include "rt_core/contact/regions.h"

namespace palpate {

namespace {

using Index = Eigen::Index;

constexpr int kEdges = 8;  // of a cone: its friction is understated by 1 - cos(22.5 degrees) at most, 8 %
// Left over, of the largest force in play: rounding of the least squares is 1e-12.
constexpr double kBalanced = 1e-9;

using Wrench6 = Eigen::Matrix<double, 6, 1>;

Wrench6 wrench_of(const Grasp& grasp, Vec3 at_w, Vec3 force) {
  const Vec3 moment = (1 / grasp.length_m) * cross(at_w - grasp.centre_w, force);
  Wrench6 w;
  w << force.x, force.y, force.z, moment.x, moment.y, moment.z;
  return w;
}

// Directions across `push`, evenly round it.
Vec3 across(Vec3 push, int edge) {
  const Vec3 u = unit_or(tangential_part(axis_off(push), push), {1, 0, 0}), v = cross(push, u);
  const double angle = 2 * kPi * edge / kEdges;
  return std::cos(angle) * u + std::sin(angle) * v;
}

double largest_force_N(const Grasp& grasp) {
  double most = norm(grasp.weight_N);
  for (const GraspContact& finger : grasp.finger) most = std::max(most, finger.normal_N);
  return most;
}

// Edges of all cones at unit push, as wrenches.
Eigen::MatrixXd edges_of(const Grasp& grasp) {
  const std::size_t contacts = grasp.finger.size() + grasp.palm.size();
  Eigen::MatrixXd edge(6, static_cast<Index>(contacts) * kEdges);
  Index next = 0;
  for (const auto* list : {&grasp.finger, &grasp.palm})
    for (const GraspContact& contact : *list) {
      const double mu = contact.normal_N > 0 ? contact.friction_N / contact.normal_N : 0;
      for (int k = 0; k < kEdges; ++k)
        edge.col(next++) = wrench_of(grasp, contact.position_w, contact.push_w + mu * across(contact.push_w, k));
    }
  return edge;
}

// Columns with the sum of their weights as a seventh row: does the convex hull hold `goal`?
bool hull_holds(const Eigen::MatrixXd& edge, const Wrench6& goal) {
  Eigen::MatrixXd column(7, edge.cols());
  column.topRows(6) = edge;
  column.row(6).setOnes();
  Eigen::VectorXd target(7);
  target << goal, 1.0;
  return cone_combination(column, target).residual.norm() <= kBalanced;
}

// The largest multiple of a unit wrench in the hull, by bisection; 0: it does not even hold the origin.
double reach(const Eigen::MatrixXd& edge, const Wrench6& axis) {
  double low = 0, high = edge.colwise().norm().maxCoeff();
  if (!hull_holds(edge, 1e-6 * high * axis)) return 0;
  for (int i = 0; i < 14; ++i) {  // to 1e-4
    const double middle = 0.5 * (low + high);
    (hull_holds(edge, middle * axis) ? low : high) = middle;
  }
  return low;
}

void judge_closure(const Grasp& grasp, GraspStability& result) {
  const Eigen::MatrixXd edge = edges_of(grasp);
  if (edge.cols() == 0) return;
  result.quality_most = kHuge;
  for (int axis = 0; axis < 6; ++axis)
    for (const double sign : {1.0, -1.0})
      result.quality_most = std::min(result.quality_most, reach(edge, sign * Wrench6::Unit(axis)));
  result.closed = result.quality_most > 0;
  result.quality_least = result.quality_most / std::sqrt(6.0);
}

}  // namespace

Grasp grasp_of(const Model& model, const Pose& tool_w, std::span<const PressedPlace> places) {
  const ModelParams& p = model.params;
  const FrictionParameters friction = friction_parameters(p);
  Grasp grasp;
  grasp.centre_w = {p.body_centre_x_m, p.body_centre_y_m, p.body_centre_z_m};
  grasp.weight_N = {0, -9.80665 * p.body_mass_kg, 0};
  grasp.length_m = 0.5 * p.surface_size_m;
  Vec3 on_hand = -grasp.weight_N;
  for (const PressedPlace& place : places) {
    if (!(place.normal_N > 0)) continue;
    grasp.finger.push_back({place.centre_w, -place.normal_w, place.normal_N, static_limit_N(friction, place.normal_N)});
    on_hand += place.normal_N * place.normal_w;
  }
  if (!(p.palm_radius_m > 0)) return grasp;
  const Vec3 out = rotate(tool_w.orientation, {0, 0, -1});
  const Vec3 face = tool_w.position_m + p.palm_face_m * out;
  const double push_N = std::max(dot(on_hand, out), 0.0);
  const double mu = push_N > 0 ? static_limit_N(friction, push_N) / push_N : 0;
  for (int k = 0; k < kEdges; ++k) grasp.palm.push_back({face + p.palm_radius_m * across(out, k), out, 1, mu});
  return grasp;
}

Grasp grasp_of(const Model& model, const State& state) {
  std::vector<PressedPlace> places;
  for (const Region& region : state.region)
    if (is_in_contact(region)) places.push_back({region.centre_w, region.normal_w, region.normal_force_N});
  return grasp_of(model, state.tool_w, places);
}

Grasp grasp_of(const Model& model, const TickRecord& record) {
  std::vector<PressedPlace> places;
  for (std::int32_t i = 0; i < std::min(record.region_count, kMaxRegions); ++i) {
    const RegionRecord& region = record.region[i];
    places.push_back({region.centre_w, region.normal_w, dot(region.force_w, region.normal_w)});
  }
  return grasp_of(model, record.output.tool_w, places);
}

double imbalance_N(const Grasp& grasp, double scale) {
  const auto fingers = static_cast<Index>(grasp.finger.size()), corners = static_cast<Index>(grasp.palm.size());
  // Rows: the wrench, then for each finger what is used of its friction and what is not, together its limit.
  Eigen::MatrixXd column = Eigen::MatrixXd::Zero(6 + fingers, fingers * (kEdges + 1) + corners * kEdges);
  Eigen::VectorXd target = Eigen::VectorXd::Zero(6 + fingers);
  target.head(6) = -wrench_of(grasp, grasp.centre_w, grasp.weight_N);
  Index next = 0;
  for (Index i = 0; i < fingers; ++i) {
    const GraspContact& finger = grasp.finger[static_cast<std::size_t>(i)];
    target.head(6) -= wrench_of(grasp, finger.position_w, finger.normal_N * finger.push_w);
    const double limit_N = scale * finger.friction_N;
    target[6 + i] = limit_N;
    for (int k = 0; k < kEdges; ++k) {
      column.col(next).head(6) = wrench_of(grasp, finger.position_w, across(finger.push_w, k));
      column(6 + i, next++) = 1;
    }
    column(6 + i, next++) = 1;
  }
  for (const GraspContact& corner : grasp.palm)
    for (int k = 0; k < kEdges; ++k)
      column.col(next++).head(6) =
          wrench_of(grasp, corner.position_w, corner.push_w + scale * corner.friction_N * across(corner.push_w, k));
  if (next == 0) return target.norm();
  return cone_combination(column, target).residual.norm();
}

double left_for_friction_N(const Grasp& grasp) {
  Grasp weightless = grasp;
  weightless.weight_N = {};
  return imbalance_N(weightless, 0);
}

bool holds(const Grasp& grasp) {
  return !grasp.finger.empty() && imbalance_N(grasp, 1) <= kBalanced * largest_force_N(grasp);
}

GraspStability judge(const Grasp& grasp) {
  GraspStability result;
  const double enough_N = kBalanced * largest_force_N(grasp);
  result.imbalance_N = imbalance_N(grasp, 1);
  result.holds = holds(grasp);
  double low = 0, high = 128;
  if (imbalance_N(grasp, high) > enough_N) high = kHuge;
  for (int i = 0; i < 17 && high < kHuge; ++i) {  // to 1e-3
    const double middle = 0.5 * (low + high);
    (imbalance_N(grasp, middle) <= enough_N ? high : low) = middle;
  }
  result.friction_needed = high;
  judge_closure(grasp, result);
  return result;
}

}  // namespace palpate
