#include "hal/bus/codec.h"

#include <algorithm>
#include <type_traits>

#include "hal/device/kinematics.h"

namespace palpate::wire {
namespace {

// Bounded by the field's width (at most 32 bits); fields need not start on a byte.
void put_bits(std::uint8_t* payload, int start, int bits, std::uint32_t value) noexcept {
  for (int i = 0; i < bits; ++i) {
    const int bit = start + i;
    const auto one = static_cast<std::uint8_t>(((value >> i) & 1u) << (bit % 8));
    payload[bit / 8] = static_cast<std::uint8_t>(payload[bit / 8] | one);
  }
}

std::uint32_t get_bits(const std::uint8_t* payload, int start, int bits) noexcept {
  std::uint32_t value = 0;
  for (int i = 0; i < bits; ++i) {
    const int bit = start + i;
    value |= ((static_cast<std::uint32_t>(payload[bit / 8]) >> (bit % 8)) & 1u) << i;
  }
  return value;
}

// Saturating: a number that does not fit its field must not wrap into another sign.
template <bool is_signed, typename T>
std::uint32_t fit(T value, int bits) noexcept {
  static_assert(std::is_signed_v<T> == is_signed, "the table and the struct disagree on a field's sign");
  if constexpr (is_signed) {
    const auto limit = static_cast<std::int32_t>((std::int64_t{1} << (bits - 1)) - 1);
    return static_cast<std::uint32_t>(std::clamp(value, -limit - 1, limit));
  } else {
    const auto limit = static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1);
    return std::min(value, limit);
  }
}

template <bool is_signed>
auto widen(std::uint32_t raw, int bits) noexcept {
  if constexpr (is_signed) {
    const std::uint32_t sign = 1u << (bits - 1);
    return static_cast<std::int32_t>((raw ^ sign) - sign);
  } else {
    return raw;
  }
}

// The identifier goes into the checksum ahead of the payload, low byte first.
std::uint32_t checksum(std::span<const std::uint8_t> covered, std::uint32_t id, bool wide) noexcept {
  const std::uint8_t head[2] = {static_cast<std::uint8_t>(id & 0xFF), static_cast<std::uint8_t>(id >> 8)};
  if (wide) return crc16(covered, crc16(head));
  return crc8(covered, static_cast<std::uint8_t>(crc8(head) ^ 0xFF));  // undo the head's final inversion to continue
}

constexpr std::size_t checksum_bytes(bool wide) { return wide ? 2 : 1; }

void seal(std::span<std::uint8_t> payload, std::uint32_t id, bool wide) noexcept {
  const std::size_t covered = payload.size() - checksum_bytes(wide);
  const std::uint32_t crc = checksum(payload.first(covered), id, wide);
  payload[covered] = static_cast<std::uint8_t>(crc & 0xFF);
  if (wide) payload[covered + 1] = static_cast<std::uint8_t>(crc >> 8);
}

bool sealed(std::span<const std::uint8_t> payload, std::uint32_t id, bool wide) noexcept {
  const std::size_t covered = payload.size() - checksum_bytes(wide);
  std::uint32_t found = payload[covered];
  if (wide) found |= static_cast<std::uint32_t>(payload[covered + 1]) << 8;
  return found == checksum(payload.first(covered), id, wide);
}

#define PALPATE_SIGNAL(member, name, start, bits, is_signed, factor, unit, meaning) \
  SignalInfo{#name, start, bits, is_signed, factor, unit, meaning},
#define PALPATE_MESSAGE(message, id, bytes, fd, sender, meaning) \
  constexpr SignalInfo kSignals##message[] = {PALPATE_WIRE_##message(PALPATE_SIGNAL)};
PALPATE_WIRE_MESSAGES(PALPATE_MESSAGE)
#undef PALPATE_MESSAGE
#undef PALPATE_SIGNAL

constexpr MessageInfo kMessages[] = {
#define PALPATE_MESSAGE(message, id, bytes, fd, sender, meaning) \
  {#message, id, bytes, fd, #sender, meaning, kSignals##message},
    PALPATE_WIRE_MESSAGES(PALPATE_MESSAGE)
#undef PALPATE_MESSAGE
};

// No two fields overlap, none reaches into the checksum and none is left without a bit.
constexpr bool well_formed(const MessageInfo& m) {
  int next = 0;
  for (const SignalInfo& s : m.signals) {
    if (s.start != next || s.bits < 1 || s.bits > 32) return false;
    next = s.start + s.bits;
  }
  return next == 8 * (m.bytes - static_cast<int>(checksum_bytes(m.fd)));
}
static_assert(std::all_of(std::begin(kMessages), std::end(kMessages), well_formed), "a message's fields must tile it");

// Unit of a signal, from the table, so that conversions cannot drift from the published one.
constexpr double unit_of(std::span<const SignalInfo> signals, int start) {
  for (const SignalInfo& s : signals)
    if (s.start == start) return s.unit_per_count;
  return 0;
}
constexpr double kForceUnit_N = unit_of(kSignalsCommand, 48);
constexpr double kTorqueUnit_Nm = unit_of(kSignalsCommand, 96);
constexpr double kPositionUnit_m = unit_of(kSignalsStatus, 96);
constexpr double kQuaternionUnit = unit_of(kSignalsStatus, 168);
constexpr double kStiffnessUnit_N_per_m = unit_of(kSignalsLocalCommand, 144);
static_assert(kStiffnessUnit_N_per_m == kStiffnessStep_N_per_m);
constexpr double kPointUnit_m = unit_of(kSignalsLocalCommand, 288);
constexpr double kValidUnit_s = unit_of(kSignalsLocalCommand, 360);
constexpr double kClassicForceUnit_N = unit_of(kSignalsClassicForce, 8);
constexpr double kClassicTorqueUnit_Nm = unit_of(kSignalsClassicTorque, 14);
constexpr double kClassicPositionUnit_m = unit_of(kSignalsClassicPosition, 8);
constexpr double kClassicComponentUnit = unit_of(kSignalsClassicOrientation, 20);
static_assert(kForceUnit_N > 0 && kTorqueUnit_Nm > 0 && kPositionUnit_m > 0 && kQuaternionUnit > 0);
static_assert(kClassicForceUnit_N > 0 && kClassicTorqueUnit_Nm > 0 && kClassicPositionUnit_m > 0);
static_assert(kWireForceMax_N <= 32767 * kForceUnit_N * (1 + 1e-12) &&
              kWireForceMax_N <= 32767 * kClassicForceUnit_N * (1 + 1e-12));
static_assert(kWireTorqueMax_Nm <= 32767 * kTorqueUnit_Nm * (1 + 1e-12) &&
              kWireTorqueMax_Nm <= 8191 * kClassicTorqueUnit_Nm);
static_assert(kClassicComponentUnit * 2047 > 0.70711, "a kept quaternion component reaches 1/sqrt 2");

void put_vector(std::int32_t* counts, Vec3 value, double unit, int bits) noexcept {
  counts[0] = to_counts(value.x, unit, bits);
  counts[1] = to_counts(value.y, unit, bits);
  counts[2] = to_counts(value.z, unit, bits);
}

// As put_vector, but a vector beyond the field is shortened as a whole.
void put_direction(std::int32_t* counts, Vec3 value, double unit, int bits) noexcept {
  const double limit = unit * static_cast<double>((std::int64_t{1} << (bits - 1)) - 1);
  const double largest = max_of(abs_of(value.x), max_of(abs_of(value.y), abs_of(value.z)));
  if (is_finite(value) && largest > limit && largest < kHuge) value = (limit / largest) * value;
  put_vector(counts, value, unit, bits);
}

Vec3 vector_of(const std::int32_t* counts, double unit) noexcept {
  return {from_counts(counts[0], unit), from_counts(counts[1], unit), from_counts(counts[2], unit)};
}

}  // namespace

std::span<const MessageInfo> messages() noexcept { return kMessages; }

std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc) noexcept {
  std::uint32_t c = crc;
  for (const std::uint8_t byte : bytes) {
    c ^= static_cast<std::uint32_t>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) c = (c & 0x8000u) != 0 ? (c << 1) ^ 0x1021u : c << 1;
    c &= 0xFFFFu;
  }
  return static_cast<std::uint16_t>(c);
}

std::uint8_t crc8(std::span<const std::uint8_t> bytes, std::uint8_t crc) noexcept {
  std::uint32_t c = crc;
  for (const std::uint8_t byte : bytes) {
    c ^= byte;
    for (int bit = 0; bit < 8; ++bit) c = (c & 0x80u) != 0 ? (c << 1) ^ 0x2Fu : c << 1;
    c &= 0xFFu;
  }
  return static_cast<std::uint8_t>(c ^ 0xFFu);
}

#define PALPATE_PUT(member, name, start, bits, is_signed, factor, unit, meaning) \
  put_bits(payload.data(), start, bits, fit<is_signed>(from.member, bits));
#define PALPATE_GET(member, name, start, bits, is_signed, factor, unit, meaning) \
  to.member = widen<is_signed>(get_bits(payload.data(), start, bits), bits);
#define PALPATE_DEFINE(message, id, bytes, fd, sender, meaning)                                         \
  void encode(const message& from, int node, std::span<std::uint8_t, bytes> payload) noexcept {         \
    std::fill(payload.begin(), payload.end(), std::uint8_t{0});                                         \
    PALPATE_WIRE_##message(PALPATE_PUT) seal(payload, id + static_cast<std::uint32_t>(node), fd);       \
  }                                                                                                     \
  DecodeResult decode(std::span<const std::uint8_t> payload, int node, message& to) noexcept {          \
    if (payload.size() != bytes) return DecodeResult::kWrongLength;                                     \
    if (!sealed(payload, id + static_cast<std::uint32_t>(node), fd)) return DecodeResult::kBadChecksum; \
    PALPATE_WIRE_##message(PALPATE_GET) return DecodeResult::kOk;                                       \
  }
PALPATE_WIRE_MESSAGES(PALPATE_DEFINE)
#undef PALPATE_DEFINE
#undef PALPATE_GET
#undef PALPATE_PUT

void set_pose(Status& status, Vec3 position_m, Quat orientation) noexcept {
  const Quat q = normalised(orientation);
  const double q_wxyz[4] = {q.w, q.x, q.y, q.z};
  put_vector(status.position, position_m, kPositionUnit_m, 24);
  for (int i = 0; i < 4; ++i) status.quaternion[i] = to_counts(q_wxyz[i], kQuaternionUnit, 16);
}

void get_pose(const Status& status, Vec3& position_m, Quat& orientation) noexcept {
  const std::int32_t* q = status.quaternion;
  position_m = vector_of(status.position, kPositionUnit_m);
  orientation = {from_counts(q[0], kQuaternionUnit), from_counts(q[1], kQuaternionUnit),
                 from_counts(q[2], kQuaternionUnit), from_counts(q[3], kQuaternionUnit)};
}

void set_pose(ClassicPosition& p, ClassicOrientation& o, Vec3 position_m, Quat orientation) noexcept {
  const Quat q = normalised(orientation);
  const double q_wxyz[4] = {q.w, q.x, q.y, q.z};
  std::uint32_t largest = 0;
  for (std::uint32_t i = 1; i < 4; ++i)
    if (abs_of(q_wxyz[i]) > abs_of(q_wxyz[largest])) largest = i;
  const double sign = q_wxyz[largest] < 0 ? -1 : 1;
  put_vector(p.position, position_m, kClassicPositionUnit_m, 16);
  o.largest = largest;
  int kept = 0;
  for (std::uint32_t i = 0; i < 4; ++i)
    if (i != largest) o.component[kept++] = to_counts(sign * q_wxyz[i], kClassicComponentUnit, 12);
}

void get_pose(const ClassicPosition& p, const ClassicOrientation& o, Vec3& position_m, Quat& orientation) noexcept {
  double q_wxyz[4] = {};
  double rest = 1;
  int kept = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == (o.largest & 3u)) continue;
    q_wxyz[i] = from_counts(o.component[kept++], kClassicComponentUnit);
    rest -= q_wxyz[i] * q_wxyz[i];
  }
  q_wxyz[o.largest & 3u] = square_root(max_of(0.0, rest));  // below zero: longer than 1, and refused for it
  position_m = vector_of(p.position, kClassicPositionUnit_m);
  orientation = {q_wxyz[0], q_wxyz[1], q_wxyz[2], q_wxyz[3]};
}

void set_wrench(Command& command, Vec3 force_N, Vec3 torque_Nm) noexcept {
  put_direction(command.force, force_N, kForceUnit_N, 16);
  put_direction(command.torque, torque_Nm, kTorqueUnit_Nm, 16);
}

void get_wrench(const Command& command, Vec3& force_N, Vec3& torque_Nm) noexcept {
  force_N = vector_of(command.force, kForceUnit_N);
  torque_Nm = vector_of(command.torque, kTorqueUnit_Nm);
}

void set_wrench(LocalCommand& command, Vec3 force_N, Vec3 torque_Nm) noexcept {
  put_direction(command.force, force_N, kForceUnit_N, 16);
  put_direction(command.torque, torque_Nm, kTorqueUnit_Nm, 16);
}

void get_wrench(const LocalCommand& command, Vec3& force_N, Vec3& torque_Nm) noexcept {
  force_N = vector_of(command.force, kForceUnit_N);
  torque_Nm = vector_of(command.torque, kTorqueUnit_Nm);
}

void set_local(LocalCommand& command, const LocalModel& model) noexcept {
  constexpr double kMost_N_per_m = kStiffnessUnit_N_per_m * ((1 << 23) - 1);
  Vec3 along = model.along_N_per_m, across = model.across_N_per_m;
  const bool is_number = is_finite(model.point_m) && is_finite(along) && is_finite(across);
  if (!is_number || !(model.valid_s > 0)) return;
  // No entry of a positive semi-definite matrix is larger than its largest on the diagonal.
  const double largest = max_of(along.x, max_of(along.y, along.z));
  if (largest > kMost_N_per_m) {
    along = (kMost_N_per_m / largest) * along;
    across = (kMost_N_per_m / largest) * across;
  }
  put_vector(command.stiffness, along, kStiffnessUnit_N_per_m, 24);
  put_vector(command.stiffness + 3, across, kStiffnessUnit_N_per_m, 24);
  put_vector(command.point, model.point_m, kPointUnit_m, 24);
  command.valid = static_cast<std::uint32_t>(to_counts(model.valid_s, kValidUnit_s, 9));
}

LocalModel get_local(const LocalCommand& command) noexcept {
  return {vector_of(command.point, kPointUnit_m), vector_of(command.stiffness, kStiffnessUnit_N_per_m),
          vector_of(command.stiffness + 3, kStiffnessUnit_N_per_m), kValidUnit_s * command.valid};
}

void set_wrench(ClassicForce& f, ClassicTorque& t, Vec3 force_N, Vec3 torque_Nm) noexcept {
  put_direction(f.force, force_N, kClassicForceUnit_N, 16);
  put_direction(t.torque, torque_Nm, kClassicTorqueUnit_Nm, 14);
}

void get_wrench(const ClassicForce& f, const ClassicTorque& t, Vec3& force_N, Vec3& torque_Nm) noexcept {
  force_N = vector_of(f.force, kClassicForceUnit_N);
  torque_Nm = vector_of(t.torque, kClassicTorqueUnit_Nm);
}

}  // namespace palpate::wire
