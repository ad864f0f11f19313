// palpate-device: a simulated haptic device held by a simulated hand, speaking the real wire protocol over CAN or the
// loopback. An ordinary process: to the controller it is a device like any other.
#include <getopt.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "hal/bus/bus_model.h"
#include "hal/bus/device_address.h"
#include "hal/bus/loopback.h"
#include "hal/device/device_node.h"
#include "hal/device/device_profile.h"
#include "hal/device/fault_player.h"
#include "hal/drives/drive_faults.h"
#include "hal/drives/drive_link.h"
#include "hal/loop/clock.h"
#include "hal/loop/deadline.h"
#include "hal/loop/lockstep.h"
#include "hal/system/duration.h"
#include "hal/system/rt_linux.h"
#include "hal/system/shared_memory.h"
#include "sim_host/exit_codes.h"
#include "sim_host/rings/hand_target.h"
#include "sim_host/run/hand_path_file.h"
#include "sim_host/run/plant_options.h"

namespace palpate {
namespace {

enum Exit { kOk = kExitOk, kUsage = kExitUsage, kUnavailable = kExitUnavailable };

constexpr char kHelp[] =
    "palpate-device --device ADDRESS [options]: a simulated device and hand\n"
    "  --device ADDRESS   can:IFACE, usb:/dev/hidgN or loopback[:NAME], each with optional ,classic and ,node=N\n"
    "  --device-fd N      use the inherited socket N instead of opening the loopback\n"
    "  --turn-fd N        inherited socket to the controller: virtual time in lock step with it; default: real time\n"
    "  --path FILE        the hand's motion: time_s,x_mm,y_mm,z_mm[,rx_deg,ry_deg,rz_deg[,closing]]; default: rests at "
    "the "
    "origin\n"
    "  --profile FILE     of a device with drives: these are simulated, each by its own protocol (docs/devices.md);\n"
    "                     the path is in the world then, the device where the profile says;\n"
    "                     the hand waits until a drive is enabled\n"
    "  --duration S       stop after S seconds, or 10s, 5m, 1h; default: when the controller is gone (loopback) or on "
    "a signal\n"
    "  --bus-model B      classic or fd: frames take the time they need at 1 Mbit/s (fd: data at 5 Mbit/s)\n"
    "  --hand-fd N        inherited memory that says where the hand is pulled (palpate view); it leaves its motion "
    "then\n"
    "  --faults FILE      misbehave by script, one line per fault: AT_S KIND [VALUE]; see below; drives by the path's "
    "time: lose, silence, miss, deaf, freeze, jump\n"
    "  --priority P       SCHED_FIFO priority 1..98; default 0: ordinary scheduling\n"
    "  --cpu N            pin to this CPU\n"
    "  --set NAME=VALUE   a property of device or hand, repeatable; SI units:\n";

struct Failure {
  int exit_code;
  std::string text;
};

struct Arguments {
  std::string device = "loopback", path, faults, bus_model, profile;
  int device_fd = -1, turn_fd = -1, hand_fd = -1, priority = 0, cpu = -1;
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
  const auto whole = [&](double lowest, double highest) {
    return static_cast<int>(number(name, value, lowest, highest));
  };
  if (name == "delay_ticks") return static_cast<void>(plant.delay_ticks = whole(0, kMaxDelayTicks));
  if (name == "substeps") return static_cast<void>(plant.substeps = whole(1, 1000));
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
  for (const auto& [name, value] : {std::pair{"delay_ticks", plant.delay_ticks}, {"substeps", plant.substeps}}) {
    std::snprintf(line, sizeof(line), "      %-28s %d\n", name, value);
    text += line;
  }
  return text + "Faults:\n" + fault_script_help() +
         "Exit codes: 0 done, 2 bad arguments, path or faults, 3 transport unavailable\n"
         "Example: palpate-device --device can:vcan0 --path press.csv --set hand_stiffness_N_per_m=500\n"
         "         echo '2.0 lose 5' > faults.txt; palpate-device --device can:vcan0 --faults faults.txt\n";
}

double duration_s(const char* text) {
  const std::optional<double> seconds = seconds_of(text);
  if (seconds && *seconds >= 0.001 && *seconds <= 1e6) return *seconds;
  throw Failure{kUsage, std::string("--duration: '") + text + "' is no duration such as 10s, 5m or 1h"};
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  const option options[] = {{"device", 1, nullptr, 'd'},   {"device-fd", 1, nullptr, 'f'}, {"path", 1, nullptr, 'p'},
                            {"duration", 1, nullptr, 's'}, {"priority", 1, nullptr, 'r'},  {"cpu", 1, nullptr, 'u'},
                            {"faults", 1, nullptr, 'a'},   {"bus-model", 1, nullptr, 'b'}, {"set", 1, nullptr, 'x'},
                            {"help", 0, nullptr, 'h'},     {"turn-fd", 1, nullptr, 't'},   {"hand-fd", 1, nullptr, 'w'},
                            {"profile", 1, nullptr, 'P'},  {nullptr, 0, nullptr, 0}};
  for (int c; (c = getopt_long(argc, argv, "", options, nullptr)) != -1;) {
    if (c == 'd') arguments.device = optarg;
    if (c == 'f') arguments.device_fd = static_cast<int>(number("--device-fd", optarg, 0, 1 << 20));
    if (c == 't') arguments.turn_fd = static_cast<int>(number("--turn-fd", optarg, 0, 1 << 20));
    if (c == 'w') arguments.hand_fd = static_cast<int>(number("--hand-fd", optarg, 0, 1 << 20));
    if (c == 'p') arguments.path = optarg;
    if (c == 'P') arguments.profile = optarg;
    if (c == 's') arguments.duration_s = duration_s(optarg);
    if (c == 'r') arguments.priority = static_cast<int>(number("--priority", optarg, 0, 98));
    if (c == 'u') arguments.cpu = static_cast<int>(number("--cpu", optarg, -1, 1023));
    if (c == 'a') arguments.faults = optarg;
    if (c == 'b') arguments.bus_model = optarg;
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

std::vector<HandPose> load_poses(const std::string& file) {
  std::vector<HandPose> poses;
  std::string error;
  if (!file.empty() && !read_hand_path(file, poses, error)) throw Failure{kUsage, error};
  return poses;
}

// A tool's pose as the handle of a device of drives has it that stands where its profile says (see AxisDevice).
Pose handle_of(const CartesianKinematics& frame, const Pose& tool_w) {
  const Pose seen = pose_in_device(frame, tool_w);
  return {seen.position_m, seen.orientation * frame.orientation_w};
}

HandPath path_in(const CartesianKinematics& frame, std::vector<HandPose> poses) {
  if (poses.empty()) poses.emplace_back();
  for (HandPose& pose : poses) pose.pose = handle_of(frame, pose.pose);
  return HandPath(std::move(poses));
}

std::vector<FaultLine> load_faults(const std::string& file) {
  std::vector<FaultLine> lines;
  if (file.empty()) return lines;
  std::ifstream input(file);
  std::ostringstream text;
  text << input.rdbuf();
  std::string error;
  if (!input) throw Failure{kUsage, file + ": cannot read"};
  if (!parse_fault_script(text.str(), lines, error)) throw Failure{kUsage, file + ": " + error};
  return lines;
}

DeviceAddress read_address(const Arguments& arguments) {
  std::string line, error;
  const std::optional<DeviceAddress> address = parse_device_address(arguments.device, line, error);
  if (!address) throw Failure{kUsage, error};
  return *address;
}

// Opened the first time, and again after the script unplugged it; the loopback has nobody to connect to a second time.
Plug connect(const Arguments& arguments, const DeviceAddress& address) {
  constexpr int kTimeout_ms = 10'000;
  std::string error;
  std::unique_ptr<Transport> transport = arguments.device_fd >= 0
                                             ? adopt_loopback(arguments.device_fd, error)
                                             : open_transport(address, DeviceSide::kDevice, kTimeout_ms, error);
  if (!transport) throw Failure{kUnavailable, error};
  Plug::Open open;
  if (address.kind != TransportKind::kLoopback) {
    open = [address] {
      std::string ignored;  // a device that stays away ends the program
      return open_transport(address, DeviceSide::kDevice, 0, ignored);
    };
  }
  return Plug(std::move(transport), std::move(open));
}

BusRate bus_rate(const Arguments& arguments, const DeviceAddress& address) {
  const bool fd = arguments.bus_model == "fd";
  if (!fd && arguments.bus_model != "classic") throw Failure{kUsage, "--bus-model: classic or fd"};
  if (fd != (address.profile == WireProfile::kFd)) {
    throw Failure{kUsage, "--bus-model " + arguments.bus_model + ": the device speaks " +
                              (fd ? "classic frames" : "CAN FD frames; add ,classic to its address")};
  }
  return {};
}

// Where somebody pulls the hand; empty without.
SharedMemory hand_memory(int fd) {
  if (fd < 0) return {};
  std::string error;
  SharedMemory memory = SharedMemory::open_peer(fd, sizeof(HandTargetRegion), error);
  if (!memory) throw Failure{kUnavailable, "--hand-fd: " + error};
  return memory;
}

void pull_hand(const SharedMemory& memory, DevicePlant& plant, const CartesianKinematics* frame = nullptr) {
  HandWish wish;
  if (!memory || !read_hand_target(*static_cast<const HandTargetRegion*>(memory.data()), wish)) return;
  if (wish.kind == HandWish::kPull)
    plant.pull(frame != nullptr ? handle_of(*frame, wish.pose) : wish.pose, wish.closing != 0);
  if (wish.kind == HandWish::kHold) plant.hold();
}

template <Clock C>
bool leader_is_there(const C& clock) {
  if constexpr (requires { clock.connected(); }) {
    return clock.connected();
  } else {
    return true;  // a clock of its own: nobody leads it
  }
}

// The device's own clock, one step per period. A late step is made up for at once: mechanics does not skip time.
// The first is a period after `deadline_ns`.
template <Clock C>
void run_node(DeviceNode& node, FaultPlayer& faults, BusModel* bus, const Arguments& arguments, C& clock,
              std::int64_t deadline_ns, const std::atomic<bool>& stop) {
  const SharedMemory hand = hand_memory(arguments.hand_fd);
  const auto steps = static_cast<std::uint64_t>(arguments.duration_s / arguments.plant.period_s);
  for (std::uint64_t i = 0; (steps == 0 || i < steps) && !stop.load(std::memory_order_relaxed) &&
                            leader_is_there(clock) && (node.connected() || faults.unplugged());
       ++i) {
    deadline_ns += faults.period_ns();
    while (bus != nullptr && bus->next_ns() >= 0 && bus->next_ns() < deadline_ns) {
      clock.wait_until(bus->next_ns());
      bus->advance(clock.now_ns());
    }
    clock.wait_until(deadline_ns);
    if (bus != nullptr) bus->advance(clock.now_ns());
    faults.advance();
    pull_hand(hand, node.plant());
    node.step(clock.now_ns());
  }
}

// The drives of a profile, one step per period. The hand holds the handle at its path's first pose until the controller
// has found them and enables one: a search takes about a second, in which a path would be half over.
template <Clock C>
void run_drives(DriveSim& drives, const CartesianKinematics& frame, DriveFaults& transport, const Arguments& arguments,
                C& clock, std::int64_t deadline_ns, const std::atomic<bool>& stop) {
  const SharedMemory hand = hand_memory(arguments.hand_fd);
  bool begun = false;
  const auto period_ns = static_cast<std::int64_t>(1e9 * arguments.plant.period_s + 0.5);
  const auto steps = static_cast<std::uint64_t>(arguments.duration_s / arguments.plant.period_s);
  for (std::uint64_t i = 0; (steps == 0 || i < steps) && !stop.load(std::memory_order_relaxed) &&
                            transport.state() == TransportState::kUp && leader_is_there(clock);
       ++i) {
    deadline_ns += period_ns;
    clock.wait_until(deadline_ns);
    pull_hand(hand, drives.plant().plant(), &frame);
    begun = begun || drives.any_enabled();
    if (begun) transport.advance(drives);
    begun ? drives.step() : drives.step_bus();
  }
}

int simulate_drives(const Arguments& arguments, const DeviceAddress& address, const std::atomic<bool>& stop) {
  std::string error;
  const std::optional<DeviceProfile> profile = read_device_profile(arguments.profile, error);
  if (!profile) throw Failure{kUsage, error};
  if (!profile->arm) throw Failure{kUsage, arguments.profile + ": has no [drives]; leave --profile out"};
  if (!arguments.bus_model.empty()) throw Failure{kUsage, "--profile: simulated drives take no --bus-model"};
  std::vector<FaultLine> script = load_faults(arguments.faults);
  if (const std::string wrong = DriveFaults::refuse(script); !wrong.empty())
    throw Failure{kUsage, arguments.faults + ": " + wrong};
  constexpr int kTimeout_ms = 10'000;
  const std::unique_ptr<Transport> transport =
      arguments.device_fd >= 0 ? adopt_loopback(arguments.device_fd, error)
                               : open_drives(address, *profile->arm, DeviceSide::kDevice, kTimeout_ms, error);
  if (!transport) throw Failure{kUnavailable, error};
  DriveFaults faulty(*transport, std::move(script), arguments.plant.period_s);
  const std::unique_ptr<DriveSim> drives =
      make_drive_sim(faulty, *profile->arm, arguments.plant, path_in(profile->frame, load_poses(arguments.path)));
  if (arguments.turn_fd >= 0) {
    FollowerClock clock(arguments.turn_fd, stop);
    run_drives(*drives, profile->frame, faulty, arguments, clock, clock.now_ns(), stop);
  } else {
    MonotonicClock clock;
    const auto period_ns = static_cast<std::int64_t>(1e9 * arguments.plant.period_s + 0.5);
    const std::int64_t first_ns = first_slot_ns(clock.now_ns(), period_ns, step_phase_ns(period_ns));
    run_drives(*drives, profile->frame, faulty, arguments, clock, first_ns - period_ns, stop);
  }
  return kOk;
}

int run(int argc, char** argv) {
  const Arguments arguments = parse(argc, argv);
  const std::atomic<bool>& stop = install_stop_signals();
  const DeviceAddress address = read_address(arguments);
  if (!arguments.profile.empty()) return simulate_drives(arguments, address, stop);
  HandPath path(load_poses(arguments.path));
  std::vector<FaultLine> script = load_faults(arguments.faults);
  const bool bus_off = std::any_of(script.begin(), script.end(),
                                   [](const FaultLine& line) { return line.fault == DeviceFault::kBusOff; });
  if (bus_off && address.kind == TransportKind::kUsb) throw Failure{kUsage, "bus-off: USB has no such state"};
  const bool timed = !arguments.bus_model.empty();
  const BusRate rate = timed ? bus_rate(arguments, address) : BusRate{};
  Plug plug = connect(arguments, address);
  BusModel bus(plug, rate);
  Transport& wire = timed ? static_cast<Transport&>(bus) : plug;
  FaultSender sender(wire);
  NodeOptions options;
  options.profile = address.profile;
  options.node = address.node;
  DeviceNode node(sender, options, arguments.plant, std::move(path));
  FaultPlayer faults(std::move(script), node, sender, plug);
  RtOptions rt;
  rt.priority = arguments.priority;
  rt.cpu = arguments.cpu;
  rt.lock_memory = rt.no_deep_sleep = arguments.priority > 0;
  const RtSetup setup(rt);
  MonotonicClock real_time;
  FollowerClock virtual_time(arguments.turn_fd, stop);
  if (arguments.turn_fd >= 0) {
    run_node(node, faults, timed ? &bus : nullptr, arguments, virtual_time, virtual_time.now_ns(), stop);
  } else {
    const std::int64_t begin_ns =
        first_slot_ns(real_time.now_ns(), faults.period_ns(), step_phase_ns(faults.period_ns())) - faults.period_ns();
    run_node(node, faults, timed ? &bus : nullptr, arguments, real_time, begin_ns, stop);
  }
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
