// What arrived from a device, in words, for the person who must mend it: how many frames came, what became of them, the
// first one that was useless with its bytes, which flag is missing, and what to do. Not for the loop: it makes text.
#pragma once

#include <string>

#include "hal/bus/device_bus.h"

namespace palpate {

struct LinkReport {
  bool good = false;   // samples arrive and the device may be armed
  std::string found;   // one line
  std::string remedy;  // one line; empty if good
};

LinkReport report_link(const DeviceBus& bus, TransportState state);

// "0x181, 32 bytes: 34 12 cd ..." (the first 32).
std::string frame_text(const Frame& frame);
// Names of the DeviceFlag bits, separated by commas; "none".
std::string device_flag_names(std::uint32_t flags);

}  // namespace palpate
