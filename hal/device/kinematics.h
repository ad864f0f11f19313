// Cartesian kinematics: device frame <-> world frame, and integer counts <-> SI units. For devices that report the
// handle's pose themselves; joint-space devices will add their own maps.
#pragma once

#include <cstdint>

#include "hal/device/device.h"
#include "rt_core/io.h"

namespace palpate {

// world = position_w + rotation * (scale * device). `scale` > 1 magnifies motion: the hand moves 1 cm, the tool
// `scale` cm. A turn is passed on as the device sent it, not normalised: the core refuses what is no rotation. Forces
// are not scaled, so the stiffness the hand feels is the scene's times `scale`; torques are divided by it, as the lever
// of a force is: the work at the handle is then the world's over `scale`, and a closed path of a coupled motion gives
// back what it took. The device's own limits apply to these products (admitted_coupling of device_profile.h).
struct CartesianKinematics {
  Vec3 position_w;      // of the device's origin
  Quat orientation_w;   // device frame to world, unit
  double scale = 1;     // 0.01 .. 100
  double radius_m = 1;  // workspace: device positions further than this from its origin are not believed
};

inline bool valid(const CartesianKinematics& k) noexcept {
  const Quat& q = k.orientation_w;
  const double length2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return is_finite(k.position_w) && k.scale >= 0.01 && k.scale <= 100 && k.radius_m > 0 && k.radius_m <= 100 &&
         length2 > 1 - 1e-9 && length2 < 1 + 1e-9;
}

inline Pose pose_in_world(const CartesianKinematics& k, const DeviceSample& sample) noexcept {
  return {k.position_w + rotate(k.orientation_w, k.scale * sample.position_m), k.orientation_w * sample.orientation};
}
inline Pose pose_in_device(const CartesianKinematics& k, const Pose& pose_w) noexcept {
  const Quat back = conjugate(k.orientation_w);
  return {(1.0 / k.scale) * rotate(back, pose_w.position_m - k.position_w), normalised(back * pose_w.orientation)};
}
// Force and torque about the handle's origin: the force keeps its size, its lever is as much shorter as motion is.
inline Wrench wrench_in_device(const CartesianKinematics& k, const Wrench& wrench_w) noexcept {
  const Quat back = conjugate(k.orientation_w);
  return {rotate(back, wrench_w.force_N), rotate(back, (1.0 / k.scale) * wrench_w.torque_Nm)};
}
// Comparison written so that a NaN position is outside.
inline bool in_workspace(const CartesianKinematics& k, const DeviceSample& sample) noexcept {
  return squared_norm(sample.position_m) <= k.radius_m * k.radius_m;
}

// Counts nearest to value / unit, saturated to a signed field of `bits` bits. The clamp comes before the conversion to
// integer (which is undefined outside the range); NaN and infinite garbage give 0: no force.
inline std::int32_t to_counts(double value, double unit, int bits) noexcept {
  const double limit = static_cast<double>((std::int64_t{1} << (bits - 1)) - 1);
  const double counts = value / unit;
  if (!(counts >= -kHuge * kHuge && counts <= kHuge * kHuge)) return 0;
  const double clamped = clamp_to(counts, -limit, limit);
  return static_cast<std::int32_t>(clamped < 0 ? clamped - 0.5 : clamped + 0.5);
}
inline double from_counts(std::int32_t counts, double unit) noexcept { return static_cast<double>(counts) * unit; }

// What the handle feels around `handle_w_m`, for a device that evaluates it; magnified motion is felt as much stiffer.
// R^T K R column by column.
inline LocalModel local_model_in_device(const CartesianKinematics& k, const Output& output, double valid_s) noexcept {
  const Quat back = conjugate(k.orientation_w);
  const Vec3 d = output.felt_along_N_per_m, o = output.felt_across_N_per_m;
  const auto column = [&](Vec3 axis) {
    const Vec3 w = k.scale * rotate(k.orientation_w, axis);
    return rotate(back, {d.x * w.x + o.z * w.y + o.y * w.z, o.z * w.x + d.y * w.y + o.x * w.z,
                         o.y * w.x + o.x * w.y + d.z * w.z});
  };
  const Vec3 x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
  const Vec3 point_m = (1.0 / k.scale) * rotate(back, output.handle_w_m - k.position_w);
  return {point_m, {x.x, y.y, z.z}, {y.z, x.z, x.y}, valid_s};
}

// `valid_s` > 0: with the local model.
inline DeviceCommand to_command(const CartesianKinematics& k, const Output& output, std::uint32_t flags,
                                double valid_s = 0) noexcept {
  const Wrench wrench = wrench_in_device(k, output.device_w);
  DeviceCommand command;
  command.flags = flags;
  if (is_finite(wrench.force_N) && is_finite(wrench.torque_Nm)) {  // the last finite check before the wire
    command.force_N = wrench.force_N;
    command.torque_Nm = wrench.torque_Nm;
    if (valid_s > 0) command.local = local_model_in_device(k, output, valid_s);
  }
  return command;
}

}  // namespace palpate
