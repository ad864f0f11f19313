// palpate-device: a simulated haptic device held by a simulated hand, speaking the real wire protocol over CAN or the
// loopback. An ordinary process: to the controller it is a device like any other.
#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/device_address.h"
#include "hal/device_node.h"
#include "hal/loopback.h"
#include "hal/rt_linux.h"
#include "sim_host/hand_path_file.h"

namespace palpate {
namespace {

enum Exit { kOk = 0, kUsage = 2, kUnavailable = 3 };

constexpr char kHelp[] =
    "palpate-device --device ADDRESS [options]: a simulated device and hand\n"
    "  --device ADDRESS   can:IFACE, usb:/dev/hidgN or loopback[:NAME], each with optional ,classic and ,node=N\n"
    "  --device-fd N      use the inherited socket N instead of opening the loopback\n"
    "  --path FILE        the hand's motion: time_s,x_mm,y_mm,z_mm[,rx_deg,ry_deg,rz_deg]; default: rests at the "
    "origin\n"
    "  --duration S       stop after S seconds; default: when the controller is gone (loopback) or on a signal\n"
    "  --priority P       SCHED_FIFO priority 1..98; default 0: ordinary scheduling\n"
    "  --cpu N            pin to this CPU\n"
    "  --set NAME=VALUE   a property of device or hand, repeatable; SI units:\n";

// X(name): members of PlantOptions that --set reaches.
#define PALPATE_PLANT_OPTIONS(X) \
  X(mass_kg)                     \
  X(damping_N_s_per_m)           \
  X(friction_N)                  \
  X(inertia_kg_m2)               \
  X(damping_Nm_s_per_rad)        \
  X(friction_Nm)                 \
  X(encoder_m)                   \
  X(noise_m)                     \
  X(force_max_N)                 \
  X(torque_max_Nm)               \
  X(hand_mass_kg)                \
  X(hand_stiffness_N_per_m)      \
  X(hand_damping_N_s_per_m)      \
  X(hand_stiffness_Nm_per_rad)   \
  X(hand_damping_Nm_s_per_rad)   \
  X(period_s)

struct Failure {
  int exit_code;
  std::string text;
};

struct Arguments {
  std::string device = "loopback", path;
  int device_fd = -1, priority = 0, cpu = -1;
  double duration_s = 0;
  PlantOptions plant;
};

double number(const std::string& option, const char* text, double lowest, double highest) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end != text && *end == '\0' && value >= lowest && value <= highest) return value;
  throw Failure{kUsage, option + ": '" + text + "' is not a number in the allowed range"};
}

void set_property(const std::string& text, PlantOptions& plant) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (equals == std::string::npos) throw Failure{kUsage, "--set " + text + ": expected NAME=VALUE"};
  const char* value = text.c_str() + equals + 1;
#define PALPATE_SET(member) \
  if (name == #member) return static_cast<void>(plant.member = number(name, value, 0, 1e6));
  PALPATE_PLANT_OPTIONS(PALPATE_SET)
#undef PALPATE_SET
  if (name == "delay_ticks") return static_cast<void>(plant.delay_ticks = static_cast<int>(number(name, value, 0, 15)));
  throw Failure{kUsage, "--set: no property '" + name + "'; see palpate-device --help"};
}

std::string help() {
  std::string text = kHelp;
  const PlantOptions plant;
  char line[80];
#define PALPATE_LINE(member)                                                    \
  std::snprintf(line, sizeof(line), "      %-28s %g\n", #member, plant.member); \
  text += line;
  PALPATE_PLANT_OPTIONS(PALPATE_LINE)
#undef PALPATE_LINE
  std::snprintf(line, sizeof(line), "      %-28s %d\n", "delay_ticks", plant.delay_ticks);
  return text + line +
         "Exit codes: 0 done, 2 bad arguments or path, 3 transport unavailable\n"
         "Example: palpate-device --device can:vcan0 --path press.csv --set hand_stiffness_N_per_m=500\n";
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  const option options[] = {{"device", 1, nullptr, 'd'},   {"device-fd", 1, nullptr, 'f'}, {"path", 1, nullptr, 'p'},
                            {"duration", 1, nullptr, 's'}, {"priority", 1, nullptr, 'r'},  {"cpu", 1, nullptr, 'u'},
                            {"set", 1, nullptr, 'x'},      {"help", 0, nullptr, 'h'},      {nullptr, 0, nullptr, 0}};
  for (int c; (c = getopt_long(argc, argv, "", options, nullptr)) != -1;) {
    if (c == 'd') arguments.device = optarg;
    if (c == 'f') arguments.device_fd = static_cast<int>(number("--device-fd", optarg, 0, 1 << 20));
    if (c == 'p') arguments.path = optarg;
    if (c == 's') arguments.duration_s = number("--duration", optarg, 0.001, 1e6);
    if (c == 'r') arguments.priority = static_cast<int>(number("--priority", optarg, 0, 98));
    if (c == 'u') arguments.cpu = static_cast<int>(number("--cpu", optarg, -1, 1023));
    if (c == 'x') set_property(optarg, arguments.plant);
    if (c == 'h') throw Failure{kOk, help()};
    if (c == '?') throw Failure{kUsage, "see palpate-device --help"};
  }
  if (optind != argc) throw Failure{kUsage, std::string("unexpected argument '") + argv[optind] + "'"};
  if (!(arguments.plant.mass_kg > 0 && arguments.plant.inertia_kg_m2 > 0 && arguments.plant.period_s >= 1e-5)) {
    throw Failure{kUsage, "mass_kg and inertia_kg_m2 must be positive, period_s at least 1e-5"};
  }
  return arguments;
}

HandPath load_path(const std::string& file) {
  if (file.empty()) return {};
  std::vector<HandPose> poses;
  std::string error;
  if (!read_hand_path(file, poses, error)) throw Failure{kUsage, error};
  return HandPath(std::move(poses));
}

std::unique_ptr<Transport> connect(const Arguments& arguments, DeviceAddress& address) {
  std::string line, error;
  const std::optional<DeviceAddress> parsed = parse_device_address(arguments.device, line, error);
  if (!parsed) throw Failure{kUsage, error};
  address = *parsed;
  std::unique_ptr<Transport> transport = arguments.device_fd >= 0
                                             ? adopt_loopback(arguments.device_fd, error)
                                             : open_transport(address, DeviceSide::kDevice, 10'000, error);
  if (!transport) throw Failure{kUnavailable, error};
  return transport;
}

// The device's own clock, one step per period. A late step is made up for at once: mechanics does not skip time.
void run_node(DeviceNode& node, const Arguments& arguments, const std::atomic<bool>& stop) {
  MonotonicClock clock;
  const auto period_ns = static_cast<std::int64_t>(arguments.plant.period_s * 1e9 + 0.5);
  const auto steps = static_cast<std::uint64_t>(arguments.duration_s / arguments.plant.period_s);
  std::int64_t deadline_ns = clock.now_ns();
  for (std::uint64_t i = 0; (steps == 0 || i < steps) && !stop.load(std::memory_order_relaxed) && node.connected();
       ++i) {
    deadline_ns += period_ns;
    clock.wait_until(deadline_ns);
    node.step(clock.now_ns());
  }
}

int run(int argc, char** argv) {
  const Arguments arguments = parse(argc, argv);
  const std::atomic<bool>& stop = install_stop_signals();
  DeviceAddress address;
  HandPath path = load_path(arguments.path);
  const std::unique_ptr<Transport> transport = connect(arguments, address);
  NodeOptions options;
  options.profile = address.profile;
  options.node = address.node;
  DeviceNode node(*transport, options, arguments.plant, std::move(path));
  RtOptions rt;
  rt.priority = arguments.priority;
  rt.cpu = arguments.cpu;
  rt.lock_memory = rt.no_deep_sleep = arguments.priority > 0;
  const RtSetup setup(rt);
  run_node(node, arguments, stop);
  return kOk;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  try {
    return palpate::run(argc, argv);
  } catch (const palpate::Failure& failure) {
    const bool help = failure.exit_code == palpate::kOk;
    std::fprintf(help ? stdout : stderr, "%s%s%s", help ? "" : "palpate-device: ", failure.text.c_str(),
                 help ? "" : "\n");
    return failure.exit_code;
  }
}
