// One hash over what a tick puts out: forces, tool, figures, bits and counts.
#pragma once

#include <cstdint>
#include <cstring>

#include "rt_core/io.h"

namespace palpate::test {

class OutputHash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x9E3779B97F4A7C15ull;
    value_ ^= value_ >> 29;
  }
  void add(Real value) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof(word));
    add(word);
  }
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const Wrench& w) { add(w.force_N), add(w.torque_Nm); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

inline void add(const Output& o, OutputHash& hash) {
  for (const Wrench& w : {o.device_w, o.contact_w, o.palm_w}) hash.add(w);
  hash.add(o.tool_w.position_m);
  for (const Real x : {o.penetration_m, o.energy_J, o.residual_m, o.strain, o.ramp}) hash.add(x);
  hash.add(static_cast<std::uint64_t>(o.status) << 32 | o.fault);
  hash.add(static_cast<std::uint64_t>(o.mode));
  hash.add(static_cast<std::uint64_t>(o.regions) << 32 | static_cast<std::uint32_t>(o.contacts));
}

}  // namespace palpate::test
