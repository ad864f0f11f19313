// Plays a fault script on a simulated device: at the tick a line names, the node, what it sends or its cable
// misbehaves.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/bus/plug.h"
#include "hal/device/device_node.h"
#include "hal/device/fault_script.h"
#include "hal/device/fault_sender.h"

namespace palpate {

class FaultPlayer {
 public:
  // Everything must outlive this. `sender` is what the node sends through, `plug` what that sends through in the end.
  FaultPlayer(std::vector<FaultLine> lines, DeviceNode& node, FaultSender& sender, Plug& plug);

  // Before each step of the node.
  void advance();
  // Length of the device's next period in true time: its nominal period, as its drifting clock measures it.
  std::int64_t period_ns() const noexcept;
  // True while a cable is out that will be put back: no reason for the device to end.
  bool unplugged() const noexcept { return replug_tick_ > 0 && tick_ <= replug_tick_; }

 private:
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};
  void begin(const FaultLine& line);
  void end_what_is_over();
  std::uint64_t after(double seconds) const noexcept;

  std::vector<FaultLine> lines_;
  std::size_t next_ = 0;
  DeviceNode& node_;
  FaultSender& sender_;
  Plug& plug_;
  double period_s_;
  double drift_ppm_ = 0;
  std::uint64_t tick_ = 0;
  std::uint64_t thaw_tick_ = kNever, power_tick_ = kNever, speak_tick_ = kNever, release_tick_ = kNever;
  std::uint64_t replug_tick_ = 0;
};

}  // namespace palpate
