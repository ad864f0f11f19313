#include "hal/drives/cia402_emergency.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace palpate::canopen {
namespace {

struct Code {
  std::uint32_t code;
  const char* words;
};
constexpr Code kCodes[] = {
    {0x1000, "an error of no class"},
    {0x2000, "current"},
    {0x2100, "current at the supply"},
    {0x2110, "short circuit or earth leakage at the supply"},
    {0x2200, "current within the drive"},
    {0x2220, "continuous over-current within the drive"},
    {0x2230, "short circuit or earth leakage within the drive"},
    {0x2300, "current at the motor"},
    {0x2310, "continuous over-current at the motor"},
    {0x2320, "short circuit or earth leakage at the motor"},
    {0x2330, "earth leakage at the motor"},
    {0x2340, "short circuit at the motor"},
    {0x2350, "motor overloaded for too long (I2t)"},
    {0x3000, "voltage"},
    {0x3100, "mains voltage"},
    {0x3110, "mains voltage too high"},
    {0x3120, "mains voltage too low"},
    {0x3130, "a phase of the mains fails"},
    {0x3200, "voltage within the drive"},
    {0x3210, "DC link voltage too high: braking energy has nowhere to go, or the supply is wrong"},
    {0x3220, "DC link voltage too low: supply off or too weak"},
    {0x3300, "voltage at the motor"},
    {0x4000, "temperature"},
    {0x4100, "ambient temperature"},
    {0x4110, "surroundings too hot"},
    {0x4120, "surroundings too cold"},
    {0x4200, "temperature of the device"},
    {0x4210, "device too hot"},
    {0x4220, "device too cold"},
    {0x4300, "temperature of the drive"},
    {0x4310, "drive too hot"},
    {0x4320, "drive too cold"},
    {0x5000, "hardware of the drive"},
    {0x5100, "its own supply"},
    {0x5400, "its power stage"},
    {0x5500, "its memory"},
    {0x6000, "software of the drive"},
    {0x6010, "its processor was reset by its watchdog"},
    {0x6100, "internal software"},
    {0x6200, "user software"},
    {0x6300, "its set of parameters"},
    {0x6320, "a parameter is wrong"},
    {0x7000, "a module added to the drive"},
    {0x7100, "brake chopper, motor or brake"},
    {0x7110, "brake chopper"},
    {0x7120, "motor"},
    {0x7121, "motor blocked"},
    {0x7122, "motor or commutation: its encoder or phases are exchanged"},
    {0x7300, "sensor: encoder or its cable"},
    {0x7305, "incremental encoder 1"},
    {0x7306, "incremental encoder 2"},
    {0x7310, "speed measured"},
    {0x7320, "position measured"},
    {0x7500, "communication within the drive"},
    {0x8000, "monitoring"},
    {0x8100, "communication"},
    {0x8110, "CAN overrun: frames were lost"},
    {0x8120, "CAN is error passive: bit rate, termination, cable"},
    {0x8130, "life guard or heartbeat: the controller was not heard in time"},
    {0x8140, "CAN came back from bus-off"},
    {0x8150, "two nodes send the same identifier"},
    {0x8200, "protocol"},
    {0x8210, "a PDO was too short"},
    {0x8220, "a PDO was too long"},
    {0x8240, "SYNC had an unexpected length"},
    {0x8250, "an RPDO did not come in time"},
    {0x8300, "torque control"},
    {0x8311, "torque too high"},
    {0x8400, "speed control"},
    {0x8500, "position control"},
    {0x8600, "positioning"},
    {0x8611, "following error"},
    {0x8612, "a limit of the position"},
    {0x8700, "synchronisation: SYNC is not in its period"},
    {0x9000, "an error from outside: an emergency stop or another input"},
    {0xF000, "additional functions"},
    {0xFF00, "the maker's own: its manual tells"},
};
static_assert(std::is_sorted(std::begin(kCodes), std::end(kCodes),
                             [](const Code& a, const Code& b) { return a.code < b.code; }));

constexpr const char* kRegisterBits[] = {"generic",       "current",           "voltage",        "temperature",
                                         "communication", "of the drive kind", "a reserved bit", "the maker's own"};

const char* words_of(std::uint32_t code) {
  for (const std::uint32_t mask : {0xFFFFu, 0xFFF0u, 0xFF00u, 0xF000u}) {
    const auto found = std::ranges::find(kCodes, code & mask, &Code::code);
    if (found != std::end(kCodes)) return found->words;
  }
  return "a code of no known class";
}

}  // namespace

std::string emergency_text(std::uint32_t code, std::uint32_t error_register) {
  char text[48];
  std::snprintf(text, sizeof text, "0x%04X (", code);
  std::string whole = text + std::string(words_of(code));
  std::snprintf(text, sizeof text, "; error register 0x%02X", error_register);
  whole += text;
  const char* before = ": ";
  for (unsigned bit = 0; bit < std::size(kRegisterBits); ++bit) {
    if ((error_register >> bit & 1) == 0) continue;
    whole += std::string(before) + kRegisterBits[bit];
    before = ", ";
  }
  return whole + ")";
}

}  // namespace palpate::canopen
