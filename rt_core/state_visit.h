// How a visitor walks the tables of a State (state.h): one order and one set of names for hash, comparison and dump.
// A visitor has kRealTime (whether it may run in a tick), enter(name, index), leave(), value(name, x) for whatever has
// no fields of its own, and skip() for an entry that is not in use. And the hash of what the tables say.
#pragma once

#include <cstdint>
#include <type_traits>

#include "rt_core/base.h"

namespace palpate {

// FNV-1a over names and sizes.
inline constexpr std::uint64_t kLayoutSeed = 0xcbf29ce484222325ull;
constexpr std::uint64_t layout_with(std::uint64_t hash, std::uint64_t number) noexcept {
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((number >> (8 * byte)) & 0xff)) * 0x100000001b3ull;
  return hash;
}
template <class T>
constexpr std::uint64_t layout_with(std::uint64_t hash, const char* name) noexcept {
  using Element = std::remove_all_extents_t<T>;
  for (; *name != 0; ++name) hash = layout_with(hash, static_cast<std::uint64_t>(*name));  // bound: the name
  if constexpr (requires { Element::layout(hash); }) hash = Element::layout(hash);
  return layout_with(hash, sizeof(T));
}

inline constexpr std::int32_t kNoIndex = -1;

template <class Visitor, class T>
void visit_value(Visitor& visitor, const char* name, const T& x, std::int32_t index = kNoIndex)
    PALPATE_RT_IF(Visitor::kRealTime) {
  if constexpr (std::is_array_v<T>) {
    std::int32_t i = 0;
    for (const auto& element : x) visit_value(visitor, name, element, i++);  // bound: the array
  } else if constexpr (requires { x.visit(visitor); }) {
    visitor.enter(name, index);
    x.visit(visitor);
    visitor.leave();
  } else {
    visitor.value(name, x);
  }
}

// Entries in use; of those that say so themselves, the live ones.
template <class Visitor, class Elements>
void visit_pool(Visitor& visitor, const char* name, const Elements& pool, std::int32_t used)
    PALPATE_RT_IF(Visitor::kRealTime) {
  for (std::int32_t i = 0; i < used; ++i) {  // bound: the pool's capacity
    if constexpr (requires { pool[i].is_live(); }) {
      if (!pool[i].is_live()) {
        visitor.skip(name, i);
        continue;
      }
    }
    visit_value(visitor, name, pool[i], i);
  }
}

}  // namespace palpate
