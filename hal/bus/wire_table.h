// The wire protocol's one table: every signal of every message. The codec, the .dbc file and the tests are generated
// from it; docs/wire_protocol.md explains it. Fields are little-endian ("Intel"); bit 0 is the lowest of byte 0.
#pragma once

#include <cstdint>

namespace palpate::wire {

// 2: after power-up and after its watchdog a node stays at zero force until it is enabled anew; the classic profile
// echoes the command it obeys.
inline constexpr std::uint8_t kVersion = 2;
inline constexpr int kMaxNode = 15;  // node numbers 1..15 are added to the base identifiers

// X(message, base identifier, bytes, needs FD, sender, meaning). The lower the identifier the higher the priority on
// the bus: commands go first, so a full bus delays samples (which the controller notices) and not forces.
#define PALPATE_WIRE_MESSAGES(X)                                                              \
  X(Command, 0x100, 20, true, Controller, "force command, CAN FD")                            \
  X(LocalCommand, 0x130, 48, true, Controller, "force command with its local model, CAN FD")  \
  X(ClassicForce, 0x110, 8, false, Controller, "force command, classic CAN, first half")      \
  X(ClassicTorque, 0x120, 8, false, Controller, "force command, classic CAN, second half")    \
  X(Status, 0x180, 32, true, HapticNode, "handle pose and device state, CAN FD")              \
  X(ClassicPosition, 0x190, 8, false, HapticNode, "handle position, classic CAN, first half") \
  X(ClassicOrientation, 0x1A0, 8, false, HapticNode, "handle orientation and state, second half")

// X(member, name, start bit, bits, signed, unit per count, unit, meaning). The checksum fills what follows the last
// one.
#define PALPATE_WIRE_Command(X)                                                              \
  X(sequence, Sequence, 0, 16, false, 1, "", "+1 per command")                               \
  X(status_sequence, StatusSequence, 16, 16, false, 1, "", "newest status when it was made") \
  X(flags, Flags, 32, 16, false, 1, "", "bit 0: enable drives")                              \
  X(force[0], ForceX, 48, 16, true, 0.001, "N", "force on the hand, device frame")           \
  X(force[1], ForceY, 64, 16, true, 0.001, "N", "force on the hand, device frame")           \
  X(force[2], ForceZ, 80, 16, true, 0.001, "N", "force on the hand, device frame")           \
  X(torque[0], TorqueX, 96, 16, true, 0.0001, "Nm", "about the handle's origin")             \
  X(torque[1], TorqueY, 112, 16, true, 0.0001, "Nm", "about the handle's origin")            \
  X(torque[2], TorqueZ, 128, 16, true, 0.0001, "Nm", "about the handle's origin")

// For devices whose status says 64. The device pushes with force - stiffness (x - point) until the next command, for no
// longer than Valid.
#define PALPATE_WIRE_LocalCommand(X)                                                                              \
  X(sequence, Sequence, 0, 16, false, 1, "", "+1 per command, of either kind")                                    \
  X(status_sequence, StatusSequence, 16, 16, false, 1, "", "newest status when it was made")                      \
  X(flags, Flags, 32, 16, false, 1, "", "bit 0: enable drives")                                                   \
  X(force[0], ForceX, 48, 16, true, 0.001, "N", "force on the hand at the point, device frame")                   \
  X(force[1], ForceY, 64, 16, true, 0.001, "N", "force on the hand at the point, device frame")                   \
  X(force[2], ForceZ, 80, 16, true, 0.001, "N", "force on the hand at the point, device frame")                   \
  X(torque[0], TorqueX, 96, 16, true, 0.0001, "Nm", "about the handle's origin")                                  \
  X(torque[1], TorqueY, 112, 16, true, 0.0001, "Nm", "about the handle's origin")                                 \
  X(torque[2], TorqueZ, 128, 16, true, 0.0001, "Nm", "about the handle's origin")                                 \
  X(stiffness[0], StiffnessXX, 144, 24, true, 0.01, "N/m", "force against a motion from the point, device frame") \
  X(stiffness[1], StiffnessYY, 168, 24, true, 0.01, "N/m", "symmetric, positive semi-definite")                   \
  X(stiffness[2], StiffnessZZ, 192, 24, true, 0.01, "N/m", "symmetric, positive semi-definite")                   \
  X(stiffness[3], StiffnessYZ, 216, 24, true, 0.01, "N/m", "symmetric, positive semi-definite")                   \
  X(stiffness[4], StiffnessXZ, 240, 24, true, 0.01, "N/m", "symmetric, positive semi-definite")                   \
  X(stiffness[5], StiffnessXY, 264, 24, true, 0.01, "N/m", "symmetric, positive semi-definite")                   \
  X(point[0], PointX, 288, 24, true, 1e-07, "m", "handle where it was linearised, device frame")                  \
  X(point[1], PointY, 312, 24, true, 1e-07, "m", "handle where it was linearised, device frame")                  \
  X(point[2], PointZ, 336, 24, true, 1e-07, "m", "handle where it was linearised, device frame")                  \
  X(valid, Valid, 360, 8, false, 0.0001, "s", "so long after it took effect, at most 5 ms; 0: no model")

#define PALPATE_WIRE_ClassicForce(X)                                               \
  X(sequence, Sequence, 0, 8, false, 1, "", "same in both halves")                 \
  X(force[0], ForceX, 8, 16, true, 0.001, "N", "force on the hand, device frame")  \
  X(force[1], ForceY, 24, 16, true, 0.001, "N", "force on the hand, device frame") \
  X(force[2], ForceZ, 40, 16, true, 0.001, "N", "force on the hand, device frame")

#define PALPATE_WIRE_ClassicTorque(X)                                            \
  X(sequence, Sequence, 0, 8, false, 1, "", "same in both halves")               \
  X(flags, Flags, 8, 6, false, 1, "", "bit 0: enable drives")                    \
  X(torque[0], TorqueX, 14, 14, true, 0.0005, "Nm", "about the handle's origin") \
  X(torque[1], TorqueY, 28, 14, true, 0.0005, "Nm", "about the handle's origin") \
  X(torque[2], TorqueZ, 42, 14, true, 0.0005, "Nm", "about the handle's origin")

#define PALPATE_WIRE_Status(X)                                                                                     \
  X(sequence, Sequence, 0, 16, false, 1, "", "+1 per status")                                                      \
  X(command_sequence, CommandSequence, 16, 16, false, 1, "", "newest command obeyed")                              \
  X(flags, Flags, 32, 16, false, 1, "", "1 calibrated 2 enabled 4 stop 8 error 16 watchdog 32 cut 64 local model") \
  X(buttons, Buttons, 48, 8, false, 1, "", "one bit per button")                                                   \
  X(error, ErrorCode, 56, 8, false, 1, "", "the device's own, 0: none")                                            \
  X(time_us, DeviceTime, 64, 32, false, 1, "us", "device clock, wraps")                                            \
  X(position[0], PositionX, 96, 24, true, 1e-07, "m", "handle, device frame")                                      \
  X(position[1], PositionY, 120, 24, true, 1e-07, "m", "handle, device frame")                                     \
  X(position[2], PositionZ, 144, 24, true, 1e-07, "m", "handle, device frame")                                     \
  X(quaternion[0], QuaternionW, 168, 16, true, 3.0517578125e-05, "", "handle to device frame")                     \
  X(quaternion[1], QuaternionX, 184, 16, true, 3.0517578125e-05, "", "handle to device frame")                     \
  X(quaternion[2], QuaternionY, 200, 16, true, 3.0517578125e-05, "", "handle to device frame")                     \
  X(quaternion[3], QuaternionZ, 216, 16, true, 3.0517578125e-05, "", "handle to device frame")                     \
  X(version, ProtocolVersion, 232, 8, false, 1, "", "2")

#define PALPATE_WIRE_ClassicPosition(X)                                       \
  X(sequence, Sequence, 0, 8, false, 1, "", "+1 per status")                  \
  X(position[0], PositionX, 8, 16, true, 1e-05, "m", "handle, device frame")  \
  X(position[1], PositionY, 24, 16, true, 1e-05, "m", "handle, device frame") \
  X(position[2], PositionZ, 40, 16, true, 1e-05, "m", "handle, device frame")

// Orientation by its three smallest quaternion components (each within +-1/sqrt 2): the largest one, made positive, is
// what completes them to unit length.
#define PALPATE_WIRE_ClassicOrientation(X)                                                              \
  X(sequence, Sequence, 0, 4, false, 1, "", "low bits of the first half's")                             \
  X(flags, Flags, 4, 6, false, 1, "", "1 calibrated 2 enabled 4 stop 8 error 16 watchdog 32 saturated") \
  X(buttons, Buttons, 10, 2, false, 1, "", "one bit per button")                                        \
  X(command_echo, CommandEcho, 12, 6, false, 1, "", "low bits of the newest command obeyed")            \
  X(largest, LargestComponent, 18, 2, false, 1, "", "component left out: 0 w 1 x 2 y 3 z")              \
  X(component[0], ComponentA, 20, 12, true, 0.000346, "", "first component kept, in the order w x y z") \
  X(component[1], ComponentB, 32, 12, true, 0.000346, "", "second component kept")                      \
  X(component[2], ComponentC, 44, 12, true, 0.000346, "", "third component kept")

}  // namespace palpate::wire
