// `palpate doctor`: reads every item of the real-time checklist and says pass, fail or unknown with the command that
// mends it. It changes nothing and refuses nothing: the person decides.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

enum class Verdict { kPass, kFail, kUnknown };

struct DoctorItem {
  std::string name;
  Verdict verdict = Verdict::kUnknown;
  std::string found;   // what was read
  std::string remedy;  // command or setting that mends it; empty when it passes
};

// Where the facts come from; tests point it at a made-up machine.
struct DoctorSources {
  std::filesystem::path root = "/";                    // of /proc, /sys and /dev
  std::function<std::string(const std::string&)> run;  // output of a shell command, empty on failure
  int cpu = -1;                                        // CPU of the real-time thread; -1: not chosen
  int loop_priority = 80;                              // SCHED_FIFO priority of the loop
};

// The machine: kernel, isolation, throttling, limits, clock, power management.
std::vector<DoctorItem> examine_machine(const DoctorSources& sources);
// The device's bus. `device` is an address as `palpate run --device` takes it (can:IFACE, usb:/dev/hidrawN, loopback).
std::vector<DoctorItem> examine_device(const DoctorSources& sources, const std::string& device);
// The device's profile, without which nothing real is driven. No item for a simulated device without one.
std::vector<DoctorItem> examine_profile(const std::string& device, const std::string& profile);
// What the device itself sends, listened to for a second without a word to it. The simulated one of a run of its own
// ("loopback" without a name) has nothing to listen to: no items. Drives (of the profile) are asked by device-test.
std::vector<DoctorItem> listen_to_device(const std::string& device, const std::string& profile = "");
// A table for the terminal, one item a line, remedies indented below what failed.
std::string doctor_table(const std::vector<DoctorItem>& items);
// Names of the items that fail, separated by commas; empty when none does.
std::string failing_items(const std::vector<DoctorItem>& items);
// DoctorSources that read this machine.
DoctorSources this_machine();
// This machine and the device's bus, for a loop of that priority on that processor.
std::vector<DoctorItem> examine_machine_and_device(int cpu, int loop_priority, const std::string& device);

}  // namespace palpate
