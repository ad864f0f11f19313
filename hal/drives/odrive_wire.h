// CANSimple, the protocol of ODrive's drives (ODrive Robotics, "CAN Protocol" and "ODrive.Axis" of the documentation of
// firmware 0.6; the numbers were compared with the public crate odrive-messages 0.2.2). Classic frames, identifier
// node << 5 | command, little-endian.
#pragma once

#include <cstdint>

namespace palpate::odrive {

enum Message : std::uint32_t {
  kGetVersion = 0x00,    // remote: protocol, hardware (line, version, variant), firmware (major, minor, revision)
  kHeartbeat = 0x01,     // u32 error, u8 state, u8 procedure result, u8 trajectory done
  kRxSdo = 0x04,         // u8 opcode, u16 endpoint, u8 0, value
  kTxSdo = 0x05,         // u8 0, u16 endpoint, u8 0, value
  kAddress = 0x06,       // remote: u8 node, u48 serial number, u8 connection
  kSetAxisState = 0x07,  // u32
  kGetEncoderEstimates = 0x09,  // f32 turns, f32 turns/s; sent by itself every encoder_msg_rate_ms
  kSetControllerMode = 0x0B,    // u32 control mode, u32 input mode
  kSetInputTorque = 0x0E,       // f32 N m
  kClearErrors = 0x18,          // u8 0
};
constexpr std::uint32_t frame_id(int node, Message message) noexcept {
  return static_cast<std::uint32_t>(node) << 5 | message;
}
constexpr std::uint32_t kMessageMask = 0x1F;
constexpr int kMostNode = 62;  // 63: not addressed yet

enum State : std::uint8_t { kIdle = 1, kClosedLoop = 8 };
constexpr std::uint32_t kTorqueControl = 1, kPassthrough = 1;
constexpr std::uint8_t kRead = 0, kWrite = 1;  // opcodes of kRxSdo

enum Error : std::uint32_t {
  kMissingEstimate = 0x8,
  kUnderVoltage = 0x200,
  kMotorOverTemperature = 0x2000,
  kWatchdogExpired = 0x1000000,
  kEstopRequested = 0x2000000,
};

}  // namespace palpate::odrive
