// Memory for ticks outside the core: States and Scratches laid out for a scene, each in a block of its own.
#pragma once

#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <span>

#include "rt_core/state.h"

namespace palpate {

struct FreeBlock {
  void operator()(void* block) const noexcept { std::free(block); }
};
using StatePtr = std::unique_ptr<State, FreeBlock>;
using ScratchPtr = std::unique_ptr<Scratch, FreeBlock>;

inline void* new_block(std::size_t bytes) {
  void* block = std::aligned_alloc(Arena::kAlignment, bytes);
  if (block == nullptr) throw std::bad_alloc();
  return std::memset(block, 0, bytes);  // touches every page: no fault is left for the first tick
}

// The block that a State begins, as a recording keeps it.
inline std::span<const std::byte> block_of(const State& state) {
  return {reinterpret_cast<const std::byte*>(&state), state.bytes};
}

// As after reset().
inline StatePtr make_state(const Model& model) { return StatePtr(&create_state(model, new_block(state_bytes(model)))); }
inline StatePtr copy_of(const State& state) {
  void* block = new_block(state.bytes);
  auto* copy = ::new (block) State;
  copy_state(state, *copy);
  return StatePtr(copy);
}
// Zeros; no tick may read what it has not written.
inline ScratchPtr make_scratch(const Model& model) {
  return ScratchPtr(&create_scratch(model, new_block(scratch_bytes(model))));
}

}  // namespace palpate
