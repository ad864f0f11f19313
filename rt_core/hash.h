// Order-sensitive 64-bit hash over 64-bit words. Each step is a bijection of the word for a fixed state and of the
// state for a fixed word, so changing any single word (hence any single byte) always changes the result.
#pragma once

#include <bit>
#include <cstdint>

#include "rt_core/base.h"
#include "rt_core/vec.h"

namespace palpate {

struct Hasher {
  std::uint64_t value = 0x9E3779B97F4A7C15ull;

  void add(std::uint64_t word) PALPATE_RT { value = std::rotl((value ^ word) * 0xD6E8FEB86659FD93ull, 29); }
  void add(std::int64_t word) PALPATE_RT { add(static_cast<std::uint64_t>(word)); }
  void add(std::uint32_t word) PALPATE_RT { add(static_cast<std::uint64_t>(word)); }
  void add(std::int32_t word) PALPATE_RT { add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(word))); }
  void add(Real x) PALPATE_RT { add(std::bit_cast<std::uint64_t>(x)); }
  void add(Vec3 a) PALPATE_RT {
    add(a.x);
    add(a.y);
    add(a.z);
  }
  void add(const Pose& p) PALPATE_RT {
    add(p.position_m);
    add(p.orientation.w);
    add(p.orientation.x);
    add(p.orientation.y);
    add(p.orientation.z);
  }
  void add(const Wrench& w) PALPATE_RT {
    add(w.force_N);
    add(w.torque_Nm);
  }
};

}  // namespace palpate
