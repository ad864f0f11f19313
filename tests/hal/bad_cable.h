// A cable that a test breaks from one tick to another, at either end of a bus.
#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <span>
#include <vector>

#include "hal/bus/transport.h"

namespace palpate::test {

class BadCable : public Transport {
 public:
  // Of what this end receives, but for the two that name what it sends.
  enum class Fault {
    kNone,
    kLose,
    kLoseEverySecond,
    kDuplicate,
    kReorder,
    kDelay,
    kCorrupt,
    kLoseSent,
    kFullQueue,
    kBusOff
  };
  explicit BadCable(Transport& inner) : inner_(inner) {}
  void set(Fault fault) { fault_ = fault; }
  void tap(std::vector<Frame>& frames) { tap_ = &frames; }  // all that passes is written there, both ways

  int send(std::span<const Frame> frames) noexcept override {
    if (tap_ != nullptr) tap_->insert(tap_->end(), frames.begin(), frames.end());
    if (fault_ == Fault::kFullQueue) return 0;
    return fault_ == Fault::kLoseSent ? static_cast<int>(frames.size()) : inner_.send(frames);
  }
  int receive(std::span<Frame> frames) noexcept override {
    Frame arrived[kMaxFramesPerReceive];
    const int count = inner_.receive(arrived);
    if (tap_ != nullptr) tap_->insert(tap_->end(), arrived, arrived + count);
    even_ = !even_;
    const std::size_t older = held_.size();
    if (!behind_ && fault_ != Fault::kDelay) release(older);
    for (int i = 0; i < count; ++i) take(arrived[i]);
    if (behind_) release(older);
    behind_ = fault_ == Fault::kReorder;
    std::size_t out = 0;
    for (; out < frames.size() && !ready_.empty(); ready_.pop_front()) frames[out++] = ready_.front();
    return static_cast<int>(out);
  }
  void accept_remote() noexcept override { inner_.accept_remote(); }
  void accept_extended() noexcept override { inner_.accept_extended(); }
  TransportState state() const noexcept override {
    return fault_ == Fault::kBusOff ? TransportState::kBusOff : inner_.state();
  }
  const TransportCounters& counters() const noexcept override { return inner_.counters(); }

 private:
  void release(std::size_t count) {
    for (; count > 0; --count, held_.pop_front()) ready_.push_back(held_.front());
  }
  void take(Frame frame) {
    if (fault_ == Fault::kLose || fault_ == Fault::kBusOff) return;
    if (fault_ == Fault::kLoseEverySecond && even_) return;
    if (fault_ == Fault::kDelay || fault_ == Fault::kReorder) return held_.push_back(frame);
    if (fault_ == Fault::kCorrupt && frame.length > 0)
      frame.data[draw_() % frame.length] ^= static_cast<std::uint8_t>(1u << draw_() % 8);
    for (int copy = 0; copy < (fault_ == Fault::kDuplicate ? 2 : 1); ++copy) ready_.push_back(frame);
  }

  Transport& inner_;
  Fault fault_ = Fault::kNone;
  std::vector<Frame>* tap_ = nullptr;
  std::deque<Frame> held_, ready_;  // what waits, and what is to be handed out
  bool even_ = false;               // of two calls
  bool behind_ = false;             // what waits comes after what arrives next
  std::mt19937 draw_{17};
};

}  // namespace palpate::test
