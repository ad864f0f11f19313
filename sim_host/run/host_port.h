// The controller's side of its host: where records go, where commands come from, and what happens when the host falls
// silent or writes garbage. Everything here runs inside the real-time loop: no allocation, no lock, no system call.
#pragma once

#include <atomic>
#include <cstdint>

#include "hal/device/device.h"
#include "hal/system/syscall_filter.h"
#include "rt_core/mailbox.h"
#include "rt_core/telemetry.h"

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

// CommandSource of the loop. Without a host it arms at once and runs until stopped.
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
    const std::uint32_t commands = reader_.connected() ? poll_mailbox() : Command::kArm;
    if (command_.quit != 0 || faults_ != 0) stop_.store(true, std::memory_order_relaxed);
    return commands;
  }
  // What the host last asked of an articulated tool's joints; open without a host.
  const JointCommand& joints() const noexcept { return command_.joints; }
  // Fault bits; they stay for the rest of this controller's life.
  std::uint32_t faults() const noexcept { return faults_; }

 private:
  std::uint32_t poll_mailbox() noexcept {
    const std::uint64_t heartbeat = command_.heartbeat;
    if (reader_.poll(command_) == MailboxResult::kInvalid) faults_ |= Fault::kCommandInvalid;
    silent_ticks_ = command_.heartbeat != heartbeat ? 0 : silent_ticks_ + 1;
    if (silent_ticks_ >= silence_ticks_) faults_ |= Fault::kHostSilent;
    return command_.commands;
  }

  MailboxReader reader_;
  HostCommand command_;
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
