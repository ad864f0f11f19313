#include "sim_host/press/press.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <memory>

#include "rt_core/contact/contact.h"
#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"

namespace palpate {

InstructionCounter::InstructionCounter() {
  perf_event_attr attributes{};
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof attributes;
  attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
  attributes.disabled = 1;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  fd_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
}

InstructionCounter::~InstructionCounter() {
  if (fd_ >= 0) close(fd_);
}

void InstructionCounter::start() {
  if (fd_ < 0) return;
  ioctl(fd_, PERF_EVENT_IOC_RESET, 0);
  ioctl(fd_, PERF_EVENT_IOC_ENABLE, 0);
}

std::int64_t InstructionCounter::stop() {
  if (fd_ < 0) return -1;
  ioctl(fd_, PERF_EVENT_IOC_DISABLE, 0);
  std::int64_t count = 0;
  return read(fd_, &count, sizeof count) == static_cast<ssize_t>(sizeof count) ? count : -1;
}

namespace {

// Solves (K + h I) x = b for the symmetric 3x3 force block K of the contact's 6x6 stiffness, by Cramer's rule; h > 0
// keeps it regular.
Vec3 solve_with_hand(const double (&stiffness)[36], double h, Vec3 b) {
  const Vec3 c0{stiffness[0] + h, stiffness[6], stiffness[12]};
  const Vec3 c1{stiffness[1], stiffness[7] + h, stiffness[13]};
  const Vec3 c2{stiffness[2], stiffness[8], stiffness[14] + h};
  const double determinant = dot(c0, cross(c1, c2));
  if (!(determinant > 1e-9 * h * h * h)) return (1 / h) * b;
  return (1 / determinant) * Vec3{dot(b, cross(c1, c2)), dot(c0, cross(b, c2)), dot(c0, cross(c1, b))};
}

// The scene as a hand's spring holds its tool, without the limits of a device.
Model held_by_hand(const Model& model, double hand_N_per_m) {
  Model held = model;
  held.params.coupling_N_per_m = hand_N_per_m;
  held.params.coupling_Nm_per_rad = 1e4;  // the stiffest there is: orientation as given
  return held;
}

}  // namespace

void press(const Model& model, std::span<const TimedPose> poses, const PressDrive& drive, State& state,
           InstructionCounter* counter, const PressListener& listen) {
  reset(state);
  const ScratchPtr scratch = make_scratch(model);
  PressRow row;
  std::uint64_t sequence = 0;
  Output output;
  // A nodal body's tick finds pushes, friction and the tool's place in one problem. One Newton step per tick outside of
  // it would throw a slipping tool, which has no mass, from one sense of sliding to the other for ever.
  const bool held_in_tick = drive.hand_N_per_m > 0 && method_of(model) == Method::kNodes;
  const Model held = held_in_tick ? held_by_hand(model, drive.hand_N_per_m) : model;
  for (const TimedPose& pose : poses) {
    row = {};
    row.time_s = pose.time_s;
    Input input;
    input.drive = held_in_tick ? Drive::kHeld : Drive::kTool;
    input.pose_w = pose.tool_w;
    input.joints = pose.joints;
    if (drive.hand_N_per_m > 0 && !held_in_tick && sequence > 0) {
      const Vec3 from = state.tool_w.position_m;
      const Vec3 pull = drive.hand_N_per_m * (pose.tool_w.position_m - from) + output.contact_w.force_N;
      input.pose_w.position_m = from + solve_with_hand(state.contact_stiffness, drive.hand_N_per_m, pull);
    }
    const auto begin = std::chrono::steady_clock::now();
    if (counter != nullptr) counter->start();
    tick(held, state, *scratch, input, output);
    if (counter != nullptr) row.instructions = counter->stop();
    row.compute_ns = std::chrono::nanoseconds(std::chrono::steady_clock::now() - begin).count();
    fill_record(state, input, output, row.record);
    row.record.sequence = ++sequence;
    listen(row, state, *scratch);
  }
}

}  // namespace palpate
