// Kinematics of a device that reports its joints: joint positions -> pose of the handle, and force on the handle ->
// joint torques by virtual work, tau_i = dx/dq_i . F + dw/dq_i . M. Closed forms with the core's own sine: the same
// bits everywhere, a bounded number of operations, no allocation.
#pragma once

#include "rt_core/vec.h"

namespace palpate {

// Joints of one device: three that carry the handle and three of a gimbal. Refused in a profile.
inline constexpr int kMaxAxes = 6;

// Device frame: x towards the operator, y to the right of it, z up (serial_3r), or as stated.
enum class LinkageKind : int {
  // Three slides along x, y, z; joints in metres.
  kCartesian = 0,
  // Turn about z, then two links in the plane so turned. A parallelogram keeps the angle of each link absolute, from
  // the horizontal, whatever the other does (Massie & Salisbury 1994; Cavusoglu, Feygin & Tendick 2002, who count the
  // second from the vertical): r = L1 cos B + L2 cos C, z = L1 sin B + L2 sin C. The elbow is up: C < B.
  kSerial3r,
  // Three arms at 0, 120 and 240 degrees about z turn a plate by three parallelograms, which keep it level (Clavel
  // 1988; Tsai 1999, chapter 3.5). Angles from the plane of the motors towards +z, where the plate is. The hinges at
  // both ends of a parallelogram may hold it off from its pivots (Stamper 1997, the arm of the University of Maryland).
  kDelta,
  // Two motors on the x axis, `base_m` apart, each with an arm; both forearms meet at the handle, on the side of +y.
  kFiveBar,
};

struct Linkage {
  LinkageKind kind = LinkageKind::kCartesian;
  bool gimbal = false;  // serial_3r: axes 4 to 6, turns about the forearm's z, y and x; the handle is where they meet
  double upper_m = 0;   // L1, the driven arm
  double fore_m = 0;    // L2
  double base_m = 0;    // delta: radius of the motors' circle; five_bar: distance of the motors
  double plate_m = 0;   // delta: radius of the plate
  double hinge_m = 0;   // delta: what the hinges of a parallelogram add to its length in the plane of its arm
  double aside_m = 0;   // delta: how far the plate's pivot lies from that plane, to its left as seen from the middle
};

int joint_count(const Linkage& linkage) noexcept;
// Joints with motors that push the handle: those that are not the gimbal's.
int arm_joint_count(const Linkage& linkage) noexcept;

enum class LinkagePlace : int {
  kGood = 0,
  kSingular,     // pose known, but force and torque lose each other here: render nothing
  kUnreachable,  // no handle fits these joints: an encoder lies
};

// A place is singular where a normalised determinant falls below this: the sine of the angle between two links, the
// share of the reach, the volume of three unit forearms. 0.1 is 6 degrees: torques there are ten times those of a right
// angle.
inline constexpr double kSingularShare = 0.1;

struct LinkageState {
  Pose pose;                  // of the handle, device frame
  Vec3 along[kMaxAxes] = {};  // dx/dq: metres per radian (or per metre)
  Vec3 about[kMaxAxes] = {};  // turn of the handle per radian
  LinkagePlace place = LinkagePlace::kUnreachable;
};

// `joint`: joint_count numbers, rad or m. Anything that is not finite is unreachable.
LinkageState linkage_at(const Linkage& linkage, const double* joint) noexcept;

// The joints that bring the handle to `pose`, elbows as described above. False where it does not reach; `joint` is then
// untouched. Orientation counts with a gimbal only.
bool linkage_to(const Linkage& linkage, const Pose& pose, double* joint) noexcept;

// Torques (N m, or N of a slide) that hold the wrench on the hand. Zero where the place is not good.
void joint_torques(const Linkage& linkage, const LinkageState& state, const Wrench& wrench, double* torque) noexcept;

}  // namespace palpate
