// The register protocol of moteus controllers over CAN FD (mjbots, moteus reference, "CAN protocol", "Registers" and
// "Diagnostic protocol", register map 5): identifier source << 8 | destination, its highest bit asking for a reply;
// a payload of sub-frames, each for consecutive registers of one type, little-endian, and NOPs behind them.
//
// An identifier above 0x7FF is a 29-bit one, as everywhere here.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

#include "hal/bus/transport.h"

namespace palpate::moteus {

enum Register : std::uint32_t {
  kMode = 0x000,
  kPosition = 0x001,  // turns of the output
  kFault = 0x00F,
  kCommandPosition = 0x020,
  kFeedforward = 0x022,  // N m
  kKpScale = 0x023,
  kKdScale = 0x024,
  kMaxTorque = 0x025,
  kStopPosition = 0x026,
  kTimeout = 0x027,  // s, of this command; 0: as configured, NaN: none
  kIlimitScale = 0x02B,
  kModel = 0x100,
  kFirmware = 0x101,  // major << 16 | minor << 8 | micro
  kRegisterMap = 0x102,
  kSerial = 0x120,  // three words, the lowest first
};
enum Mode : int { kStopped = 0, kFaulted = 1, kPositionMode = 10, kTimedOut = 11 };
inline constexpr int kMapVersion = 5;
inline constexpr int kLimitingCodes = 96;  // fault codes from here on tell in a good mode what limits the torque

enum class Type : int { kInt8 = 0, kInt16 = 1, kInt32 = 2, kFloat = 3 };
constexpr int size_of(Type type) noexcept { return type == Type::kInt8 ? 1 : type == Type::kInt16 ? 2 : 4; }

enum Subframe : std::uint8_t {
  kWrite = 0x00,  // | type << 2 | count, if that is 1 to 3
  kRead = 0x10,
  kReply = 0x20,
  kWriteError = 0x30,
  kReadError = 0x31,
  kToServer = 0x40,  // of the diagnostic stream: channel, length, bytes
  kFromServer = 0x41,
  kPollServer = 0x42,  // channel, most bytes
  kNop = 0x50,
};
inline constexpr std::uint8_t kDiagnosticChannel = 1;

inline constexpr int kMostNode = 127;
inline constexpr std::uint32_t kAnswer = 0x8000;  // a reply is asked for
constexpr std::uint32_t request_id(int node) noexcept { return kAnswer | static_cast<std::uint32_t>(node); }
constexpr std::uint32_t reply_id(int node) noexcept { return static_cast<std::uint32_t>(node) << 8; }

// Appends sub-frames. What does not fit is left out and `whole` is false.
class Writer {
 public:
  explicit Writer(std::uint32_t id) noexcept {
    frame_.id = id;
    frame_.fd = true;
  }
  void head(Subframe kind, Type type, std::uint32_t first, int count) noexcept {
    byte(static_cast<std::uint8_t>(kind | static_cast<int>(type) << 2 | (count <= 3 ? count : 0)));
    if (count > 3) varuint(static_cast<std::uint32_t>(count));
    varuint(first);
  }
  template <class T>
  void value(T number) noexcept {
    put(&number, sizeof number);
  }
  template <class T>
  void write(Type type, std::uint32_t reg, T number) noexcept {
    head(kWrite, type, reg, 1);
    value(number);
  }
  void read(Type type, std::uint32_t first, int count) noexcept { head(kRead, type, first, count); }
  void text(Subframe kind, const char* bytes, int count) noexcept {
    byte(kind), byte(kDiagnosticChannel), varuint(static_cast<std::uint32_t>(count)), put(bytes, count);
  }
  void byte(std::uint8_t value) noexcept { put(&value, 1); }
  void varuint(std::uint32_t value) noexcept {
    for (; value > 0x7F; value >>= 7) byte(static_cast<std::uint8_t>(value | 0x80));
    byte(static_cast<std::uint8_t>(value));
  }
  bool whole() const noexcept { return whole_; }
  // Padded to a length that CAN FD has.
  const Frame& finish() noexcept {
    constexpr int kLengths[] = {8, 12, 16, 20, 24, 32, 48, 64};
    int length = at_;
    for (int i = 7; at_ > 8 && i >= 0; --i) length = kLengths[i] >= at_ ? kLengths[i] : length;
    std::memset(frame_.data + at_, kNop, static_cast<std::size_t>(length - at_));
    frame_.length = static_cast<std::uint8_t>(length);
    return frame_;
  }

 private:
  void put(const void* bytes, int count) noexcept {
    whole_ = whole_ && at_ + count <= 64;
    if (!whole_) return;
    std::memcpy(frame_.data + at_, bytes, static_cast<std::size_t>(count));
    at_ += count;
  }
  Frame frame_;
  int at_ = 0;
  bool whole_ = true;
};

// A sub-frame that was read: values of registers, a question for them, or text.
struct Part {
  Subframe kind = kNop;
  Type type = Type::kInt8;
  std::uint32_t first = 0;  // register; error number of an error
  int count = 0;            // registers, or bytes of text
  const std::uint8_t* bytes = nullptr;

  // The i-th value as a number: integers as they are, not scaled.
  double number(int i) const noexcept {
    const std::uint8_t* at = bytes + i * size_of(type);
    switch (type) {
      case Type::kInt8:
        return as<std::int8_t>(at);
      case Type::kInt16:
        return as<std::int16_t>(at);
      case Type::kInt32:
        return as<std::int32_t>(at);
      case Type::kFloat:
        break;
    }
    return static_cast<double>(as<float>(at));
  }

 private:
  template <class T>
  static T as(const std::uint8_t* at) noexcept {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
};

class Reader {
 public:
  explicit Reader(const Frame& frame) noexcept : at_(frame.data), end_(frame.data + frame.length) {}
  // The next sub-frame; false at the end, or where the frame is malformed.
  bool next(Part& part) noexcept {
    while (at_ < end_ && *at_ == kNop) ++at_;
    if (at_ == end_ || bad_) return false;
    const std::uint8_t head = *at_++;
    part = {};
    if (head >= kToServer && head <= kPollServer) return text(part, head);
    if (head == kWriteError || head == kReadError) {
      std::uint32_t error = 0;
      part.kind = static_cast<Subframe>(head);
      return varuint(part.first) && varuint(error);
    }
    if (head >= kWriteError) return fail();
    part.kind = static_cast<Subframe>(head & 0x30);
    part.type = static_cast<Type>(head >> 2 & 3);
    std::uint32_t count = head & 3;
    if (count == 0 && !varuint(count)) return false;
    if (!varuint(part.first) || count == 0 || count > 64) return fail();
    part.count = static_cast<int>(count);
    return part.kind == kRead || take(part, part.count * size_of(part.type));
  }
  bool malformed() const noexcept { return bad_; }

 private:
  bool fail() noexcept {
    bad_ = true;
    return false;
  }
  bool take(Part& part, int bytes) noexcept {
    if (end_ - at_ < bytes) return fail();
    part.bytes = at_;
    at_ += bytes;
    return true;
  }
  bool text(Part& part, std::uint8_t head) noexcept {
    std::uint32_t channel = 0, count = 0;
    part.kind = static_cast<Subframe>(head);
    if (!varuint(channel) || !varuint(count) || channel != kDiagnosticChannel || count > 64) return fail();
    part.count = static_cast<int>(count);
    return head == kPollServer || take(part, part.count);
  }
  bool varuint(std::uint32_t& value) noexcept {
    value = 0;
    for (int shift = 0; shift < 35 && at_ < end_; shift += 7) {  // at most five bytes
      value |= static_cast<std::uint32_t>(*at_ & 0x7F) << shift;
      if ((*at_++ & 0x80) == 0) return true;
    }
    return fail();
  }
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  bool bad_ = false;
};

}  // namespace palpate::moteus
