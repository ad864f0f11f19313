// What a tick counted of itself, as text.
#pragma once

#include <string>

#include "rt_core/work.h"

namespace palpate::test {

// " unit count" of every unit that is not 0, in the order of PALPATE_WORK_UNITS.
inline std::string work_text(const Work& work) {
  std::string text;
#define PALPATE_UNIT(unit, stage, price, what) \
  if (work.unit != 0) text += " " #unit " " + std::to_string(work.unit);
  PALPATE_WORK_UNITS(PALPATE_UNIT)
#undef PALPATE_UNIT
  return text;
}

}  // namespace palpate::test
