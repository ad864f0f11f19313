#include "hal/bus/frame_socket.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace palpate {
namespace {

constexpr std::size_t kControlBytes = CMSG_SPACE(sizeof(std::uint32_t)) + CMSG_SPACE(sizeof(timespec));

// Number of frames the kernel dropped on this socket since it was opened (SO_RXQ_OVFL), or `last` if not told.
std::uint32_t overflow_of(msghdr& header, std::uint32_t last) noexcept {
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) std::memcpy(&last, CMSG_DATA(c), sizeof last);
  }
  return last;
}

std::int64_t nanoseconds(const timespec& time) noexcept {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// Since the kernel took the frame (SO_TIMESTAMPNS), by the clock of its stamps; -1 without one. That clock can be set:
// what lies in the future or more than a second back is no age.
std::int64_t age_of(msghdr& header, std::int64_t now_ns) noexcept {
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp;
    std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
    const std::int64_t age_ns = now_ns - nanoseconds(stamp);
    return age_ns >= 0 && age_ns < 1'000'000'000 ? age_ns : -1;
  }
  return -1;
}

}  // namespace

FrameSocket::~FrameSocket() {
  if (fd_ >= 0) ::close(fd_);
}

void FrameSocket::stamp_arrivals() noexcept {
  const int on = 1;
  stamps_ = ::setsockopt(fd_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) == 0;
}

void FrameSocket::take_failure(int error) noexcept {
  if (error == EAGAIN || error == EWOULDBLOCK || error == EINTR) return;
  if (error == ENETDOWN || error == ENODEV || error == ENXIO || error == ECONNRESET || error == EPIPE) {
    if (state_ == TransportState::kUp) state_ = TransportState::kDown;
    return;
  }
  counters_.failures += 1;
}

// Bus-off is kept until the transport is opened again: a force device must not come back by itself.
void FrameSocket::take_error_frame(std::uint32_t id) noexcept {
  counters_.error_frames += 1;
  if ((id & CAN_ERR_BUSOFF) != 0) state_ = TransportState::kBusOff;
}

int FrameSocket::send(std::span<const Frame> frames) noexcept {
  constexpr std::size_t kMost = 4;
  canfd_frame wire[kMost];
  iovec io[kMost];
  mmsghdr message[kMost];
  const std::size_t count = std::min(frames.size(), kMost);
  std::memset(wire, 0, sizeof wire);
  std::memset(message, 0, sizeof message);
  for (std::size_t i = 0; i < count; ++i) {
    const Frame& frame = frames[i];
    wire[i].can_id = frame.id | (frame.remote ? CAN_RTR_FLAG : 0) | (frame.id > CAN_SFF_MASK ? CAN_EFF_FLAG : 0);
    wire[i].len = std::min<std::uint8_t>(frame.length, frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN);
    wire[i].flags = frame.fd ? CANFD_BRS : 0;
    std::memcpy(wire[i].data, frame.data, wire[i].len);
    // A classic frame is the first 16 bytes of the same layout.
    io[i] = {&wire[i], static_cast<std::size_t>(frame.fd ? CANFD_MTU : CAN_MTU)};
    message[i].msg_hdr.msg_iov = &io[i];
    message[i].msg_hdr.msg_iovlen = 1;
  }
  const int taken = ::sendmmsg(fd_, message, static_cast<unsigned>(count), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (taken < 0) take_failure(errno == ENOBUFS ? EAGAIN : errno);  // full queue: the frame is dropped and counted
  const std::size_t sent = taken > 0 ? static_cast<std::size_t>(taken) : 0;
  counters_.sent += sent;
  counters_.send_dropped += frames.size() - sent;
  return static_cast<int>(sent);
}

int FrameSocket::receive(std::span<Frame> frames) noexcept {
  canfd_frame wire[kMaxFramesPerReceive];
  iovec io[kMaxFramesPerReceive];
  mmsghdr message[kMaxFramesPerReceive];
  alignas(cmsghdr) char control[kMaxFramesPerReceive][kControlBytes];
  const std::size_t most = std::min(frames.size(), std::size_t{kMaxFramesPerReceive});
  std::memset(message, 0, most * sizeof(mmsghdr));
  for (std::size_t i = 0; i < most; ++i) {
    io[i] = {&wire[i], sizeof wire[i]};
    message[i].msg_hdr.msg_iov = &io[i];
    message[i].msg_hdr.msg_iovlen = 1;
    message[i].msg_hdr.msg_control = control[i];
    message[i].msg_hdr.msg_controllen = kControlBytes;
  }
  const int arrived = ::recvmmsg(fd_, message, static_cast<unsigned>(most), MSG_DONTWAIT, nullptr);
  if (arrived < 0) take_failure(errno);
  timespec now{};
  if (stamps_ && arrived > 0) ::clock_gettime(CLOCK_REALTIME, &now);
  std::size_t kept = 0;
  for (int i = 0; i < arrived; ++i) {
    const unsigned bytes = message[i].msg_len;
    if (bytes == 0) {  // only a closed stream of records gives an empty one
      if (state_ == TransportState::kUp) state_ = TransportState::kDown;
      break;
    }
    const std::uint32_t overflow = overflow_of(message[i].msg_hdr, last_overflow_);
    counters_.overflow += overflow - last_overflow_;
    last_overflow_ = overflow;
    const canfd_frame& in = wire[i];
    const bool fd = bytes == CANFD_MTU;
    if (!(fd || bytes == CAN_MTU) || in.len > (fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN)) {
      counters_.malformed += 1;
    } else if ((in.can_id & CAN_ERR_FLAG) != 0) {
      take_error_frame(in.can_id);
    } else if (((in.can_id & CAN_EFF_FLAG) != 0 && !extended_) ||
               ((in.can_id & CAN_RTR_FLAG) != 0 && (!remote_ || fd))) {
      counters_.malformed += 1;
    } else {
      Frame& out = frames[kept++];
      out.id = in.can_id & (extended_ ? CAN_EFF_MASK : CAN_SFF_MASK);
      out.remote = (in.can_id & CAN_RTR_FLAG) != 0;
      out.length = in.len;
      out.fd = fd;
      out.age_ns = stamps_ ? age_of(message[i].msg_hdr, nanoseconds(now)) : -1;
      std::memcpy(out.data, in.data, in.len);
    }
  }
  counters_.received += kept;
  return static_cast<int>(kept);
}

}  // namespace palpate
