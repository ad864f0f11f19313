#include "hal/bus/link_report.h"

#include <cstdio>

namespace palpate {
namespace {

std::string hexadecimal(std::uint32_t id) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%03x", id);
  return text;
}

void append(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

void append_count(std::string& list, std::uint64_t count, const char* what) {
  if (count > 0) append(list, std::to_string(count) + " " + what);
}

// "3000 with a wrong checksum, 2 of a wrong length"; empty if every frame was used.
std::string drops(const BusCounters& c, const TransportCounters& t) {
  std::string list;
  append_count(list, c.checksum, "with a wrong checksum");
  append_count(list, c.identifier, "with the identifier of something else");
  append_count(list, c.kind, "of the other frame kind (FD or classic)");
  append_count(list, c.length, "of a wrong length");
  append_count(list, c.version, "of another protocol version");
  append_count(list, c.orientation, "whose orientation is no rotation");
  append_count(list, c.unpaired, "without their other half");
  append_count(list, c.duplicates, "with a number that came before");
  append_count(list, c.reordered, "older than one that came before");
  append_count(list, t.malformed, "that are no data frames with 11-bit identifiers");
  append_count(list, t.overflow, "lost in a full receive queue");
  return list;
}

// Which node or profile an identifier would belong to.
std::string identifier_remedy(const DeviceBus& bus) {
  const std::uint32_t id = bus.first_bad().id, node = id & 0xFu, base = id & ~0xFu;
  const bool classic = bus.profile() == WireProfile::kClassic;
  const bool fd_status = base == wire::kStatusId;
  const bool classic_status = base == wire::kClassicPositionId || base == wire::kClassicOrientationId;
  if (node != 0 && (classic ? classic_status : fd_status))
    return "that is node " + std::to_string(node) + ": add ,node=" + std::to_string(node) + " to the address";
  if (classic_status && !classic) return "that is the classic profile: add ,classic to the address";
  if (fd_status && classic) return "that is the FD profile: leave ,classic out of the address";
  return "expected are " + hexadecimal(status_ids(bus.profile(), bus.node()).id[0]) +
         " and what docs/wire_protocol.md lists for node " + std::to_string(bus.node());
}

std::string drop_remedy(const DeviceBus& bus) {
  switch (bus.first_reason()) {
    case DropReason::kIdentifier:
      return identifier_remedy(bus);
    case DropReason::kKind:
      return "the device sends the other kind of frame: give or leave out ,classic, or change its firmware's setting";
    case DropReason::kLength:
      return "a status has 32 bytes (classic halves: 8): compare the firmware with docs/palpate.dbc";
    case DropReason::kChecksum:
      return "if every frame is wrong, the firmware's checksum: it covers the identifier, then the payload "
             "(docs/wire_protocol.md); if some are, wiring and termination";
    case DropReason::kVersion:
      return "the device speaks protocol " + std::to_string(bus.first_bad().data[29]) + ", this build " +
             std::to_string(wire::kVersion) + ": update the older one";
    case DropReason::kOrientation:
      return "send the handle's unit quaternion, w x y z in counts of 2^-15; a device without orientation sends "
             "32767 0 0 0";
    case DropReason::kNone:
      break;
  }
  return "check wiring, termination and bit rate";
}

std::string flag_remedy(std::uint32_t flags) {
  if ((flags & DeviceFlag::kStopButton) != 0) return "release the device's emergency stop";
  if ((flags & DeviceFlag::kError) != 0) return "clear the device's error: its own manual knows the code";
  return "calibrate the device: flag 1 is missing, so its positions mean no place";
}

LinkReport nothing_came(TransportState state) {
  LinkReport report;
  report.found = "no frame came";
  report.remedy = "check power, cable, termination, bit rate, bus and node number";
  if (state == TransportState::kDown) {
    report.found += "; the interface is down or the other end closed";
    report.remedy = "bring the interface up or plug the device in";
  }
  if (state == TransportState::kBusOff) {
    report.found += "; the bus controller went bus-off";
    report.remedy = "check wiring and termination; restart the interface";
  }
  return report;
}

}  // namespace

std::string frame_text(const Frame& frame) {
  std::string text = hexadecimal(frame.id) + ", " + std::to_string(frame.length) + " bytes:";
  constexpr std::size_t kMost = 32;
  for (std::size_t i = 0; i < frame.length && i < kMost; ++i) {
    char byte[8];
    std::snprintf(byte, sizeof byte, " %02x", frame.data[i]);
    text += byte;
  }
  return frame.length > kMost ? text + " ..." : text;
}

std::string device_flag_names(std::uint32_t flags) {
  constexpr const char* kNames[] = {"calibrated", "enabled", "emergency stop", "error", "let go", "saturated"};
  std::string names;
  for (std::size_t bit = 0; bit < std::size(kNames); ++bit)
    if ((flags >> bit & 1u) != 0) append(names, kNames[bit]);
  return names.empty() ? "none" : names;
}

LinkReport report_link(const DeviceBus& bus, TransportState state) {
  const BusCounters& c = bus.counters();
  const std::string dropped = drops(c, bus.transport_counters());
  if (c.frames == 0 && dropped.empty()) return nothing_came(state);
  LinkReport report;
  report.found = std::to_string(c.frames) + " frames came, " + std::to_string(c.accepted) + " samples were used";
  if (!dropped.empty()) report.found += "; dropped: " + dropped;
  if (bus.first_reason() != DropReason::kNone) report.found += "; the first: " + frame_text(bus.first_bad());
  const DeviceSample& newest = bus.newest();
  if (c.accepted > 0) {
    report.found += "; flags: " + device_flag_names(newest.flags);
    if (newest.error_code != 0) report.found += " (code " + std::to_string(newest.error_code) + ")";
    if (newest.faults != 0) {
      report.remedy = flag_remedy(newest.flags);
      return report;
    }
  }
  // Other nodes on the same bus are none of this one's faults.
  report.good = c.accepted > 0 && c.checksum + c.kind + c.length + c.version + c.orientation == 0;
  if (!report.good) report.remedy = drop_remedy(bus);
  return report;
}

}  // namespace palpate
