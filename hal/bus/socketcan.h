// CAN_RAW sockets: classic CAN and CAN FD on a network interface.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/bus/transport.h"

namespace palpate {

struct SocketCanOptions {
  std::string interface;                   // "can0"
  bool fd = true;                          // CAN FD frames; refused if the interface is set up for classic CAN only
  std::span<const std::uint32_t> receive;  // identifiers to receive (exact match), at least one
  bool extended = false;                   // those of 29 bits too, whatever their value
};

// Opens the interface, or returns null and says in `error` what is wrong and what to do: unknown interface, not a CAN
// interface, down, not FD capable, no CAN in the kernel. Error frames are received (without the flood of single bus
// errors), own frames are not.
std::unique_ptr<Transport> open_socketcan(const SocketCanOptions& options, std::string& error);

// First CAN interface that is up, or else the first CAN interface, or an empty string.
std::string find_can_interface();

}  // namespace palpate
