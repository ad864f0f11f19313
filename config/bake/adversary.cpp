#include "config/bake/adversary.h"

#include <algorithm>

#include "rt_core/tool/virtual_coupling.h"

namespace palpate {

double Adversary::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
}

Vec3 Adversary::direction() {
  for (;;) {
    const Vec3 v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    if (squared_norm(v) > 1e-4 && squared_norm(v) <= 1) return (1 / norm(v)) * v;
  }
}

Vec3 Adversary::any_way(double most, double unit) {
  const Vec3 way = direction();
  return uniform(0, most) * unit * way;
}

Pose Adversary::start(double deepest_m) {
  const std::size_t v = random_() % model_.vertex_m.size(), i = random_() % model_.tool_point.size();
  const ToolPoint& point = model_.tool_point[i];
  const double deep = uniform(-1e-3, deepest_m);
  Pose pose{{}, small_rotation(any_way(3))};
  if (!model_.grasp_w.empty()) pose.orientation = model_.grasp_w[0].orientation;
  const Vec3 target = model_.vertex_m[v] + (point.margin_m - deep) * model_.vertex_normal[v];
  pose.position_m = target - rotate(pose.orientation, point.position_tool_m);
  return pose;
}

bool Adversary::begin() {
  const double half = 0.5 * model_.params.surface_size_m;
  left_ = 20 + static_cast<int>(random_() % 60);
  move_ = static_cast<Move>(random_() % 6);
  const bool forgets = one_in(4);  // only then may the pose of a device jump
  input_.drive = one_in(2) ? Drive::kTool : forgets && one_in(2) ? Drive::kDevice : Drive::kHeld;
  input_.pose_w = start(one_in(3) ? half : std::min(model_.params.max_depth_m, 0.5 * half));
  if (!model_.grasp_w.empty() && one_in(2)) {  // about the grasp that the tool was made for
    input_.pose_w = model_.grasp_w[0];
    input_.pose_w.position_m += any_way(0.2, half);
    input_.pose_w.orientation = normalised(small_rotation(any_way(0.5)) * input_.pose_w.orientation);
  }
  middle_ = input_.pose_w;
  drift_ = direction();
  spin_ = direction();
  joint_step_ = one_in(3) ? 1.0 : 0.03;
  for (float& closing : input_.joints.closing) closing = static_cast<float>(uniform(0, 1));
  return forgets;
}

void Adversary::move(const Output& last) {
  const double step_m = std::min(model_.params.speed_max_m_per_s * model_.params.period_s, 2e-3);
  const auto turn = [&](double angle, Vec3 axis) {
    input_.pose_w.orientation = normalised(small_rotation(angle * axis) * input_.pose_w.orientation);
  };
  if (one_in(8)) drift_ = direction();
  if (one_in(8)) spin_ = direction();
  Vec3& at = input_.pose_w.position_m;
  switch (move_) {
    case Move::kJump:
      input_.pose_w = start(std::min(model_.params.max_depth_m, 0.25 * model_.params.surface_size_m));
      return;
    case Move::kSlide:
      at += uniform(0, 5e-3) * drift_;
      return turn(uniform(0, 0.1), spin_);
    case Move::kPush:
      at += uniform(0, 1) * step_m * drift_;
      return turn(uniform(0, 0.01), spin_);
    case Move::kSpin:
      at += any_way(0.2, step_m);
      return turn(uniform(0, 1), spin_);
    case Move::kShake: {
      input_.pose_w = middle_;
      at += any_way(1, step_m);
      const Vec3 axis = direction();
      return turn(uniform(0, 0.02), axis);
    }
    case Move::kCreep:
      break;
  }
  // As deep as the law reaches, and back.
  if (last.penetration_m > model_.params.max_depth_m) {
    drift_ = -drift_;
    at += 2 * step_m * drift_;
    if (one_in(4)) left_ = 0;
    return;
  }
  at += uniform(0, 1) * step_m * drift_;
  turn(uniform(0, 0.03), spin_);
}

Input Adversary::next(const Output& last, bool& forgets) {
  forgets = false;
  if (left_-- <= 0) {
    forgets = begin();
  } else {
    move(last);
  }
  for (float& closing : input_.joints.closing)
    closing = std::clamp(closing + static_cast<float>(uniform(-joint_step_, joint_step_)), 0.0f, 1.0f);
  input_.joints.direct = 0;
  for (std::size_t j = 0; j < model_.joint.size(); ++j) {
    if (!one_in(4)) continue;
    input_.joints.direct |= 1u << j;
    input_.joints.target[j] = static_cast<float>(uniform(model_.joint[j].lowest, model_.joint[j].highest));
  }
  input_.commands = one_in(16) ? Command::kArm : 0;
  return input_;
}

}  // namespace palpate
