#include "sim_host/press.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <memory>

#include "rt_core/tick.h"

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

void press(const Model& model, std::span<const TimedPose> poses, State& state, InstructionCounter* counter,
           const PressListener& listen) {
  reset(state);
  const auto scratch = std::make_unique<Scratch>();
  PressRow row;
  std::uint64_t sequence = 0;
  for (const TimedPose& pose : poses) {
    row = {};
    row.time_s = pose.time_s;
    Input input;
    input.drive = Drive::kTool;
    input.pose_w = pose.tool_w;
    input.commands = sequence == 0 ? Command::kArm : 0;
    Output output;
    const auto begin = std::chrono::steady_clock::now();
    if (counter != nullptr) counter->start();
    tick(model, state, *scratch, input, output);
    if (counter != nullptr) row.instructions = counter->stop();
    row.compute_ns = std::chrono::nanoseconds(std::chrono::steady_clock::now() - begin).count();
    fill_record(model, state, input, output, row.record);
    row.record.sequence = ++sequence;
    listen(row, state, *scratch);
  }
}

}  // namespace palpate
