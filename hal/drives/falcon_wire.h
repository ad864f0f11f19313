// What a Novint Falcon speaks: packets of 16 letters over an FTDI serial adapter (FT232R) at 1.5 Mbaud. Of the maker
// nothing is published; requests, packets, numbers and signs are those of the public library libnifalcon (K. Machulis,
// 2007 to 2010), which found them out. FTDI's own requests are also in Linux (drivers/usb/serial/ftdi_sio.h).
#pragma once

#include <cstdint>

#include "hal/bus/usb_bulk.h"

namespace palpate::falcon {

inline constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xCB48;
inline constexpr int kMotors = 3;

// FTDI's requests.
enum Request : std::uint8_t {
  kReset = 0,       // value 0: the chip, 1: what was received, 2: what is to be sent
  kModem = 1,       // low byte: DTR 1, RTS 2; high byte: which of them are meant
  kFlow = 2,        // 0: none
  kBaud = 3,        // divisor of 3 MHz; bits 14 and 15 are eighths
  kData = 4,        // 8: eight bits, no parity, one stop bit
  kLatency = 9,     // ms that bytes wait for more of them, 1 to 255
  kGetLatency = 10  // one byte
};
inline constexpr std::uint16_t kReceived = 1, kUnsent = 2;      // of kReset
inline constexpr std::uint16_t kFastBaud = 2, kLatency_ms = 1;  // 1.5 Mbaud
inline constexpr int kStatusBytes = 2;  // modem and line, before the bytes of every packet an FTDI chip sends
inline constexpr std::uint8_t kLineErrors = 0x02 | 0x04 | 0x08 | 0x10;  // overrun, parity, framing, break; second byte

// Packets: '<', then for each motor the four nibbles of a signed 16-bit number, the lowest first, a byte of bits, a
// byte of zeros, '>'. Every byte between is 'A' plus its number.
inline constexpr int kPacketBytes = 16;
inline constexpr int kBits = 13, kRest = 14;  // places in it
inline constexpr std::uint8_t kZero = 0x41;
// Bits of the controller: lamps, and that the device shall look for the index marks of its encoders.
enum Command : std::uint8_t { kSeekHome = 0x01, kRed = 0x02, kGreen = 0x04, kBlue = 0x08 };
// Bits of the device: four buttons, and which encoders have passed their index mark, where they then count from zero.
inline constexpr std::uint8_t kButtons = 0x0F, kHomed = 0x70;
inline constexpr int kMostMotor = 4096;  // what a motor is sent at most

struct Packet {
  std::int16_t number[kMotors] = {};  // counts of the encoders, or strengths of the motors
  std::uint8_t bits = 0;
};

inline Frame packet_frame(std::uint32_t endpoint, const Packet& packet, int status_bytes = 0) noexcept {
  Frame frame{.id = endpoint, .length = static_cast<std::uint8_t>(status_bytes + kPacketBytes), .fd = true};
  std::uint8_t* out = frame.data + status_bytes;
  out[0] = '<';
  for (int i = 0; i < kMotors; ++i)
    for (int n = 0; n < 4; ++n)
      out[1 + 4 * i + n] =
          static_cast<std::uint8_t>(kZero + (static_cast<std::uint16_t>(packet.number[i]) >> 4 * n & 0xF));
  out[kBits] = static_cast<std::uint8_t>(kZero + packet.bits);
  out[kRest] = kZero;
  out[kPacketBytes - 1] = '>';
  return frame;
}

// Puts packets together from a stream of bytes that may begin anywhere and lose any. A letter that no number has ends
// the packet it is in; the next begins with the next '<'.
class PacketReader {
 public:
  // True if this byte ends a whole packet, which `packet` then is.
  bool take(std::uint8_t byte, Packet& packet) noexcept {
    if (byte == '<') {
      spoilt_ += at_ > 0;
      at_ = 1;
      return false;
    }
    if (at_ == 0) return false;
    if (at_ == kPacketBytes - 1) {
      const bool whole = byte == '>';
      at_ = 0;
      spoilt_ += !whole;
      if (whole) packet = decoded();
      return whole;
    }
    const int digit = byte - kZero, most = at_ == kBits ? 0x7F : 0xF;
    if (digit < 0 || digit > most) {
      at_ = 0;
      spoilt_ += 1;
      return false;
    }
    digit_[at_++] = static_cast<std::uint8_t>(digit);
    return false;
  }
  std::uint64_t spoilt() const noexcept { return spoilt_; }

 private:
  Packet decoded() const noexcept {
    Packet packet;
    for (int i = 0; i < kMotors; ++i) {
      unsigned number = 0;
      for (int n = 0; n < 4; ++n) number |= static_cast<unsigned>(digit_[1 + 4 * i + n]) << 4 * n;
      packet.number[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(number));
    }
    packet.bits = digit_[kBits];
    return packet;
  }

  std::uint8_t digit_[kPacketBytes] = {};
  int at_ = 0;
  std::uint64_t spoilt_ = 0;
};

}  // namespace palpate::falcon
