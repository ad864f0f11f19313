// Values of records and states as text that tells every bit.
#pragma once

#include <fmt/format.h>

#include <string>

#include "rt_core/status.h"
#include "rt_core/vec.h"

namespace palpate {

inline std::string text_of(double value) { return fmt::format("{:.17g}", value); }
inline std::string text_of(std::int32_t value) { return fmt::format("{}", value); }
inline std::string text_of(std::uint32_t value) { return fmt::format("{:#x}", value); }
inline std::string text_of(std::uint64_t value) { return fmt::format("{:016x}", value); }
inline std::string text_of(Mode value) { return fmt::format("{}", static_cast<std::int32_t>(value)); }
inline std::string text_of(Vec3 v) { return fmt::format("({:.17g}, {:.17g}, {:.17g})", v.x, v.y, v.z); }
inline std::string text_of(const Wrench& w) { return text_of(w.force_N) + " " + text_of(w.torque_Nm); }
inline std::string text_of(const Pose& p) {
  const Quat& q = p.orientation;
  return fmt::format("{} ({:.17g}, {:.17g}, {:.17g}, {:.17g})", text_of(p.position_m), q.w, q.x, q.y, q.z);
}

}  // namespace palpate
