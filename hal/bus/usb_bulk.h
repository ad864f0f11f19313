// A USB device with one bulk endpoint each way, as frames: for devices that are no HID device. A frame's identifier is
// the endpoint it goes through. The controller speaks through usbfs with requests of its own that stand ready, because
// libusb allocates at every submit; two kinds of ioctl are all the loop makes. The simulated device's side is
// FunctionFS (usb_function.h); on the loopback the same frames go over a socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "hal/bus/transport.h"

namespace palpate {

namespace usb {
inline constexpr std::uint32_t kControl = 0x00;        // 8 bytes of a set-up packet; start-up only: it waits
inline constexpr std::uint32_t kControlAnswer = 0x80;  // what the device answers where the set-up packet asks
inline constexpr std::uint32_t kIn = 0x81, kOut = 0x02;
inline constexpr int kPacketBytes = 64;  // of a full-speed bulk endpoint

// Set-up packet of a vendor's request without data, or of one that asks for `answer_bytes`.
Frame control_frame(std::uint8_t request, std::uint16_t value, std::uint16_t index, int answer_bytes = 0) noexcept;
}  // namespace usb

class UsbBulk : public Transport {
 public:
  explicit UsbBulk(int fd);  // takes ownership of a usbfs descriptor whose interface 0 is claimed
  ~UsbBulk() override;
  UsbBulk(const UsbBulk&) = delete;
  UsbBulk& operator=(const UsbBulk&) = delete;

  int send(std::span<const Frame> frames) noexcept override;
  int receive(std::span<Frame> frames) noexcept override;
  TransportState state() const noexcept override { return state_; }
  const TransportCounters& counters() const noexcept override { return counters_; }

 private:
  // Packets in flight: a device that sends one in 1 ms leaves room for 8 ms in which nobody reads, one that is sent as
  // many for 4; what is beyond these is dropped, never kept.
  static constexpr int kReads = 8, kWrites = 4;
  // One packet and the kernel's usbdevfs_urb, which is no member because its end is open.
  struct Request {
    alignas(8) std::byte urb[56];
    std::uint8_t data[usb::kPacketBytes];
    bool pending;
  };
  bool submit(Request& request, unsigned endpoint, int bytes) noexcept;
  bool write(const Frame& frame) noexcept;
  bool control(const Frame& frame);
  void take_failure(int error) noexcept;

  int fd_;
  Request reads_[kReads] = {}, writes_[kWrites] = {};
  std::deque<Frame> answers_;
  TransportState state_ = TransportState::kUp;
  TransportCounters counters_;
};

// Opens /dev/bus/usb/BUS/DEVICE of that maker's product and takes its interface from whichever driver has it. Null,
// with a reason that says what to do.
std::unique_ptr<Transport> open_usb_bulk(const std::string& path, std::uint16_t vendor, std::uint16_t product,
                                         std::string& error);

}  // namespace palpate
