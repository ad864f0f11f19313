// Who speaks on a CAN bus, told from frames that were listened to.
#pragma once

#include <span>
#include <vector>

#include "hal/bus/transport.h"

namespace palpate {

// What the drivers of hal/ speak to.
enum class Protocol { kOpenNode, kOpenNodeClassic, kCanopen, kOdrive };

struct Speaker {
  Protocol protocol;
  int node;
  auto operator<=>(const Speaker&) const = default;
};

// Each node once, by protocol and number. Open nodes are known by their checksums, CANopen's by their heartbeat
// (CiA 301), ODrives by theirs (firmware 0.5 and 0.6) where no frame of the others explains it: a process data object
// of CANopen's node 1 has the identifier of the heartbeat of ODrive 12.
std::vector<Speaker> speakers_of(std::span<const Frame> frames);

}  // namespace palpate
