#include "hal/bus/usb_function.h"

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "hal/bus/usb_bulk.h"

namespace palpate {
namespace {

constexpr int kPriority = 73;
constexpr std::size_t kMostWaiting = 16;  // frames either way; beyond that the oldest is dropped

struct [[gnu::packed]] Interface {
  usb_interface_descriptor interface {
    sizeof(usb_interface_descriptor), USB_DT_INTERFACE, 0, 0, 2, USB_CLASS_VENDOR_SPEC, 0xFF, 0xFF, 1
  };
  usb_endpoint_descriptor_no_audio in, out;
};

usb_endpoint_descriptor_no_audio endpoint(std::uint32_t address, std::uint16_t bytes) {
  return {sizeof(usb_endpoint_descriptor_no_audio),
          USB_DT_ENDPOINT,
          static_cast<__u8>(address),
          USB_ENDPOINT_XFER_BULK,
          static_cast<__le16>(bytes),
          0};
}

// What ep0 is told first: the function at full and at high speed, and one word of text.
struct [[gnu::packed]] Descriptors {
  usb_functionfs_descs_head_v2 head;
  __le32 full_count = 3, high_count = 3;
  Interface full{.in = endpoint(usb::kIn, 64), .out = endpoint(usb::kOut, 64)};
  Interface high{.in = endpoint(usb::kIn, 512), .out = endpoint(usb::kOut, 512)};
};
struct [[gnu::packed]] Strings {
  usb_functionfs_strings_head head;
  __le16 language = 0x0409;
  char text[8] = "Palpate";
};

bool describe(int control) {
  Descriptors descriptors{};
  descriptors.head = {FUNCTIONFS_DESCRIPTORS_MAGIC_V2, sizeof descriptors,
                      FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_ALL_CTRL_RECIP};
  Strings strings{};
  strings.head = {FUNCTIONFS_STRINGS_MAGIC, sizeof strings, 1, 1};
  return ::write(control, &descriptors, sizeof descriptors) == static_cast<ssize_t>(sizeof descriptors) &&
         ::write(control, &strings, sizeof strings) == static_cast<ssize_t>(sizeof strings);
}

// Wakes a thread out of a call that waits.
void on_wake(int) {}

}  // namespace

UsbFunction::UsbFunction(int control, int in, int out) : control_(control), in_(in), out_(out) {
  struct sigaction action {};
  action.sa_handler = on_wake;  // without SA_RESTART: the call ends
  sigaction(SIGUSR2, &action, nullptr);
  const auto begin = [this](void (UsbFunction::*serve)()) {
    return std::thread([this, serve] {
      (this->*serve)();
      ended_ += 1;
    });
  };
  threads_[0] = begin(&UsbFunction::serve_control);
  threads_[1] = begin(&UsbFunction::serve_in);
  threads_[2] = begin(&UsbFunction::serve_out);
  // The bus does not wait for the simulation: its threads go before it, as a chip would, and after the controller.
  sched_param priority{kPriority};
  for (std::thread& thread : threads_) pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &priority);
}

UsbFunction::~UsbFunction() {
  stop_ = true;
  changed_.notify_all();
  // Once is not enough where a thread was about to wait.
  for (; ended_ < 3; ::usleep(1000))
    for (std::thread& thread : threads_) pthread_kill(thread.native_handle(), SIGUSR2);
  for (std::thread& thread : threads_) thread.join();
  for (const int fd : {in_, out_, control_}) ::close(fd);
}

void UsbFunction::push(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  received_.push_back(frame);
  if (received_.size() > kMostWaiting) received_.pop_front();
}

// The controller's requests: told on, and answered with what the simulation says within half a second.
void UsbFunction::serve_control() {
  while (!stop_) {
    pollfd ready{control_, POLLIN, 0};
    if (::poll(&ready, 1, 100) <= 0) continue;
    usb_functionfs_event event{};
    if (::read(control_, &event, sizeof event) != static_cast<ssize_t>(sizeof event)) continue;
    if (event.type != FUNCTIONFS_SETUP) continue;
    Frame frame{.id = usb::kControl, .length = 8, .fd = true};
    std::memcpy(frame.data, &event.u.setup, 8);
    push(frame);
    if ((event.u.setup.bRequestType & USB_DIR_IN) == 0) {
      (void)!::read(control_, nullptr, 0);  // agreed to
      continue;
    }
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(500), [this] { return stop_ || !answers_.empty(); });
    const Frame answer = answers_.empty() ? Frame{} : answers_.front();
    answers_.clear();
    lock.unlock();
    (void)!::write(control_, answer.data, answer.length);
  }
}

void UsbFunction::serve_out() {
  while (!stop_) {
    Frame frame{.id = usb::kOut, .fd = true};
    std::uint8_t packet[512];  // of a high-speed endpoint
    const ssize_t bytes = ::read(out_, packet, sizeof packet);
    if (bytes < 0) ::usleep(1000);  // not bound yet, or no longer
    if (bytes <= 0 || bytes > usb::kPacketBytes) continue;
    frame.length = static_cast<std::uint8_t>(bytes);
    std::memcpy(frame.data, packet, frame.length);
    push(frame);
  }
}

void UsbFunction::serve_in() {
  while (!stop_) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(100), [this] { return stop_ || !unsent_.empty(); });
    if (unsent_.empty()) continue;
    const Frame frame = unsent_.front();
    unsent_.pop_front();
    lock.unlock();
    if (::write(in_, frame.data, frame.length) < 0 && !stop_) ::usleep(1000);
  }
}

int UsbFunction::send(std::span<const Frame> frames) noexcept {
  const std::lock_guard lock(mutex_);
  for (const Frame& frame : frames) {
    std::deque<Frame>& queue = frame.id == usb::kControlAnswer ? answers_ : unsent_;
    queue.push_back(frame);
    if (queue.size() <= kMostWaiting) continue;
    queue.pop_front();
    counters_.send_dropped += 1;
  }
  counters_.sent += frames.size();
  changed_.notify_all();
  return static_cast<int>(frames.size());
}

int UsbFunction::receive(std::span<Frame> frames) noexcept {
  const std::lock_guard lock(mutex_);
  std::size_t count = 0;
  for (; count < frames.size() && !received_.empty(); received_.pop_front()) frames[count++] = received_.front();
  counters_.received += count;
  return static_cast<int>(count);
}

std::unique_ptr<Transport> open_usb_function(const std::string& folder, std::string& error) {
  const auto failed = [&](const std::string& what) {
    error = what + ": " + std::strerror(errno) + "; is it a mounted function (mount -t functionfs NAME FOLDER)?";
    return nullptr;
  };
  const int control = ::open((folder + "/ep0").c_str(), O_RDWR | O_CLOEXEC);
  if (control < 0) return failed("cannot open " + folder + "/ep0");
  if (!describe(control)) {
    const auto refused = failed(folder + "/ep0 refuses the function's descriptors");
    ::close(control);
    return refused;
  }
  const int in = ::open((folder + "/ep1").c_str(), O_RDWR | O_CLOEXEC);
  const int out = ::open((folder + "/ep2").c_str(), O_RDWR | O_CLOEXEC);
  if (in >= 0 && out >= 0) return std::make_unique<UsbFunction>(control, in, out);
  const auto refused = failed("cannot open the endpoints in " + folder);
  for (const int fd : {control, in, out})
    if (fd >= 0) ::close(fd);
  return refused;
}

}  // namespace palpate
