// The --device text: which transport, where, and which wire profile.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/bus/device_bus.h"

namespace palpate {

enum class TransportKind : int { kLoopback = 0, kCan = 1, kUsb = 2 };

struct DeviceAddress {
  TransportKind kind = TransportKind::kLoopback;
  std::string name = "palpate";  // CAN interface; loopback socket name (abstract) or path; USB device's file
  WireProfile profile = WireProfile::kFd;
  int node = 1;
};

// Reads "auto", "can:IFACE", "usb:/dev/hidrawN" (or "usb:/dev/bus/usb/BUS/DEVICE", of a Falcon) or "loopback[:NAME]",
// each with optional ",classic" and ",node=N" (1..15). "auto" takes a CAN interface if there is one, else the loopback.
// Empty on bad text, with `error` saying what is allowed; otherwise `line` says in one line what was chosen and why.
std::optional<DeviceAddress> parse_device_address(const std::string& text, std::string& line, std::string& error);

// What tells it from every other device of this computer, for DeviceLock (hal/system/device_lock.h); "" for the
// loopback, whose socket is exclusive by itself.
std::string lock_name(const DeviceAddress& address);

// kObserver: as the controller, but on CAN every frame of the bus is received, to say what came instead of a sample.
enum class DeviceSide : int { kController = 0, kDevice = 1, kObserver = 2 };

// Opens it: CAN with exact filters for that side; on the loopback the controller listens and the device connects, each
// for up to timeout_ms. Null and `error` on failure.
std::unique_ptr<Transport> open_transport(const DeviceAddress& address, DeviceSide side, int timeout_ms,
                                          std::string& error);

}  // namespace palpate
