#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include <fmt/format.h>
#include "sim_host/doctor/doctor.h"
#include "sim_host/doctor/doctor_files.h"

namespace palpate {

namespace {

using doctor::content;
using doctor::cpu_in_list;
using doctor::first_line;
using doctor::number;

DoctorItem judged(std::string name, bool known, bool good, std::string found, std::string remedy) {
  const Verdict verdict = !known ? Verdict::kUnknown : good ? Verdict::kPass : Verdict::kFail;
  return {std::move(name), verdict, std::move(found), good && known ? "" : std::move(remedy)};
}

DoctorItem kernel(const DoctorSources& s) {
  const auto flag = first_line(s.root / "sys/kernel/realtime");
  // /sys/kernel/realtime exists only on PREEMPT_RT kernels, so its absence is an answer.
  return judged("PREEMPT_RT kernel", true, flag == "1", flag == "1" ? "yes" : "no",
                "apt-get install linux-image-rt-amd64, then reboot into it");
}

DoctorItem isolation(const DoctorSources& s) {
  const auto isolated = first_line(s.root / "sys/devices/system/cpu/isolated");
  const std::string list = isolated.value_or("");
  const bool good = s.cpu >= 0 ? cpu_in_list(list, s.cpu) : !list.empty();
  return judged("isolated CPU", isolated.has_value() || std::filesystem::exists(s.root / "sys/devices/system/cpu"),
                good, list.empty() ? "none" : list,
                "boot with isolcpus=N nohz_full=N rcu_nocbs=N irqaffinity=<the others>, and run with --cpu N");
}

DoctorItem boot_option(const DoctorSources& s, const std::string& option) {
  const std::string line = content(s.root / "proc/cmdline");
  const bool good = line.find(option + "=") != std::string::npos;
  return judged("boot option " + option, !line.empty(), good, good ? "set" : "not set",
                "add " + option + "=... to GRUB_CMDLINE_LINUX in /etc/default/grub, then update-grub and reboot");
}

DoctorItem throttling(const DoctorSources& s) {
  const auto runtime = number(first_line(s.root / "proc/sys/kernel/sched_rt_runtime_us"));
  return judged("real-time throttling off", runtime.has_value(), runtime == -1,
                runtime ? fmt::format("{} us", *runtime) : "not readable", "sysctl kernel.sched_rt_runtime_us=-1");
}

// The soft-lockup detector wakes the kernel's stop thread (priority 99) on every watched processor, once in 4 s by
// default: seen to preempt the loop in the laboratory, 2026-11-21.
DoctorItem lockup_watchdog(const DoctorSources& s) {
  const auto on = number(first_line(s.root / "proc/sys/kernel/watchdog"));
  const auto cpus = first_line(s.root / "proc/sys/kernel/watchdog_cpumask");
  const bool elsewhere = s.cpu >= 0 && cpus && !cpu_in_list(*cpus, s.cpu);
  return judged("lockup watchdog off the real-time CPU", on.has_value(), on == 0 || elsewhere,
                !on        ? "not readable"
                : *on == 0 ? "off"
                           : "on CPU " + cpus.value_or("?"),
                "sysctl kernel.watchdog=0, or kernel.watchdog_cpumask=<the other CPUs>");
}

// How many freed pages a CPU keeps before it hands them back, against its least, four batches. They go back in one
// go, under locks that the loop's send may wait for: 1100 pages took 150 us in the laboratory, 2026-11-21.
DoctorItem page_lists(const DoctorSources& s) {
  std::ifstream zones(s.root / "proc/zoneinfo");
  std::string word;
  long kept = 0, longest = 0, least = 0;
  while (zones >> word) {
    if (word == "high:" || word == "high_max:") {  // high_max: since Linux 6.7, which adapts `high` up to it
      zones >> kept;
      longest = std::max(longest, kept);
    } else if (long batch = 0; word == "batch:" && zones >> batch) {
      least = std::max(least, 4 * batch);
    }
  }
  return judged("short lists of free pages", least > 0, longest <= least,
                least > 0 ? fmt::format("{} pages a CPU, {} is the least", longest, least) : "not readable",
                "sysctl vm.percpu_pagelist_high_fraction=1000000");
}

DoctorItem limit(const std::string& name, int resource, rlim_t needed, const std::string& remedy) {
  rlimit found{};
  const bool known = getrlimit(static_cast<__rlimit_resource>(resource), &found) == 0;
  const bool root = geteuid() == 0;  // root is not bound by these two
  const std::string text = found.rlim_cur == RLIM_INFINITY ? "unlimited" : fmt::format("{}", found.rlim_cur);
  return judged(name, known, root || found.rlim_cur >= needed, root ? text + " (root)" : text, remedy);
}

DoctorItem governor(const DoctorSources& s) {
  const std::string cpu = fmt::format("cpu{}", s.cpu < 0 ? 0 : s.cpu);
  const auto found = first_line(s.root / "sys/devices/system/cpu" / cpu / "cpufreq/scaling_governor");
  return judged("CPU governor", found.has_value(), found == "performance", found.value_or("no frequency scaling found"),
                "cpupower frequency-set -g performance");
}

DoctorItem dma_latency(const DoctorSources& s) {
  const auto path = s.root / "dev/cpu_dma_latency";
  const bool exists = std::filesystem::exists(path);
  const bool good = exists && access(path.c_str(), R_OK | W_OK) == 0;
  return judged("/dev/cpu_dma_latency usable", true, good,
                good     ? "yes"
                : exists ? "no permission"
                         : "missing",
                "install the limits and udev files shipped in hal/system, or run as root");
}

DoctorItem sibling(const DoctorSources& s) {
  const std::string cpu = fmt::format("cpu{}", s.cpu < 0 ? 0 : s.cpu);
  const auto list = first_line(s.root / "sys/devices/system/cpu" / cpu / "topology/thread_siblings_list");
  const bool alone = list && list->find_first_of(",-") == std::string::npos;
  return judged("no SMT sibling on the real-time CPU", list.has_value(), alone, list.value_or("not readable"),
                "echo off > /sys/devices/system/cpu/smt/control, or isolate the sibling too");
}

DoctorItem huge_pages(const DoctorSources& s) {
  const auto found = first_line(s.root / "sys/kernel/mm/transparent_hugepage/enabled");
  const bool good = found && found->find("[always]") == std::string::npos;
  return judged("transparent huge pages not forced", found.has_value(), good, found.value_or("not readable"),
                "echo madvise > /sys/kernel/mm/transparent_hugepage/enabled");
}

DoctorItem swap(const DoctorSources& s) {
  const std::string text = content(s.root / "proc/swaps");
  const auto lines = std::count(text.begin(), text.end(), '\n');
  return judged("no swap", !text.empty(), lines <= 1, lines <= 1 ? "none" : fmt::format("{} areas", lines - 1),
                "swapoff -a");
}

DoctorItem clock_source(const DoctorSources& s) {
  const auto found = first_line(s.root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  return judged("clock source tsc", found.has_value(), found == "tsc", found.value_or("not readable"),
                "boot with tsc=reliable if the processor's TSC is invariant; a slow clock costs microseconds a read");
}

DoctorItem group_scheduling(const DoctorSources& s) {
  // With CONFIG_RT_GROUP_SCHED a group without runtime silently cannot create real-time threads.
  const auto runtime = number(first_line(s.root / "sys/fs/cgroup/cpu/cpu.rt_runtime_us"));
  return judged("real-time group scheduling", true, !runtime || *runtime != 0,
                runtime ? fmt::format("{} us", *runtime) : "not restricting",
                "give the group cpu.rt_runtime_us, or use a kernel without RT_GROUP_SCHED");
}

// The limits are a group's.
constexpr const char* kLimitsRemedy =
    "copy hal/system/palpate-limits.conf to /etc/security/limits.d (the Debian package has done it), "
    "`adduser YOU palpate` and log in again";

}  // namespace

std::vector<DoctorItem> examine_machine(const DoctorSources& s) {
  return {kernel(s),
          isolation(s),
          boot_option(s, "nohz_full"),
          boot_option(s, "rcu_nocbs"),
          throttling(s),
          lockup_watchdog(s),
          page_lists(s),
          group_scheduling(s),
          limit("real-time priority limit", RLIMIT_RTPRIO, static_cast<rlim_t>(s.loop_priority), kLimitsRemedy),
          limit("locked-memory limit", RLIMIT_MEMLOCK, RLIM_INFINITY, kLimitsRemedy),
          governor(s),
          dma_latency(s),
          sibling(s),
          huge_pages(s),
          swap(s),
          clock_source(s)};
}

DoctorSources this_machine() {
  DoctorSources sources;
  sources.run = [](const std::string& command) {
    std::string output;
    FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return output;
    char buffer[4096];
    while (const std::size_t count = fread(buffer, 1, sizeof(buffer), pipe)) output.append(buffer, count);
    return pclose(pipe) == 0 ? output : std::string{};
  };
  return sources;
}

std::vector<DoctorItem> examine_machine_and_device(int cpu, int loop_priority, const std::string& device) {
  DoctorSources sources = this_machine();
  sources.cpu = cpu;
  sources.loop_priority = loop_priority;
  std::vector<DoctorItem> items = examine_machine(sources);
  const std::vector<DoctorItem> bus = examine_device(sources, device);
  items.insert(items.end(), bus.begin(), bus.end());
  return items;
}

}  // namespace palpate
