// A transport whose cable can be pulled and put back: closes the one below and opens another.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "hal/bus/transport.h"

namespace palpate {

class Plug : public Transport {
 public:
  using Open = std::function<std::unique_ptr<Transport>()>;
  // `open` makes the transport anew; empty: once pulled it stays out.
  Plug(std::unique_ptr<Transport> transport, Open open) : transport_(std::move(transport)), open_(std::move(open)) {}

  void pull() noexcept { transport_.reset(); }
  // True if it is in again.
  bool put_back() {
    if (transport_ == nullptr && open_) transport_ = open_();
    return transport_ != nullptr;
  }

  int send(std::span<const Frame> frames) noexcept override { return transport_ ? transport_->send(frames) : 0; }
  int receive(std::span<Frame> frames) noexcept override { return transport_ ? transport_->receive(frames) : 0; }
  TransportState state() const noexcept override { return transport_ ? transport_->state() : TransportState::kDown; }
  const TransportCounters& counters() const noexcept override { return transport_ ? transport_->counters() : none_; }

 private:
  std::unique_ptr<Transport> transport_;
  Open open_;
  TransportCounters none_;
};

}  // namespace palpate
