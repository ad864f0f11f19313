#include "config/hand/preshape.h"

#include <algorithm>

#include "config/bake/tool_points.h"
#include "config/hand/hand_model.h"
#include "rt_core/surface/closest_point.h"
#include "rt_core/tool/articulate.h"

namespace palpate {

namespace {

constexpr double kSweepStep_rad = 0.5 * 3.14159265358979323846 / 180;
constexpr int kBisections = 40;
constexpr int kOpeningSteps = 40;
constexpr double kWayIn_m = 0.1;  // from where the hand comes to the grasp
constexpr int kWayInSteps = 10;

class Planner {
 public:
  Planner(const Model& model, const HandDesc& hand, const std::vector<double>& stretched)
      : model_(model), hand_(hand), stretched_(stretched), q_(stretched) {}

  Preshape run() {
    Preshape plan;
    plan.closed = plan.open = stretched_;
    for (std::int32_t f = 0; f < kMaxFingers; ++f)
      if (takes_part(hand_.fingers, f)) close(f, plan);
    plan.closed = q_;
    for (std::size_t p = 0; p < model_.piece.size(); ++p)
      plan.parts_touching += model_.piece[p].joint >= 0 && depth_of(p, grasp()) > 0 ? 1 : 0;
    plan.clearance_m = kHuge;
    for (std::int32_t f = 0; f < kMaxFingers; ++f)
      if (takes_part(hand_.fingers, f)) open(f, plan);
    if (plan.clearance_m < hand_.clearance_m && plan.warning.empty())
      plan.warning = "the hand, wide open, comes within " + std::to_string(1e3 * plan.clearance_m) +
                     " mm of the body on its way in; grasp a slimmer body or move hand.grasp_mm";
    return plan;
  }

 private:
  Pose grasp() const { return {hand_.grasp_position_m, rotation_of(hand_.grasp_rotation_rad)}; }
  // The hand on its way in, `back_m` before the grasp, along the palm's normal.
  Pose before_grasp(double back_m) const {
    Pose pose = grasp();
    pose.position_m += rotate(pose.orientation, {0, 0, back_m});
    return pose;
  }

  // Largest depth of a piece's tool points below the rest surface; negative: the gap.
  double depth_of(std::size_t piece, const Pose& palm_w) const {
    Pose link[kMaxJoints];
    place_links(model_, q_.data(), link, nullptr, nullptr);
    const ToolPiece& p = model_.piece[piece];
    const auto joint = static_cast<std::size_t>(p.joint);
    const Pose carrier = palm_w * (link[joint] * model_.joint[joint].zero_inverse);
    double depth = -kHuge;
    for (std::int32_t i = p.first_point; i < p.first_point + p.point_count; ++i) {
      const ToolPoint& point = model_.tool_point[static_cast<std::size_t>(i)];
      const SurfacePoint at = closest_surface_point(model_, transform(carrier, point.position_tool_m), kHuge, -1);
      depth = std::max(depth, point.margin_m - at.signed_distance_m);
    }
    return depth;
  }

  // Largest depth over the parts of a finger from `part` on to its tip.
  double depth_from(std::int32_t finger, std::size_t part, const Pose& palm_w) const {
    double depth = -kHuge;
    const FingerJoints joints = finger_joints(finger);
    for (std::size_t p = 0; p < model_.piece.size(); ++p)
      for (std::size_t k = part; k < 3; ++k)
        if (model_.piece[p].joint == joints.flexion[k]) depth = std::max(depth, depth_of(p, palm_w));
    return depth;
  }

  static void warn_of_miss(std::int32_t finger, std::string& warning) {
    warning += warning.empty() ? "fingertips that do not reach the body: " : ", ";
    warning += finger_name(finger);
  }

  void close(std::int32_t finger, Preshape& plan) {
    const FingerJoints joints = finger_joints(finger);
    const double squeeze_m = hand_.squeeze_m[static_cast<std::size_t>(finger)];
    for (const std::int32_t j : joints.flexion) q_[static_cast<std::size_t>(j)] = extended(j);
    for (std::size_t part = 0; part < 3; ++part) {
      const auto j = static_cast<std::size_t>(joints.flexion[part]);
      const double end = model_.joint[j].highest;
      double low = q_[j], high = low;
      while (high < end && depth_from(finger, part, grasp()) < squeeze_m) {
        low = high;
        high = std::min(high + kSweepStep_rad, end);
        q_[j] = high;
      }
      if (depth_from(finger, part, grasp()) < squeeze_m) {
        if (part == 2 && depth_from(finger, 2, grasp()) < 0) warn_of_miss(finger, plan.warning);
        continue;
      }
      for (int i = 0; i < kBisections; ++i) {
        q_[j] = 0.5 * (low + high);
        (depth_from(finger, part, grasp()) < squeeze_m ? low : high) = q_[j];
      }
      q_[j] = low;
    }
  }

  double extended(std::int32_t j) const { return model_.joint[static_cast<std::size_t>(j)].lowest; }

  // Smallest gap of a finger to the body over the way in.
  double gap_of(std::int32_t finger) const {
    double gap = kHuge;
    for (int k = 0; k <= kWayInSteps; ++k)
      gap = std::min(gap, -depth_from(finger, 0, before_grasp(kWayIn_m * k / kWayInSteps)));
    return gap;
  }

  void open(std::int32_t finger, Preshape& plan) {
    const FingerJoints joints = finger_joints(finger);
    double gap = -kHuge;
    for (int k = 0; k <= kOpeningSteps && gap < hand_.clearance_m; ++k) {
      for (const std::int32_t joint : joints.flexion) {
        const auto j = static_cast<std::size_t>(joint);
        // The last step's sum may miss the limit by a rounding.
        plan.open[j] = k == kOpeningSteps ? extended(joint)
                                          : plan.closed[j] + (extended(joint) - plan.closed[j]) * k / kOpeningSteps;
        q_[j] = plan.open[j];
      }
      gap = gap_of(finger);
    }
    plan.clearance_m = std::min(plan.clearance_m, gap);
  }

  const Model& model_;
  const HandDesc& hand_;
  const std::vector<double>& stretched_;
  std::vector<double> q_;
};

}  // namespace

Preshape plan_preshape(const Model& model, const HandDesc& hand, const std::vector<double>& stretched) {
  return Planner(model, hand, stretched).run();
}

}  // namespace palpate
