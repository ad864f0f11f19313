// Where a person pulls the simulated device's hand: the one-way region from a viewer's mouse to palpate-device. Only
// the host writes it; the device copies it once per period and believes it only when it is whole and finite. The
// version and word order are the mailbox's (mailbox.h), and so is the argument that a torn copy is noticed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rt_core/vec.h"

namespace palpate {

struct HandWish {
  // The hand keeps to its own motion; goes to `pose` and stays there; stays where it is.
  enum Kind : std::uint32_t { kFree = 0, kPull = 1, kHold = 2 };
  Pose pose;  // of the handle, device frame
  std::uint32_t kind = kFree;
  std::uint32_t closing = 0;  // 1: the device's closing button is held
};
static_assert(std::is_trivially_copyable_v<HandWish> && sizeof(HandWish) % 8 == 0);
inline constexpr std::size_t kWishWords = sizeof(HandWish) / 8;

inline bool is_valid(const HandWish& wish) noexcept {
  constexpr double kFarthest_m = 10;
  return is_finite(wish.pose) && norm(wish.pose.position_m) < kFarthest_m && wish.kind <= HandWish::kHold &&
         wish.closing <= 1;
}

struct HandTargetRegion {
  alignas(64) std::atomic<std::uint64_t> sequence;  // odd while the host is writing; 0: nothing yet
  std::atomic<std::uint64_t> word[kWishWords];
};
static_assert(std::is_standard_layout_v<HandTargetRegion>);

class HandTargetWriter {
 public:
  explicit HandTargetWriter(HandTargetRegion& region) noexcept : region_(&region) {}
  void write(const HandWish& wish) noexcept {
    sequence_ += 2;
    region_->sequence.store(sequence_ - 1, std::memory_order_relaxed);
    const auto* bytes = reinterpret_cast<const unsigned char*>(&wish);
    for (std::size_t i = 0; i < kWishWords; ++i) {
      std::uint64_t value;
      std::memcpy(&value, bytes + 8 * i, 8);
      region_->word[i].store(value, std::memory_order_release);
    }
    region_->sequence.store(sequence_, std::memory_order_release);
  }

 private:
  HandTargetRegion* region_;
  std::uint64_t sequence_ = 0;
};

// True with the newest wish; false, `wish` unchanged, when there is none, it is being written, or it is none to follow.
inline bool read_hand_target(const HandTargetRegion& region, HandWish& wish) noexcept {
  const std::uint64_t before = region.sequence.load(std::memory_order_acquire);
  if (before == 0 || (before & 1) != 0) return false;
  HandWish copy;
  auto* bytes = reinterpret_cast<unsigned char*>(&copy);
  for (std::size_t i = 0; i < kWishWords; ++i) {
    const std::uint64_t value = region.word[i].load(std::memory_order_acquire);
    std::memcpy(bytes + 8 * i, &value, 8);
  }
  if (region.sequence.load(std::memory_order_relaxed) != before || !is_valid(copy)) return false;
  wish = copy;
  return true;
}

}  // namespace palpate
