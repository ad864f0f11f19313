// palpate-rt: the controller. Opens a baked image, connects to the device and (if started by one) to the host, makes
// itself a real-time thread, and runs the loop. No parser, no graphics; everything is allocated before the first tick.
#include <getopt.h>

#include <concepts>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "hal/bus/bus_budget.h"
#include "hal/bus/device_address.h"
#include "hal/bus/link_report.h"
#include "hal/bus/loopback.h"
#include "hal/device/device_profile.h"
#include "hal/drives/axis_device.h"
#include "hal/drives/drive_link.h"
#include "hal/drives/moved_record.h"
#include "hal/loop/lockstep.h"
#include "hal/loop/loop.h"
#include "hal/system/device_lock.h"
#include "hal/system/duration.h"
#include "hal/system/private_file.h"
#include "hal/system/rt_linux.h"
#include "rt_core/image.h"
#include "rt_core/stage_cost.h"
#include "sim_host/build_id.h"
#include "sim_host/exit_codes.h"
#include "sim_host/run/controller_report.h"
#include "sim_host/run/crash_file.h"
#include "sim_host/run/heap_count.h"
#include "sim_host/run/host_connection.h"
#include "sim_host/run/host_port.h"
#include "sim_host/run/switching_controller.h"
#include "sim_host/run/tick_fit.h"
#include "sim_host/tick_memory.h"

namespace palpate {
namespace {

enum Exit {
  kOk = kExitOk,
  kFaulted = kExitFault,
  kUsage = kExitUsage,
  kUnavailable = kExitUnavailable,
  kSilentAtStart = kExitSilent
};

constexpr char kHelp[] =
    "palpate-rt --image FILE --device ADDRESS [options]: the real-time controller\n"
    "  --image FILE        baked scene (palpate bake)\n"
    "  --device ADDRESS    auto, can:IFACE, usb:/dev/hidrawN or loopback[:NAME], each with optional ,classic and "
    ",node=N\n"
    "  --second-device ADDRESS, --second-fd N   of the hand at the body, where two hold the scene; same profile\n"
    "  --profile FILE      what the device can do (config/devices/*.toml); needed on can: and usb:\n"
    "  --device-fd N       use the inherited socket N instead of opening the loopback\n"
    "  --control-fd N      inherited Unix socket to the host: telemetry and commands; default: none; then\n"
    "                      SIGUSR1 arms: an operator's act, never by itself\n"
    "  --telemetry PATH    listen on this socket for readers of the same user (docs/record_format.md)\n"
    "  --crash-file FILE   when the host dies: write the last ticks to this recording\n"
    "  --duration S        stop after S seconds, or 10s, 5m, 1h; default: when told to\n"
    "  --cpu N             pin to this CPU; default: any\n"
    "  --priority P        SCHED_FIFO priority 1..98, 0: ordinary scheduling; default 80\n"
    "  --require-rt        refuse to run without scheduler, memory lock and CPU as asked; default on can: and usb:\n"
    "  --allow-no-rt       drive a real device without them all the same\n"
    "  --device-turn-fd N, --second-turn-fd N, --host-turn-fd N   inherited sockets: virtual time in lock step with "
    "them; default: real "
    "time\n"
    "Exit codes: 0 done, 2 bad arguments or image, 3 device, host or memory unavailable, 4 the device sent nothing at\n"
    "            start, 5 a fault was latched. In every case the last commands sent are zero force, drives off.\n"
    "Example: palpate-rt --image mallet.pal --device can:can0 --profile arm.toml --cpu 3 --duration 60\n";

constexpr int kSocketTimeout_ms = 2000;
constexpr double kHostSilence_s = 2.0;  // forty heartbeats; see host_port.h
constexpr double kStartTimeout_s = 3.0;

struct Arguments {
  std::string image, device = "auto", second_device, profile, crash_file, telemetry;
  int second_fd = -1, second_turn_fd = -1;
  int device_fd = -1, control_fd = -1, cpu = -1, priority = 80;
  int device_turn_fd = -1, host_turn_fd = -1;
  bool require_rt = false, allow_no_rt = false;
  double duration_s = 0;
  bool virtual_time() const { return device_turn_fd >= 0 || host_turn_fd >= 0; }
};

// A failed step ends the program with this exit code and message.
struct Failure {
  int exit_code;
  std::string text;
};

double number(const char* option, const char* text, double lowest, double highest) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end != text && *end == '\0' && value >= lowest && value <= highest) return value;
  throw Failure{kUsage, std::string(option) + ": '" + text + "' is not a number in the allowed range"};
}

double duration_s(const char* text) {
  const std::optional<double> seconds = seconds_of(text);
  if (seconds && *seconds >= 0.001 && *seconds <= 1e6) return *seconds;
  throw Failure{kUsage, std::string("--duration: '") + text + "' is no duration such as 10s, 5m or 1h"};
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  const option options[] = {
      {"image", 1, nullptr, 'i'},          {"device", 1, nullptr, 'd'},       {"device-fd", 1, nullptr, 'f'},
      {"control-fd", 1, nullptr, 'c'},     {"duration", 1, nullptr, 's'},     {"cpu", 1, nullptr, 'u'},
      {"priority", 1, nullptr, 'p'},       {"help", 0, nullptr, 'h'},         {"version", 0, nullptr, 'v'},
      {"device-turn-fd", 1, nullptr, 'D'}, {"host-turn-fd", 1, nullptr, 'H'}, {"crash-file", 1, nullptr, 'x'},
      {"require-rt", 0, nullptr, 'q'},     {"allow-no-rt", 0, nullptr, 'a'},  {"profile", 1, nullptr, 'P'},
      {"second-device", 1, nullptr, '2'},  {"second-fd", 1, nullptr, 'F'},    {"second-turn-fd", 1, nullptr, 'T'},
      {"telemetry", 1, nullptr, 't'},      {nullptr, 0, nullptr, 0}};
  const auto integer = [](const char* name, double low, double high) {
    return static_cast<int>(number(name, optarg, low, high));
  };
  for (int c; (c = getopt_long(argc, argv, "", options, nullptr)) != -1;) {
    if (c == 'i') arguments.image = optarg;
    if (c == 'd') arguments.device = optarg;
    if (c == '2') arguments.second_device = optarg;
    if (c == 'F') arguments.second_fd = integer("--second-fd", 0, 1 << 20);
    if (c == 'T') arguments.second_turn_fd = integer("--second-turn-fd", 0, 1 << 20);
    if (c == 'P') arguments.profile = optarg;
    if (c == 'x') arguments.crash_file = optarg;
    if (c == 't') arguments.telemetry = optarg;
    if (c == 'f') arguments.device_fd = integer("--device-fd", 0, 1 << 20);
    if (c == 'c') arguments.control_fd = integer("--control-fd", 0, 1 << 20);
    if (c == 's') arguments.duration_s = duration_s(optarg);
    if (c == 'u') arguments.cpu = integer("--cpu", -1, 1023);
    if (c == 'p') arguments.priority = integer("--priority", 0, 98);
    if (c == 'D') arguments.device_turn_fd = integer("--device-turn-fd", 0, 1 << 20);
    if (c == 'H') arguments.host_turn_fd = integer("--host-turn-fd", 0, 1 << 20);
    if (c == 'q') arguments.require_rt = true;
    if (c == 'a') arguments.allow_no_rt = true;
    if (c == 'h') throw Failure{kOk, kHelp};
    if (c == 'v') throw Failure{kOk, std::string(kBuildId) + "\n"};
    if (c == '?') throw Failure{kUsage, "see palpate-rt --help"};
  }
  if (arguments.image.empty() || optind != argc) throw Failure{kUsage, "--image FILE is needed; see palpate-rt --help"};
  return arguments;
}

// Checks a copy that nobody else can change, and binds the model to it. `file` must live as long as the model.
Model load_image(const std::string& path, PrivateFile& file) {
  std::string error;
  file = PrivateFile::read(path, error);
  if (!file) throw Failure{kUsage, error};
  Model model;
  const ImageResult result = open_image(file.bytes(), model);
  if (result.error != ImageError::kNone) {
    throw Failure{kUsage, path + ": " + result.field + ": " + describe(result.error) + "; bake the scene again"};
  }
  return model;
}

// A set-up that cannot carry its traffic in every period is refused before anything is sent, with the table.
void check_bus(const DeviceAddress& address, const DeviceProfile& profile, double period_s) {
  if (address.kind != TransportKind::kCan) return;
  BusBudget budget = haptic_node_budget(address.profile == WireProfile::kFd);
  budget.period_us = period_s * 1e6;
  const BusVerdict verdict = profile.arm ? check_drives_budget(*profile.arm, period_s) : check_bus_budget(budget);
  std::fprintf(stderr, "%s", verdict.text.c_str());
  if (!verdict.fits) throw Failure{kUnavailable, "the bus cannot carry this traffic in every period"};
}

// Nothing is driven that the scene could overstrain, and nothing real of which that is not known.
DeviceProfile check_profile(const Arguments& arguments, const std::string& device, const DeviceAddress& address,
                            const ModelParams& scene) {
  DeviceProfile profile;
  const bool real = address.kind != TransportKind::kLoopback;
  const std::string refusal = refuse_profile(real, device, arguments.profile, scene, &profile);
  if (!refusal.empty()) throw Failure{kUsage, refusal};
  if (!arguments.profile.empty()) std::fprintf(stderr, "profile %s\n", profile_text(profile, scene).c_str());
  return profile;
}

// The other end, and what is known of it.
struct Connection {
  DeviceAddress address;
  DeviceProfile profile;
  DeviceLock lock;
  std::unique_ptr<Transport> transport;
  DeviceBus* second = nullptr;  // of the other hand's device, which outlives this
};

// `fd`: inherited socket of a loopback, or -1.
Connection connect_device(const Arguments& arguments, const std::string& device, int fd, const ModelParams& scene) {
  Connection c;
  std::string line, error;
  const std::optional<DeviceAddress> parsed = parse_device_address(device, line, error);
  if (!parsed) throw Failure{kUsage, error};
  c.address = *parsed;
  std::fprintf(stderr, "%s\n", line.c_str());
  c.profile = check_profile(arguments, device, c.address, scene);
  check_bus(c.address, c.profile, scene.period_s);
  // A real device has one controller at a time.
  if (const std::string name = lock_name(c.address); !name.empty()) {
    c.lock = DeviceLock::take(name, error);
    if (!c.lock) throw Failure{kUnavailable, error};
  }
  constexpr int kWait_ms = 5 * kSocketTimeout_ms;
  if (fd >= 0) {
    c.transport = adopt_loopback(fd, error);
  } else if (c.profile.arm) {
    c.transport = open_drives(c.address, *c.profile.arm, DeviceSide::kController, kWait_ms, error);
  } else {
    c.transport = open_transport(c.address, DeviceSide::kController, kWait_ms, error);
  }
  if (!c.transport) throw Failure{kUnavailable, error};
  return c;
}

// The device of the hand at the body, where two hands hold the scene.
std::optional<Connection> connect_second(const Arguments& arguments, const ModelParams& scene,
                                         const Connection& first) {
  const bool both = has_two_devices(scene.held_part);
  if (both == arguments.second_device.empty())
    throw Failure{
        kUsage, both ? "two hands hold this scene: name the second --second-device, too"
                     : "--second-device: one hand moves this scene; it needs device.holds = \"both\" or \"two_tools\""};
  if (!both) return std::nullopt;
  Connection second = connect_device(arguments, arguments.second_device, arguments.second_fd, scene);
  const bool can = second.address.kind == TransportKind::kCan && second.address.name == first.address.name;
  if (can || first.profile.arm)
    throw Failure{kUnavailable, can ? "two devices need two buses; " + first.address.name + " carries one"
                                    : "devices made of drives are for one hand"};
  return second;
}

// Ticks in time after a stall before the force comes back, on the loopback: as many as before arming at the start.
constexpr std::uint32_t kRideThroughTicks = 50;

LoopOptions loop_options(const Model& model, const Arguments& arguments, const Connection& connection) {
  const double period_s = model.params.period_s;
  LoopOptions options;
  options.deadline = deadline_limits(model.params);
  options.ticks = static_cast<std::uint64_t>(arguments.duration_s / period_s);
  options.start_timeout_ticks = static_cast<std::uint32_t>(kStartTimeout_s / period_s);
  options.silence_fault_ticks = static_cast<std::uint32_t>(model.params.silence_fault_ticks);
  const bool ride_through = connection.address.kind == TransportKind::kLoopback && !arguments.virtual_time();
  options.ride_through_ticks = ride_through ? kRideThroughTicks : 0;
  options.link = link_limits(model.params);
  options.local_valid_s = local_valid_s(model.params);
  options.clutch_buttons = connection.profile.clutch_buttons;
  if (!arguments.virtual_time()) options.phase_ns = slot_phase_ns(options.deadline.period_ns);
  // Long enough for the ramp, with room for ticks that come late.
  options.stop_ticks = static_cast<std::uint32_t>(3.0 * model.params.ramp_out_s / period_s) + 20;
  return options;
}

struct Core {
  explicit Core(const Model& model) : state(make_state(model)), scratch(make_scratch(model)) {}
  StatePtr state;
  ScratchPtr scratch;
};

// What the device sent before the loop started is old, and reading it all would make the first tick late.
template <Device D>
void drain(D& device) {
  constexpr int kMostReads = 16;  // 1024 frames: more than a socket holds
  DeviceSample sample;
  for (int i = 0; i < kMostReads; ++i) {
    device.receive(sample);
    if (!sample.fresh) return;
  }
}

// Drives are found, proved and set up; none is enabled.
template <Clock C>
void start_drives(AxisDevice& arm, const Arguments& arguments, const Connection& connection, C& clock) {
  const bool asked = connection.profile.arm->drives.moved_by_hand > 0;
  const bool matters = asked || connection.address.kind != TransportKind::kLoopback;
  const std::string unmoved = matters ? text_if_unmoved(arguments.device, arguments.profile) : "";
  if (asked && !unmoved.empty()) throw Failure{kUnavailable, "refused, and no motor was enabled: " + unmoved};
  if (!unmoved.empty()) std::fprintf(stderr, "drives: %s\n", unmoved.c_str());
  std::fprintf(stderr, "drives: looking for them\n");
  const std::string wrong = arm.start([&clock] { clock.wait_until(clock.now_ns() + 1'000'000); });
  if (!wrong.empty()) throw Failure{kUnavailable, "refused, and no motor was enabled: " + wrong};
  std::fprintf(stderr, "%s", arm.remarks().c_str());
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

// What the loop's thread used while it ran.
struct LoopUsage {
  ThreadUsage thread;
  long heap_calls = 0;  // -1: not counted
};

// What a run in virtual time asks of the machine: nothing but the system-call filter, which holds there as well.
RtOptions rt_options(const Arguments& arguments) {
  RtOptions options;
  options.priority = arguments.priority;
  options.cpu = arguments.cpu;
  if (arguments.virtual_time()) {
    options.priority = 0;
    options.lock_memory = options.no_deep_sleep = false;
  }
  return options;
}

// What was refused of that which a loop that drives motors cannot do without.
std::string missing_rights(const RtSetup& setup, const Arguments& arguments) {
  std::string missing = arguments.priority == 0 ? "scheduler (--priority 0)" : "";
  for (const RtVerdict& verdict : setup.verdicts()) {
    const bool needed = verdict.item == "scheduler" || verdict.item == "memory lock" || verdict.item == "affinity";
    if (needed && !verdict.ok) missing += (missing.empty() ? "" : ", ") + verdict.item;
  }
  return missing;
}

// What speaks against going over to a scene beyond scene_misfit().
std::string refuse_scene(const Arguments& arguments, const Connection& connection, const Model& next) {
  const bool real = connection.address.kind != TransportKind::kLoopback;
  const std::string profile = refuse_profile(real, arguments.device, arguments.profile, next.params);
  if (!profile.empty() || arguments.virtual_time()) return profile;
  const TickFit fit{worst_tick_instructions(next), measure_slowest_tick_ns(next), next.params.period_s};
  return fit.fits() || !real ? "" : "its worst tick does not fit the period on this machine: " + tick_fit_text(fit);
}

// The real-time thread: set-up, system-call filter, loop. Prints only before the filter is in place.
template <Device D, Clock C>
LoopSummary run_loop(const Arguments& arguments, const Model& model, Core& core, HostConnection& host, D& bus,
                     const Connection& connection, C& clock, const std::atomic<bool>& interrupted, LoopUsage& usage) {
  std::string missing;
  std::atomic<bool> stop{false};
  const MailboxRegion* mailbox = host.mailbox_region();
  HostPort port(mailbox, static_cast<std::uint32_t>(kHostSilence_s / model.params.period_s), interrupted, stop);
  if (mailbox == nullptr) port.arm_on(install_arm_signal());
  CrashFile crash(arguments.control_fd, arguments.crash_file);
  TelemetrySink sink(host.telemetry ? &host.writer : nullptr);
  D* second = nullptr;
  if constexpr (std::same_as<D, DeviceBus>) second = connection.second;
  SupervisedDevice device(bus, port), other(second != nullptr ? *second : bus, port);
  SceneShelf shelf(model, [&](const Model& next) { return refuse_scene(arguments, connection, next); });
  SwitchingController controller(model, *core.state, *core.scratch, shelf, port,
                                 host.telemetry ? &host.writer : nullptr);
  if constexpr (std::same_as<D, AxisDevice>) start_drives(bus, arguments, connection, clock);
  LoopSummary summary;
  std::thread thread([&] {
    const RtSetup setup(rt_options(arguments));
    if (arguments.require_rt) missing = missing_rights(setup, arguments);
    if (!missing.empty()) return crash.loop_ended();
    std::string reason = "built with a sanitizer, whose own library maps memory at any time";
    const bool filtered = !kSanitized && install_syscall_filter(reason);
    std::fprintf(stderr, "%s%s\n",
                 arguments.virtual_time() ? "virtual time: in lock step with device and host, nothing here is timed\n"
                                          : setup.text().c_str(),
                 filtered ? "ok       system-call filter: only what the loop needs"
                          : ("REFUSED  system-call filter: " + reason).c_str());
    drain(bus);
    if (second != nullptr) drain(*second);
    const ThreadUsage before = thread_usage();
    const long heap_calls_before = heap_calls();
    Loop loop(device, clock, controller, sink, port, connection.profile.frame,
              loop_options(model, arguments, connection), stop, second != nullptr ? &other : nullptr,
              connection.profile.frame);
    summary = loop.run();
    const long heap_calls_after = heap_calls();
    usage.heap_calls = heap_calls_after < 0 ? -1 : heap_calls_after - heap_calls_before;
    usage.thread = thread_usage() - before;
    summary.faults |= port.faults();
    crash.loop_ended();
  });
  const bool host_died = mailbox != nullptr && crash.wait_for_death([&] { host.hear(arguments.control_fd, shelf); });
  if (host_died) {
    port.host_has_died();
    crash.write(host.ring(), host.newest_model(shelf, model), true);
  }
  thread.join();
  if (!host_died && (port.faults() & Fault::kHostSilent) != 0) {
    crash.write(host.ring(), host.newest_model(shelf, model), false);
  }
  if (!missing.empty()) {
    throw Failure{kUnavailable, "refused: " + missing +
                                    "; a real device is not driven without real-time rights. Copy "
                                    "hal/system/palpate-limits.conf to /etc/security/limits.d, see palpate doctor; "
                                    "--allow-no-rt drives it all the same"};
  }
  return summary;
}

template <Device D>
LoopSummary run_in_virtual_time(const Arguments& arguments, const Model& model, Core& core, HostConnection& host,
                                D& bus, const Connection& connection, const std::atomic<bool>& interrupted,
                                LoopUsage& usage) {
  LockstepClock clock;
  // The device first: a host that looks in the same step sees the sample's tick not yet, but everything before it.
  if (arguments.device_turn_fd >= 0) clock.add(arguments.device_turn_fd, "device");
  if (arguments.second_turn_fd >= 0) clock.add(arguments.second_turn_fd, "second device");
  if (arguments.host_turn_fd >= 0) clock.add(arguments.host_turn_fd, "host");
  const LoopSummary summary = run_loop(arguments, model, core, host, bus, connection, clock, interrupted, usage);
  if (clock.lost() != nullptr) {
    std::fprintf(stderr, "virtual time: the %s %s at %.3f s; time went on without it\n", clock.lost(),
                 clock.lost_closed() ? "closed its end" : "did not take its turn for 10 s",
                 1e-9 * static_cast<double>(clock.lost_ns()));
  }
  return summary;
}

void print_usage(const LoopUsage& usage) {
  std::fprintf(stderr, "loop thread: %ld minor and %ld major page faults, %ld waits, %ld preemptions, ",
               usage.thread.minor_faults, usage.thread.major_faults, usage.thread.waits, usage.thread.preemptions);
  if (usage.heap_calls >= 0) std::fprintf(stderr, "%ld heap calls\n", usage.heap_calls);
  if (usage.heap_calls < 0) std::fprintf(stderr, "heap calls not counted\n");
}

// A real device is not driven by a machine on which the worst tick does not fit.
void check_tick_fits(const Model& model, bool real) {
  const TickFit fit{worst_tick_instructions(model), measure_slowest_tick_ns(model), model.params.period_s};
  std::fprintf(stderr, "%s\n", tick_fit_text(fit).c_str());
  if (!fit.fits() && real) {
    throw Failure{kUnavailable,
                  "refused: the scene's worst tick does not fit its period on this machine; bake it with "
                  "fewer tool.piece.points, a coarser body or a longer device.period_ms"};
  }
}

template <Device D>
LoopSummary run_on(const Arguments& arguments, const Model& model, Core& core, HostConnection& host, D& device,
                   const Connection& connection, const std::atomic<bool>& interrupted, LoopUsage& usage) {
  if (arguments.virtual_time())
    return run_in_virtual_time(arguments, model, core, host, device, connection, interrupted, usage);
  MonotonicClock clock;
  return run_loop(arguments, model, core, host, device, connection, clock, interrupted, usage);
}

int run(int argc, char** argv) {
  Arguments arguments = parse(argc, argv);
  const std::atomic<bool>& interrupted = install_stop_signals();
  PrivateFile image;
  const Model model = load_image(arguments.image, image);
  Core core(model);
  HostConnection host;
  std::string error;
  if (arguments.control_fd >= 0 || !arguments.telemetry.empty())
    error = host.share_telemetry(model, arguments.image, arguments.telemetry);
  if (error.empty() && arguments.control_fd >= 0) error = host.connect(arguments.control_fd);
  if (!error.empty()) throw Failure{kUnavailable, error};
  Connection connection = connect_device(arguments, arguments.device, arguments.device_fd, model.params);
  const std::optional<Connection> second = connect_second(arguments, model.params, connection);
  std::optional<DeviceBus> other;
  if (second) connection.second = &other.emplace(*second->transport, second->address.profile, second->address.node);
  const bool real = connection.address.kind != TransportKind::kLoopback ||
                    (second && second->address.kind != TransportKind::kLoopback);
  if (!arguments.virtual_time()) connection.transport->stamp_arrivals();  // they are the computer's time
  arguments.require_rt = (arguments.require_rt || real) && !arguments.allow_no_rt && !arguments.virtual_time();
  if (!arguments.virtual_time()) check_tick_fits(model, real);
  LoopUsage usage;
  LoopSummary summary;
  if (connection.profile.arm) {
    const std::unique_ptr<AxisDrives> drives =
        make_drives(*connection.transport, *connection.profile.arm, model.params.period_s);
    AxisDevice device(*drives, *connection.profile.arm, connection.profile.frame, model.params.period_s);
    summary = run_on(arguments, model, core, host, device, connection, interrupted, usage);
    if (summary.end == LoopEnd::kSilentAtStart) throw Failure{kSilentAtStart, "no positions from the drives at start"};
    print_run(summary);
    std::fprintf(stderr, "drives: %llu ticks without force beyond a limit of joints or linkage\n",
                 static_cast<unsigned long long>(device.limited_ticks()));
    if (summary.faults != 0) std::fprintf(stderr, "%s", device.remarks().c_str());
  } else {
    DeviceBus bus(*connection.transport, connection.address.profile, connection.address.node);
    summary = run_on(arguments, model, core, host, bus, connection, interrupted, usage);
    if (summary.end == LoopEnd::kSilentAtStart) {
      const LinkReport report = report_link(bus, connection.transport->state());
      const std::string at_body = other ? report_link(*other, second->transport->state()).found : "";
      throw Failure{kSilentAtStart, "no sample at start: " + report.found + "; " + report.remedy +
                                        (at_body.empty() ? "" : "; the second device: " + at_body)};
    }
    print_run(summary);
    print_link(summary, bus, connection.transport->state());
    if (other) print_link(summary, *other, second->transport->state());
  }
  print_usage(usage);
  return summary.faults != 0 ? kFaulted : kOk;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // the crash file is written while the force ramps out: a full limit must not end that
  try {
    return palpate::run(argc, argv);
  } catch (const palpate::Failure& failure) {
    const bool help = failure.exit_code == palpate::kOk;
    std::fprintf(help ? stdout : stderr, "%s%s%s", help ? "" : "palpate-rt: ", failure.text.c_str(), help ? "" : "\n");
    return failure.exit_code;
  }
}
