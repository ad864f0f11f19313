// The rest of a device profile: where the device stands ([frame]), and for a device whose drives report joints, its
// geometry ([linkage]), its bus ([drives]) and each motor ([[axis]]).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/device/kinematics.h"
#include "hal/device/linkage.h"

namespace palpate {

// [frame]; SI. Every key may be left out.
struct FrameProfile {
  double x_m = 0, y_m = 0, z_m = 0;                       // of the device's origin in the world
  double turn_x_rad = 0, turn_y_rad = 0, turn_z_rad = 0;  // rotation vector, device frame to world
  double scale = 1;
  double workspace_m = 1;    // radius about the device's origin
  double clutch_button = 0;  // 1..8; 0: none
};

// [linkage]; which lengths are needed depends on the kind.
struct LinkageProfile {
  double upper_m = 0, fore_m = 0, base_m = 0, plate_m = 0, hinge_m = 0, aside_m = 0;
  double weight_x_N = 0, weight_y_N = 0, weight_z_N = 0;  // of handle and forearms, device frame; the motors hold it
};

enum class DriveProtocol : int { kODrive = 0, kCia402, kMoteus, kFalcon };

// [drives]; numbers of parameters depend on the firmware's version, so that the profile states both.
struct DrivesProfile {
  double bit_rate_Hz = 1e6;
  double watchdog_s = 0.02;                               // without a command for so long a drive lets go
  double vendor_id = 0, product_code = 0, revision = 0;   // cia402: object 0x1018
  double endpoint_watchdog = 0, endpoint_watchdog_s = 0;  // odrive: enable_watchdog, watchdog_timeout
  double endpoint_direction = 0;                          // odrive: the sign of its position mapper
  double moved_by_hand = 0;                               // 1: refused unless device-test --move found it right
};

// [[axis]], in the order of the joints. "Motor turns" are what the drive counts.
struct AxisProfile {
  double node = 0;
  double serial = 0;               // of the drive: tells it from any other, and axes from each other
  double counts_per_turn = 0;      // of the motor
  double ratio = 0;                // motor turns per turn of the joint: capstan, gear
  double travel_m = 0;             // of a slide, per motor turn; a slide has no ratio
  double direction = 1;            // -1: the motor turns against the joint
  double home_joint = 0;           // rad or m, in the home pose or at home_turns
  double home_turns = 0;           // what the drive counts there, from its own zero or its index mark
  double lowest = 0, highest = 0;  // joint limits
  double torque_max_Nm = 0;        // of the motor, held; 0: an encoder alone
  double rated_Nm = 0;             // cia402: of the motor, object 0x6076, in whose thousandths torque is sent;
                                   // falcon: at the largest number a motor can be sent, 4096
  double gravity_Nm = 0;           // of a link: what holds it level
  double friction_Nm = 0;          // of the motor: the torque at which it just moves; 0: not compensated
};

struct ArmProfile {
  Linkage linkage;
  Vec3 weight_N;
  bool home_pose = true;  // the handle rests in a known pose at start; otherwise drives are absolute, or
  bool index = false;     // each encoder counts from its index mark, which it must pass before the pose is believed
  DriveProtocol protocol = DriveProtocol::kODrive;
  std::string firmware;  // "0.6.10": of every drive; "" asks for none
  DrivesProfile drives;
  std::vector<AxisProfile> axes;
};

// Reads the lines of these tables one by one; every function answers "" or what is wrong.
class ArmReader {
 public:
  // A line "[name]" or "[[name]]".
  std::string table(const std::string& header);
  std::string key(const std::string& name, const std::string& value);
  // Once all lines are read: whether what was given is whole and possible.
  std::string finish();

  bool given() const { return linkage_given_ || drives_given_ || !arm_.axes.empty(); }
  const ArmProfile& arm() const { return arm_; }
  CartesianKinematics frame() const;
  std::uint32_t clutch_buttons() const;

 private:
  enum class Table : int { kNone = 0, kFrame, kLinkage, kDrives, kAxis };
  std::string close_table();
  std::string check_linkage();
  std::string check_axis(const AxisProfile& axis, std::size_t number) const;

  Table table_ = Table::kNone;
  bool frame_given_ = false, linkage_given_ = false, drives_given_ = false;
  int kind_ = 0, calibrate_ = 0, protocol_ = 0;
  std::vector<std::string> seen_;  // keys of this table
  FrameProfile frame_;
  LinkageProfile linkage_;
  ArmProfile arm_;
};

}  // namespace palpate
