#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "hal/bus/device_address.h"
#include "hal/device/device_profile.h"
#include "hal/drives/axis_device.h"
#include "hal/drives/drive_link.h"
#include "hal/drives/moved_record.h"
#include "hal/loop/clock.h"
#include "hal/system/device_lock.h"
#include "sim_host/cli.h"
#include "sim_host/doctor/device_test.h"
#include "sim_host/doctor/doctor_json.h"
#include "sim_host/doctor/move_check.h"
#include "sim_host/doctor/push_check.h"

namespace palpate {

namespace {

constexpr int kTimeout_ms = 10'000;

// The person's part, once the drives are found: moves the handle, motors off.
std::vector<DoctorItem> move_by_hand(AxisDevice& device, const DeviceProfile& profile, const std::string& file,
                                     const AxisDrives::Pause& pause, bool json) {
  MoveCheck check(device, *profile.arm, profile.frame, pause, [json](const std::string& line) {
    fmt::print(json ? stderr : stdout, "{}\n", line);
    std::fflush(stdout);
  });
  std::vector<DoctorItem> rows = check.run();
  if (!failing_items(rows).empty()) return rows;
  const std::string wrong = record_moved(file);
  rows.push_back({"record", wrong.empty() ? Verdict::kPass : Verdict::kUnknown,
                  wrong.empty() ? file + ".moved, for runs whose profile says moved_by_hand = 1" : wrong, ""});
  return rows;
}

struct DeviceTestOptions {
  std::string device, profile;
  bool move = false, push = false, json = false;
};

// A period that the drives' traffic fits: the usual one, or the half rate that the bus budget offers where it does not.
double fitting_period_s(const ArmProfile& arm) {
  constexpr double kUsual_s = 1e-3;
  return check_drives_budget(arm, kUsual_s).fits ? kUsual_s : 2 * kUsual_s;
}

// Drives are found, identified and set up as before a run, and none is enabled.
int run_drives_test(const DeviceAddress& address, const DeviceProfile& profile, const DeviceTestOptions& options,
                    Json& json) {
  const ArmProfile& arm = *profile.arm;
  const double period_s = fitting_period_s(arm);
  std::string error;
  const std::unique_ptr<Transport> transport = open_drives(address, arm, DeviceSide::kController, kTimeout_ms, error);
  if (!transport) {
    fmt::print(stderr, "palpate: {}\n", error);
    return kExitUnavailable;
  }
  MonotonicClock clock;
  const AxisDrives::Pause pause = [&clock] { clock.wait_until(clock.now_ns() + 1'000'000); };
  const std::unique_ptr<AxisDrives> drives = make_drives(*transport, arm, period_s);
  AxisDevice device(*drives, arm, profile.frame, period_s);
  // Joints beyond their limits are what moving them by hand explains.
  const std::string wrong = options.move ? device.find(pause) : device.start(pause);
  const std::string found = fmt::format("{} drives are those of the profile, with their watchdogs on", arm.axes.size());
  std::vector<DoctorItem> rows{
      {"drives", wrong.empty() ? Verdict::kPass : Verdict::kFail, wrong.empty() ? found : wrong, ""}};
  const auto add = [&rows](std::vector<DoctorItem> more) {
    for (DoctorItem& row : more) rows.push_back(std::move(row));
  };
  if (options.move && wrong.empty()) add(move_by_hand(device, profile, options.profile, pause, options.json));
  const bool push = options.push && failing_items(rows).empty();
  if (push) add(PushCheck(*drives, arm, pause).run());
  drives->transmit({});
  const auto failed = std::ranges::count(rows, Verdict::kFail, &DoctorItem::verdict);
  json["items"] = items_json(rows);
  json["fail"] = failed;
  fmt::print("{}{}{}.\n", doctor_table(rows), device.remarks(),
             push ? "Each motor pushed by itself, with a fifth of its torque at most" : "No motor was enabled");
  return failed == 0 ? kExitOk : kExitFailed;
}

int run_device_test(const DeviceTestOptions& options, Json& json) {
  std::string line, error;
  const std::optional<DeviceAddress> address = parse_device_address(options.device, line, error);
  if (!address) throw std::runtime_error(error);
  fmt::print("{}\n", line);
  json["device"] = options.device;
  DeviceLock lock;  // two that command one node are both obeyed, in turn
  if (const std::string name = lock_name(*address); !name.empty()) {
    lock = DeviceLock::take(name, error);
    if (!lock) {
      fmt::print(stderr, "palpate: {}\n", error);
      return kExitUnavailable;
    }
  }
  if (!options.profile.empty()) {
    const std::optional<DeviceProfile> known = read_device_profile(options.profile, error);
    if (!known) throw std::runtime_error(error);
    if (known->arm) return run_drives_test(*address, *known, options, json);
  }
  if (options.move || options.push)
    throw CLI::ValidationError(options.move ? "--move" : "--push", "is for a device of drives: give its --profile");
  const std::unique_ptr<Transport> transport = open_transport(*address, DeviceSide::kController, kTimeout_ms, error);
  if (!transport) {
    fmt::print(stderr, "palpate: {}\n", error);
    return kExitUnavailable;
  }
  MonotonicClock clock;
  constexpr std::int64_t kPeriod_ns = 1'000'000;
  std::int64_t deadline_ns = clock.now_ns();
  DeviceTest test(*transport, address->profile, address->node,
                  [&] { clock.wait_until(deadline_ns = std::max(deadline_ns + kPeriod_ns, clock.now_ns())); });
  const std::vector<DoctorItem> rows = test.run();
  fmt::print("{}", doctor_table(rows));
  const auto failed =
      std::count_if(rows.begin(), rows.end(), [](const DoctorItem& row) { return row.verdict == Verdict::kFail; });
  json["items"] = items_json(rows);
  json["fail"] = failed;
  fmt::print("{} rules: {} broken. No command carried a force.\n", rows.size(), failed);
  return failed == 0 ? kExitOk : kExitFailed;
}

}  // namespace

void add_device_test_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DeviceTestOptions>();
  CLI::App* command = app.add_subcommand(
      "device-test", "Grade a device's firmware by the wire protocol's rules, with zero force throughout");
  command
      ->add_option("ADDRESS", options->device,
                   "can:IFACE, usb:/dev/hidrawN or loopback:NAME, with ,classic and ,node=N")
      ->required();
  command->add_option("--profile", options->profile, "of a device of drives: finds and identifies each, enables none");
  command->add_flag("--move", options->move,
                    "of drives: asks you to move the handle forward, up and right, motors off, and names the axis that "
                    "is dead, reversed, swapped or of another scale");
  command->footer(
      "It takes the controller's place for 2 s: nothing else may drive the device meanwhile. Commands are lost, late,\n"
      "repeated, spoilt and withheld; each row says what the device made of it and, where a rule of\n"
      "docs/wire_protocol.md is broken, what its firmware should do. Exits with 1 when a rule is broken, 3 when the\n"
      "device cannot be opened. On a machine that stands still for milliseconds a row can fail by itself: repeat it.\n"
      "Examples:\n"
      "  palpate device-test can:can0\n"
      "  palpate device-test can:can0,classic,node=3\n"
      "  palpate device-test can:can0 --profile arm.toml      # of drives\n"
      "  palpate device-test can:can0 --profile arm.toml --move --push\n"
      "  palpate-device --device loopback:x & palpate device-test loopback:x");
  command->add_flag("--push", options->push,
                    "of drives, after that: enables them, and each motor pushes by itself until its joint moves by "
                    "1 mm, with a fifth of its torque at most; names one that pushes the wrong way");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    exit_code =
        run_with_json(options->json, "device-test", [&](Json& json) { return run_device_test(*options, json); });
  });
}

}  // namespace palpate
