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

// What is in the messages that go over the bus here, for odrive.dbc. Little-endian; start in bits.
enum class Number : int { kUnsigned, kFloat };
struct Signal {
  Message message;
  const char* name;
  int start, bits;
  Number number;
  const char* unit;
};
struct MessageShape {
  Message message;
  const char* name;
  int bytes;
  bool from_drive;
};
inline constexpr MessageShape kShapes[] = {{kGetVersion, "GetVersion", 8, true},
                                           {kHeartbeat, "Heartbeat", 8, true},
                                           {kRxSdo, "RxSdo", 8, false},
                                           {kTxSdo, "TxSdo", 8, true},
                                           {kAddress, "Address", 8, true},
                                           {kSetAxisState, "SetAxisState", 4, false},
                                           {kGetEncoderEstimates, "GetEncoderEstimates", 8, true},
                                           {kSetControllerMode, "SetControllerMode", 8, false},
                                           {kSetInputTorque, "SetInputTorque", 4, false},
                                           {kClearErrors, "ClearErrors", 1, false}};
inline constexpr Signal kSignals[] = {{kGetVersion, "Protocol", 0, 8, Number::kUnsigned, ""},
                                      {kGetVersion, "HardwareLine", 8, 8, Number::kUnsigned, ""},
                                      {kGetVersion, "HardwareVersion", 16, 8, Number::kUnsigned, ""},
                                      {kGetVersion, "HardwareVariant", 24, 8, Number::kUnsigned, ""},
                                      {kGetVersion, "FirmwareMajor", 32, 8, Number::kUnsigned, ""},
                                      {kGetVersion, "FirmwareMinor", 40, 8, Number::kUnsigned, ""},
                                      {kGetVersion, "FirmwareRevision", 48, 8, Number::kUnsigned, ""},
                                      {kHeartbeat, "Error", 0, 32, Number::kUnsigned, ""},
                                      {kHeartbeat, "State", 32, 8, Number::kUnsigned, ""},
                                      {kHeartbeat, "ProcedureResult", 40, 8, Number::kUnsigned, ""},
                                      {kHeartbeat, "TrajectoryDone", 48, 8, Number::kUnsigned, ""},
                                      {kRxSdo, "Opcode", 0, 8, Number::kUnsigned, ""},
                                      {kRxSdo, "Endpoint", 8, 16, Number::kUnsigned, ""},
                                      {kRxSdo, "Value", 32, 32, Number::kUnsigned, ""},
                                      {kTxSdo, "Endpoint", 8, 16, Number::kUnsigned, ""},
                                      {kTxSdo, "Value", 32, 32, Number::kUnsigned, ""},
                                      {kAddress, "Node", 0, 8, Number::kUnsigned, ""},
                                      {kAddress, "SerialNumber", 8, 48, Number::kUnsigned, ""},
                                      {kAddress, "Connection", 56, 8, Number::kUnsigned, ""},
                                      {kSetAxisState, "State", 0, 32, Number::kUnsigned, ""},
                                      {kGetEncoderEstimates, "Position", 0, 32, Number::kFloat, "turns"},
                                      {kGetEncoderEstimates, "Velocity", 32, 32, Number::kFloat, "turns/s"},
                                      {kSetControllerMode, "ControlMode", 0, 32, Number::kUnsigned, ""},
                                      {kSetControllerMode, "InputMode", 32, 32, Number::kUnsigned, ""},
                                      {kSetInputTorque, "Torque", 0, 32, Number::kFloat, "Nm"},
                                      {kClearErrors, "Identify", 0, 8, Number::kUnsigned, ""}};

}  // namespace palpate::odrive
