#include "hal/device/fault_player.h"

#include <linux/can.h>
#include <linux/can/error.h>

#include <cmath>

namespace palpate {

FaultPlayer::FaultPlayer(std::vector<FaultLine> lines, DeviceNode& node, FaultSender& sender, Plug& plug)
    : lines_(std::move(lines)), node_(node), sender_(sender), plug_(plug), period_s_(node.plant().options().period_s) {}

std::uint64_t FaultPlayer::after(double seconds) const noexcept {
  return tick_ + static_cast<std::uint64_t>(std::llround(seconds / period_s_));
}

std::int64_t FaultPlayer::period_ns() const noexcept { return std::llround(1e9 * period_s_ / (1 + 1e-6 * drift_ppm_)); }

void FaultPlayer::begin(const FaultLine& line) {
  const int count = static_cast<int>(line.value);
  switch (line.fault) {
    case DeviceFault::kLose:
      return sender_.lose(count);
    case DeviceFault::kDuplicate:
      return sender_.duplicate(count);
    case DeviceFault::kReorder:
      return sender_.reorder(count);
    case DeviceFault::kDelay:
      return sender_.delay(count);
    case DeviceFault::kCorrupt:
      return sender_.corrupt(count);
    case DeviceFault::kFreeze:
      node_.plant().freeze_encoder(true);
      thaw_tick_ = after(line.value);
      return;
    case DeviceFault::kJump:
      return node_.plant().shift_encoder({1e-3 * line.value, 0, 0});
    case DeviceFault::kSequence:
      return node_.reset_sequence();
    case DeviceFault::kRestart:
      node_.set_powered(false);
      power_tick_ = after(line.value);
      return;
    case DeviceFault::kDrift:
      drift_ppm_ = line.value;
      return;
    case DeviceFault::kBusOff: {
      Frame frame;  // as a CAN driver tells it to every socket that asked for error frames
      frame.id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
      frame.length = CAN_ERR_DLC;
      plug_.send({&frame, 1});
      return;
    }
    case DeviceFault::kUnplug:
      plug_.pull();
      replug_tick_ = after(line.value);
      return;
    case DeviceFault::kSilence:
      node_.set_silent(true);
      speak_tick_ = after(line.value);
      return;
    case DeviceFault::kMiss:
      return sender_.miss(count);
    case DeviceFault::kGarble:
      return sender_.garble(count);
    case DeviceFault::kDeaf:
      return sender_.miss(static_cast<int>(std::llround(line.value / period_s_)));
    case DeviceFault::kStop:
      node_.press_stop(true);
      release_tick_ = after(line.value);
      return;
  }
}

void FaultPlayer::end_what_is_over() {
  if (tick_ == thaw_tick_) node_.plant().freeze_encoder(false);
  if (tick_ == power_tick_) node_.set_powered(true);
  if (tick_ == speak_tick_) node_.set_silent(false);
  if (tick_ == release_tick_) node_.press_stop(false);
  if (tick_ == replug_tick_ && tick_ > 0) plug_.put_back();
}

void FaultPlayer::advance() {
  end_what_is_over();
  while (next_ < lines_.size() && lines_[next_].at_s <= (static_cast<double>(tick_) + 1e-6) * period_s_)
    begin(lines_[next_++]);
  tick_ += 1;
}

}  // namespace palpate
