#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include <fmt/format.h>
#include "hal/bus/device_address.h"
#include "hal/device/device_profile.h"
#include "hal/drives/drive_link.h"
#include "rt_core/safety/smoothing_friction.h"
#include "sim_host/doctor/doctor.h"
#include "sim_host/doctor/doctor_files.h"

namespace palpate {

namespace {

using doctor::first_line;
using doctor::number;
using nlohmann::json;

DoctorItem judged(std::string name, std::optional<bool> good, std::string found, std::string remedy) {
  const Verdict verdict = !good ? Verdict::kUnknown : *good ? Verdict::kPass : Verdict::kFail;
  return {std::move(name), verdict, std::move(found), good.value_or(false) ? "" : std::move(remedy)};
}

// SCHED_FIFO priority of the interrupt thread whose name ends in `suffix` ("-can0"), from /proc/PID/stat field 40.
std::optional<long> interrupt_thread_priority(const DoctorSources& s, const std::string& suffix) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(s.root / "proc", error)) {
    const auto name = first_line(entry.path() / "comm");
    if (!name || name->rfind("irq/", 0) != 0 || !name->ends_with(suffix)) continue;
    const std::string stat = first_line(entry.path() / "stat").value_or("");
    std::stringstream fields(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
    std::string field;
    for (int i = 3; i <= 40 && fields >> field; ++i) {
    }
    return number(field);
  }
  return std::nullopt;
}

DoctorItem interrupt_thread(const DoctorSources& s, const std::string& suffix) {
  const auto priority = interrupt_thread_priority(s, suffix);
  return judged(
      "interrupt thread above the loop", priority ? std::optional(*priority > s.loop_priority) : std::nullopt,
      priority ? fmt::format("priority {}, loop {}", *priority, s.loop_priority) : "no threaded interrupt found",
      fmt::format("chrt -f -p {} $(pgrep -f 'irq/.*{}')", s.loop_priority + 5, suffix));
}

// The name becomes part of a shell command, so nothing but what the kernel allows in practice gets through.
bool is_interface_name(const std::string& name) {
  return !name.empty() && name.size() < 16 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.';
  });
}

std::vector<DoctorItem> examine_can(const DoctorSources& s, const std::string& name, WireProfile profile) {
  if (!is_interface_name(name)) return {judged("CAN interface", false, name, "give an interface name such as can0")};
  const json links = json::parse(s.run(fmt::format("ip -details -json link show {}", name)), nullptr, false);
  if (!links.is_array() || links.empty()) {
    return {judged("CAN interface " + name, false, "not found", "ip link show type can; modprobe the card's driver")};
  }
  const json& link = links[0];
  const json data = link.value("/linkinfo/info_data"_json_pointer, json::object());
  const std::string kind = link.value("/linkinfo/info_kind"_json_pointer, std::string{});
  const bool is_virtual = kind == "vcan" || kind == "vxcan";
  const bool up = link.dump().find("\"UP\"") != std::string::npos;
  const std::string qdisc = link.value("qdisc", "");
  const long queue = link.value("txqlen", -1L);
  const long mtu = link.value("mtu", 0L);
  const std::string down = fmt::format("ip link set {} down; ", name);
  std::vector<DoctorItem> items;
  items.push_back(judged("CAN interface " + name, up, up ? "up" : "down", fmt::format("ip link set {} up", name)));
  items.push_back(
      judged("queue discipline", qdisc == "pfifo_fast" || qdisc == "noqueue", qdisc.empty() ? "none" : qdisc,
             fmt::format("tc qdisc replace dev {} root pfifo_fast   (fq_codel drops frames silently)", name)));
  if (profile == WireProfile::kFd)
    items.push_back(judged("MTU for CAN FD", mtu == 72 ? std::optional(true) : std::nullopt, fmt::format("{}", mtu),
                           "classic frames only (can:IFACE,classic): " + down +
                               fmt::format("ip link set {} up type can bitrate 1000000 dbitrate 5000000 fd on", name)));
  if (is_virtual) return items;
  const long bitrate = data.value("/bittiming/bitrate"_json_pointer, 0L);
  const long restart = data.value("restart_ms", 0L);
  items.push_back(judged("bit rate", bitrate >= 1'000'000, fmt::format("{} bit/s", bitrate),
                         down + fmt::format("ip link set {} up type can bitrate 1000000", name)));
  items.push_back(judged("stays bus-off until the operator acts", restart == 0, fmt::format("restart-ms {}", restart),
                         down + fmt::format("ip link set {} type can restart-ms 0", name)));
  items.push_back(judged("short transmit queue", queue >= 0 && queue <= 16, fmt::format("{} frames", queue),
                         fmt::format("ip link set {} txqueuelen 10   (a long queue sends stale forces)", name)));
  items.push_back(interrupt_thread(s, "-" + name));
  return items;
}

std::vector<DoctorItem> examine_usb(const DoctorSources& s, const std::string& path) {
  const auto node = s.root / std::filesystem::path(path).relative_path();
  const bool exists = std::filesystem::exists(node);
  return {judged("USB device " + path, exists, exists ? "present" : "missing", "plug it in; dmesg | tail"),
          judged("readable without root", exists ? std::optional(access(node.c_str(), R_OK | W_OK) == 0) : std::nullopt,
                 exists ? "see file mode" : "-",
                 "copy hal/system/70-palpate.rules to /etc/udev/rules.d and plug it in again"),
          interrupt_thread(s, "-xhci_hcd")};
}

}  // namespace

std::vector<DoctorItem> examine_device(const DoctorSources& s, const std::string& device) {
  std::string line, error;
  const std::optional<DeviceAddress> address = parse_device_address(device, line, error);
  if (!address) return {judged("device " + device, false, error, "palpate run --help")};
  if (address->kind == TransportKind::kCan) return examine_can(s, address->name, address->profile);
  if (address->kind == TransportKind::kUsb) return examine_usb(s, address->name);
  return {judged("device " + device, true, "simulated: nothing to check on a bus", "")};
}

std::vector<DoctorItem> examine_profile(const std::string& device, const std::string& profile) {
  std::string line, error;
  const std::optional<DeviceAddress> address = parse_device_address(device, line, error);
  const bool real = address && address->kind != TransportKind::kLoopback;
  if (profile.empty() && !real) return {};
  if (profile.empty())
    return {judged("device profile", false, "none given",
                   "--profile FILE: copy config/devices/example-can.toml and put in "
                   "the device's numbers (docs/devices.md)")};
  const std::optional<DeviceProfile> found = read_device_profile(profile, error);
  if (!found) return {judged("device profile", false, error, "docs/devices.md says what a profile holds")};
  constexpr double kUsualPeriod_s = 1e-3;
  const double admitted = admitted_coupling(*found, kUsualPeriod_s, HeldPart::kTool).translation.value;
  const SmoothingNeed need =
      smoothing_need(kSmoothedPosition, admitted, found->encoder_step_m, found->mass_kg, found->friction_N);
  std::vector<DoctorItem> items{judged(
      "device profile", true,
      fmt::format("{}: {:.4g} N, {:.4g} N m, admits {:.4g} N/m at 1 kHz; smoothing its encoder there asks for "
                  "{:.4g} N of friction, it has {:.4g} N",
                  found->name, found->force_max_N, found->torque_max_Nm, admitted, need.friction, found->friction_N),
      "")};
  if (!found->arm) return items;
  const BusVerdict verdict = check_drives_budget(*found->arm, kUsualPeriod_s);
  items.push_back(judged("bus budget of the drives", verdict.fits,
                         fmt::format("{:.0f} of {:.0f} us at 1 kHz", verdict.used_us, verdict.available_us),
                         "bake scenes with device.period_ms = 2, or drive all axes by one node on CAN FD"));
  return items;
}

std::string failing_items(const std::vector<DoctorItem>& items) {
  std::string text;
  for (const DoctorItem& item : items) {
    if (item.verdict == Verdict::kFail) text += (text.empty() ? "" : ", ") + item.name;
  }
  return text;
}

std::string doctor_table(const std::vector<DoctorItem>& items) {
  std::string table;
  for (const DoctorItem& item : items) {
    const char* word = item.verdict == Verdict::kPass ? "pass" : item.verdict == Verdict::kFail ? "FAIL" : "unknown";
    table += fmt::format("{:<8}{:<40}{}\n", word, item.name, item.found);
    if (!item.remedy.empty()) table += fmt::format("        -> {}\n", item.remedy);
  }
  return table;
}

}  // namespace palpate
