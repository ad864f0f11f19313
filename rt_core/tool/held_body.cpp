#include "rt_core/tool/held_body.h"

namespace palpate {

namespace {

// R K R^T of a symmetric matrix, told as xx, yy, zz and yz, xz, xy.
void turn_stiffness(Quat turn, Vec3& along, Vec3& across) PALPATE_RT {
  const RigidFrame frame({{}, turn});
  const auto of = [&](Vec3 v) PALPATE_RT {
    return Vec3{along.x * v.x + across.z * v.y + across.y * v.z, across.z * v.x + along.y * v.y + across.x * v.z,
                across.y * v.x + across.x * v.y + along.z * v.z};
  };
  // Rows of R: world axes in the body's frame.
  const Vec3 x{frame.x.x, frame.y.x, frame.z.x}, y{frame.x.y, frame.y.y, frame.z.y}, z{frame.x.z, frame.y.z, frame.z.z};
  const Vec3 kx = of(x), ky = of(y), kz = of(z);
  along = {dot(x, kx), dot(y, ky), dot(z, kz)};
  across = {dot(y, kz), dot(x, kz), dot(x, ky)};
}

// A wrench's moment within what a device gives.
void cut_torque(const Model& model, Scratch& scratch, Wrench& wrench) PALPATE_RT {
  const Real most_Nm = model.params.torque_max_Nm, size_Nm = norm(wrench.torque_Nm);
  if (!(size_Nm > most_Nm)) return;
  wrench.torque_Nm = (most_Nm / size_Nm) * wrench.torque_Nm;
  if (most_Nm > 0) scratch.status |= Status::kTorqueClamped;
}

}  // namespace

Input seen_from_body(const Model& model, const Input& input) PALPATE_RT {
  Input seen = input;
  const bool alone = model.params.held_part == HeldPart::kBody;
  seen.pose_w =
      alone ? tool_seen(grip_of(model), input.pose_w, {}) : tool_seen(grip_of(model), input.second_w, input.pose_w);
  return seen;
}

void render_on_body(const Model& model, const State& state, Scratch& scratch, Output& output) PALPATE_RT {
  const bool alone = model.params.held_part == HeldPart::kBody;
  const Pose body_w = alone ? handle_seeing(grip_of(model), state.device_w) : state.second_w;
  const Quat out = body_w.orientation;
  const Vec3 arm_m = rotate(out, state.device_w.position_m - grip_of(model));  // from the body's handle to the tool
  const Wrench tool{rotate(out, output.device_w.force_N), rotate(out, output.device_w.torque_Nm)};
  Wrench body{-tool.force_N, -tool.torque_Nm - cross(arm_m, tool.force_N)};
  cut_torque(model, scratch, body);
  output.device_w = alone ? body : tool;
  output.handle_w_m = alone ? body_w.position_m : body_w.position_m + arm_m;
  if (!alone) {
    output.second_w = body;
    output.second_handle_w_m = body_w.position_m;
  }
  turn_stiffness(out, output.felt_along_N_per_m, output.felt_across_N_per_m);
  if (alone) return;
  output.second_felt_along_N_per_m = output.felt_along_N_per_m;
  output.second_felt_across_N_per_m = output.felt_across_N_per_m;
}

}  // namespace palpate
