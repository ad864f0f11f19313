// What is known of a haptic device (config/devices/*.toml), and whether a scene asks more of it than it can do. The
// controller drives no device on a bus without one: force limit and coupling of an image are claims about hardware.
#pragma once

#include <optional>
#include <string>

#include "hal/device/arm_profile.h"
#include "rt_core/device_profile.h"
#include "rt_core/model.h"

namespace palpate {

struct DeviceProfile {
  std::string name;
#define PALPATE_KEY(member, key, value, lowest, highest, scale, meaning) double member = 0;
  PALPATE_PROFILE_KEYS(PALPATE_KEY)
#undef PALPATE_KEY
  CartesianKinematics frame;
  std::uint32_t clutch_buttons = 0;
  std::optional<ArmProfile> arm;  // a device whose drives report joints
};

// Reads the file: a [device] table of `key = number` lines and `name = "text"`, and the tables of arm_profile.h: a
// subset of TOML, so that the controller needs no parser of it and the file can be laid over a scene too (palpate bake
// --with, which takes [device] alone). Every key of [device] is needed: what was not measured is not known. On failure
// empty, and `error` names file, line, key, range and remedy.
std::optional<DeviceProfile> read_device_profile(const std::string& path, std::string& error);
// The same from text; `file` names it in errors.
std::optional<DeviceProfile> parse_device_profile(const std::string& text, const std::string& file, std::string& error);

// Stiffest coupling of a scene that the device keeps passive at this period. A handle whose motion is magnified by
// `scale` feels the scene's spring that many times as stiff, and its turning as many times as soft
// (hal/device/kinematics.h). Two handles against one another have half the damping of one and twice its encoder step.
struct AdmittedCoupling {
  StiffnessBound translation, rotation;
};
AdmittedCoupling admitted_coupling(const DeviceProfile& profile, double period_s, HeldPart held);

// Where the scene's numbers contradict the profile: its largest force or torque above the device's, or a coupling above
// what damping, delay, friction, encoder and frame.scale admit at the scene's period. One line each; empty when there
// is none.
std::string profile_contradictions(const DeviceProfile& profile, const ModelParams& scene);
// What a scene asks of what the device has, in one line.
std::string profile_text(const DeviceProfile& profile, const ModelParams& scene);

// Whether this run may begin: real devices need a profile, and a profile must fit the scene. `profile`: path, or empty.
// "" when it may, otherwise why not and what to do. `read`, when not null, receives what was read.
std::string refuse_profile(bool real_device, const std::string& device, const std::string& profile,
                           const ModelParams& scene, DeviceProfile* read = nullptr);

}  // namespace palpate
