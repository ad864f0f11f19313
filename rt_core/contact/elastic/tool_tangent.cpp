#include "rt_core/contact/elastic/tool_tangent.h"

namespace palpate {

Real ToolTangent::yield_m_per_N(std::int32_t soft, const Spring& spring) const PALPATE_RT {
  Real left[kMaxSoftModes], sum = 0;
  for (std::int32_t m = 0; m < soft; ++m) left[m] = spring.slope[m];  // bound: soft
  for (std::int32_t m = 0; m < soft; ++m) {                           // bound: soft^2 / 2
    const Real known = left[m] * inverse[m];
    for (std::int32_t i = m + 1; i < soft; ++i) left[i] -= known * joint[m][i];
    sum += known * known;
  }
  return sum;
}

ContactStiffness ToolTangent::from(std::int32_t twist) const PALPATE_RT {
  const Real* row[kTwist];
  for (std::int32_t i = 0; i < kTwist; ++i) row[i] = joint[twist + i] + twist;  // bound: 6
  ContactStiffness out;
  std::int32_t packed = 0;
  for (std::int32_t i = 0; i < 3; ++i) {  // bound: 3 x 3
    for (std::int32_t j = 0; j < 3; ++j) out.coupling[3 * i + j] = row[i][3 + j];
    for (std::int32_t j = i; j < 3; ++j, ++packed) {
      out.force[packed] = row[i][j];
      out.torque[packed] = row[3 + i][3 + j];
    }
  }
  return out;
}

}  // namespace palpate
