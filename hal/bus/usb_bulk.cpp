#include "hal/bus/usb_bulk.h"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace palpate {

namespace {

static_assert(sizeof(usbdevfs_urb) == 56 && alignof(usbdevfs_urb) == 8);
usbdevfs_urb& urb_in(std::byte* place) noexcept { return *reinterpret_cast<usbdevfs_urb*>(place); }

}  // namespace

namespace usb {

Frame control_frame(std::uint8_t request, std::uint16_t value, std::uint16_t index, int answer_bytes) noexcept {
  constexpr std::uint8_t kVendorOut = 0x40, kVendorIn = 0xC0;
  Frame frame{.id = kControl, .length = 8, .fd = true};
  frame.data[0] = answer_bytes > 0 ? kVendorIn : kVendorOut;
  frame.data[1] = request;
  std::memcpy(frame.data + 2, &value, 2);
  std::memcpy(frame.data + 4, &index, 2);
  frame.data[6] = static_cast<std::uint8_t>(answer_bytes);
  return frame;
}

}  // namespace usb

UsbBulk::UsbBulk(int fd) : fd_(fd) {
  for (Request& request : reads_) submit(request, usb::kIn, usb::kPacketBytes);
}

UsbBulk::~UsbBulk() {
  for (Request* group : {reads_, writes_})
    for (int i = 0; i < (group == reads_ ? kReads : kWrites); ++i)
      if (group[i].pending) ::ioctl(fd_, USBDEVFS_DISCARDURB, group[i].urb);
  ::close(fd_);
}

void UsbBulk::take_failure(int error) noexcept {
  if (error == 0 || error == EAGAIN) return;
  if (error == ENODEV || error == ESHUTDOWN || error == EPROTO || error == EILSEQ || error == ENOENT) {
    state_ = TransportState::kDown;  // unplugged
    return;
  }
  counters_.failures += 1;
}

bool UsbBulk::submit(Request& request, unsigned endpoint, int bytes) noexcept {
  std::memset(request.urb, 0, sizeof request.urb);
  usbdevfs_urb& urb = urb_in(request.urb);
  urb.type = USBDEVFS_URB_TYPE_BULK;
  urb.endpoint = static_cast<unsigned char>(endpoint);
  urb.buffer = request.data;
  urb.buffer_length = bytes;
  request.pending = ::ioctl(fd_, USBDEVFS_SUBMITURB, &urb) == 0;
  if (!request.pending) take_failure(errno);
  return request.pending;
}

bool UsbBulk::write(const Frame& frame) noexcept {
  for (Request& request : writes_) {
    if (request.pending) continue;
    std::memcpy(request.data, frame.data, frame.length);
    return submit(request, usb::kOut, frame.length);
  }
  return false;
}

// Waits up to a second: before the loop only.
bool UsbBulk::control(const Frame& frame) {
  constexpr unsigned kWait_ms = 1000;
  Frame answer{.id = usb::kControlAnswer, .fd = true};
  usbdevfs_ctrltransfer transfer{};
  transfer.bRequestType = frame.data[0];
  transfer.bRequest = frame.data[1];
  std::memcpy(&transfer.wValue, frame.data + 2, 2);
  std::memcpy(&transfer.wIndex, frame.data + 4, 2);
  transfer.wLength = std::min<std::uint16_t>(frame.data[6], usb::kPacketBytes);
  transfer.timeout = kWait_ms;
  transfer.data = answer.data;
  const int bytes = ::ioctl(fd_, USBDEVFS_CONTROL, &transfer);
  if (bytes < 0) return take_failure(errno), false;
  answer.length = static_cast<std::uint8_t>(bytes);
  if (transfer.wLength > 0) answers_.push_back(answer);
  return true;
}

int UsbBulk::send(std::span<const Frame> frames) noexcept {
  int sent = 0;
  for (const Frame& frame : frames) {  // bound: kWrites, of which none is kept
    const bool taken = frame.length > usb::kPacketBytes ? false
                       : frame.id == usb::kControl      ? control(frame)
                                                        : write(frame);
    if (!taken) break;
    ++sent;
  }
  counters_.sent += static_cast<std::uint64_t>(sent);
  counters_.send_dropped += frames.size() - static_cast<std::size_t>(sent);
  return sent;
}

int UsbBulk::receive(std::span<Frame> frames) noexcept {
  std::size_t kept = 0;
  for (; kept < frames.size() && !answers_.empty(); answers_.pop_front()) frames[kept++] = answers_.front();
  for (int i = 0; i < kReads + kWrites && kept < frames.size(); ++i) {  // at most so many are in flight
    usbdevfs_urb* done = nullptr;
    if (::ioctl(fd_, USBDEVFS_REAPURBNDELAY, &done) != 0) {
      take_failure(errno);
      break;
    }
    const auto place =
        std::find_if(std::begin(reads_), std::end(reads_), [&](Request& r) { return &urb_in(r.urb) == done; });
    if (place == std::end(reads_)) {
      for (Request& request : writes_) request.pending = request.pending && &urb_in(request.urb) != done;
      take_failure(-done->status);
      continue;
    }
    if (done->status == 0) {
      Frame& frame = frames[kept++];
      frame = {.id = usb::kIn, .fd = true};
      frame.length = static_cast<std::uint8_t>(std::clamp(done->actual_length, 0, usb::kPacketBytes));
      std::memcpy(frame.data, place->data, frame.length);
    }
    take_failure(-done->status);
    place->pending = false;
    if (state_ == TransportState::kUp) submit(*place, usb::kIn, usb::kPacketBytes);
  }
  counters_.received += kept;
  return static_cast<int>(kept);
}

namespace {

// "" or why it is another device: its descriptor begins what usbfs reads as the file.
std::string refuse(int fd, const std::string& path, std::uint16_t vendor, std::uint16_t product) {
  std::uint8_t descriptor[18] = {};
  if (::read(fd, descriptor, sizeof descriptor) != static_cast<ssize_t>(sizeof descriptor))
    return path + " is no USB device: give a /dev/bus/usb/BUS/DEVICE, as 'palpate doctor --device' tells it";
  const auto word = [&](int at) { return static_cast<unsigned>(descriptor[at] | descriptor[at + 1] << 8); };
  if (word(8) == vendor && word(10) == product) return "";
  char text[96];
  std::snprintf(text, sizeof text, " is the USB device %04x:%04x, the profile's is %04x:%04x", word(8), word(10),
                static_cast<unsigned>(vendor), static_cast<unsigned>(product));
  return path + text;
}

}  // namespace

std::unique_ptr<Transport> open_usb_bulk(const std::string& path, std::uint16_t vendor, std::uint16_t product,
                                         std::string& error) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) {
    error = "cannot open " + path + ": " + std::strerror(errno);
    if (errno == EACCES)
      error += "; copy hal/system/70-palpate.rules to /etc/udev/rules.d and plug the device in again";
    if (errno == ENOENT) error += "; is the device plugged in? 'palpate doctor --device' tells its address";
    return nullptr;
  }
  error = refuse(fd, path, vendor, product);
  usbdevfs_disconnect_claim claim{};  // from the serial driver that may have taken it
  if (error.empty() && ::ioctl(fd, USBDEVFS_DISCONNECT_CLAIM, &claim) != 0)
    error = "cannot claim " + path + ": " + std::strerror(errno) + "; does another program use the device?";
  if (error.empty()) return std::make_unique<UsbBulk>(fd);
  ::close(fd);
  return nullptr;
}

}  // namespace palpate
