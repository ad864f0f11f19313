#include "hal/bus/device_address.h"

#include <net/if.h>

#include <charconv>
#include <cstdlib>

#include "hal/bus/loopback.h"
#include "hal/bus/socketcan.h"
#include "hal/bus/usb_hid.h"

namespace palpate {
namespace {

constexpr const char* kAllowed =
    "use auto, can:IFACE, usb:/dev/hidrawN, usb:/dev/bus/usb/BUS/DEVICE or loopback[:NAME], with optional ,classic and "
    ",node=1..15";

bool parse_option(const std::string& option, DeviceAddress& address, std::string& error) {
  constexpr const char* kNode = "node=";
  if (option == "classic") {
    address.profile = WireProfile::kClassic;
    return true;
  }
  if (option.rfind(kNode, 0) == 0) {
    const char* first = option.data() + 5;
    const char* last = option.data() + option.size();
    const auto [end, status] = std::from_chars(first, last, address.node);
    if (status == std::errc{} && end == last && address.node >= 1 && address.node <= wire::kMaxNode) return true;
    error = "device: node must be 1 to 15, not '" + option.substr(5) + "'";
    return false;
  }
  error = "device: unknown option '" + option + "': " + kAllowed;
  return false;
}

void choose_automatically(DeviceAddress& address, std::string& line) {
  const std::string can = find_can_interface();
  if (can.empty()) {
    line = "device: loopback (no CAN interface on this machine)";
    return;
  }
  address.kind = TransportKind::kCan;
  address.name = can;
  line = "device: CAN interface " + can + " (found on this machine; choose with --device)";
}

}  // namespace

std::optional<DeviceAddress> parse_device_address(const std::string& text, std::string& line, std::string& error) {
  DeviceAddress address;
  const std::size_t comma = text.find(',');
  const std::string where = text.substr(0, comma);
  for (std::size_t at = comma; at != std::string::npos;) {
    const std::size_t next = text.find(',', at + 1);
    if (!parse_option(text.substr(at + 1, next == std::string::npos ? next : next - at - 1), address, error))
      return std::nullopt;
    at = next;
  }
  if (where == "auto") {
    choose_automatically(address, line);
  } else if (where.rfind("can:", 0) == 0 && where.size() > 4) {
    address.kind = TransportKind::kCan;
    address.name = where.substr(4);
    line = "device: CAN interface " + address.name + " (as asked)";
  } else if (where.rfind("usb:/", 0) == 0) {
    address.kind = TransportKind::kUsb;
    address.name = where.substr(4);
    line = "device: USB " + address.name + " (as asked)";
  } else if (where == "loopback" || (where.rfind("loopback:", 0) == 0 && where.size() > 9)) {
    if (where.size() > 9) address.name = where.substr(9);
    line = "device: loopback " + address.name + " (as asked)";
  } else {
    error = "device: cannot read '" + text + "': " + kAllowed;
    return std::nullopt;
  }
  line += address.profile == WireProfile::kFd ? ", CAN FD frames" : ", classic CAN frames";
  return address;
}

std::string lock_name(const DeviceAddress& address) {
  if (address.kind == TransportKind::kLoopback) return "";
  if (address.kind == TransportKind::kCan) {
    // An interface may have other names (ip link property add ... altname), and each opens it.
    char own[IF_NAMESIZE];
    const unsigned index = if_nametoindex(address.name.c_str());
    const bool known = index != 0 && if_indextoname(index, own) != nullptr;
    return "can-" + (known ? std::string(own) : address.name) + "-node" + std::to_string(address.node);
  }
  const std::unique_ptr<char, void (*)(void*)> full(realpath(address.name.c_str(), nullptr), std::free);
  return "usb" + std::string(full ? full.get() : address.name.c_str());
}

std::unique_ptr<Transport> open_transport(const DeviceAddress& address, DeviceSide side, int timeout_ms,
                                          std::string& error) {
  if (address.kind == TransportKind::kLoopback)
    return side != DeviceSide::kDevice ? accept_loopback(address.name, timeout_ms, error)
                                       : connect_loopback(address.name, timeout_ms, error);
  if (address.kind == TransportKind::kUsb)
    return open_usb_hid(address.name, side != DeviceSide::kDevice ? UsbSide::kController : UsbSide::kDevice, error);
  const WireIds ids = side == DeviceSide::kDevice ? command_ids(address.profile, address.node)
                                                  : status_ids(address.profile, address.node);
  const auto count = static_cast<std::size_t>(side == DeviceSide::kObserver ? 0 : ids.count);
  const std::span<const std::uint32_t> wanted(ids.id, count);
  return open_socketcan({address.name, address.profile == WireProfile::kFd, wanted}, error);
}

}  // namespace palpate
