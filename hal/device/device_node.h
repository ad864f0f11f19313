// The device's end of the wire protocol: the simulated plant behind a transport, with the safety a real node must have
// of its own: commands are checked, stale and repeated ones refused, and without fresh ones it renders zero force.
#pragma once

#include <cstdint>

#include "hal/bus/device_bus.h"
#include "hal/bus/transport.h"
#include "hal/device/device_sim.h"
#include "rt_core/io.h"

namespace palpate {

struct NodeOptions {
  WireProfile profile = WireProfile::kFd;
  int node = 1;
  std::int64_t watchdog_ns = 20'000'000;  // without a valid new command: zero force until enabled anew (0 -> 1)
  // Change of force and torque in a millisecond, as a share of the motors' limit: what a lost command, a late one or
  // the watchdog does to the hand. An emergency stop and an error cut at once. The force of a device that evaluates the
  // local model has its slope there (PlantOptions::local_slope_share_per_ms).
  double slew_share_per_ms = 0.1;
};

struct NodeCounters {
  std::uint64_t commands = 0;  // obeyed
  std::uint64_t lost = 0;      // command sequence numbers missing
  std::uint64_t refused = 0;   // duplicates, old ones
  std::uint64_t bad = 0;       // wrong checksum, length or identifier, unpaired half
  std::uint64_t watchdog = 0;  // times the watchdog tripped
  std::uint64_t send_dropped = 0;
};

class DeviceNode {
 public:
  // `transport` must outlive this.
  DeviceNode(Transport& transport, const NodeOptions& options, const PlantOptions& plant, HandPath path);

  // One device period: take the newest valid command, move the plant one period, send a sample. Call it once per
  // PlantOptions::period_s; never waits.
  void step(std::int64_t now_ns) noexcept;

  void press_stop(bool pressed) noexcept { stop_pressed_ = pressed; }  // the device's emergency stop: zero force
  void set_error(std::uint8_t code) noexcept { error_ = code; }        // 0 clears
  // Misbehaviour on purpose: sends nothing; numbers its samples from 0 again; loses power (no force, deaf and mute) and
  // begins anew when it comes back, with numbers, clock and watchdog as at the start.
  void set_silent(bool silent) noexcept { silent_ = silent; }
  void reset_sequence() noexcept { status_sequence_ = 0; }
  void set_powered(bool powered) noexcept;
  DevicePlant& plant() noexcept { return plant_; }
  const NodeCounters& counters() const noexcept { return counters_; }
  const DeviceCommand& command() const noexcept { return command_; }  // being obeyed
  bool latched() const noexcept { return latched_; }                  // zero force until enabled anew
  bool connected() const noexcept { return transport_.state() == TransportState::kUp; }

 private:
  void take(const Frame& frame, std::int64_t now_ns) noexcept;
  void obey(std::uint32_t sequence, const DeviceCommand& command, std::int64_t now_ns) noexcept;
  void render() noexcept;
  void send_status() noexcept;
  std::uint32_t flags() const noexcept;
  std::uint32_t buttons() const noexcept { return plant_.trigger() ? kButtonClose : 0u; }

  Transport& transport_;
  NodeOptions options_;
  DevicePlant plant_;
  SequenceTracker sequence_;
  NodeCounters counters_;
  DeviceCommand command_;
  wire::ClassicForce pending_;
  bool has_pending_ = false;
  bool expired_ = true;  // no valid command (yet, or within the watchdog time)
  bool latched_ = true;  // since power-up or the watchdog, enable has not gone from 0 to 1
  bool enabled_ = true;  // by the newest command; true while latched anew, so that a 0 must come first
  DeviceCommand rendered_;
  std::int64_t last_command_ns_ = 0;
  std::uint32_t status_sequence_ = 0;
  std::uint8_t error_ = 0;
  bool stop_pressed_ = false;
  bool silent_ = false;
  bool powered_ = true;
  double started_s_ = 0;  // plant time at which the device's clock was 0
};

}  // namespace palpate
