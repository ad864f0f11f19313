// The controller's side of its host: where records go, where commands come from, and what happens when the host falls
// silent or writes garbage. Everything here runs inside the real-time loop: no allocation, no lock, no system call.
#pragma once

#include <atomic>
#include <cstdint>

#include "hal/device/device.h"
#include "hal/system/syscall_filter.h"
#include "sim_host/rings/mailbox.h"
#include "sim_host/rings/telemetry.h"

namespace palpate {

// RecordSink of the loop.
class TelemetrySink {
 public:
  explicit TelemetrySink(TelemetryWriter* writer) noexcept : writer_(writer) {}  // null: nobody listens
  void publish(const TickRecord& record) noexcept {
    if (writer_ != nullptr) writer_->write(record);
  }

 private:
  TelemetryWriter* writer_;
};

// CommandSource of the loop. Without a host it runs until stopped, and arms only on an operator's signal.
class HostPort {
 public:
  // `stop` is set when the host asks to quit or has died, after a forbidden system call, and with `interrupted` (set by
  // a signal handler). `silence_ticks`: so long without a heartbeat is death.
  HostPort(const MailboxRegion* mailbox, std::uint32_t silence_ticks, const std::atomic<bool>& interrupted,
           std::atomic<bool>& stop) noexcept
      : reader_(mailbox != nullptr ? MailboxReader(*mailbox) : MailboxReader()),
        silence_ticks_(silence_ticks),
        interrupted_(interrupted),
        stop_(stop) {}

  std::uint32_t poll() noexcept {
    // Relaxed, here and below: flags polled every tick, nothing else is published through them.
    if (interrupted_.load(std::memory_order_relaxed)) stop_.store(true, std::memory_order_relaxed);
    if (forbidden_syscall() >= 0) faults_ |= Fault::kForbiddenCall;
    const std::uint32_t commands = reader_.connected() ? poll_mailbox() : poll_operator();
    if (command_.quit != 0 || faults_ != 0) stop_.store(true, std::memory_order_relaxed);
    return commands;
  }
  // Without a host: counts the operator's requests to arm. Must outlive this.
  void arm_on(const std::atomic<std::uint32_t>& requests) noexcept { arm_requests_ = &requests; }
  // From another thread: the host has ended. A fault at once, without waiting for its silence.
  void host_has_died() noexcept { host_died_.store(true, std::memory_order_relaxed); }
  // What the host last asked of an articulated tool's joints; open without a host.
  const JointCommand& joints() const noexcept { return command_.joints; }
  // What it last asked of the live settings; as they were baked without a host.
  const LiveSettings& live() const noexcept { return command_.live; }
  // Which of the announced scenes it wants; 0: the one the run began with.
  std::uint64_t scene() const noexcept { return command_.scene; }
  // Fault bits; they stay for the rest of this controller's life.
  std::uint32_t faults() const noexcept { return faults_; }

 private:
  std::uint32_t poll_mailbox() noexcept {
    const std::uint64_t heartbeat = command_.heartbeat;
    if (reader_.poll(command_) == MailboxResult::kInvalid) faults_ |= Fault::kCommandInvalid;
    silent_ticks_ = command_.heartbeat != heartbeat ? 0 : silent_ticks_ + 1;
    const bool died = host_died_.load(std::memory_order_relaxed);
    if (silent_ticks_ >= silence_ticks_ || died) faults_ |= Fault::kHostSilent;
    return command_.commands;
  }

  // Arming is an edge, ignored by a tick without a fresh sample: each request offers some edges.
  std::uint32_t poll_operator() noexcept {
    constexpr std::uint32_t kOffers = 200;
    if (arm_requests_ == nullptr) return 0;
    const std::uint32_t requests = arm_requests_->load(std::memory_order_relaxed);
    if (requests != arm_requests_seen_) arm_offers_ = kOffers;
    arm_requests_seen_ = requests;
    if (arm_offers_ == 0) return 0;
    arm_offers_ -= 1;
    return arm_offers_ % 2 != 0 ? Command::kArm : 0;
  }

  MailboxReader reader_;
  HostCommand command_;
  const std::atomic<std::uint32_t>* arm_requests_ = nullptr;
  std::uint32_t arm_requests_seen_ = 0, arm_offers_ = 0;
  std::atomic<bool> host_died_{false};
  std::uint32_t silence_ticks_;
  std::uint32_t silent_ticks_ = 0;
  std::uint32_t faults_ = 0;
  const std::atomic<bool>& interrupted_;
  std::atomic<bool>& stop_;
};

// A device whose samples also carry the host's faults, so that they latch and ramp down like any other.
template <Device D>
class SupervisedDevice {
 public:
  SupervisedDevice(D& device, const HostPort& host) noexcept : device_(device), host_(host) {}
  void receive(DeviceSample& sample) noexcept {
    device_.receive(sample);
    sample.faults |= host_.faults();
  }
  bool transmit(const DeviceCommand& command) noexcept { return device_.transmit(command); }

 private:
  D& device_;
  const HostPort& host_;
};

}  // namespace palpate
