#include "sim_host/doctor/push_check.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "hal/device/device.h"
#include "hal/drives/axis_map.h"
#include "sim_host/doctor/move_check.h"

namespace palpate {

namespace {

constexpr double kMoved_m = 1e-3;  // of a lever's end: above tremor and encoder steps

}  // namespace

PushCheck::PushCheck(AxisDrives& drives, const ArmProfile& arm, AxisDrives::Pause pause)
    : drives_(drives), arm_(arm), pause_(std::move(pause)) {}

void PushCheck::step(const AxisCommand& command) {
  drives_.transmit(command);
  pause_();
  AxisSample sample;
  drives_.receive(sample);
  if (!sample.fresh)  // positions stay
    for (int i = 0; i < kMaxAxes; ++i) sample.turns[i] = sample_.turns[i];
  sample_ = sample;
}

// How far the motor's joint went the way its drive counts.
double PushCheck::moved_m(int axis, double from_turns) const {
  const AxisProfile& a = arm_.axes[static_cast<std::size_t>(axis)];
  return (sample_.turns[axis] - from_turns) * std::abs(joint_per_turn(a)) * lever_m(arm_, axis);
}

std::string PushCheck::enable() {
  constexpr int kMost_ms = 1000;
  AxisCommand command;
  step(command);
  command.enable = true;
  for (int ms = 0; ms < kMost_ms; ++ms) {
    step(command);
    if ((sample_.flags & DeviceFlag::kEnabled) != 0) return "";
  }
  return fmt::format("the drives do not obey within a second; error {:#x}", sample_.error_code);
}

// "" or what is wrong. Still first, then a torque that grows for half a second.
std::string PushCheck::push(int axis) {
  constexpr int kStill_ms = 200, kWindows = 10, kGrow_ms = 500;
  AxisCommand command;
  command.enable = true;
  double from = 0, moved = 0;
  for (int window = 0; window == 0 || (window < kWindows && moved > 0.2 * kMoved_m); ++window) {
    from = sample_.turns[axis];
    for (int ms = 0; ms < kStill_ms; ++ms) step(command);
    moved = std::abs(moved_m(axis, from));
  }
  if (moved > 0.2 * kMoved_m)
    return "moves by itself with no torque: lay the handle down, or hold it lightly and still";
  from = sample_.turns[axis];
  const double most_Nm = kMostShare * arm_.axes[static_cast<std::size_t>(axis)].torque_max_Nm;
  for (int ms = 1; ms <= kGrow_ms; ++ms) {
    command.torque_Nm[axis] = most_Nm * ms / kGrow_ms;
    step(command);
    if ((sample_.flags & (DeviceFlag::kError | DeviceFlag::kStopButton)) != 0)
      return fmt::format("its drives report error {:#x}", sample_.error_code);
    if (moved_m(axis, from) > kMoved_m) return "";
    if (moved_m(axis, from) < -kMoved_m)
      return "pushes against its own count: the leads of motor or encoder are swapped. Force would push the hand the "
             "wrong way; calibrate the drive again";
  }
  return fmt::format("does not move with {:.0f} % of its torque: held, blocked, too stiff, or no motor",
                     100 * kMostShare);
}

std::vector<DoctorItem> PushCheck::run() {
  std::vector<DoctorItem> rows;
  std::string wrong = enable();
  if (!wrong.empty()) rows.push_back({"motors", Verdict::kFail, wrong, ""});
  for (int i = 0; i < joint_count(arm_.linkage) && wrong.empty(); ++i) {
    const AxisProfile& axis = arm_.axes[static_cast<std::size_t>(i)];
    if (!(axis.torque_max_Nm > 0)) continue;
    wrong = push(i);
    rows.push_back({fmt::format("motor of axis {} (node {:.0f})", i + 1, axis.node),
                    wrong.empty() ? Verdict::kPass : Verdict::kFail,
                    wrong.empty() ? "pushes the way its encoder counts" : wrong, ""});
  }
  constexpr int kOff = 10;  // set-up frames of six axes
  for (int n = 0; n < kOff; ++n) step({});
  return rows;
}

}  // namespace palpate
