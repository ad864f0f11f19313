#include "rt_core/coupling/virtual_coupling.h"

#include "rt_core/cholesky.h"

namespace palpate {

namespace {

constexpr std::int32_t kDof = 6;

// Solves (contact_stiffness + diag(coupling)) x = b in place.
bool solve(const Model& model, const double (&contact_stiffness)[36], Real (&b)[kDof]) PALPATE_RT {
  Real matrix[kDof * kDof];
  for (std::int32_t i = 0; i < kDof * kDof; ++i) matrix[i] = contact_stiffness[i];
  for (std::int32_t i = 0; i < 3; ++i) {
    matrix[i * (kDof + 1)] += model.params.coupling_N_per_m;
    matrix[(i + 3) * (kDof + 1)] += model.params.coupling_Nm_per_rad;
  }
  if (!cholesky_factor(matrix, kDof)) return false;
  cholesky_solve(matrix, b, kDof);
  return true;
}

}  // namespace

Twist twist_between(const Pose& from, const Pose& to) PALPATE_RT {
  return {to.position_m - from.position_m, small_rotation_vector(to.orientation * conjugate(from.orientation))};
}

Pose moved(const Pose& pose, const Twist& twist) PALPATE_RT {
  return {pose.position_m + twist.translation_m, normalised(small_rotation(twist.rotation_rad) * pose.orientation)};
}

bool follow(const Model& model, const double (&contact_stiffness)[36], const Twist& handle, Twist& tool) PALPATE_RT {
  const Vec3 force = model.params.coupling_N_per_m * handle.translation_m;
  const Vec3 torque = model.params.coupling_Nm_per_rad * handle.rotation_rad;
  Real x[kDof] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
  tool = handle;
  if (!solve(model, contact_stiffness, x)) return false;
  tool = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  return true;
}

bool correct(const Model& model, const double (&contact_stiffness)[36], const Wrench& contact_w,
             const Wrench& coupling_on_tool_w, Twist& correction) PALPATE_RT {
  const Vec3 force = contact_w.force_N + coupling_on_tool_w.force_N;
  const Vec3 torque = contact_w.torque_Nm + coupling_on_tool_w.torque_Nm;
  Real x[kDof] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
  correction = {};
  if (!solve(model, contact_stiffness, x)) return false;
  correction = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  return true;
}

Wrench coupling_wrench(const Model& model, const Pose& device_w, const Pose& tool_w) PALPATE_RT {
  const Twist offset = twist_between(device_w, tool_w);
  return {model.params.coupling_N_per_m * offset.translation_m, model.params.coupling_Nm_per_rad * offset.rotation_rad};
}

}  // namespace palpate
