#include "sim_host/status_text.h"

namespace palpate {

namespace {

#define PALPATE_TEXT(name, bit, meaning, remedy) {&#name[1], bit, meaning, remedy},  // without the k
constexpr BitText kStatusTexts[] = {PALPATE_STATUS_BITS(PALPATE_TEXT)};
constexpr BitText kFaultTexts[] = {PALPATE_FAULT_BITS(PALPATE_TEXT)};
#undef PALPATE_TEXT

}  // namespace

std::span<const BitText> status_bit_texts() { return kStatusTexts; }
std::span<const BitText> fault_bit_texts() { return kFaultTexts; }

std::string bit_names(std::span<const BitText> table, std::uint32_t bits) {
  std::string names;
  for (int bit = 0; bit < 32; ++bit) {
    if ((bits >> bit & 1u) == 0) continue;
    std::string name = "bit " + std::to_string(bit);
    for (const BitText& text : table) {
      if (text.bit == bit) name = text.name;
    }
    names += (names.empty() ? "" : " ") + name;
  }
  return names.empty() ? "-" : names;
}

const char* mode_name(Mode mode) {
  switch (mode) {
    case Mode::kIdle:
      return "idle";
    case Mode::kForce:
      return "force";
    case Mode::kHold:
      return "hold";
    case Mode::kPassive:
      return "passive";
    case Mode::kRamp:
      return "ramp";
    case Mode::kFault:
      return "fault";
  }
  return "?";
}

const char* stage_name(Stage stage) {
  switch (stage) {
#define PALPATE_STAGE(name, function, shown, what) \
  case Stage::name:                                \
    return shown;
    PALPATE_STAGES(PALPATE_STAGE)
#undef PALPATE_STAGE
  }
  return "?";
}

}  // namespace palpate
