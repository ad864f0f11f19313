#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "hal/bus/device_address.h"
#include "hal/device/device_profile.h"
#include "hal/drives/axis_device.h"
#include "hal/drives/drive_link.h"
#include "hal/loop/clock.h"
#include "hal/system/device_lock.h"
#include "sim_host/cli.h"
#include "sim_host/doctor/device_test.h"
#include "sim_host/doctor/doctor_json.h"

namespace palpate {

namespace {

// Drives are found, identified and set up as before a run, and none is enabled.
int run_drives_test(const DeviceAddress& address, const ArmProfile& arm, Json& json) {
  constexpr int kTimeout_ms = 10'000;
  constexpr double kUsualPeriod_s = 1e-3;
  std::string error;
  const std::unique_ptr<Transport> transport = open_drives(address, arm, DeviceSide::kController, kTimeout_ms, error);
  if (!transport) {
    fmt::print(stderr, "palpate: {}\n", error);
    return kExitUnavailable;
  }
  MonotonicClock clock;
  const std::unique_ptr<AxisDrives> drives = make_drives(*transport, arm, kUsualPeriod_s);
  AxisDevice device(*drives, arm, {}, kUsualPeriod_s);
  const std::string wrong = device.start([&clock] { clock.wait_until(clock.now_ns() + 1'000'000); });
  drives->transmit({});
  const std::string found = fmt::format("{} drives are those of the profile, with their watchdogs on", arm.axes.size());
  const std::vector<DoctorItem> rows{
      {"drives", wrong.empty() ? Verdict::kPass : Verdict::kFail, wrong.empty() ? found : wrong, ""}};
  json["items"] = items_json(rows);
  json["fail"] = wrong.empty() ? 0 : 1;
  fmt::print("{}No motor was enabled.\n", doctor_table(rows));
  return wrong.empty() ? kExitOk : kExitFailed;
}

int run_device_test(const std::string& device, const std::string& profile, Json& json) {
  std::string line, error;
  const std::optional<DeviceAddress> address = parse_device_address(device, line, error);
  if (!address) throw std::runtime_error(error);
  fmt::print("{}\n", line);
  json["device"] = device;
  DeviceLock lock;  // two that command one node are both obeyed, in turn
  if (const std::string name = lock_name(*address); !name.empty()) {
    lock = DeviceLock::take(name, error);
    if (!lock) {
      fmt::print(stderr, "palpate: {}\n", error);
      return kExitUnavailable;
    }
  }
  if (!profile.empty()) {
    const std::optional<DeviceProfile> known = read_device_profile(profile, error);
    if (!known) throw std::runtime_error(error);
    if (known->arm) return run_drives_test(*address, *known->arm, json);
  }
  constexpr int kTimeout_ms = 10'000;
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
  auto device = std::make_shared<std::string>(), profile = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "device-test", "Grade a device's firmware by the wire protocol's rules, with zero force throughout");
  command->add_option("ADDRESS", *device, "can:IFACE, usb:/dev/hidrawN or loopback:NAME, with ,classic and ,node=N")
      ->required();
  command->add_option("--profile", *profile, "of a device of drives: finds and identifies each, enables none");
  command->footer(
      "It takes the controller's place for 2 s: nothing else may drive the device meanwhile. Commands are lost, late,\n"
      "repeated, spoilt and withheld; each row says what the device made of it and, where a rule of\n"
      "docs/wire_protocol.md is broken, what its firmware should do. Exits with 1 when a rule is broken, 3 when the\n"
      "device cannot be opened. On a machine that stands still for milliseconds a row can fail by itself: repeat it.\n"
      "Examples:\n"
      "  palpate device-test can:can0\n"
      "  palpate device-test can:can0,classic,node=3\n"
      "  palpate device-test can:can0 --profile arm.toml      # of drives\n"
      "  palpate-device --device loopback:x & palpate device-test loopback:x");
  add_json_flag(*command, *as_json);
  command->callback([device, profile, as_json, &exit_code] {
    exit_code =
        run_with_json(*as_json, "device-test", [&](Json& json) { return run_device_test(*device, *profile, json); });
  });
}

}  // namespace palpate
