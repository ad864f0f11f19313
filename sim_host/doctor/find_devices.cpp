#include "sim_host/doctor/find_devices.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/bus/device_address.h"
#include "hal/bus/socketcan.h"
#include "hal/bus/usb_hid.h"
#include "hal/loop/clock.h"
#include "hal/system/device_lock.h"
#include "sim_host/doctor/ask_moteus.h"
#include "sim_host/doctor/bus_speakers.h"
#include "sim_host/doctor/doctor_files.h"

namespace palpate {

namespace {

namespace fs = std::filesystem;
using doctor::content;
using doctor::first_line;

constexpr const char* kArpCan = "280";  // ARPHRD_CAN of linux/if_arp.h
constexpr int kFdMtu = 72;
constexpr const char* kOpenProfile = "config/devices/example-can.toml";

DoctorItem open_node_item(const std::string& address, bool classic, const std::vector<int>& nodes) {
  const std::string options = (classic ? ",classic" : "") + (nodes[0] == 1 ? "" : fmt::format(",node={}", nodes[0]));
  return {fmt::format("{}: open node {}", address, fmt::join(nodes, ", ")), Verdict::kPass,
          fmt::format("{} frames; profile: a copy of {}", classic ? "classic" : "CAN FD", kOpenProfile),
          "palpate device-test " + address + options};
}

// `profile`: a file of config/devices/ to copy.
DoctorItem drives_item(const std::string& name, const std::string& address, const std::string& driver,
                       const std::string& profile) {
  return {name, Verdict::kPass, fmt::format("driver {}; profile: a copy of config/devices/{}", driver, profile),
          fmt::format("cp config/devices/{} device.toml; edit it; palpate device-test {} --profile device.toml",
                      profile, address)};
}

DoctorItem item_of(const std::string& address, Protocol protocol, const std::vector<int>& nodes) {
  const auto named = [&](const char* what) { return fmt::format("{}: {} {}", address, what, fmt::join(nodes, ", ")); };
  switch (protocol) {
    case Protocol::kCanopen:
      return drives_item(named("CANopen node"), address, "cia402", "example-delta-cia402.toml");
    case Protocol::kOdrive:
      return drives_item(named("ODrive"), address, "odrive", "example-arm-odrive.toml");
    case Protocol::kOpenNode:
    case Protocol::kOpenNodeClassic:
      break;
  }
  return open_node_item(address, protocol == Protocol::kOpenNodeClassic, nodes);
}

// What asks for moteus controllers adds; with nobody found, the next step.
void ask_bus(const std::string& name, const std::vector<Frame>& heard, const AskOn& ask,
             std::vector<DoctorItem>& items) {
  const std::string address = "can:" + name;
  if (!ask) return;
  if (std::ranges::any_of(heard, [](const Frame& frame) { return !frame.fd; })) {
    items.push_back({address, Verdict::kUnknown,
                     "moteus not asked for: classic frames were heard, whose nodes CAN FD may disturb", ""});
    return;
  }
  const BusAnswers answers = ask(name);
  if (!answers.error.empty())
    items.push_back({address, Verdict::kUnknown, "moteus not asked for: " + answers.error, ""});
  if (!answers.moteus.empty())
    items.push_back(drives_item(fmt::format("{}: moteus {}", address, fmt::join(answers.moteus, ", ")), address,
                                "moteus", "example-arm-moteus.toml"));
}

DoctorItem nobody(const std::string& address, bool fd, bool asked, const std::vector<Frame>& heard) {
  std::set<std::uint32_t> others;
  for (const Frame& frame : heard) others.insert(frame.id);
  const std::string silent = fmt::format(
      "nobody heard for half a second{}: power, termination, bit rate; a drive may keep silent until its heartbeat is "
      "set{}",
      asked ? ", no moteus answers" : "", fd && !asked ? ", a moteus until it is asked" : "");
  return {address, Verdict::kUnknown,
          others.empty() ? silent
                         : fmt::format("{} frames of {} identifiers, of no driver here, the first {:#x}", heard.size(),
                                       others.size(), *others.begin()),
          (fd && !asked ? "palpate doctor --device --ask   (asks each moteus there can be), or " : "") +
              ("palpate device-test " + address) + " --profile FILE   (asks the drives of a profile)"};
}

void find_on_bus(const std::string& name, bool fd, const ListenTo& listen, const AskOn& ask,
                 std::vector<DoctorItem>& items) {
  const std::string address = "can:" + name;
  const BusTraffic traffic = listen(name, fd);
  if (!traffic.error.empty()) {
    items.push_back({address, Verdict::kUnknown, "not listened to: " + traffic.error, ""});
    return;
  }
  std::map<Protocol, std::vector<int>> nodes;
  for (const Speaker& speaker : speakers_of(traffic.frames)) nodes[speaker.protocol].push_back(speaker.node);
  const std::size_t before = items.size();
  for (const auto& [protocol, list] : nodes) items.push_back(item_of(address, protocol, list));
  if (fd) ask_bus(name, traffic.frames, ask, items);
  if (items.size() == before) items.push_back(nobody(address, fd, static_cast<bool>(ask), traffic.frames));
}

void find_can(const fs::path& root, const ListenTo& listen, const AskOn& ask, std::vector<DoctorItem>& items) {
  std::error_code error;
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(root / "sys/class/net", error))
    if (first_line(entry.path() / "type") == kArpCan) names.insert(entry.path().filename().string());
  for (const std::string& name : names) {
    const fs::path folder = root / "sys/class/net" / name;
    const long flags = std::strtol(first_line(folder / "flags").value_or("0").c_str(), nullptr, 0);
    if ((flags & 1) == 0) {                                       // IFF_UP
      const bool is_chip = fs::exists(folder / "device", error);  // a virtual one has no bit rate
      const std::string rate = " type can bitrate 1000000 restart-ms 0   (FD: dbitrate 5000000 fd on)";
      items.push_back({"can:" + name, Verdict::kFail, "down", "ip link set " + name + " up" + (is_chip ? rate : "")});
      continue;
    }
    find_on_bus(name, doctor::number(first_line(folder / "mtu")).value_or(0) >= kFdMtu, listen, ask, items);
  }
}

// The value of a line KEY=value.
std::string value_of(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key + "=");
  if (at == std::string::npos) return "";
  const std::size_t from = at + key.size() + 1;
  return text.substr(from, text.find('\n', from) - from);
}

void find_hid(const fs::path& root, std::vector<DoctorItem>& items) {
  std::error_code error;
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(root / "sys/class/hidraw", error))
    names.insert(entry.path().filename().string());
  for (const std::string& name : names) {
    const fs::path device = root / "sys/class/hidraw" / name / "device";
    const std::string descriptor = content(device / "report_descriptor");
    const std::string_view wanted(reinterpret_cast<const char*>(kReportDescriptor), sizeof kReportDescriptor);
    const std::string called = value_of(content(device / "uevent"), "HID_NAME");
    const std::string address = "usb:/dev/" + name;
    if (descriptor != wanted) continue;  // keyboards and the like
    items.push_back({address + ": open node", Verdict::kPass, "'" + called + "'; profile: a copy of " + kOpenProfile,
                     "palpate device-test " + address});
  }
}

// /dev/bus/usb/BUS/DEVICE, as usbfs names it.
std::string usb_path(const fs::path& device) {
  const auto number = [&](const char* name) {
    return doctor::number(first_line(device / name).value_or("")).value_or(0);
  };
  return fmt::format("/dev/bus/usb/{:03}/{:03}", number("busnum"), number("devnum"));
}

// Devices known by their numbers alone.
void find_usb(const fs::path& root, std::vector<DoctorItem>& items) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root / "sys/bus/usb/devices", error)) {
    const auto vendor = first_line(entry.path() / "idVendor"), product = first_line(entry.path() / "idProduct");
    if (vendor != "0403" || !product) continue;  // FTDI
    if (product != "cb48") {
      items.push_back(
          {"USB " + *vendor + ":" + *product, Verdict::kUnknown, "FTDI serial adapter: no driver uses one", ""});
      continue;
    }
    const std::string address = "usb:" + usb_path(entry.path());
    items.push_back({address + ": Novint Falcon", Verdict::kPass,
                     "profile: a copy of config/devices/example-falcon.toml",
                     "palpate device-test " + address + " --profile FILE"});
  }
}

}  // namespace

std::vector<DoctorItem> find_devices(const fs::path& root, const ListenTo& listen, const AskOn& ask) {
  std::vector<DoctorItem> items;
  find_can(root, listen, ask, items);
  find_hid(root, items);
  find_usb(root, items);
  if (items.empty())
    items.push_back({"devices", Verdict::kUnknown, "no CAN interface, no HID node, no FTDI adapter",
                     "palpate view SCENE   (the mouse is the device), or docs/devices.md"});
  return items;
}

BusTraffic listen_to_bus(const std::string& interface, bool fd) {
  constexpr int kPeriods = 500;
  constexpr std::size_t kMostFrames = 4096;
  BusTraffic traffic;
  const std::unique_ptr<Transport> transport = open_socketcan({interface, fd, {}}, traffic.error);
  if (!transport) return traffic;
  MonotonicClock clock;
  for (int i = 0; i < kPeriods; ++i) {
    clock.wait_until(clock.now_ns() + 1'000'000);
    Frame frames[kMaxFramesPerReceive];
    const int count = transport->receive(frames);
    for (int k = 0; k < count && traffic.frames.size() < kMostFrames; ++k) traffic.frames.push_back(frames[k]);
  }
  return traffic;
}

BusAnswers ask_on_bus(const std::string& interface) {
  BusAnswers answers;
  const DeviceLock lock = DeviceLock::take(lock_name({TransportKind::kCan, interface}), answers.error);
  if (!lock) return answers;
  const std::unique_ptr<Transport> transport = open_socketcan({interface, true, {}, true}, answers.error);
  if (!transport) return answers;
  MonotonicClock clock;
  answers.moteus = ask_moteus(*transport, [&clock] { clock.wait_until(clock.now_ns() + 1'000'000); });
  return answers;
}

}  // namespace palpate
