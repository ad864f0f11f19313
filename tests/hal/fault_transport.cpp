#include "tests/hal/fault_transport.h"

namespace palpate {

const FaultEvent* FaultTransport::active(TransportFault fault) const noexcept {
  const std::uint64_t call = call_ > 0 ? call_ - 1 : 0;
  for (const FaultEvent& e : script_)
    if (e.fault == fault && call >= e.from && call - e.from < e.count) return &e;
  return nullptr;
}

void FaultTransport::hold(const Frame& frame, std::uint64_t due) noexcept {
  if (held_count_ < kMaxFramesPerReceive) held_[held_count_++] = {frame, due};
}

// Appends the held frames that are due, oldest first.
int FaultTransport::release(std::span<Frame> frames, int count) noexcept {
  int kept = 0;
  for (int i = 0; i < held_count_; ++i) {
    if (held_[i].due <= call_ - 1 && static_cast<std::size_t>(count) < frames.size())
      frames[static_cast<std::size_t>(count++)] = held_[i].frame;
    else
      held_[kept++] = held_[i];
  }
  held_count_ = kept;
  return count;
}

int FaultTransport::receive(std::span<Frame> frames) noexcept {
  Frame arrived[kMaxFramesPerReceive];
  const int count = inner_.receive(arrived);
  call_ += 1;
  if (active(TransportFault::kBusOff) != nullptr) bus_off_ = true;
  const FaultEvent* corrupt = active(TransportFault::kCorrupt);
  const FaultEvent* delay = active(TransportFault::kDelay);
  const bool duplicate = active(TransportFault::kDuplicate) != nullptr;
  const bool reorder = active(TransportFault::kReorder) != nullptr;
  const bool lose = active(TransportFault::kLose) != nullptr || bus_off_;
  if (delay != nullptr || (queued_ && held_count_ > 0 && held_[0].due > call_ - 1)) {
    queued_ = true;
    // A delay is a queue: what comes later also waits, so the order stays.
    for (int i = 0; i < count; ++i)
      hold(arrived[i], delay != nullptr ? call_ - 1 + static_cast<std::uint64_t>(delay->argument) : held_[0].due);
    return release(frames, 0);
  }
  int out = queued_ ? release(frames, 0) : 0;  // a queue delivers the old ones first, a reordering last
  queued_ = false;
  for (int i = 0; i < count && !lose; ++i) {
    if (corrupt != nullptr) {
      std::uint8_t& byte = arrived[i].data[(corrupt->argument / 8) % 64];
      byte = static_cast<std::uint8_t>(byte ^ (1u << (corrupt->argument % 8)));
    }
    if (reorder) {
      hold(arrived[i], call_);
      continue;
    }
    for (int copy = 0; copy < (duplicate ? 2 : 1); ++copy)
      if (static_cast<std::size_t>(out) < frames.size()) frames[static_cast<std::size_t>(out++)] = arrived[i];
  }
  return release(frames, out);
}

int FaultTransport::send(std::span<const Frame> frames) noexcept {
  if (active(TransportFault::kFullQueue) != nullptr || bus_off_) return 0;
  if (active(TransportFault::kLoseSent) != nullptr) return static_cast<int>(frames.size());
  return inner_.send(frames);
}

}  // namespace palpate
