// Wire codec of the open haptic node: pure encode and decode between plain structs of counts and bytes. No clock, no
// socket, no state. Field placement comes from hal/bus/wire_table.h; every message ends with a checksum that also
// covers its identifier, so a frame that reaches the wrong decoder is refused.
#pragma once

#include <cstdint>
#include <span>

#include "hal/bus/wire_table.h"
#include "hal/device/device.h"

namespace palpate::wire {

// Counts, one member per signal. Values outside a field's width are saturated when encoded.
struct Command {
  std::uint32_t sequence = 0, status_sequence = 0, flags = 0;
  std::int32_t force[3] = {}, torque[3] = {};
  friend bool operator==(const Command&, const Command&) = default;
};
struct LocalCommand {
  std::uint32_t sequence = 0, status_sequence = 0, flags = 0;
  std::int32_t force[3] = {}, torque[3] = {}, stiffness[6] = {}, point[3] = {};
  std::uint32_t valid = 0;
  friend bool operator==(const LocalCommand&, const LocalCommand&) = default;
};
struct ClassicForce {
  std::uint32_t sequence = 0;
  std::int32_t force[3] = {};
  friend bool operator==(const ClassicForce&, const ClassicForce&) = default;
};
struct ClassicTorque {
  std::uint32_t sequence = 0, flags = 0;
  std::int32_t torque[3] = {};
  friend bool operator==(const ClassicTorque&, const ClassicTorque&) = default;
};
struct Status {
  std::uint32_t sequence = 0, command_sequence = 0, flags = 0, buttons = 0, error = 0, time_us = 0;
  std::int32_t position[3] = {}, quaternion[4] = {};
  std::uint32_t version = kVersion;
  friend bool operator==(const Status&, const Status&) = default;
};
struct ClassicPosition {
  std::uint32_t sequence = 0;
  std::int32_t position[3] = {};
  friend bool operator==(const ClassicPosition&, const ClassicPosition&) = default;
};
struct ClassicOrientation {
  std::uint32_t sequence = 0, flags = 0, buttons = 0, command_echo = 0, largest = 0;
  std::int32_t component[3] = {};
  friend bool operator==(const ClassicOrientation&, const ClassicOrientation&) = default;
};

struct SignalInfo {
  const char* name;
  int start, bits;
  bool is_signed;
  double unit_per_count;
  const char* unit;
  const char* meaning;
};
struct MessageInfo {
  const char* name;
  std::uint32_t base_id;
  int bytes;
  bool fd;
  const char* sender;
  const char* meaning;
  std::span<const SignalInfo> signals;
};

enum class MessageKind : int {
#define PALPATE_KIND(message, id, bytes, fd, sender, meaning) k##message,
  PALPATE_WIRE_MESSAGES(PALPATE_KIND)
#undef PALPATE_KIND
};
#define PALPATE_SIZE(message, id, bytes, fd, sender, meaning) \
  inline constexpr std::uint32_t k##message##Id = id;         \
  inline constexpr std::size_t k##message##Bytes = bytes;
PALPATE_WIRE_MESSAGES(PALPATE_SIZE)
#undef PALPATE_SIZE

// All messages, in the order of MessageKind.
std::span<const MessageInfo> messages() noexcept;

enum class DecodeResult { kOk, kWrongLength, kBadChecksum };

// encode writes exactly k<Message>Bytes bytes. `node` (1..15) is added to the base identifier in the checksum.
// decode accepts a payload of exactly that length and checksum; on failure `message` is untouched.
#define PALPATE_DECLARE(message, id, bytes, fd, sender, meaning)                               \
  void encode(const message& from, int node, std::span<std::uint8_t, bytes> payload) noexcept; \
  DecodeResult decode(std::span<const std::uint8_t> payload, int node, message& to) noexcept;
PALPATE_WIRE_MESSAGES(PALPATE_DECLARE)
#undef PALPATE_DECLARE

// CRC-16/CCITT-FALSE (polynomial 0x1021, start 0xFFFF) and CRC-8/AUTOSAR (0x2F, start and final inversion 0xFF), both
// continued from `crc`. The latter keeps Hamming distance 4 up to 119 bits (Koopman & Chakravarty 2004): the 8-byte
// frames use it.
std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc = 0xFFFF) noexcept;
std::uint8_t crc8(std::span<const std::uint8_t> bytes, std::uint8_t crc = 0xFF) noexcept;

// What the classic profile has room for: the second half's share of the sample's number and the echo of a command's.
inline constexpr std::uint32_t kClassicPairMask = 0xF, kClassicEchoMask = 0x3F, kClassicButtonMask = 0x3;

inline constexpr double kStiffnessStep_N_per_m = 0.01;  // of the wire table

// Pose and wrench in SI units <-> counts of each profile. Positions out of range saturate per axis; a force or torque
// out of range is scaled as a whole, so that it keeps its direction; not finite ones become 0. get_pose does not
// normalise: whether four numbers are a rotation is for the reader to judge.
void set_pose(Status& status, Vec3 position_m, Quat orientation) noexcept;
void get_pose(const Status& status, Vec3& position_m, Quat& orientation) noexcept;
void set_pose(ClassicPosition& p, ClassicOrientation& o, Vec3 position_m, Quat orientation) noexcept;
void get_pose(const ClassicPosition& p, const ClassicOrientation& o, Vec3& position_m, Quat& orientation) noexcept;
void set_wrench(Command& command, Vec3 force_N, Vec3 torque_Nm) noexcept;
void get_wrench(const Command& command, Vec3& force_N, Vec3& torque_Nm) noexcept;
void set_wrench(LocalCommand& command, Vec3 force_N, Vec3 torque_Nm) noexcept;
void get_wrench(const LocalCommand& command, Vec3& force_N, Vec3& torque_Nm) noexcept;
// A stiffness beyond its field is scaled as a whole, so that it stays positive semi-definite; a model with a number
// that is none is none. The point saturates.
void set_local(LocalCommand& command, const LocalModel& model) noexcept;
LocalModel get_local(const LocalCommand& command) noexcept;
void set_wrench(ClassicForce& f, ClassicTorque& t, Vec3 force_N, Vec3 torque_Nm) noexcept;
void get_wrench(const ClassicForce& f, const ClassicTorque& t, Vec3& force_N, Vec3& torque_Nm) noexcept;

}  // namespace palpate::wire
