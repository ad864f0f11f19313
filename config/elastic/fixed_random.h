// Random numbers that are the same on every machine: probing directions of the elastic body's bake.
#pragma once

#include <cstdint>

namespace palpate::elastic {

// SplitMix64 (Steele, Lea & Flood 2014).
class FixedRandom {
 public:
  explicit FixedRandom(std::uint64_t seed) : state_(seed) {}
  // Uniform in (-1, 1).
  double symmetric() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1p-52 - 1;
  }

 private:
  std::uint64_t state_;
};

}  // namespace palpate::elastic
