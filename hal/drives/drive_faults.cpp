#include "hal/drives/drive_faults.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {

DriveFaults::DriveFaults(Transport& inner, std::vector<FaultLine> lines, double period_s)
    : inner_(inner), lines_(std::move(lines)), period_s_(period_s) {}

std::string DriveFaults::refuse(const std::vector<FaultLine>& lines) {
  constexpr DeviceFault kOfDrives[] = {DeviceFault::kLose, DeviceFault::kSilence, DeviceFault::kMiss,
                                       DeviceFault::kDeaf, DeviceFault::kFreeze,  DeviceFault::kJump};
  for (const FaultLine& line : lines)
    if (std::ranges::find(kOfDrives, line.fault) == std::end(kOfDrives))
      return "simulated drives know of lose, silence, miss, deaf, freeze and jump alone; leave the other lines out";
  return "";
}

std::uint64_t DriveFaults::after(double seconds) const noexcept {
  return tick_ + static_cast<std::uint64_t>(std::llround(seconds / period_s_));
}

void DriveFaults::begin(const FaultLine& line, DriveSim& drives) {
  switch (line.fault) {
    case DeviceFault::kLose:  // whole sets of positions
      mute_until_ = tick_ + static_cast<std::uint64_t>(line.value);
      return;
    case DeviceFault::kSilence:
      mute_until_ = after(line.value);
      return;
    case DeviceFault::kMiss:
      deaf_until_ = tick_ + static_cast<std::uint64_t>(line.value);
      return;
    case DeviceFault::kDeaf:
      deaf_until_ = after(line.value);
      return;
    case DeviceFault::kFreeze:
      frozen_until_ = after(line.value);
      return drives.plant().freeze_encoders(true);
    case DeviceFault::kJump:
      return drives.plant().shift_handle({1e-3 * line.value, 0, 0});
    default:
      return;  // refused before
  }
}

void DriveFaults::advance(DriveSim& drives) {
  if (tick_ == frozen_until_ && tick_ > 0) drives.plant().freeze_encoders(false);
  while (next_ < lines_.size() && lines_[next_].at_s <= (static_cast<double>(tick_) + 1e-6) * period_s_)
    begin(lines_[next_++], drives);
  tick_ += 1;
}

int DriveFaults::send(std::span<const Frame> frames) noexcept {
  return tick_ <= mute_until_ && mute_until_ > 0 ? static_cast<int>(frames.size()) : inner_.send(frames);
}

int DriveFaults::receive(std::span<Frame> frames) noexcept {
  const int count = inner_.receive(frames);
  return tick_ <= deaf_until_ && deaf_until_ > 0 ? 0 : count;
}

}  // namespace palpate
