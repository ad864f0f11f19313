// The same frames over USB: a vendor-defined HID device with interrupt endpoints and 64-byte reports without report
// numbers. The controller speaks through hidraw, whose read and write neither allocate in user space nor wait on an
// O_NONBLOCK descriptor; libusb allocates at every submit. The device side (a gadget's /dev/hidgN) uses the same class.
//
// Report: byte 0 frame length (0..61), bytes 1-2 identifier (little-endian), then the frame's data, zero to the end.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hal/bus/transport.h"
#include "hal/loop/report_writer.h"

namespace palpate {

inline constexpr int kReportBytes = 64;
inline constexpr int kReportHeaderBytes = 3;
// What the device tells of itself (docs/wire_protocol.md): vendor-defined, 64 bytes in, 64 bytes out, no numbers.
inline constexpr std::uint8_t kReportDescriptor[] = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x15, 0x00,
                                                     0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x40, 0x09, 0x02,
                                                     0x81, 0x02, 0x09, 0x03, 0x91, 0x02, 0xC0};
// hidraw's queue holds 63 reports and then drops the newest: a full drain means reports were lost.
inline constexpr int kHidrawQueue = 63;

enum class UsbSide {
  kController,  // hidraw: a written report starts with its number, 0 for none
  kDevice,      // hidg: plain 64 bytes
};

class UsbHid : public Transport {
 public:
  UsbHid(int fd, UsbSide side) noexcept : fd_(fd), side_(side) {}  // takes ownership of a non-blocking descriptor
  ~UsbHid() override;
  UsbHid(const UsbHid&) = delete;
  UsbHid& operator=(const UsbHid&) = delete;

  // From now on send() hands reports to a thread that waits for the bus in its place. For the controller's side.
  void write_in_background() { writer_ = std::make_unique<ReportWriter>(fd_); }

  int send(std::span<const Frame> frames) noexcept override;
  int receive(std::span<Frame> frames) noexcept override;
  TransportState state() const noexcept override { return state_; }
  const TransportCounters& counters() const noexcept override { return counters_; }

 private:
  void take_failure(int error) noexcept;
  int hand_over(std::span<const Frame> frames) noexcept;

  int fd_;
  UsbSide side_;
  TransportState state_ = TransportState::kUp;
  TransportCounters counters_;
  std::unique_ptr<ReportWriter> writer_;
};

// Opens /dev/hidrawN (controller) or /dev/hidgN (device). Null, with a reason that says what to do, when it is missing,
// not readable, or not a HID device.
std::unique_ptr<Transport> open_usb_hid(const std::string& path, UsbSide side, std::string& error);

}  // namespace palpate
