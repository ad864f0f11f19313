// The wire codec: published vectors, round trips, every single-bit error, random bytes, and the database file.
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "hal/bus/codec.h"
#include "hal/bus/dbc.h"

namespace palpate::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <typename Message, std::size_t bytes>
Bytes encoded(const Message& message, int node = 1) {
  Bytes payload(bytes, 0xEE);
  encode(message, node, std::span<std::uint8_t, bytes>(payload.data(), bytes));
  return payload;
}

Status sample_status() {
  Status s;
  s.sequence = 0x1234;
  s.command_sequence = 0xABCD;
  s.flags = 0x0003;
  s.buttons = 0x81;
  s.error = 7;
  s.time_us = 0xDEADBEEF;
  s.position[0] = -1;
  s.position[1] = 0x123456;
  s.position[2] = -(1 << 23);
  s.quaternion[0] = 32767;
  s.quaternion[1] = -32768;
  s.quaternion[2] = 1;
  s.quaternion[3] = -2;
  return s;
}

TEST(Codec, ChecksumsGiveTheirPublishedCheckValues) {
  const std::string digits = "123456789";
  const Bytes bytes(digits.begin(), digits.end());
  EXPECT_EQ(crc16(bytes), 0x29B1);  // CRC-16/CCITT-FALSE
  EXPECT_EQ(crc8(bytes), 0xDF);     // CRC-8/AUTOSAR
}

TEST(Codec, StatusBytesAreWhereTheDocumentSays) {
  const Bytes p = encoded<Status, kStatusBytes>(sample_status());
  const Bytes head = {0x34, 0x12, 0xCD, 0xAB, 0x03, 0x00, 0x81, 0x07, 0xEF, 0xBE, 0xAD, 0xDE, 0xFF, 0xFF, 0xFF,
                      0x56, 0x34, 0x12, 0x00, 0x00, 0x80, 0xFF, 0x7F, 0x00, 0x80, 0x01, 0x00, 0xFE, 0xFF, 0x02};
  EXPECT_EQ(Bytes(p.begin(), p.end() - 2), head);
  Bytes covered = {0x81, 0x01};  // identifier 0x181, low byte first
  covered.insert(covered.end(), head.begin(), head.end());
  EXPECT_EQ(p[30] | p[31] << 8, crc16(covered));
}

TEST(Codec, RoundTripsEveryMessage) {
  Status status;
  EXPECT_EQ(decode(encoded<Status, kStatusBytes>(sample_status()), 1, status), DecodeResult::kOk);
  EXPECT_EQ(status, sample_status());
  const Command command{65535, 1, 1, {-32768, 32767, -1}, {5, -6, 7}};
  Command command_back;
  EXPECT_EQ(decode(encoded<Command, kCommandBytes>(command), 1, command_back), DecodeResult::kOk);
  EXPECT_EQ(command_back, command);
  const LocalCommand local{7, 6, 1, {1, -2, 3}, {4, 5, -6}, {8388607, 0, 200000, -150, 42, -8388608}, {-1, 2, 3}, 30};
  LocalCommand local_back;
  EXPECT_EQ(decode(encoded<LocalCommand, kLocalCommandBytes>(local), 1, local_back), DecodeResult::kOk);
  EXPECT_EQ(local_back, local);
  const ClassicForce force{255, {-32768, 32767, -1}};
  ClassicForce force_back;
  EXPECT_EQ(decode(encoded<ClassicForce, 8>(force), 1, force_back), DecodeResult::kOk);
  EXPECT_EQ(force_back, force);
  const ClassicTorque torque{9, 63, {-8192, 8191, -1}};
  ClassicTorque torque_back;
  EXPECT_EQ(decode(encoded<ClassicTorque, 8>(torque), 1, torque_back), DecodeResult::kOk);
  EXPECT_EQ(torque_back, torque);
  const ClassicOrientation orientation{14, 33, 3, 61, 3, {-2048, 2047, -1}};
  ClassicOrientation orientation_back;
  EXPECT_EQ(decode(encoded<ClassicOrientation, 8>(orientation), 1, orientation_back), DecodeResult::kOk);
  EXPECT_EQ(orientation_back, orientation);
}

TEST(Codec, TooLargeNumbersSaturateInsteadOfWrapping) {
  Command command;
  command.sequence = 70000;
  command.force[0] = 40000;
  command.force[1] = -40000;
  Command back;
  ASSERT_EQ(decode(encoded<Command, kCommandBytes>(command), 1, back), DecodeResult::kOk);
  EXPECT_EQ(back.sequence, 65535u);
  EXPECT_EQ(back.force[0], 32767);
  EXPECT_EQ(back.force[1], -32768);
}

// Sets one bit of the payload at a time and restores it: every one must be noticed.
template <typename Message, std::size_t bytes>
void expect_every_bit_guarded(const Message& message) {
  Bytes payload = encoded<Message, bytes>(message);
  for (std::size_t bit = 0; bit < 8 * bytes; ++bit) {
    payload[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    Message back;
    EXPECT_EQ(decode(payload, 1, back), DecodeResult::kBadChecksum) << "bit " << bit;
    payload[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
  }
}

TEST(Codec, EverySingleBitErrorIsDetected) {
  expect_every_bit_guarded<Status, kStatusBytes>(sample_status());
  expect_every_bit_guarded<Command, kCommandBytes>(Command{});
  expect_every_bit_guarded<LocalCommand, kLocalCommandBytes>(LocalCommand{});
  expect_every_bit_guarded<ClassicForce, 8>({3, {1, 2, 3}});
  expect_every_bit_guarded<ClassicTorque, 8>({3, 1, {1, 2, 3}});
  expect_every_bit_guarded<ClassicPosition, 8>({3, {1, 2, 3}});
  expect_every_bit_guarded<ClassicOrientation, 8>({3, 1, 0, 7, 2, {1, 2, 3}});
}

TEST(Codec, AFrameOfAnotherNodeOrMessageIsRefused) {
  Status status;
  EXPECT_EQ(decode(encoded<Status, kStatusBytes>(Status{}, 2), 1, status), DecodeResult::kBadChecksum);
  ClassicTorque torque;
  EXPECT_EQ(decode(encoded<ClassicForce, 8>(ClassicForce{}), 1, torque), DecodeResult::kBadChecksum);
  EXPECT_EQ(decode(Bytes(31), 1, status), DecodeResult::kWrongLength);
  EXPECT_EQ(decode(Bytes(), 1, status), DecodeResult::kWrongLength);
}

// A random payload passes a checksum of n bits with odds 2^-n. Over 200,000 trials that is 3 for 16 bits and 781 for 8;
// the limits are ten and six standard deviations away.
TEST(Codec, RandomBytesAreAcceptedNoMoreOftenThanChance) {
  std::mt19937 random(7);
  int wide = 0, narrow = 0;
  for (int trial = 0; trial < 200'000; ++trial) {
    std::uint8_t bytes[64];
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
    Status status;
    ClassicPosition position;
    wide += decode({bytes, kStatusBytes}, 1, status) == DecodeResult::kOk;
    narrow += decode({bytes, 8}, 1, position) == DecodeResult::kOk;
    Command command;
    EXPECT_EQ(decode({bytes, random() % 20}, 1, command), DecodeResult::kWrongLength);
  }
  EXPECT_LE(wide, 21);
  EXPECT_LE(narrow, 781 + 6 * 28);
}

// Planted once as (45, 0, 30) N sent as (32.8, 0, 30): each axis cut by itself turns the force by 8.9 degrees.
TEST(Codec, AWrenchBeyondTheRangeKeepsItsDirection) {
  Command command;
  Vec3 force_N, torque_Nm;
  set_wrench(command, {45, 0, 30}, {0.5, -50, 10});
  get_wrench(command, force_N, torque_Nm);
  EXPECT_NEAR(force_N.x, 32.767, 1e-9);
  EXPECT_NEAR(force_N.z, 32.767 * 30 / 45, 1e-3);
  EXPECT_NEAR(torque_Nm.y, -3.2767, 1e-9);
  EXPECT_NEAR(torque_Nm.z, 3.2767 / 5, 1e-4);
  ClassicForce force;
  ClassicTorque torque;
  set_wrench(force, torque, {-400, 4, 0}, {0, 0, 8.192});
  get_wrench(force, torque, force_N, torque_Nm);
  EXPECT_NEAR(force_N.y / force_N.x, -0.01, 1e-4);
  EXPECT_NEAR(torque_Nm.z, 8191 * 0.0005, 1e-9);
  set_wrench(command, {std::numeric_limits<double>::infinity(), 1, 0}, {});
  EXPECT_EQ(command.force[0], 0);
}

// What is no rotation is not made one on the way: the reader judges it.
TEST(Codec, AQuaternionIsNotNormalisedOnTheWay) {
  Status status;
  Vec3 position_m;
  Quat q;
  get_pose(status, position_m, q);
  EXPECT_EQ(q, (Quat{0, 0, 0, 0}));
  ClassicPosition position;
  ClassicOrientation orientation;
  orientation.component[0] = orientation.component[1] = orientation.component[2] = 2047;  // 1.5 together
  get_pose(position, orientation, position_m, q);
  EXPECT_EQ(q.w, 0);
  EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z, 1.505, 1e-3);
}

Quat random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return normalised({normal(random), normal(random), normal(random), normal(random)});
}

TEST(Codec, PosesSurviveWithinHalfACount) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-0.3, 0.3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 p{place(random), place(random), place(random)};
    const Quat q = random_rotation(random);
    Status status;
    set_pose(status, p, q);
    Vec3 p_back;
    Quat q_back;
    get_pose(status, p_back, q_back);
    EXPECT_NEAR(q_back.w * q_back.w + q_back.x * q_back.x + q_back.y * q_back.y + q_back.z * q_back.z, 1, 1e-4);
    q_back = normalised(q_back);
    EXPECT_NEAR(p_back.x, p.x, 0.5001e-7);
    EXPECT_NEAR(p_back.z, p.z, 0.5001e-7);
    EXPECT_LT(norm(small_rotation_vector(q_back * conjugate(q))), 1e-4);  // 4 half counts of 2^-15, doubled
    ClassicPosition position;
    ClassicOrientation orientation;
    set_pose(position, orientation, p, q);
    get_pose(position, orientation, p_back, q_back);
    EXPECT_NEAR(p_back.y, p.y, 0.5001e-5);
    EXPECT_LT(norm(small_rotation_vector(q_back * conjugate(q))),
              1.6e-3);  // half counts of 3.46e-4 and the completed one
  }
}

TEST(Codec, WrenchesSurviveSaturateAndNeverCarryNan) {
  Command command;
  set_wrench(command, {1.2345, -100, std::nan("")}, {0.01234, 1e300, -HUGE_VAL});
  EXPECT_EQ(command.force[0], 1235);
  EXPECT_EQ(command.force[1], -32767);
  EXPECT_EQ(command.force[2], 0);
  EXPECT_EQ(command.torque[0], 123);
  EXPECT_EQ(command.torque[1], 0);  // beyond belief: garbage, not a large torque
  EXPECT_EQ(command.torque[2], 0);
  ClassicForce force;
  ClassicTorque torque;
  set_wrench(force, torque, {1, 2, 3}, {0.1, -0.2, 99});
  Vec3 f, t;
  get_wrench(force, torque, f, t);
  EXPECT_DOUBLE_EQ(f.z, 3.0);
  EXPECT_NEAR(t.y, -0.2 * 8191 * 0.0005 / 99, 0.00025);  // cut as a whole
  EXPECT_DOUBLE_EQ(t.z, 8191 * 0.0005);
}

TEST(Dbc, DocumentEqualsTheTable) {
  std::ifstream file(PALPATE_SOURCE_DIR "/docs/palpate.dbc");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), dbc_text()) << "the wire table changed: write dbc_text() to docs/palpate.dbc";
}

// Encodes each signal alone with all its bits set and compares the bits of the frame with the table's.
#define PALPATE_ALONE(member, signal_name, start, bits, is_signed, factor, unit, meaning)                          \
  {                                                                                                                \
    auto m = empty;                                                                                                \
    m.member = is_signed ? static_cast<std::remove_cvref_t<decltype((m.member))>>(-1)                              \
                         : static_cast<std::remove_cvref_t<decltype((m.member))>>((std::uint64_t{1} << bits) - 1); \
    const Bytes with = to_bytes(m);                                                                                \
    for (int bit = 0; bit < last_bit; ++bit) {                                                                     \
      const bool set = ((with[static_cast<std::size_t>(bit) / 8] >> (bit % 8)) & 1) != 0;                          \
      EXPECT_EQ(set, bit >= start && bit < start + bits) << #signal_name << " bit " << bit;                        \
    }                                                                                                              \
  }
#define PALPATE_TEST_MESSAGE(message, id, bytes, fd, sender, meaning)                  \
  TEST(Dbc, Bits##message) {                                                           \
    const auto to_bytes = [](const message& m) { return encoded<message, bytes>(m); }; \
    message empty;                                                                     \
    clear_version(empty);                                                              \
    const int last_bit = 8 * (bytes - (fd ? 2 : 1));                                   \
    PALPATE_WIRE_##message(PALPATE_ALONE)                                              \
  }
template <typename M>
void clear_version(M&) {}
void clear_version(Status& status) { status.version = 0; }
PALPATE_WIRE_MESSAGES(PALPATE_TEST_MESSAGE)

}  // namespace
}  // namespace palpate::wire
