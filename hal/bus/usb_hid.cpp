#include "hal/bus/usb_hid.h"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace palpate {

namespace {

// A frame of more than kReportBytes - kReportHeaderBytes does not fit; the protocol's longest is 48 bytes.
void pack(const Frame& frame, std::uint8_t (&report)[kReportBytes]) noexcept {
  const std::size_t length = std::min<std::size_t>(frame.length, kReportBytes - kReportHeaderBytes);
  std::memset(report, 0, sizeof report);
  report[0] = static_cast<std::uint8_t>(length);
  report[1] = static_cast<std::uint8_t>(frame.id & 0xFF);
  report[2] = static_cast<std::uint8_t>(frame.id >> 8 & 0xFF);
  std::memcpy(report + kReportHeaderBytes, frame.data, length);
}

bool unpack(const std::uint8_t (&report)[kReportBytes], Frame& frame) noexcept {
  if (report[0] > kReportBytes - kReportHeaderBytes) return false;
  frame.length = report[0];
  frame.id = static_cast<std::uint32_t>(report[1]) | static_cast<std::uint32_t>(report[2]) << 8;
  frame.fd = frame.length > 8;
  std::memcpy(frame.data, report + kReportHeaderBytes, frame.length);
  return true;
}

}  // namespace

UsbHid::~UsbHid() {
  writer_.reset();  // it writes to fd_
  if (fd_ >= 0) ::close(fd_);
}

void UsbHid::take_failure(int error) noexcept {
  if (error == 0 || error == EAGAIN || error == EWOULDBLOCK || error == EINTR) return;
  if (error == ENODEV || error == EIO || error == ESHUTDOWN || error == EPIPE || error == ECONNRESET) {
    state_ = TransportState::kDown;  // unplugged
    return;
  }
  counters_.failures += 1;
}

int UsbHid::hand_over(std::span<const Frame> frames) noexcept {
  static_assert(sizeof(ReportWriter::Report) == 1 + kReportBytes);
  take_failure(writer_->take_error());
  ReportWriter::Report reports[ReportWriter::kMostReports] = {};  // each begins with the number 0: none
  const auto count = std::min(frames.size(), static_cast<std::size_t>(ReportWriter::kMostReports));
  for (std::size_t i = 0; i < count; ++i)
    pack(frames[i], reinterpret_cast<std::uint8_t(&)[kReportBytes]>(reports[i][1]));
  const bool free = writer_->put(reports, static_cast<int>(count));
  if (!free) counters_.send_dropped += count;  // the ones before: the bus did not take them in time
  counters_.sent += count;
  return free && state_ == TransportState::kUp ? static_cast<int>(count) : 0;
}

int UsbHid::send(std::span<const Frame> frames) noexcept {
  if (writer_) return hand_over(frames);
  int sent = 0;
  for (const Frame& frame : frames) {  // bound: 2 frames a tick
    std::uint8_t report[1 + kReportBytes] = {};
    pack(frame, reinterpret_cast<std::uint8_t(&)[kReportBytes]>(report[1]));
    const bool numbered = side_ == UsbSide::kController;
    const std::size_t bytes = numbered ? 1 + kReportBytes : kReportBytes;
    if (::write(fd_, numbered ? report : report + 1, bytes) == static_cast<ssize_t>(bytes)) {
      ++sent;
    } else {
      take_failure(errno);
      break;  // the rest is dropped with it: an old command is never sent again
    }
  }
  counters_.sent += static_cast<std::uint64_t>(sent);
  counters_.send_dropped += frames.size() - static_cast<std::size_t>(sent);
  return sent;
}

int UsbHid::receive(std::span<Frame> frames) noexcept {
  const int most = static_cast<int>(std::min(frames.size(), std::size_t{kMaxFramesPerReceive}));
  int kept = 0, reports = 0;
  for (; reports < most; ++reports) {
    std::uint8_t report[kReportBytes];
    const ssize_t bytes = ::read(fd_, report, sizeof report);
    if (bytes < 0) take_failure(errno);
    if (bytes == 0) state_ = TransportState::kDown;
    if (bytes <= 0) break;
    if (bytes != kReportBytes || !unpack(report, frames[static_cast<std::size_t>(kept)])) {
      counters_.malformed += 1;
    } else {
      ++kept;
    }
  }
  if (side_ == UsbSide::kController && reports >= kHidrawQueue) counters_.overflow += 1;
  counters_.received += static_cast<std::uint64_t>(kept);
  return kept;
}

std::unique_ptr<Transport> open_usb_hid(const std::string& path, UsbSide side, std::string& error) {
  const int fd = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) {
    error = "cannot open " + path + ": " + std::strerror(errno);
    if (errno == EACCES)
      error += "; copy hal/system/70-palpate.rules to /etc/udev/rules.d and plug the device in again";
    if (errno == ENOENT) error += "; is the device plugged in? See 'ls /dev/hidraw*'";
    return nullptr;
  }
  hidraw_devinfo info{};
  if (side == UsbSide::kController && ::ioctl(fd, HIDIOCGRAWINFO, &info) != 0) {
    error = path + " is not a HID device: give a /dev/hidrawN";
    ::close(fd);
    return nullptr;
  }
  auto transport = std::make_unique<UsbHid>(fd, side);
  if (side == UsbSide::kController) transport->write_in_background();
  return transport;
}

}  // namespace palpate
