#include "hal/device/linkage.h"

#include "rt_core/math.h"

namespace palpate {
namespace {

constexpr int kDeltaLegs = 3;
// Cosine and sine of the legs' azimuths: 0, 120 and 240 degrees.
constexpr double kLegCos[kDeltaLegs] = {1, -0.5, -0.5};
constexpr double kLegSin[kDeltaLegs] = {0, 0.86602540378443864676, -0.86602540378443864676};

Quat turn_about(Vec3 axis, double angle) noexcept {
  const double s = math::sin(0.5 * angle);
  return {math::cos(0.5 * angle), s * axis.x, s * axis.y, s * axis.z};
}

LinkageState cartesian_at(const double* joint) noexcept {
  LinkageState state;
  state.pose.position_m = {joint[0], joint[1], joint[2]};
  state.along[0] = {1, 0, 0};
  state.along[1] = {0, 1, 0};
  state.along[2] = {0, 0, 1};
  state.place = LinkagePlace::kGood;
  return state;
}

// Forearm's frame: x along it, y level, z above it.
Quat forearm_frame(double a, double c) noexcept { return turn_about({0, 0, 1}, a) * turn_about({0, 1, 0}, -c); }

void add_gimbal(const double* joint, LinkageState& state) noexcept {
  const Quat forearm = forearm_frame(joint[0], joint[2]);
  const Quat first = forearm * turn_about({0, 0, 1}, joint[3]);
  const Quat second = first * turn_about({0, 1, 0}, joint[4]);
  state.pose.orientation = normalised(second * turn_about({1, 0, 0}, joint[5]));
  state.about[0] = {0, 0, 1};
  state.about[2] = rotate(turn_about({0, 0, 1}, joint[0]), {0, -1, 0});
  state.about[3] = rotate(forearm, {0, 0, 1});
  state.about[4] = rotate(first, {0, 1, 0});
  state.about[5] = rotate(second, {1, 0, 0});
  // Gimbal lock: its first and last axes in line.
  if (!(abs_of(math::cos(joint[4])) >= kSingularShare)) state.place = LinkagePlace::kSingular;
}

LinkageState serial_at(const Linkage& l, const double* joint) noexcept {
  LinkageState state;
  const double ca = math::cos(joint[0]), sa = math::sin(joint[0]);
  const double cb = math::cos(joint[1]), sb = math::sin(joint[1]);
  const double cc = math::cos(joint[2]), sc = math::sin(joint[2]);
  const double r = l.upper_m * cb + l.fore_m * cc;
  state.pose.position_m = {r * ca, r * sa, l.upper_m * sb + l.fore_m * sc};
  state.along[0] = {-r * sa, r * ca, 0};
  state.along[1] = l.upper_m * Vec3{-sb * ca, -sb * sa, cb};
  state.along[2] = l.fore_m * Vec3{-sc * ca, -sc * sa, cc};
  // det J = r L1 L2 sin(C - B): over the post, or the arm stretched or folded.
  const double elbow = abs_of(sc * cb - cc * sb), reach = r / (l.upper_m + l.fore_m);
  state.place = elbow >= kSingularShare && reach >= kSingularShare ? LinkagePlace::kGood : LinkagePlace::kSingular;
  if (l.gimbal) add_gimbal(joint, state);
  return state;
}

// Both parallel kinds: each forearm s_i = x - elbow_i keeps its length, s_i . (dx - elbow_i' dq_i) = 0. With k_i =
// s_i . elbow_i' : s_i . dx = k_i dq_i. k -> 0: arm and forearm in line, the motor cannot push.
bool pushes(const Linkage& l, double k) noexcept {
  return abs_of(k) >= kSingularShare * l.upper_m * (l.fore_m + l.hinge_m);
}

// Where three spheres of equal radius about the elbows meet, on the side of the plate.
bool meet(const Vec3* elbow, double radius, Vec3& point) noexcept {
  // On the line through the centre of the circle of their centres, across its plane.
  const Vec3 a = elbow[0] - elbow[2], b = elbow[1] - elbow[2], across = cross(a, b);
  const double area2 = squared_norm(across);
  if (!(area2 > 1e-18)) return false;
  const Vec3 to_centre = (0.5 / area2) * cross(squared_norm(a) * b - squared_norm(b) * a, across);
  const double height2 = radius * radius - squared_norm(to_centre);
  if (!(height2 > 0)) return false;
  const double side = across.z < 0 ? -1.0 : 1.0;
  point = elbow[2] + to_centre + (side * square_root(height2 / area2)) * across;
  return true;
}

// A leg at a handle's place: how far its length is from being right, and the gradient of that in the place. A
// parallelogram that leans by v out of its arm's plane is q = sqrt(L2^2 - v^2) long in it, and its hinges stay there:
// g = (|forearm in the plane|^2 - (hinge + q)^2) / 2. Without hinges that is the sphere, its gradient the forearm.
bool delta_leg(const Linkage& l, int leg, const Vec3& from_elbow, double& g, Vec3& gradient) noexcept {
  const Vec3 out{kLegCos[leg], kLegSin[leg], 0}, left{-kLegSin[leg], kLegCos[leg], 0};
  const double u = dot(from_elbow, out), v = dot(from_elbow, left), q2 = l.fore_m * l.fore_m - v * v;
  if (!(q2 > 1e-6 * l.fore_m * l.fore_m)) return false;
  const double q = square_root(q2), length = l.hinge_m + q;
  g = 0.5 * (u * u + from_elbow.z * from_elbow.z - length * length);
  gradient = u * out + (length * v / q) * left + Vec3{0, 0, from_elbow.z};
  return true;
}

// Newton from the meeting spheres, which is the answer where there are no hinges. Those of the largest device known
// (22.5 mm at 102.5 mm) leave 1e-16 m after four steps anywhere in its reach; a place that leaves more is refused.
bool settle(const Linkage& l, const Vec3* elbow, Vec3& x) noexcept {
  constexpr int kSteps = 6;
  constexpr double kSettled = 1e-12;  // of the forearm's square
  const double reach = l.fore_m + l.hinge_m;
  double left = 0;
  for (int step = 0; step <= kSteps; ++step) {
    Vec3 s[kDeltaLegs];
    double g[kDeltaLegs];
    left = 0;
    for (int i = 0; i < kDeltaLegs; ++i) {
      if (!delta_leg(l, i, x - elbow[i], g[i], s[i])) return false;
      left = max_of(left, abs_of(g[i]));
    }
    if (step == kSteps) break;
    const double volume = dot(s[0], cross(s[1], s[2]));
    if (!(abs_of(volume) > 1e-6 * reach * reach * reach)) return false;
    const Vec3 move = g[0] * cross(s[1], s[2]) + g[1] * cross(s[2], s[0]) + g[2] * cross(s[0], s[1]);
    x = x - (1 / volume) * move;
  }
  return left <= kSettled * reach * reach;
}

LinkageState delta_at(const Linkage& l, const double* joint) noexcept {
  LinkageState state;
  Vec3 elbow[kDeltaLegs], moves[kDeltaLegs], s[kDeltaLegs];
  for (int i = 0; i < kDeltaLegs; ++i) {
    const double c = math::cos(joint[i]), sine = math::sin(joint[i]);
    const double out = l.base_m - l.plate_m + l.upper_m * c;
    elbow[i] = {out * kLegCos[i] + l.aside_m * kLegSin[i], out * kLegSin[i] - l.aside_m * kLegCos[i], l.upper_m * sine};
    moves[i] = l.upper_m * Vec3{-sine * kLegCos[i], -sine * kLegSin[i], c};
  }
  const double reach = l.fore_m + l.hinge_m;
  if (!meet(elbow, reach, state.pose.position_m)) return state;
  if (l.hinge_m > 0 && !settle(l, elbow, state.pose.position_m)) return state;
  double rest = 0;
  for (int i = 0; i < kDeltaLegs; ++i)
    if (!delta_leg(l, i, state.pose.position_m - elbow[i], rest, s[i])) return state;
  const double volume = dot(s[0], cross(s[1], s[2]));
  const bool stiff = abs_of(volume) >= kSingularShare * reach * reach * reach;
  state.place = stiff ? LinkagePlace::kGood : LinkagePlace::kSingular;
  for (int i = 0; i < kDeltaLegs; ++i) {
    const double k = dot(s[i], moves[i]);
    if (!pushes(l, k)) state.place = LinkagePlace::kSingular;
    if (stiff) state.along[i] = (k / volume) * cross(s[(i + 1) % kDeltaLegs], s[(i + 2) % kDeltaLegs]);
  }
  return state;
}

LinkageState five_bar_at(const Linkage& l, const double* joint) noexcept {
  LinkageState state;
  const double cl = math::cos(joint[0]), sl = math::sin(joint[0]), cr = math::cos(joint[1]), sr = math::sin(joint[1]);
  const Vec3 left{-0.5 * l.base_m + l.upper_m * cl, l.upper_m * sl, 0};
  const Vec3 right{0.5 * l.base_m + l.upper_m * cr, l.upper_m * sr, 0};
  const Vec3 apart = right - left;
  const double apart2 = squared_norm(apart), height2 = l.fore_m * l.fore_m - 0.25 * apart2;
  if (!(apart2 > 1e-12) || !(height2 > 0)) return state;
  const Vec3 up = square_root(height2 / apart2) * Vec3{-apart.y, apart.x, 0};
  state.pose.position_m = 0.5 * (left + right) + up;
  const Vec3 s = state.pose.position_m - left, t = state.pose.position_m - right;
  const double ks = dot(s, l.upper_m * Vec3{-sl, cl, 0}), kt = dot(t, l.upper_m * Vec3{-sr, cr, 0});
  const double area = s.x * t.y - s.y * t.x;
  const bool stiff = abs_of(area) >= kSingularShare * l.fore_m * l.fore_m;
  state.place = stiff && pushes(l, ks) && pushes(l, kt) ? LinkagePlace::kGood : LinkagePlace::kSingular;
  if (!stiff) return state;
  state.along[0] = (ks / area) * Vec3{t.y, -t.x, 0};
  state.along[1] = (kt / area) * Vec3{-s.y, s.x, 0};
  return state;
}

// The angle of an arm that starts at `root` in a plane (u out of the motor's axis, v across it) and whose forearm, of
// square `fore2` in that plane, ends at (u, v): on the side of smaller angles, or of larger ones.
bool arm_angle(double upper, double fore2, double u, double v, bool smaller, double& angle) noexcept {
  const double reach2 = u * u + v * v, reach = square_root(reach2);
  if (!(reach > 1e-9)) return false;
  const double cosine = (reach2 + upper * upper - fore2) / (2 * upper * reach);
  if (!(cosine >= -1 && cosine <= 1)) return false;
  const double between = math::acos(cosine), towards = math::atan2(v, u);
  angle = smaller ? towards - between : towards + between;
  return true;
}

bool serial_to(const Linkage& l, const Pose& pose, double* joint) noexcept {
  const Vec3 p = pose.position_m;
  const double r = square_root(p.x * p.x + p.y * p.y);
  double b = 0;
  if (!arm_angle(l.upper_m, l.fore_m * l.fore_m, r, p.z, false, b)) return false;
  joint[0] = math::atan2(p.y, p.x);
  joint[1] = b;
  joint[2] = math::atan2(p.z - l.upper_m * math::sin(b), r - l.upper_m * math::cos(b));
  if (!l.gimbal) return true;
  // Rz Ry Rx of the handle seen from the forearm.
  const Quat q = conjugate(forearm_frame(joint[0], joint[2])) * normalised(pose.orientation);
  joint[3] = math::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
  joint[4] = math::asin(2 * (q.w * q.y - q.z * q.x));
  joint[5] = math::atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y));
  return true;
}

bool delta_to(const Linkage& l, Vec3 p, double* joint) noexcept {
  double found[kDeltaLegs];
  for (int i = 0; i < kDeltaLegs; ++i) {
    const double out = p.x * kLegCos[i] + p.y * kLegSin[i] - (l.base_m - l.plate_m);
    const double aside = p.y * kLegCos[i] - p.x * kLegSin[i] + l.aside_m;
    const double q2 = l.fore_m * l.fore_m - aside * aside;
    if (!(q2 > 0)) return false;
    const double length = l.hinge_m + square_root(q2);
    if (!arm_angle(l.upper_m, length * length, out, p.z, true, found[i])) return false;
  }
  for (int i = 0; i < kDeltaLegs; ++i) joint[i] = found[i];
  return true;
}

bool five_bar_to(const Linkage& l, Vec3 p, double* joint) noexcept {
  double left = 0, right = 0;
  const double half = 0.5 * l.base_m, fore2 = l.fore_m * l.fore_m;
  if (!arm_angle(l.upper_m, fore2, p.x + half, p.y, false, left)) return false;
  if (!arm_angle(l.upper_m, fore2, p.x - half, p.y, true, right)) return false;
  joint[0] = left;
  joint[1] = right;
  return true;
}

}  // namespace

int arm_joint_count(const Linkage& linkage) noexcept { return linkage.kind == LinkageKind::kFiveBar ? 2 : 3; }
int joint_count(const Linkage& linkage) noexcept { return arm_joint_count(linkage) + (linkage.gimbal ? 3 : 0); }

LinkageState linkage_at(const Linkage& linkage, const double* joint) noexcept {
  constexpr double kMost = 1e3;  // radians: well within the sine's range
  for (int i = 0; i < joint_count(linkage); ++i)
    if (!(abs_of(joint[i]) <= kMost)) return LinkageState();
  switch (linkage.kind) {
    case LinkageKind::kCartesian:
      return cartesian_at(joint);
    case LinkageKind::kSerial3r:
      return serial_at(linkage, joint);
    case LinkageKind::kDelta:
      return delta_at(linkage, joint);
    case LinkageKind::kFiveBar:
      return five_bar_at(linkage, joint);
  }
  return LinkageState();
}

bool linkage_to(const Linkage& linkage, const Pose& pose, double* joint) noexcept {
  if (!is_finite(pose)) return false;
  const Vec3 p = pose.position_m;
  switch (linkage.kind) {
    case LinkageKind::kCartesian:
      joint[0] = p.x;
      joint[1] = p.y;
      joint[2] = p.z;
      return true;
    case LinkageKind::kSerial3r:
      return serial_to(linkage, pose, joint);
    case LinkageKind::kDelta:
      return delta_to(linkage, p, joint);
    case LinkageKind::kFiveBar:
      return five_bar_to(linkage, p, joint);
  }
  return false;
}

void joint_torques(const Linkage& linkage, const LinkageState& state, const Wrench& wrench, double* torque) noexcept {
  const bool usable = state.place == LinkagePlace::kGood && is_finite(wrench.force_N) && is_finite(wrench.torque_Nm);
  for (int i = 0; i < joint_count(linkage); ++i)
    torque[i] = usable ? dot(state.along[i], wrench.force_N) + dot(state.about[i], wrench.torque_Nm) : 0.0;
}

}  // namespace palpate
