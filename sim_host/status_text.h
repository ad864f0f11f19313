// Names, meanings and remedies of status and fault bits, generated from the tables in rt_core/status.h.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "rt_core/status.h"

namespace palpate {

struct BitText {
  const char* name;
  int bit;
  const char* meaning;
  const char* remedy;
};

std::span<const BitText> status_bit_texts();
std::span<const BitText> fault_bit_texts();
// Names of the bits set, separated by blanks; "-" for none, "bit N" for one without a name.
std::string bit_names(std::span<const BitText> table, std::uint32_t bits);
// "idle", "force", "hold", "passive", "ramp", "fault", or "?" for a value that is no mode.
const char* mode_name(Mode mode);
const char* stage_name(Stage stage);

}  // namespace palpate
