// A State and a Scratch for the ticks that the baker itself makes.
#pragma once

#include <new>

#include "rt_core/state.h"

namespace palpate {

class TickMemory {
 public:
  // `model` must outlive it.
  explicit TickMemory(const Model& model)
      : state_block_(state_bytes(model)),
        scratch_block_(scratch_bytes(model)),
        state(create_state(model, state_block_.at)),
        scratch(create_scratch(model, scratch_block_.at)) {}

 private:
  struct Block {
    explicit Block(std::size_t bytes) : at(::operator new (bytes, std::align_val_t{Arena::kAlignment})) {}
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    ~Block() { ::operator delete (at, std::align_val_t{Arena::kAlignment}); }
    void* at;
  };
  Block state_block_, scratch_block_;

 public:
  State& state;
  Scratch& scratch;
};

}  // namespace palpate
