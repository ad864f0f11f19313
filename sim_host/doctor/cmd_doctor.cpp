#include <CLI/CLI.hpp>
#include <memory>

#include <fmt/format.h>
#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/doctor/doctor.h"
#include "sim_host/doctor/doctor_json.h"
#include "sim_host/doctor/find_devices.h"
#include "sim_host/doctor/identify.h"

namespace palpate {

namespace {

constexpr const char* kFind = "find";

struct DoctorOptions {
  std::string device = "loopback", profile, identify;
  int cpu = -1;
  int priority = 80;
  bool json = false, ask = false;
};

int measure(const DoctorOptions& options, Json& json) {
  if (options.device != "loopback" || options.profile.empty())
    throw CLI::ValidationError("--identify",
                               "moves the simulated device alone: leave out --device, and say with "
                               "--profile FILE which device it is to be");
  const Identified found = identify_simulated(options.profile, options.identify);
  json["refused"] = found.refused;
  if (!found.refused.empty()) {
    fmt::print("refused: {}\n", found.refused);
    return kExitFailed;
  }
  const DeviceFit& f = found.fit;
  json["mass_kg"] = f.mass_kg;
  json["damping_Ns_per_m"] = f.damping_Ns_per_m;
  json["friction_N"] = f.friction_N;
  json["encoder_step_m"] = found.encoder_step_m;
  json["delay_s"] = f.delay_s;
  fmt::print(
      "moved by {:.1f} mm with {:.2f} N; {:.1f} um RMS are left unexplained\n"
      "mass     {:.4g} kg\ndamping  {:.4g} N s/m\nfriction {:.4g} N\nencoder  {:.4g} um\ndelay    {:.3g} ms\n"
      "wrote    {}\n",
      1e3 * f.travel_m, found.force_N, 1e6 * f.residual_m, f.mass_kg, f.damping_Ns_per_m, f.friction_N,
      1e6 * found.encoder_step_m, 1e3 * f.delay_s, options.identify);
  return kExitOk;
}

// Returns how many fail.
int tell(const std::vector<DoctorItem>& items, Json& json) {
  int failed = 0, unknown = 0;
  for (const DoctorItem& item : items) {
    failed += item.verdict == Verdict::kFail;
    unknown += item.verdict == Verdict::kUnknown;
  }
  json["items"] = items_json(items);
  json["fail"] = failed;
  json["unknown"] = unknown;
  fmt::print("{}{} items: {} fail, {} unknown. Nothing was changed; Palpate starts either way.\n", doctor_table(items),
             items.size(), failed, unknown);
  return failed;
}

int run_doctor(const DoctorOptions& options, Json& json) {
  const bool find = options.device == kFind;
  if (options.ask && !find) throw CLI::ValidationError("--ask", "goes with --device without an address");
  if (find) {
    const auto found = find_devices("/", listen_to_bus, options.ask ? AskOn(ask_on_bus) : AskOn());
    return tell(found, json) == 0 ? kExitOk : kExitFailed;
  }
  std::vector<DoctorItem> items = examine_machine_and_device(options.cpu, options.priority, options.device);
  const std::vector<DoctorItem> profile = examine_profile(options.device, options.profile);
  items.insert(items.end(), profile.begin(), profile.end());
  const std::vector<DoctorItem> heard = listen_to_device(options.device, options.profile);
  items.insert(items.end(), heard.begin(), heard.end());
  return tell(items, json) == 0 ? kExitOk : kExitFailed;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand("doctor", "Check this machine and the device's bus for hard real time");
  command
      ->add_option("--device", options->device,
                   "device address: loopback (if not given), can:IFACE, usb:/dev/hidrawN, with ,classic and ,node=N; "
                   "without an address, or find: what is plugged in, its driver and the next command; nothing is sent")
      ->expected(0, 1)
      ->default_str(kFind)  // of the option without a value
      ->type_name("[ADDRESS]");
  command->add_flag("--ask", options->ask,
                    "with --device: also asks for moteus controllers, which speak only then: one read of a register "
                    "for each of 1 to 127, on CAN FD interfaces where no classic frame is heard");
  command->add_option("--profile", options->profile, "the device's profile (config/devices/*.toml)");
  command->add_option("--cpu", options->cpu, "CPU the controller will run on");
  command->add_option("--priority", options->priority, "SCHED_FIFO priority of the loop")
      ->capture_default_str()
      ->check(CLI::Range(1, 98));
  command
      ->add_option("--identify", options->identify,
                   "instead: measure mass, damping, friction, encoder step and delay by a small motion of a handle "
                   "that nobody holds (simulated, as --profile says), and write them as a profile (.toml)")
      ->check(ends_in({".toml"}));
  command->footer(
      "Exits with 1 when an item fails; unknown ones do not count.\n"
      "Examples:\n  palpate doctor\n  palpate doctor --device\n  palpate doctor --device --ask\n  palpate doctor "
      "--device can:can0 --profile arm.toml "
      "--cpu 3\n"
      "  palpate doctor --identify measured.toml --profile config/devices/sim-6dof.toml");
  add_json_flag(*command, options->json);
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "doctor", [&](Json& json) {
      return options->identify.empty() ? run_doctor(*options, json) : measure(*options, json);
    });
  });
}

}  // namespace palpate
