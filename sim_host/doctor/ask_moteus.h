// moteus controllers speak only when they are asked: one harmless question to each identifier there can be.
#pragma once

#include <functional>
#include <vector>

#include "hal/bus/transport.h"

namespace palpate {

// Reads the version of the register map of each of 1 to 127, four a millisecond, and listens a tenth of a second more;
// identifiers that answered, in order. Nothing is written, and a read feeds no watchdog. `pause` lets a millisecond
// pass.
std::vector<int> ask_moteus(Transport& transport, const std::function<void()>& pause);

}  // namespace palpate
