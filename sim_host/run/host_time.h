// When the host looks at a run: twenty times a second of the run's own time, real or virtual, or more often where a
// person takes part.
#pragma once

#include <atomic>
#include <chrono>

#include "hal/loop/lockstep.h"

namespace palpate {

// The controller takes 2 s without a heartbeat for the death of its host.
inline constexpr std::chrono::milliseconds kHeartbeatPeriod{50};

class HostTime {
 public:
  virtual ~HostTime() = default;
  // Waits for the next look, the first at once. False: the controller is gone and there will be none.
  virtual bool next() = 0;
  // Of the run, since the first look.
  virtual double elapsed_s() const = 0;
};

class RealHostTime : public HostTime {
 public:
  explicit RealHostTime(std::chrono::milliseconds period = kHeartbeatPeriod) : period_(period) {}
  bool next() override;
  double elapsed_s() const override;

 private:
  std::chrono::milliseconds period_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool first_ = true;
};

// In lock step with the controller: it stands still from the moment next() returns until it is called again.
class VirtualHostTime : public HostTime {
 public:
  // `fd` stays the caller's. `paced`: each look waits until as much real time has passed.
  VirtualHostTime(int fd, bool paced, std::chrono::milliseconds period = kHeartbeatPeriod)
      : turns_(fd, never_), paced_(paced), period_(period) {}
  bool next() override;
  double elapsed_s() const override { return 1e-9 * static_cast<double>(turns_.now_ns()); }

 private:
  std::atomic<bool> never_{false};  // the controller's end is what ends a wait
  FollowerClock turns_;
  bool paced_;
  std::chrono::milliseconds period_;
  std::int64_t look_ns_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace palpate
