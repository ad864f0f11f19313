#include <CLI/CLI.hpp>
#include <memory>

#include <fmt/format.h>
#include "sim_host/cli.h"
#include "sim_host/doctor/doctor.h"

namespace palpate {

namespace {

struct Options {
  std::string device = "loopback", profile;
  int cpu = -1;
  int priority = 80;
};

// Returns how many fail.
int print_summary(const std::vector<DoctorItem>& items) {
  int failed = 0, unknown = 0;
  for (const DoctorItem& item : items) {
    failed += item.verdict == Verdict::kFail;
    unknown += item.verdict == Verdict::kUnknown;
  }
  fmt::print("{} items: {} fail, {} unknown. Nothing was changed; Palpate starts either way.\n", items.size(), failed,
             unknown);
  return failed;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("doctor", "Check this machine and the device's bus for hard real time");
  command
      ->add_option("--device", options->device,
                   "device address: loopback, can:IFACE, usb:/dev/hidrawN, with ,classic and ,node=N")
      ->capture_default_str();
  command->add_option("--profile", options->profile, "the device's profile (config/devices/*.toml)");
  command->add_option("--cpu", options->cpu, "CPU the controller will run on");
  command->add_option("--priority", options->priority, "SCHED_FIFO priority of the loop")
      ->capture_default_str()
      ->check(CLI::Range(1, 98));
  command->footer(
      "Exits with 1 when an item fails; unknown ones do not count.\n"
      "Examples:\n  palpate doctor\n  palpate doctor --device can:can0 --profile arm.toml --cpu 3");
  command->callback([options, &exit_code] {
    DoctorSources sources = this_machine();
    sources.cpu = options->cpu;
    sources.loop_priority = options->priority;
    std::vector<DoctorItem> items = examine_machine(sources);
    const std::vector<DoctorItem> device = examine_device(sources, options->device);
    items.insert(items.end(), device.begin(), device.end());
    const std::vector<DoctorItem> profile = examine_profile(options->device, options->profile);
    items.insert(items.end(), profile.begin(), profile.end());
    const std::vector<DoctorItem> heard = listen_to_device(options->device, options->profile);
    items.insert(items.end(), heard.begin(), heard.end());
    fmt::print("{}", doctor_table(items));
    exit_code = print_summary(items) == 0 ? kExitOk : kExitFailed;
  });
}

}  // namespace palpate
