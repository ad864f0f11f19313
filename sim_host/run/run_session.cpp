#include "sim_host/run/run_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "hal/bus/bus_budget.h"
#include "hal/bus/device_address.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/bake/scene_image.h"
#include "sim_host/record/recorder.h"
#include "sim_host/run/controller_link.h"
#include "sim_host/run/device_process.h"
#include "sim_host/run/status_line.h"

namespace palpate {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// The controller takes 2 s without a heartbeat for the death of its host.
constexpr milliseconds kHeartbeatPeriod{50};
// Ticks before arming, so that the force does not ramp in on the first, perhaps wild, ones.
constexpr std::uint64_t kTicksBeforeArming = 50;

// The simulated device stands for hardware, which nothing delays; but the controller comes first.
constexpr int kDevicePriorityBelow = 10;

volatile std::sig_atomic_t stop_signal = 0;
extern "C" void on_stop_signal(int number) { stop_signal = number; }

// Takes SIGINT and SIGTERM for the time of a run.
class StopSignals {
 public:
  StopSignals() {
    stop_signal = 0;
    struct sigaction action {};
    action.sa_handler = on_stop_signal;
    sigaction(SIGINT, &action, &old_int_);
    sigaction(SIGTERM, &action, &old_term_);
  }
  ~StopSignals() {
    sigaction(SIGINT, &old_int_, nullptr);
    sigaction(SIGTERM, &old_term_, nullptr);
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  struct sigaction old_int_ {
  }, old_term_{};
};

std::vector<std::string> controller_arguments(const RunOptions& options, const std::string& image,
                                              const std::string& device, bool device_inherited) {
  std::vector<std::string> arguments{"--image", image,        "--device",
                                     device,    "--priority", std::to_string(options.priority)};
  if (options.cpu >= 0) arguments.insert(arguments.end(), {"--cpu", std::to_string(options.cpu)});
  if (device_inherited) {
    arguments.insert(arguments.end(), {"--device-fd", std::to_string(ControllerLink::kDeviceDescriptor)});
  }
  return arguments;
}

DeviceAddress device_address(const std::string& device) {
  std::string line, error;
  const std::optional<DeviceAddress> address = parse_device_address(device, line, error);
  if (!address) throw std::runtime_error(error);
  return *address;
}

// True when the run brings its own simulated device: on the loopback, unless the user named a socket of somebody
// else's. "auto" takes the loopback when there is no CAN interface.
bool wants_simulated_device(const DeviceAddress& address, const std::string& device) {
  return address.kind == TransportKind::kLoopback && device.rfind("loopback:", 0) != 0;
}

// Before anything is started: a bus that cannot carry the scene's traffic in every period is refused with the table.
void check_bus(const DeviceAddress& address, double period_s) {
  if (address.kind != TransportKind::kCan) return;
  BusBudget budget = haptic_node_budget(address.profile == WireProfile::kFd);
  budget.period_us = 1e6 * period_s;
  const BusVerdict verdict = check_bus_budget(budget);
  if (verdict.fits) return;
  throw std::runtime_error(
      fmt::format("{} cannot carry this scene's traffic in every period:\n{}", address.name, verdict.text));
}

// The motion over and over, with a second to return to its first pose, until `duration_s` is over.
void repeat_path(PathDesc& path, double duration_s) {
  constexpr double kReturn_s = 1;
  const std::vector<PathPoint> once = path.point;
  if (once.empty()) return;
  const double period_s = once.back().time_s - once.front().time_s + kReturn_s;
  for (double start_s = period_s; start_s < duration_s; start_s += period_s) {
    for (const PathPoint& point : once) {
      path.point.push_back(point);
      path.point.back().time_s += start_s;
    }
  }
}

// The summary, filled by the recorder's thread and shown by this one.
class SharedSummary {
 public:
  void take(const TickRecord& record) {
    const std::lock_guard lock(mutex_);
    add(all_, record);
    add(recent_, record);
  }
  // Copies both; the recent one starts again.
  void look(RunSummary& all, RunSummary& recent) {
    const std::lock_guard lock(mutex_);
    all = all_;
    recent = recent_;
    recent_ = {};
  }
  RunSummary all() {
    const std::lock_guard lock(mutex_);
    return all_;
  }

 private:
  std::mutex mutex_;
  RunSummary all_, recent_;
};

// "" when the controller ended in order (a latched fault is order: exit code 1), otherwise how.
std::string death_text(int exit_code) {
  if (exit_code >= 128) return fmt::format("controller killed by signal {}", exit_code - 128);
  return exit_code > 1 ? fmt::format("controller ended with exit code {}", exit_code) : "";
}

CandumpOptions candump_options(const DeviceAddress& address) {
  CandumpOptions options;
  if (address.kind == TransportKind::kCan) options.interface = address.name;
  options.profile = address.profile;
  options.node = address.node;
  options.wall_minus_monotonic_ns = wall_minus_monotonic_ns();
  return options;
}

// Watches the controller until the time is over, a signal comes or it ends by itself.
class Watch {
 public:
  Watch(ControllerLink& link, const RunOptions& options, const JointScript& joints, SharedSummary& summary)
      : link_(link),
        options_(options),
        joints_(joints),
        summary_(summary),
        reader_(link.telemetry()),
        show_(!options.quiet && !options.progress && isatty(STDERR_FILENO) != 0),
        all_(std::make_unique<RunSummary>()),
        recent_(std::make_unique<RunSummary>()) {}

  // Returns how long it watched, in seconds.
  double run() {
    const auto start = Clock::now();
    const auto end = start + std::chrono::duration<double>(options_.duration_s);
    const auto elapsed_s = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    while (Clock::now() < end && stop_signal == 0 && !faulted_ && link_.process().running()) {
      link_.mailbox().beat();
      if (!joints_.empty()) link_.mailbox().set_joints(joints_.at(elapsed_s()));
      look();
      report(elapsed_s(), false);
      std::this_thread::sleep_for(kHeartbeatPeriod);
    }
    if (show_) fmt::print(stderr, "\r\x1b[K");
    report(elapsed_s(), true);
    return elapsed_s();
  }

 private:
  void look() {
    TickRecord newest;
    if (!reader_.newest(newest)) return;
    // Arming is an edge, ignored by a tick that happens to have no fresh sample: offer edges until one is taken.
    if (options_.arm && newest.output.mode == Mode::kIdle && newest.sequence >= kTicksBeforeArming) {
      arming_ = !arming_;
      link_.mailbox().set(arming_ ? Command::kArm : 0, false);
    }
    // A latched fault leaves only by an operator's reset; there is none to ask here, so the run is over.
    faulted_ = newest.output.mode == Mode::kFault;
    if (show_) fmt::print(stderr, "\r{}\x1b[K", line_.text(newest));
  }

  void report(double elapsed_s, bool last) {
    constexpr double kReportPeriod_s = 1;
    if (!options_.progress || (!last && elapsed_s < reported_s_ + kReportPeriod_s)) return;
    reported_s_ = elapsed_s;
    summary_.look(*all_, *recent_);
    options_.progress({all_.get(), recent_.get(), elapsed_s, options_.duration_s});
  }

  ControllerLink& link_;
  const RunOptions& options_;
  const JointScript& joints_;
  SharedSummary& summary_;
  TelemetryReader reader_;
  StatusLine line_;
  bool show_;
  std::unique_ptr<RunSummary> all_, recent_;
  double reported_s_ = 0;
  bool arming_ = false;
  bool faulted_ = false;
};

// Ends the controller in order; the heartbeat goes on meanwhile, or a slow stop would look like a dead host.
int finish(ControllerLink& link) {
  link.mailbox().set(Command::kStop, true);
  const auto until = Clock::now() + milliseconds(3000);
  while (link.process().running() && Clock::now() < until) {
    link.mailbox().beat();
    std::this_thread::sleep_for(milliseconds(5));
  }
  return link.finish();
}

// Records and watches a controller that has just started, then ends it.
RunResult follow(ControllerLink& link, const RunOptions& options, const JointScript& joints,
                 const DeviceAddress& address, const Model& model) {
  const TelemetryHeader& header = link.telemetry().header;
  std::unique_ptr<RecordingWriter> file;
  if (!options.record.empty()) {
    file = std::make_unique<RecordingWriter>(options.record, recording_header(header), header.initial_state);
  }
  std::unique_ptr<BlackBox> box;
  if (!options.black_box.empty()) {
    box = std::make_unique<BlackBox>(options.black_box, recording_header(header), header.initial_state, &model,
                                     candump_options(address));
  }
  const auto summary = std::make_unique<SharedSummary>();
  Recorder recorder(link.telemetry(), file.get(), [&](const TickRecord& record) {
    summary->take(record);
    if (box) box->add(record);
  });
  recorder.start();
  RunResult result;
  result.elapsed_s = Watch(link, options, joints, *summary).run();
  result.interrupted = stop_signal != 0;
  result.controller_exit = finish(link);
  recorder.stop();  // the controller has ended: the ring holds its last word
  if (box) {
    box->finish(death_text(result.controller_exit));
    result.dumps = box->dumps();
    result.black_box_error = box->error();
  }
  result.summary = summary->all();
  result.lost = recorder.lost();
  result.recorder_error = recorder.error();
  return result;
}

}  // namespace

RunResult run_session(const RunOptions& options) {
  const StopSignals signals;
  const DeviceAddress address = device_address(options.device);
  SceneImage scene = prepare_scene(options.scene, options.image, options.record);
  const ImageFile image(scene.image_path);
  check_bus(address, image.model().params.period_s);
  std::vector<TimedJoints> scripted;
  if (scene.scene && options.path.empty()) scripted = scripted_joints(scene.scene->path);
  const JointScript joints(options.joints, image.model(), scripted);
  // The commands go through the mailbox; the closing button, which closes every finger, is left alone then.
  if (!joints.empty() && scene.scene)
    for (PathPoint& point : scene.scene->path.point) point.closing.clear();
  if (options.repeat_path && scene.scene) repeat_path(scene.scene->path, options.duration_s);
  const std::string& folder = options.program_folder;
  const auto program = [&](const char* name) { return folder.empty() ? sibling_program(name) : folder + "/" + name; };

  if (options.before_start) options.before_start();
  std::optional<DeviceProcess> device;
  if (wants_simulated_device(address, options.device)) {
    device.emplace(program("palpate-device"), scene, options.path, options.device,
                   std::max(0, options.priority - kDevicePriorityBelow));
  }
  ControllerLink link(program("palpate-rt"),
                      controller_arguments(options, scene.image_path, options.device, device.has_value()),
                      device ? device->controller_end() : -1);
  if (device) device->close_controller_end();
  return follow(link, options, joints, address, image.model());
}

}  // namespace palpate
