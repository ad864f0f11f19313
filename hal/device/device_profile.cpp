#include "hal/device/device_profile.h"

#include <algorithm>
#include <span>
#include <sstream>
#include <vector>

#include "hal/device/profile_key.h"
#include "hal/system/private_file.h"
#include "rt_core/safety/smoothing_friction.h"

namespace palpate {
namespace {

constexpr ProfileKey<DeviceProfile> kKeys[] = {
#define PALPATE_KEY(member, key, value, lowest, highest, scale, meaning) \
  {&DeviceProfile::member, key, lowest, highest, scale, (value) == 0},  // a default of 0: the device cannot do it
    PALPATE_PROFILE_KEYS(PALPATE_KEY)
#undef PALPATE_KEY
};
constexpr std::size_t kLongestFile = 1 << 16;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Reads lines into a profile; every function answers "" or what is wrong.
class Reader {
 public:
  std::string line(const std::string& text) {
    if (text == "[device]") {
      if (begun_) return "a second [device]; one file describes one device";
      return begun_ = in_device_ = true, "";
    }
    if (text[0] == '[') {
      if (!begun_) return text + ": begin the file with [device]";
      in_device_ = false;
      return arm_.table(text);
    }
    const auto equals = text.find('=');
    if (equals == std::string::npos) return "'" + text + "': write KEY = VALUE";
    if (!begun_) return "a key before [device]; begin the file with [device]";
    const std::string key = trimmed(text.substr(0, equals)), value = trimmed(text.substr(equals + 1));
    if (!in_device_) return arm_.key(key, value);
    if (std::ranges::find(seen_, key) != seen_.end()) return key + ": given twice; keep one";
    seen_.push_back(key);
    return key == "name" ? read_text(key, value, profile.name) : read_key(kKeys, key, value, profile);
  }

  std::string finish() {
    std::string missing = std::ranges::find(seen_, "name") == seen_.end() ? "name" : "";
    add_missing(kKeys, seen_, missing);
    if (!missing.empty())
      return "missing: " + missing + "; a profile gives every key (docs/devices.md says how to measure them)";
    const std::string wrong = arm_.finish();
    profile.frame = arm_.frame();
    profile.clutch_buttons = arm_.clutch_buttons();
    if (arm_.given()) profile.arm = arm_.arm();
    return wrong;
  }

  DeviceProfile profile;

 private:
  ArmReader arm_;
  std::vector<std::string> seen_;
  bool begun_ = false, in_device_ = false;
};

// A number that the scene states and the device must reach.
void compare(std::string& text, const char* key, double asked, double has, const char* unit, const std::string& why) {
  if (asked <= has * (1 + 1e-9)) return;  // the same digits, rounded
  text += std::string(text.empty() ? "" : "\n") + "device." + key + ": the scene states " + short_text(asked) + " " +
          unit + ", the device " + why + " " + short_text(has) + " " + unit;
}

// A smoothed handle goes to and fro at rest where its friction does not hold it.
void compare_friction(std::string& text, const char* key, double asked, double has, const char* unit) {
  if (asked <= has * (1 + 1e-9)) return;
  text += std::string(text.empty() ? "" : "\n") + "device." + key + ": the scene smooths the encoder, which asks for " +
          short_text(asked) + " " + unit + " of friction, the device has " + short_text(has) + " " + unit +
          "; bake the scene with this profile (--with PROFILE), or with device.smooth_encoder = false";
}

// The rule of a bound, and what made it another: "2b / (T + 2 tau) over frame.scale = 2".
std::string rule_of(const StiffnessBound& bound, const DeviceProfile& profile, const char* by_scale) {
  const double scale = profile.frame.scale;
  return std::string(reason_of(bound)) +
         (scale != 1 ? std::string(by_scale) + "frame.scale = " + short_text(scale) : "");
}

}  // namespace

std::optional<DeviceProfile> parse_device_profile(const std::string& text, const std::string& file,
                                                  std::string& error) {
  Reader reader;
  std::istringstream input(text);
  std::string row;
  for (int number = 1; std::getline(input, row); ++number) {
    row.erase(std::min(row.find('#'), row.size()));
    const std::string line = trimmed(row);
    if (line.empty()) continue;
    const std::string wrong = reader.line(line);
    if (wrong.empty()) continue;
    error = file + ":" + std::to_string(number) + ": " + wrong;
    return std::nullopt;
  }
  // "force_max_N = 20" cut to "force_max_N = 2" reads well.
  if (!text.empty() && text.back() != '\n') {
    error = file + ": the last line has no end: cut off? Add an empty line";
    return std::nullopt;
  }
  if (const std::string wrong = reader.finish(); !wrong.empty()) {
    error = file + ": " + wrong;
    return std::nullopt;
  }
  return reader.profile;
}

std::optional<DeviceProfile> read_device_profile(const std::string& path, std::string& error) {
  error.clear();
  const PrivateFile file = PrivateFile::read(path, error);
  if (!file) return std::nullopt;
  const std::span<const std::byte> bytes = file.bytes();
  if (bytes.size() > kLongestFile) {
    error = path + ": " + std::to_string(bytes.size()) + " bytes are no device profile; give a config/devices/*.toml";
    return std::nullopt;
  }
  return parse_device_profile({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, error);
}

AdmittedCoupling admitted_coupling(const DeviceProfile& p, double period_s, HeldPart held) {
  const double hands = held == HeldPart::kBoth ? 2 : 1, scale = p.frame.scale;
  AdmittedCoupling admitted{admissible_stiffness(p.damping_Ns_per_m / hands, p.friction_N, hands * p.encoder_step_m,
                                                 period_s, p.delay_s, p.local_Hz),
                            admissible_stiffness(p.damping_Nms_per_rad / hands, p.friction_Nm,
                                                 hands * p.encoder_step_rad, period_s, p.delay_s)};
  admitted.translation.value /= scale;
  admitted.rotation.value *= scale;
  return admitted;
}

std::string profile_contradictions(const DeviceProfile& profile, const ModelParams& scene) {
  const AdmittedCoupling bounds = admitted_coupling(profile, scene.period_s, scene.held_part);
  const double scale = profile.frame.scale;
  std::string text;
  compare(text, "force_max_N", scene.force_max_N, profile.force_max_N, "N", "has");
  compare(text, "torque_max_Nm", scene.torque_max_Nm, scale * profile.torque_max_Nm, "N m",
          scale != 1 ? "has, times frame.scale = " + short_text(scale) + "," : "has");
  compare(text, "coupling_N_per_m", scene.coupling_N_per_m, bounds.translation.value, "N/m",
          "admits, by " + rule_of(bounds.translation, profile, " over ") + ",");
  if (scene.local_period_s > 0)
    compare(text, "local_kHz", 1e-3 / scene.local_period_s, 1e-3 * profile.local_Hz, "kHz",
            "evaluates the local contact model with");
  if (!(scene.local_period_s > 0)) {  // else the device smooths by itself
    const auto asked_N = [&](EncoderLaw law, double stiffness_N_per_m) {
      return friction_to_smooth(law, kSmoothedPosition, stiffness_N_per_m, scene.encoder_step_m,
                                profile.mass_kg / scale);
    };
    compare_friction(text, "friction_N",
                     std::max(asked_N(scene.encoder_law_m, scene.coupling_N_per_m),
                              asked_N(EncoderLaw::kMotion, scene.track_below_N_per_m)),
                     profile.friction_N, "N");
  }
  // Without torque the rotational spring moves nothing.
  if (scene.torque_max_Nm > 0)
    compare(text, "coupling_Nm_per_rad", scene.coupling_Nm_per_rad, bounds.rotation.value, "N m/rad",
            "admits, by " + rule_of(bounds.rotation, profile, " times ") + ",");
  if (scene.torque_max_Nm > 0)
    compare_friction(text, "friction_Nm",
                     friction_to_smooth(scene.encoder_law_rad, kSmoothedAngle, scene.coupling_Nm_per_rad,
                                        scene.encoder_step_rad, scale * profile.inertia_kg_m2),
                     scale * profile.friction_Nm, "N m");
  return text;
}

std::string profile_text(const DeviceProfile& profile, const ModelParams& scene) {
  const AdmittedCoupling bounds = admitted_coupling(profile, scene.period_s, scene.held_part);
  const auto part = [](double asked, double has, const char* unit) {
    return short_text(asked) + " of " + short_text(has) + " " + unit;
  };
  return profile.name + ": the scene asks " + part(scene.force_max_N, profile.force_max_N, "N") + ", " +
         part(scene.torque_max_Nm, profile.frame.scale * profile.torque_max_Nm, "N m") + ", a coupling of " +
         part(scene.coupling_N_per_m, bounds.translation.value, "N/m") + " and " +
         part(scene.coupling_Nm_per_rad, bounds.rotation.value, "N m/rad");
}

std::string refuse_profile(bool real_device, const std::string& device, const std::string& profile,
                           const ModelParams& scene, DeviceProfile* read) {
  if (profile.empty()) {
    if (!real_device) return "";
    return "refused: " + device +
           " is driven only with a profile that says what it can do: --profile FILE. Copy "
           "config/devices/example-can.toml, put in your device's numbers (docs/devices.md)";
  }
  std::string error;
  const std::optional<DeviceProfile> found = read_device_profile(profile, error);
  if (!found) return error;
  if (read != nullptr) *read = *found;
  const std::string against = profile_contradictions(*found, scene);
  if (against.empty()) return "";
  return "refused: the scene asks more than " + profile + " allows:\n" + against +
         "\nbake it for this device: palpate bake SCENE --with " + profile +
         (found->frame.scale != 1 ? " (which counts frame.scale in), or set frame.scale nearer to 1" : "");
}

}  // namespace palpate
