// Room on the stack for numbers that a tick writes as it finds them: to clear it all first takes as long as to use it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rt_core/base.h"

namespace palpate {

// `capacity` elements, each to be written before it is read. Indices are not checked.
template <class T, std::int32_t capacity>
class Unwritten {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  T* data() PALPATE_RT { return reinterpret_cast<T*>(room_); }
  const T* data() const PALPATE_RT { return reinterpret_cast<const T*>(room_); }
  T& operator[](std::int32_t i) PALPATE_RT { return data()[i]; }
  const T& operator[](std::int32_t i) const PALPATE_RT { return data()[i]; }

 private:
  alignas(T) std::byte room_[static_cast<std::size_t>(capacity) * sizeof(T)];
};

}  // namespace palpate
