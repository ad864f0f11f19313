// The other end of usb_bulk.h, for a simulated device: a USB function with one bulk endpoint each way through Linux'
// FunctionFS. Threads of its own wait at the endpoints, for FunctionFS knows no other way; for simulations only.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "hal/bus/transport.h"

namespace palpate {

class UsbFunction : public Transport {
 public:
  // Takes ownership of the files ep0, ep1 (towards the controller) and ep2 of a mounted function.
  UsbFunction(int control, int in, int out);
  ~UsbFunction() override;
  UsbFunction(const UsbFunction&) = delete;
  UsbFunction& operator=(const UsbFunction&) = delete;

  int send(std::span<const Frame> frames) noexcept override;
  int receive(std::span<Frame> frames) noexcept override;
  TransportState state() const noexcept override { return TransportState::kUp; }
  const TransportCounters& counters() const noexcept override { return counters_; }

 private:
  void serve_control();
  void serve_out();
  void serve_in();
  void push(const Frame& frame);

  int control_, in_, out_;
  TransportCounters counters_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> received_, unsent_, answers_;
  std::atomic<bool> stop_{false};
  std::atomic<int> ended_{0};  // threads
  std::thread threads_[3];
};

// `folder`: where the function is mounted (mount -t functionfs NAME FOLDER). The gadget around it is bound to its
// controller afterwards, by whoever made it (docs/laboratory.md). Null and `error` on failure.
std::unique_ptr<Transport> open_usb_function(const std::string& folder, std::string& error);

}  // namespace palpate
