#include "hal/device/arm_profile.h"

#include <algorithm>

#include "hal/device/profile_key.h"
#include "rt_core/math.h"

namespace palpate {
namespace {

constexpr double kDegree = kPi / 180;
constexpr double kWord = 4294967295.0;         // 32 bits
constexpr double kSerial = 281474976710655.0;  // 48 bits: an ODrive's

constexpr ProfileKey<FrameProfile> kFrameKeys[] = {{&FrameProfile::x_m, "position_x_mm", -1e4, 1e4, 1e-3, true},
                                                   {&FrameProfile::y_m, "position_y_mm", -1e4, 1e4, 1e-3, true},
                                                   {&FrameProfile::z_m, "position_z_mm", -1e4, 1e4, 1e-3, true},
                                                   {&FrameProfile::turn_x_rad, "turn_x_deg", -360, 360, kDegree, true},
                                                   {&FrameProfile::turn_y_rad, "turn_y_deg", -360, 360, kDegree, true},
                                                   {&FrameProfile::turn_z_rad, "turn_z_deg", -360, 360, kDegree, true},
                                                   {&FrameProfile::scale, "scale", 0.01, 100, 1, true},
                                                   {&FrameProfile::workspace_m, "workspace_mm", 1, 1e5, 1e-3, true},
                                                   {&FrameProfile::clutch_button, "clutch_button", 0, 8, 1, true}};
constexpr ProfileKey<LinkageProfile> kLinkageKeys[] = {{&LinkageProfile::upper_m, "upper_mm", 1, 1e4, 1e-3, true},
                                                       {&LinkageProfile::fore_m, "fore_mm", 1, 1e4, 1e-3, true},
                                                       {&LinkageProfile::base_m, "base_mm", 1, 1e4, 1e-3, true},
                                                       {&LinkageProfile::plate_m, "plate_mm", 1, 1e4, 1e-3, true},
                                                       {&LinkageProfile::hinge_m, "hinge_mm", 0, 1e4, 1e-3, true},
                                                       {&LinkageProfile::aside_m, "aside_mm", -1e4, 1e4, 1e-3, true},
                                                       {&LinkageProfile::weight_x_N, "weight_x_N", -100, 100, 1, true},
                                                       {&LinkageProfile::weight_y_N, "weight_y_N", -100, 100, 1, true},
                                                       {&LinkageProfile::weight_z_N, "weight_z_N", -100, 100, 1, true}};
constexpr ProfileKey<DrivesProfile> kDrivesKeys[] = {
    {&DrivesProfile::bit_rate_Hz, "bit_rate_kHz", 10, 1000, 1e3, true},
    {&DrivesProfile::watchdog_s, "watchdog_ms", 5, 100, 1e-3, true},
    {&DrivesProfile::vendor_id, "vendor_id", 0, kWord, 1, true},
    {&DrivesProfile::product_code, "product_code", 0, kWord, 1, true},
    {&DrivesProfile::revision, "revision", 0, kWord, 1, true},
    {&DrivesProfile::endpoint_watchdog, "endpoint_enable_watchdog", 1, 65535, 1, true},
    {&DrivesProfile::endpoint_watchdog_s, "endpoint_watchdog_timeout", 1, 65535, 1, true},
    {&DrivesProfile::endpoint_direction, "endpoint_direction", 1, 65535, 1, true},
    {&DrivesProfile::moved_by_hand, "moved_by_hand", 0, 1, 1, true}};
constexpr ProfileKey<AxisProfile> kAxisKeys[] = {{&AxisProfile::node, "node", 1, 127, 1, false},
                                                 {&AxisProfile::serial, "serial", 1, kSerial, 1, true},
                                                 {&AxisProfile::counts_per_turn, "counts_per_turn", 1, 1e8, 1, false},
                                                 {&AxisProfile::ratio, "ratio", 0.01, 1000, 1, true},
                                                 {&AxisProfile::travel_m, "mm_per_turn", 0.01, 1e4, 1e-3, true},
                                                 {&AxisProfile::direction, "direction", -1, 1, 1, false},
                                                 {&AxisProfile::home_joint, "home_deg", -720, 720, kDegree, true},
                                                 {&AxisProfile::home_joint, "home_mm", -1e4, 1e4, 1e-3, true},
                                                 {&AxisProfile::home_turns, "home_turns", -1e6, 1e6, 1, true},
                                                 {&AxisProfile::lowest, "lowest_deg", -720, 720, kDegree, true},
                                                 {&AxisProfile::lowest, "lowest_mm", -1e4, 1e4, 1e-3, true},
                                                 {&AxisProfile::highest, "highest_deg", -720, 720, kDegree, true},
                                                 {&AxisProfile::highest, "highest_mm", -1e4, 1e4, 1e-3, true},
                                                 {&AxisProfile::torque_max_Nm, "torque_max_Nm", 0, 1000, 1, false},
                                                 {&AxisProfile::rated_Nm, "rated_Nm", 1e-3, 1000, 1, true},
                                                 {&AxisProfile::gravity_Nm, "gravity_Nm", -100, 100, 1, true},
                                                 {&AxisProfile::friction_Nm, "friction_Nm", 0, 100, 1, true}};

constexpr const char* kKinds[] = {"cartesian", "serial_3r", "serial_3r_gimbal", "delta", "five_bar"};
constexpr LinkageKind kKindOf[] = {LinkageKind::kCartesian, LinkageKind::kSerial3r, LinkageKind::kSerial3r,
                                   LinkageKind::kDelta, LinkageKind::kFiveBar};
constexpr int kGimbalKind = 2;
constexpr const char* kCalibrations[] = {"home_pose", "absolute", "index"};
constexpr int kHomePose = 0, kIndex = 2;
constexpr const char* kProtocols[] = {"odrive", "cia402", "moteus", "falcon"};

bool has(const std::vector<std::string>& seen, const char* key) { return std::ranges::find(seen, key) != seen.end(); }
bool whole(double value) { return value == static_cast<double>(static_cast<std::int64_t>(value)); }

}  // namespace

std::string ArmReader::table(const std::string& header) {
  if (const std::string wrong = close_table(); !wrong.empty()) return wrong;
  seen_.clear();
  bool* given = nullptr;
  if (header == "[frame]") table_ = Table::kFrame, given = &frame_given_;
  if (header == "[linkage]") table_ = Table::kLinkage, given = &linkage_given_;
  if (header == "[drives]") table_ = Table::kDrives, given = &drives_given_;
  if (header == "[[axis]]") {
    if (arm_.axes.size() == kMaxAxes) return "[[axis]]: more than " + std::to_string(kMaxAxes) + " axes";
    table_ = Table::kAxis;
    arm_.axes.emplace_back();
    return "";
  }
  if (given == nullptr) return header + ": a profile holds only [device], [frame], [linkage], [drives] and [[axis]]";
  if (*given) return "a second " + header + "; one file describes one device";
  *given = true;
  return "";
}

std::string ArmReader::key(const std::string& name, const std::string& value) {
  if (has(seen_, name.c_str())) return name + ": given twice; keep one";
  seen_.push_back(name);
  switch (table_) {
    case Table::kFrame:
      return read_key(kFrameKeys, name, value, frame_);
    case Table::kLinkage:
      if (name == "kind") return read_word(name, value, kKinds, kind_);
      if (name == "calibrate") return read_word(name, value, kCalibrations, calibrate_);
      return read_key(kLinkageKeys, name, value, linkage_);
    case Table::kDrives:
      if (name == "protocol") return read_word(name, value, kProtocols, protocol_);
      if (name == "firmware") return read_text(name, value, arm_.firmware);
      return read_key(kDrivesKeys, name, value, arm_.drives);
    case Table::kAxis:
      return read_key(kAxisKeys, name, value, arm_.axes.back());
    case Table::kNone:
      break;
  }
  return "a key before a table; begin the file with [device]";
}

// What only the whole table shows.
std::string ArmReader::close_table() {
  std::string missing;
  const auto need = [&](const char* key, bool needed) {
    if (needed && !has(seen_, key)) missing += (missing.empty() ? "" : ", ") + std::string(key);
  };
  const LinkageKind kind = kKindOf[kind_];
  if (table_ == Table::kLinkage) {
    need("kind", true);
    need("calibrate", true);
    need("upper_mm", kind != LinkageKind::kCartesian);
    need("fore_mm", kind != LinkageKind::kCartesian);
    need("base_mm", kind == LinkageKind::kDelta || kind == LinkageKind::kFiveBar);
    need("plate_mm", kind == LinkageKind::kDelta);
  } else if (table_ == Table::kDrives) {
    need("protocol", true);
    add_missing(kDrivesKeys, seen_, missing);
    const auto protocol = static_cast<DriveProtocol>(protocol_);
    need("firmware", protocol == DriveProtocol::kODrive || protocol == DriveProtocol::kMoteus);
    need("watchdog_ms", protocol != DriveProtocol::kFalcon);
    for (const char* key : {"endpoint_enable_watchdog", "endpoint_watchdog_timeout", "endpoint_direction"})
      need(key, protocol == DriveProtocol::kODrive);
    for (const char* key : {"vendor_id", "product_code", "revision"}) need(key, protocol == DriveProtocol::kCia402);
  } else if (table_ == Table::kAxis) {
    if (!linkage_given_ || !drives_given_) return "[[axis]] before [linkage] and [drives]; give these first";
    const bool slide = kind == LinkageKind::kCartesian;
    add_missing(kAxisKeys, seen_, missing);
    for (const char* key : {"mm_per_turn", "home_mm", "lowest_mm", "highest_mm"}) need(key, slide);
    for (const char* key : {"ratio", "home_deg", "lowest_deg", "highest_deg"}) need(key, !slide);
    need("home_turns", calibrate_ != kHomePose);
    const auto protocol = static_cast<DriveProtocol>(protocol_);
    need("rated_Nm", protocol == DriveProtocol::kCia402 || protocol == DriveProtocol::kFalcon);
    need("serial", protocol != DriveProtocol::kFalcon);
    if (has(seen_, slide ? "ratio" : "mm_per_turn"))
      return slide ? "ratio: a slide has mm_per_turn" : "mm_per_turn: only a slide has it";
    if (missing.empty()) return check_axis(arm_.axes.back(), arm_.axes.size());
  }
  return missing.empty() ? "" : "missing in the table above: " + missing + "; see docs/devices.md";
}

std::string ArmReader::check_axis(const AxisProfile& a, std::size_t number) const {
  const std::string axis = "axis " + std::to_string(number) + ": ";
  if (!whole(a.node) || !whole(a.serial)) return axis + "node and serial are whole numbers";
  if (a.direction != 1 && a.direction != -1) return axis + "direction: 1 or -1";
  if (!(a.lowest < a.home_joint && a.home_joint < a.highest))
    return axis + "the home position must lie between lowest and highest";
  for (std::size_t i = 0; i + 1 < number; ++i) {
    if (arm_.axes[i].node == a.node)
      return axis + "node " + short_text(a.node) + " is that of axis " + std::to_string(i + 1);
    if (a.serial > 0 && arm_.axes[i].serial == a.serial)
      return axis + "serial is that of axis " + std::to_string(i + 1);
  }
  if (a.friction_Nm > 0 && !(a.friction_Nm < a.torque_max_Nm))
    return axis + "friction_Nm: must be below torque_max_Nm, the torque the motor compensates it with";
  const auto protocol = static_cast<DriveProtocol>(protocol_);
  if (protocol == DriveProtocol::kODrive && a.node > 62) return axis + "node: an ODrive's is 1 to 62";
  if (protocol == DriveProtocol::kFalcon && a.node > 3) return axis + "node: a Falcon's motors are 1 to 3";
  if (protocol == DriveProtocol::kFalcon && a.torque_max_Nm > a.rated_Nm)
    return axis + "torque_max_Nm: more than rated_Nm, the most a Falcon's motor can be sent";
  if (protocol == DriveProtocol::kCia402 && a.torque_max_Nm > 10 * a.rated_Nm)
    return axis + "torque_max_Nm: more than ten times rated_Nm";
  return "";
}

std::string ArmReader::check_linkage() {
  arm_.linkage = {kKindOf[kind_],  kind_ == kGimbalKind, linkage_.upper_m, linkage_.fore_m,
                  linkage_.base_m, linkage_.plate_m,     linkage_.hinge_m, linkage_.aside_m};
  arm_.weight_N = {linkage_.weight_x_N, linkage_.weight_y_N, linkage_.weight_z_N};
  arm_.home_pose = calibrate_ == kHomePose;
  arm_.index = calibrate_ == kIndex;
  arm_.protocol = static_cast<DriveProtocol>(protocol_);
  const bool falcon = arm_.protocol == DriveProtocol::kFalcon;
  if (falcon && !arm_.index)
    return "calibrate: a Falcon's encoders count from their index marks: calibrate = \"index\"";
  if (arm_.index && !falcon && arm_.protocol != DriveProtocol::kCia402)
    return "calibrate = \"index\": of CiA 402 drives and of a Falcon alone; " + std::string(kProtocols[protocol_]) +
           " drives are not asked for their index marks: let the drive itself search its index when it is switched on "
           "and state \"absolute\", or state \"home_pose\"";
  if (falcon && arm_.linkage.kind != LinkageKind::kDelta) return "protocol = \"falcon\" goes with kind = \"delta\"";
  const auto joints = static_cast<std::size_t>(joint_count(arm_.linkage));
  if (arm_.axes.size() != joints)
    return std::string(kKinds[kind_]) + " has " + std::to_string(joints) + " axes, not " +
           std::to_string(arm_.axes.size());
  double home[kMaxAxes] = {};
  for (std::size_t i = 0; i < joints; ++i) home[i] = arm_.axes[i].home_joint;
  if (linkage_at(arm_.linkage, home).place == LinkagePlace::kUnreachable)
    return "no handle fits the home positions of the axes: lengths or angles are wrong";
  return "";
}

std::string ArmReader::finish() {
  if (const std::string wrong = close_table(); !wrong.empty()) return wrong;
  if (!whole(frame_.clutch_button)) return "clutch_button: a whole number";
  if (!whole(arm_.drives.moved_by_hand)) return "moved_by_hand: 0 or 1";
  if (!given()) return "";
  if (!linkage_given_ || !drives_given_) return "drives need [linkage], [drives] and one [[axis]] for each joint";
  return check_linkage();
}

CartesianKinematics ArmReader::frame() const {
  const Vec3 turn{frame_.turn_x_rad, frame_.turn_y_rad, frame_.turn_z_rad};
  const double angle = norm(turn);
  const Vec3 axis = math::sin(0.5 * angle) * unit_or(turn, {0, 0, 1});
  return {{frame_.x_m, frame_.y_m, frame_.z_m},
          normalised({math::cos(0.5 * angle), axis.x, axis.y, axis.z}),
          frame_.scale,
          frame_.workspace_m};
}

std::uint32_t ArmReader::clutch_buttons() const {
  const auto button = static_cast<std::uint32_t>(frame_.clutch_button);
  return button > 0 ? 1u << (button - 1) : 0;
}

}  // namespace palpate
