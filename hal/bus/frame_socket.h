// What SocketCAN and the loopback share: CAN frames as datagrams on a non-blocking socket, in the kernel's own layouts
// (struct can_frame, 16 bytes; struct canfd_frame, 72 bytes). One system call drains a whole tick (recvmmsg).
#pragma once

#include "hal/bus/transport.h"

namespace palpate {

class FrameSocket : public Transport {
 public:
  explicit FrameSocket(int fd) noexcept : fd_(fd) {}  // takes ownership
  ~FrameSocket() override;
  FrameSocket(const FrameSocket&) = delete;
  FrameSocket& operator=(const FrameSocket&) = delete;

  int send(std::span<const Frame> frames) noexcept override;
  int receive(std::span<Frame> frames) noexcept override;
  void accept_remote() noexcept override { remote_ = true; }
  void accept_extended() noexcept override { extended_ = true; }
  void stamp_arrivals() noexcept override;
  TransportState state() const noexcept override { return state_; }
  const TransportCounters& counters() const noexcept override { return counters_; }

 private:
  void take_error_frame(std::uint32_t id) noexcept;
  void take_failure(int error) noexcept;

  int fd_;
  bool remote_ = false, extended_ = false, stamps_ = false;
  TransportState state_ = TransportState::kUp;
  TransportCounters counters_;
  std::uint32_t last_overflow_ = 0;
};

}  // namespace palpate
