#include "sim_host/doctor/bus_speakers.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "hal/bus/codec.h"
#include "hal/drives/canopen_wire.h"
#include "hal/drives/odrive_wire.h"

namespace palpate {

namespace {

using FramesById = std::map<std::uint32_t, std::vector<const Frame*>>;

// Whether more than half of the frames pass. One in 256 of any 8 bytes has the checksum of the classic profile, so a
// single frame says nothing.
template <class Test>
bool mostly(const std::vector<const Frame*>& frames, Test test) {
  return 2 * std::ranges::count_if(frames, [&](const Frame* frame) { return test(*frame); }) > std::ssize(frames);
}

template <class Message>
std::optional<int> open_node(std::uint32_t id, const std::vector<const Frame*>& frames, std::uint32_t base, bool fd) {
  const int node = static_cast<int>(id) - static_cast<int>(base);
  if (node < 1 || node > wire::kMaxNode) return std::nullopt;
  const bool speaks = mostly(frames, [&](const Frame& frame) {
    Message message;
    return frame.fd == fd && wire::decode({frame.data, frame.length}, node, message) == wire::DecodeResult::kOk;
  });
  return speaks ? std::optional(node) : std::nullopt;
}

std::optional<int> canopen_node(std::uint32_t id, const std::vector<const Frame*>& frames) {
  if (id <= canopen::kHeartbeat || id > canopen::kHeartbeat + 127) return std::nullopt;
  // CiA 301: boot-up, stopped, operational, pre-operational.
  constexpr std::array<std::uint8_t, 4> kStates{0, 4, 5, 127};
  const bool speaks = mostly(frames, [&](const Frame& frame) {
    return !frame.fd && !frame.remote && frame.length == 1 && std::ranges::count(kStates, frame.data[0]) > 0;
  });
  return speaks ? std::optional(static_cast<int>(id - canopen::kHeartbeat)) : std::nullopt;
}

std::optional<int> odrive_node(std::uint32_t id, const std::vector<const Frame*>& frames) {
  constexpr std::uint8_t kMostState = 14;
  const int node = static_cast<int>(id >> 5);
  if ((id & odrive::kMessageMask) != odrive::kHeartbeat || node > odrive::kMostNode) return std::nullopt;
  const bool speaks = mostly(frames, [&](const Frame& frame) {
    return !frame.fd && !frame.remote && frame.length == 8 && frame.data[4] <= kMostState;
  });
  return speaks ? std::optional(node) : std::nullopt;
}

// Whether a node that is known already sends frames of this identifier.
bool is_explained(std::uint32_t id, const std::set<Speaker>& known) {
  constexpr std::uint32_t kCanopenNode = 0x7F;  // the rest is the function code
  return std::ranges::any_of(known, [&](const Speaker& speaker) {
    const auto node = static_cast<std::uint32_t>(speaker.node);
    if (speaker.protocol == Protocol::kCanopen) return (id & kCanopenNode) == node;
    return std::ranges::any_of(wire::messages(), [&](const wire::MessageInfo& m) { return id == m.base_id + node; });
  });
}

}  // namespace

std::vector<Speaker> speakers_of(std::span<const Frame> frames) {
  FramesById by_id;
  for (const Frame& frame : frames) by_id[frame.id].push_back(&frame);
  std::set<Speaker> speakers;
  for (const auto& [id, sent] : by_id) {
    if (const auto node = open_node<wire::Status>(id, sent, wire::kStatusId, true))
      speakers.insert({Protocol::kOpenNode, *node});
    if (const auto node = open_node<wire::ClassicPosition>(id, sent, wire::kClassicPositionId, false))
      speakers.insert({Protocol::kOpenNodeClassic, *node});
    if (const auto node = canopen_node(id, sent)) speakers.insert({Protocol::kCanopen, *node});
  }
  const std::set<Speaker> sure = speakers;
  for (const auto& [id, sent] : by_id)
    if (const auto node = odrive_node(id, sent); node && !is_explained(id, sure))
      speakers.insert({Protocol::kOdrive, *node});
  return {speakers.begin(), speakers.end()};
}

}  // namespace palpate
