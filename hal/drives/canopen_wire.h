// What is needed of CANopen (CiA 301, 4.2.0) and of its drive profile (CiA 402-2, IEC 61800-7-201): identifiers,
// network commands, expedited SDO transfers, objects and the drive's states. Classic frames, little-endian.
#pragma once

#include <cstdint>

#include "hal/drives/frame_bytes.h"

namespace palpate::canopen {

enum Cob : std::uint32_t {
  kNmt = 0x000,        // u8 command, u8 node
  kSync = 0x080,       // no data
  kEmergency = 0x080,  // + node; u16 code, u8 register, 5 bytes of the maker's
  kTpdo1 = 0x180,
  kRpdo1 = 0x200,
  kSdoReply = 0x580,
  kSdoRequest = 0x600,
  kHeartbeat = 0x700,  // + node; u8 state, 0: just started
};
enum Nmt : std::uint8_t { kStart = 0x01, kPreOperational = 0x80 };
enum NodeState : std::uint8_t { kBoot = 0x00, kStopped = 0x04, kOperational = 0x05, kIsPreOperational = 0x7F };
// The controller's own node number, in whose heartbeat the drives trust: the highest, as masters have by custom.
inline constexpr int kMasterNode = 127;

// index << 8 | subindex
enum Object : std::uint32_t {
  kDeviceType = 0x100000,         // low half 402: a drive
  kConsumerHeartbeat = 0x101601,  // node << 16 | ms
  kVendor = 0x101801,
  kProduct = 0x101802,
  kRevision = 0x101803,
  kSerial = 0x101804,
  kRpdoCob = 0x140001,   // bit 31: off
  kRpdoType = 0x140002,  // 1: taken over at every SYNC
  kRpdoCount = 0x160000,
  kTpdoCob = 0x180001,  // bit 31: off, bit 30: no remote frames
  kTpdoType = 0x180002,
  kTpdoCount = 0x1A0000,
  kAbortOption = 0x600700,  // what a drive does when its connection breaks; 0: nothing
  kControlword = 0x604000,
  kStatusword = 0x604100,
  kMode = 0x606000,
  kModeDisplay = 0x606100,
  kPosition = 0x606400,
  kTargetTorque = 0x607100,  // thousandths of the rated torque
  kMaxTorque = 0x607200,     // the same
  kRatedTorque = 0x607600,   // mN m
  kPolarity = 0x607E00,
  kEncoderIncrements = 0x608F01,
  kEncoderTurns = 0x608F02,
  kProbeFunction = 0x60B800,  // touch probe 1
  kProbeStatus = 0x60B900,
  kProbePosition = 0x60BA00,  // where it was caught, rising edge
  kPeriodValue = 0x60C201,
  kPeriodExponent = 0x60C202,  // 10^n s
  kSupportedModes = 0x650200,
};
// An entry of a PDO's mapping.
constexpr std::uint32_t mapped(Object object, std::uint32_t bits) noexcept { return object << 8 | bits; }
inline constexpr std::uint32_t kPdoOff = 0x80000000u, kNoRemote = 0x40000000u;
inline constexpr std::uint8_t kTorqueMode = 10;           // cyclic synchronous torque
inline constexpr std::uint32_t kTorqueModeBit = 1u << 9;  // in kSupportedModes
inline constexpr std::uint8_t kAbortByFault = 1;          // of kAbortOption: malfunction
// Of kProbeFunction: on, the first event alone, of the encoder's index mark, its rising edge.
inline constexpr std::uint16_t kCatchIndex = 0x0001 | 0x0004 | 0x0010;
inline constexpr std::uint16_t kCaught = 0x0002;  // of kProbeStatus

enum class DriveState : int { kNotReady, kDisabled, kReady, kSwitchedOn, kEnabled, kQuickStop, kFaultReaction, kFault };
inline DriveState drive_state(std::uint32_t statusword) noexcept {
  switch (statusword & 0x4Fu) {
    case 0x00:
      return DriveState::kNotReady;
    case 0x40:
      return DriveState::kDisabled;
    case 0x0F:
      return DriveState::kFaultReaction;
    case 0x08:
      return DriveState::kFault;
    default:
      break;
  }
  switch (statusword & 0x6Fu) {
    case 0x21:
      return DriveState::kReady;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kEnabled;
    case 0x07:
      return DriveState::kQuickStop;
    default:
      return DriveState::kNotReady;
  }
}
inline constexpr std::uint16_t kDisableVoltage = 0x00, kShutdown = 0x06, kSwitchOn = 0x07, kEnableOperation = 0x0F,
                               kFaultReset = 0x80;
inline constexpr std::uint16_t kHeartbeatLost = 0x8130;  // emergency code of a heartbeat or life guard that failed
inline const char* state_name(DriveState state) noexcept {
  constexpr const char* kNames[] = {
      "not ready to switch on", "switch on disabled", "ready to switch on",    "switched on",
      "operation enabled",      "quick stop active",  "fault reaction active", "fault"};
  return kNames[static_cast<int>(state)];
}

// SDO: 8 bytes each way; u8 specifier, u16 index, u8 subindex, up to four of data.
inline constexpr std::uint8_t kUpload = 0x40, kDownloaded = 0x60, kAborted = 0x80;
inline Frame sdo_frame(std::uint32_t id, std::uint8_t specifier, std::uint32_t object, std::uint32_t data) noexcept {
  Frame frame = classic_frame(id, 8);
  frame.data[0] = specifier;
  put_bytes(frame, 1, static_cast<std::uint16_t>(object >> 8));
  frame.data[3] = static_cast<std::uint8_t>(object);
  put_bytes(frame, 4, data);
  return frame;
}
// Specifiers of 1 to 4 bytes in an expedited transfer with its size stated.
constexpr std::uint8_t download_of(int bytes) noexcept { return static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2); }
constexpr std::uint8_t uploaded_of(int bytes) noexcept { return static_cast<std::uint8_t>(0x43 | (4 - bytes) << 2); }
inline constexpr std::uint32_t kNoObject = 0x06020000;  // abort code: not in the dictionary
inline std::uint32_t sdo_object(const Frame& frame) noexcept {
  return static_cast<std::uint32_t>(get_bytes<std::uint16_t>(frame, 1)) << 8 | frame.data[3];
}

}  // namespace palpate::canopen
