// A hand that plays the same eight seconds in every scene, derived from the scene's own geometry: approach the top of
// the body, press, slide along a circle, tilt both ways while pressing, tap, press deeply, and leave. It holds the
// handle through a spring, so that the path depends on the forces rendered: a single wrong bit anywhere changes
// everything after it. A scene with a hand is grasped instead: come in along the palm's normal, close, sway and shake
// while holding, open, and leave; a gripper stays closed but for the taps. Determinism, guard and instruction tests all
// tick with this hand. Plain IEEE arithmetic and
// rt_core's own sine: the same bits from every compiler.
#pragma once

#include "rt_core/io.h"
#include "rt_core/math.h"
#include "rt_core/model.h"

namespace palpate::test {

inline constexpr int kScriptTicks = 8000;

// Where the tool's origin is when its lowest points, unrotated, are level with and centred over the highest points of
// the body. Up is y, as in every scene. Points within kLevel_m count as equally high or low.
inline Vec3 touching_position(const Model& model) {
  constexpr Real kLevel_m = 5e-4;
  const auto bottom_of = [](const ToolPoint& p) { return p.position_tool_m - Vec3{0, p.margin_m, 0}; };
  Real top_m = -kHuge, bottom_m = kHuge;
  for (const Vec3& v : model.vertex_m) top_m = max_of(top_m, v.y);
  for (const ToolPoint& p : model.tool_point) bottom_m = min_of(bottom_m, bottom_of(p).y);
  Vec3 top, bottom;
  Real top_count = 0, bottom_count = 0;
  for (const Vec3& v : model.vertex_m) {
    if (v.y < top_m - kLevel_m) continue;
    top += v;
    top_count += 1;
  }
  for (const ToolPoint& p : model.tool_point) {
    if (bottom_of(p).y > bottom_m + kLevel_m) continue;
    bottom += bottom_of(p);
    bottom_count += 1;
  }
  const Vec3 centred = (1 / top_count) * top - (1 / bottom_count) * bottom;
  return {centred.x, top_m - bottom_m, centred.z};
}

class ScriptedHand {
 public:
  explicit ScriptedHand(const Model& model)
      : period_s_(model.params.period_s), size_m_(model.params.surface_size_m), touch_(touching_position(model)) {
    handle_.position_m = touch_ + Vec3{0, kClearance_m, 0};
    if (!model.grasp_w.empty()) {
      grasps_ = true;
      grasp_ = model.grasp_w[0];
      handle_ = target_at(0);
    }
  }

  // The sample of the next tick, after the forces of the last one acted on hand and handle for one period.
  Input next(const Output& last) {
    const Real t_s = static_cast<Real>(tick_) * period_s_;
    const Pose target = target_at(t_s);
    const Vec3 pull = kHand_N_per_m * (target.position_m - handle_.position_m) - kHand_Ns_per_m * velocity_;
    velocity_ += (period_s_ / kHandle_kg) * (pull + last.device_w.force_N);
    handle_.position_m += period_s_ * velocity_;
    handle_.orientation = target.orientation;
    Input input;
    input.pose_w = {quantised(handle_.position_m), handle_.orientation};
    input.commands = tick_ == 1 ? Command::kArm : 0;
    for (float& closing : input.joints.closing) closing = static_cast<float>(closing_at(t_s));
    tick_ += 1;
    return input;
  }

 private:
  static constexpr Real kClearance_m = 0.01;
  static constexpr Real kHandle_kg = 0.2;
  static constexpr Real kHand_N_per_m = 500;
  static constexpr Real kHand_Ns_per_m = 12;
  static constexpr Real kEncoder_m = 3e-5;

  // 0 before `from`, 1 after `to`, a straight line between.
  static Real ease(Real t_s, Real from_s, Real to_s) { return clamp_to((t_s - from_s) / (to_s - from_s), 0, 1); }
  // 0, up to 1 during the first tenth, down again during the last tenth.
  static Real during(Real t_s, Real from_s, Real to_s) {
    const Real edge = 0.1 * (to_s - from_s);
    return ease(t_s, from_s, from_s + edge) - ease(t_s, to_s - edge, to_s);
  }
  static Vec3 quantised(Vec3 p) {
    const auto step = [](Real x) { return kEncoder_m * static_cast<Real>(static_cast<std::int64_t>(x / kEncoder_m)); };
    return {step(p.x), step(p.y), step(p.z)};
  }

  Real closing_at(Real t_s) const {
    if (grasps_) return ease(t_s, 0.9, 2.4) - ease(t_s, 6.2, 7.2);
    return 1 - during(t_s, 5.2, 5.4) - during(t_s, 5.5, 5.7);
  }

  Pose target_at(Real t_s) const {
    if (grasps_) return grasp_at(t_s);
    const Real press = ease(t_s, 0.3, 0.8) - ease(t_s, 7.6, 7.9);            // down, and up at the end
    const Real deep = during(t_s, 6.2, 7.5);                                 // press as hard as a hand does
    const Real tap = during(t_s, 5.2, 5.4) + during(t_s, 5.5, 5.7);          // leave and come back, twice
    const Real slide = during(t_s, 1.2, 3.2);                                // two turns of a circle
    const Real roll = during(t_s, 3.4, 4.2), pitch = during(t_s, 4.3, 5.1);  // tilt over x, then over z
    const Real sway = math::sin(25.0 * t_s);                                 // 4 Hz, within the tilts
    const Real height_m = kClearance_m * (1 - press) - 0.004 * press - 0.018 * deep + 0.03 * tap;  // above first touch
    const Real radius_m = 0.08 * size_m_ * slide, angle = 6.283185307179586 * t_s;
    Pose target;
    target.position_m = touch_ + Vec3{radius_m * math::cos(angle), height_m, radius_m * math::sin(angle)};
    target.orientation = small_rotation({0.3 * roll * sway, 0.0, 0.3 * pitch * sway});
    return target;
  }

  Pose grasp_at(Real t_s) const {
    const Real back_m = 0.06 * (1 - ease(t_s, 0.1, 0.8) + ease(t_s, 7.3, 7.9));
    const Real sway = math::sin(25.0 * t_s);
    const Real shake = during(t_s, 2.8, 3.6), roll = during(t_s, 3.8, 4.6), push = during(t_s, 4.8, 6.0);
    Pose target = grasp_;
    target.position_m +=
        rotate(grasp_.orientation, {0.002 * shake * sway, 0.003 * shake * sway, back_m - 0.004 * push});
    target.orientation = normalised(grasp_.orientation * small_rotation({0.05 * roll * sway, 0.05 * roll * sway, 0}));
    return target;
  }

  Real period_s_, size_m_;
  Vec3 touch_, velocity_;
  Pose handle_, grasp_;
  bool grasps_ = false;
  std::int64_t tick_ = 0;
};

}  // namespace palpate::test
