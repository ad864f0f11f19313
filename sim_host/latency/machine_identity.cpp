#include "sim_host/latency/machine_identity.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim_host/doctor/doctor_files.h"

namespace palpate {

namespace {

// Value of the first "key : value" line of /proc/cpuinfo; `count`: how many there are.
std::string cpuinfo(const std::string& text, const std::string& key, int* count = nullptr) {
  std::istringstream lines(text);
  std::string value;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with(key)) continue;
    if (line.find_first_not_of(" \t", key.size()) != colon) continue;
    if (count != nullptr) *count += 1;
    if (value.empty() && colon + 2 <= line.size()) value = line.substr(colon + 2);
  }
  return value;
}

}  // namespace

MachineIdentity identify_machine(const DoctorSources& s, const std::string& device) {
  using doctor::first_line;
  MachineIdentity machine;
  const std::string cpu = doctor::content(s.root / "proc/cpuinfo");
  machine.cpu_model = cpuinfo(cpu, "model name");
  machine.microcode = cpuinfo(cpu, "microcode");
  cpuinfo(cpu, "processor", &machine.cpus);
  machine.host = first_line(s.root / "proc/sys/kernel/hostname").value_or("");
  machine.kernel = first_line(s.root / "proc/sys/kernel/osrelease").value_or("");
  machine.kernel_version = first_line(s.root / "proc/sys/kernel/version").value_or("");
  machine.boot_options = first_line(s.root / "proc/cmdline").value_or("");
  machine.isolated_cpus = first_line(s.root / "sys/devices/system/cpu/isolated").value_or("");
  const auto path = fmt::format("sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", std::max(0, s.cpu));
  machine.governor = first_line(s.root / path).value_or("");
  machine.realtime_kernel = first_line(s.root / "sys/kernel/realtime") == "1";
  machine.checks = examine_machine(s);
  const std::vector<DoctorItem> bus = examine_device(s, device);
  machine.checks.insert(machine.checks.end(), bus.begin(), bus.end());
  return machine;
}

}  // namespace palpate
