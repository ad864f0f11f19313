// Memory laid out once per scene: pools of elements in one block, found by their distance from the pool itself, so that
// the block can be copied, recorded and restored as bytes wherever it lies (the memsize and create of HPIPM).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rt_core/base.h"

namespace palpate {

// A run of elements in the block that holds the pool. Copying a pool alone would lose its elements: only whole blocks
// are copied. Indices are not checked; every loop over a pool names its bound.
template <class T>
class Pool {
 public:
  Pool() = default;
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  T* data() PALPATE_RT { return reinterpret_cast<T*>(reinterpret_cast<std::byte*>(this) + distance_); }
  const T* data() const PALPATE_RT {
    return reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(this) + distance_);
  }
  T& operator[](std::ptrdiff_t i) PALPATE_RT { return data()[i]; }
  const T& operator[](std::ptrdiff_t i) const PALPATE_RT { return data()[i]; }
  T* begin() PALPATE_RT { return data(); }
  T* end() PALPATE_RT { return data() + count_; }
  const T* begin() const PALPATE_RT { return data(); }
  const T* end() const PALPATE_RT { return data() + count_; }
  std::int32_t size() const PALPATE_RT { return count_; }
  void fill(const T& value) PALPATE_RT {
    for (T& element : *this) element = value;  // bound: the capacity
  }
  // Whether both are laid out alike.
  bool is_like(const Pool& other) const PALPATE_RT { return distance_ == other.distance_ && count_ == other.count_; }

 private:
  friend class Arena;
  std::int64_t distance_ = 0;  // bytes from this to the first element
  std::int32_t count_ = 0;
  std::int32_t reserved_ = 0;
};

// Hands out room behind an object that begins a block. Nothing is read or written but the pools, so an object that
// stands alone can be laid out too, to learn how large its block would be.
class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;

  Arena(void* block, std::size_t used) noexcept : block_(static_cast<std::byte*>(block)), used_(used) {}
  template <class T>
  void place(Pool<T>& pool, std::int64_t count) noexcept {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kAlignment);
    const std::size_t at = bytes();
    pool.distance_ = block_ + at - reinterpret_cast<std::byte*>(&pool);
    pool.count_ = static_cast<std::int32_t>(count);
    used_ = at + static_cast<std::size_t>(count) * sizeof(T);
  }
  // Of the block so far, rounded up to the alignment.
  std::size_t bytes() const noexcept { return (used_ + kAlignment - 1) / kAlignment * kAlignment; }

 private:
  std::byte* block_;
  std::size_t used_;
};

}  // namespace palpate
