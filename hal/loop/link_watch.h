// Proves every tick that commands reach the device, and makes the enable edge that it asks for.
//
// A node echoes the number of the newest command it obeys. While that stays behind for longer than the node's own
// watchdog allows, or while the node says that it let go (DeviceFlag::kWatchdog), what is computed here reaches no
// hand: force ramps out (Command::kUnheard), the drives are disabled for a few commands once it is zero, and enabled
// again when the device hears: the edge 0 -> 1 without which a node stays at zero force. Then force ramps in as after
// arming.
//   kClosed  not armed: drives disabled
//   kOpen    armed: enabled;  deaf or refused ---> kLettingGo
//   kLettingGo  enabled, force ramps out;  zero -> kResting
//   kResting    disabled;  heard for rest_ticks -> kOpen
#pragma once

#include <cstdint>

#include "hal/device/device.h"

namespace palpate {

// A node without a valid new command for this long renders zero force until it is enabled anew.
inline constexpr double kNodeWatchdog_s = 0.02;

struct LinkLimits {
  // Commands the echo may lag behind: the node's watchdog at 1 kHz. Below it the node still holds the last force and a
  // late command changes little; beyond it the node has let go. At most 40: the classic profile's echo has 6 bits.
  std::uint32_t lag_ticks = 20;
  std::uint32_t fault_ticks = 50;  // so long behind while armed: Fault::kDeviceDeaf
  std::uint32_t rest_ticks = 5;    // disabled commands before the edge, so that one lost frame does not matter
};

class LinkWatch {
 public:
  explicit LinkWatch(const LinkLimits& limits) noexcept : limits_(limits) {}

  // After every receive.
  void look(const DeviceSample& sample) noexcept {
    if (!sample.fresh) return;  // silence is judged elsewhere
    lag_ticks_ = sample.command_lag;
    late_ = lag_ticks_ > limits_.lag_ticks;
    heard_ticks_ = late_ ? 0 : heard_ticks_ + 1;
    proven_ = proven_ || heard_ticks_ > limits_.rest_ticks;
    if (state_ != State::kOpen) return;
    open_ticks_ += 1;
    const bool let_go = (sample.flags & DeviceFlag::kWatchdog) != 0;
    const bool refused = let_go && (obeyed_ || open_ticks_ > limits_.lag_ticks);
    obeyed_ = obeyed_ || !let_go;
    if (obeyed_ && !let_go) refusals_ = 0;
    if (!late_ && !refused) return;
    refusals_ += refused && !obeyed_ ? 1 : 0;
    state_ = State::kLettingGo;
    drops_ += 1;
  }

  // Once a tick, after the controller: whether this command enables the drives. `armed`: it renders or ramps; `zero`:
  // its force is zero.
  bool enable(bool armed, bool zero) noexcept {
    late_run_ = late_ && armed ? late_run_ + 1 : 0;
    if (!armed && zero) {
      state_ = State::kClosed;
      refusals_ = 0;
    } else if (state_ == State::kClosed) {
      open();
    } else if (state_ == State::kLettingGo && zero) {
      state_ = State::kResting;
      rested_ticks_ = 0;
    } else if (state_ == State::kResting && !late_ && ++rested_ticks_ >= limits_.rest_ticks) {
      open();
    }
    return state_ == State::kOpen || state_ == State::kLettingGo;
  }

  // The device has heard this controller, and enough disabled commands of it for an edge: it may be armed.
  bool proven() const noexcept { return proven_; }
  bool unheard() const noexcept { return late_ || state_ == State::kLettingGo || state_ == State::kResting; }
  bool fault() const noexcept { return late_run_ >= limits_.fault_ticks || refusals_ >= kMostRefusals; }
  std::uint32_t lag_ticks() const noexcept { return lag_ticks_; }
  std::uint32_t drops() const noexcept { return drops_; }  // times force was let go

 private:
  enum class State : int { kClosed = 0, kOpen, kLettingGo, kResting };
  static constexpr std::uint32_t kMostRefusals = 3;  // edges offered in vain: it will not
  void open() noexcept {
    state_ = State::kOpen;
    open_ticks_ = 0;
    obeyed_ = false;
  }

  LinkLimits limits_;
  State state_ = State::kClosed;
  std::uint32_t lag_ticks_ = 0, heard_ticks_ = 0, late_run_ = 0, open_ticks_ = 0, rested_ticks_ = 0, refusals_ = 0,
                drops_ = 0;
  bool late_ = false, proven_ = false;
  bool obeyed_ = false;  // since it was opened, the node has cleared its watchdog flag
};

}  // namespace palpate
