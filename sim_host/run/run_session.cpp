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

#include "config/scene/child_program.h"
#include "hal/bus/bus_budget.h"
#include "hal/bus/device_address.h"
#include "hal/device/device_profile.h"
#include "hal/drives/drive_link.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/bake/scene_image.h"
#include "sim_host/exit_codes.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recorder.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/record/recover.h"
#include "sim_host/run/controller_link.h"
#include "sim_host/run/device_process.h"
#include "sim_host/run/hand_path_file.h"
#include "sim_host/run/host_time.h"
#include "sim_host/run/scene_log.h"
#include "sim_host/run/second_hand.h"
#include "sim_host/run/settings_port.h"
#include "sim_host/run/socket_pair.h"
#include "sim_host/run/status_line.h"
#include "sim_host/tick_memory.h"

namespace palpate {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Ticks before arming, so that the force does not ramp in on the first, perhaps wild, ones.
constexpr std::uint64_t kTicksBeforeArming = 50;

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
                                              const std::string& device, bool device_inherited, bool virtual_time) {
  std::vector<std::string> arguments{"--image", image,        "--device",
                                     device,    "--priority", std::to_string(options.priority)};
  if (!options.record.empty()) arguments.insert(arguments.end(), {"--crash-file", crash_path(options.record)});
  if (!options.telemetry.empty()) arguments.insert(arguments.end(), {"--telemetry", options.telemetry});
  if (options.cpu >= 0) arguments.insert(arguments.end(), {"--cpu", std::to_string(options.cpu)});
  if (options.allow_no_rt) arguments.emplace_back("--allow-no-rt");
  if (!options.profile.empty()) arguments.insert(arguments.end(), {"--profile", options.profile});
  if (device_inherited) {
    arguments.insert(arguments.end(), {"--device-fd", std::to_string(ControllerLink::kDeviceDescriptor)});
  }
  if (virtual_time) {
    arguments.insert(arguments.end(), {"--device-turn-fd", std::to_string(ControllerLink::kDeviceTurnDescriptor),
                                       "--host-turn-fd", std::to_string(ControllerLink::kHostTurnDescriptor)});
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
void check_bus(const DeviceAddress& address, const DeviceProfile& profile, double period_s) {
  if (address.kind != TransportKind::kCan) return;
  BusBudget budget = haptic_node_budget(address.profile == WireProfile::kFd);
  budget.period_us = 1e6 * period_s;
  const BusVerdict verdict = profile.arm ? check_drives_budget(*profile.arm, period_s) : check_bus_budget(budget);
  if (verdict.fits) return;
  throw std::runtime_error(
      fmt::format("{} cannot carry this scene's traffic in every period:\n{}", address.name, verdict.text));
}

// The controller refuses the same; here it is said before a scene is baked, and the simulated device becomes the one
// that the profile describes.
DeviceProfile check_profile(const RunOptions& options, const DeviceAddress& address, const ModelParams& params,
                            SceneImage& scene) {
  DeviceProfile profile;
  const bool real = address.kind != TransportKind::kLoopback;
  const std::string refusal = refuse_profile(real, options.device, options.profile, params, &profile);
  if (!refusal.empty()) throw std::runtime_error(refusal);
  if (options.profile.empty() || !scene.scene) return profile;
#define PALPATE_KEY(member, key, value, lowest, highest, scale, meaning) scene.scene->device.member = profile.member;
  PALPATE_PROFILE_KEYS(PALPATE_KEY)
#undef PALPATE_KEY
  return profile;
}

// The motion over and over, with a second to return to its first pose, until `duration_s` is over.
void repeat_path(std::vector<PathPoint>& points, double duration_s) {
  constexpr double kReturn_s = 1;
  const std::vector<PathPoint> once = points;
  if (once.empty()) return;
  const double period_s = once.back().time_s - once.front().time_s + kReturn_s;
  for (double start_s = period_s; start_s < duration_s; start_s += period_s) {
    for (const PathPoint& point : once) {
      points.push_back(point);
      points.back().time_s += start_s;
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

// "" when the controller ended in order (a latched fault is order), otherwise how.
std::string death_text(int exit_code) {
  if (exit_code >= 128) return fmt::format("controller killed by signal {}", exit_code - 128);
  return exit_code != kExitOk && exit_code != kExitFault ? fmt::format("controller ended with exit code {}", exit_code)
                                                         : "";
}

CandumpOptions candump_options(const DeviceAddress& address, bool virtual_time) {
  CandumpOptions options;
  if (address.kind == TransportKind::kCan) options.interface = address.name;
  options.profile = address.profile;
  options.node = address.node;
  options.wall_minus_monotonic_ns = virtual_time ? 0 : wall_minus_monotonic_ns();
  return options;
}

// What a recording of so long a run takes at most in practice: two regions a tick, an image that does not pack well.
double recording_bytes(double duration_s, const ImageFile& image) {
  const double ticks = duration_s / image.model().params.period_s;
  return ticks * static_cast<double>(plr::kRecordPrefix + 2 * sizeof(RegionRecord)) +
         static_cast<double>(state_bytes(image.model()) + image.bytes().size());
}

// Watches the controller until the time is over, a signal comes or it ends by itself.
class Watch {
 public:
  // `device`: null when it is not ours. `recorder`: drained at each look; null when it has a thread of its own.
  Watch(ControllerLink& link, HostTime& time, DeviceProcess* device, Recorder* recorder, const RunOptions& options,
        const JointScript& joints, SharedSummary& summary, SceneLog& scenes)
      : link_(link),
        time_(time),
        device_(device),
        recorder_(recorder),
        options_(options),
        joints_(joints),
        summary_(summary),
        scenes_(scenes),
        reader_(link.telemetry()),
        show_(!options.quiet && !options.progress && isatty(STDERR_FILENO) != 0),
        all_(std::make_unique<RunSummary>()),
        recent_(std::make_unique<RunSummary>()) {}

  // Returns how long it watched, in seconds of the run.
  double run() {
    while (next() && time_.elapsed_s() < options_.duration_s && stop_signal == 0 && !faulted_ && !waits_in_vain()) {
      if (options_.companion.goes_on && !options_.companion.goes_on()) break;
      tell_joints();
      tell_live();
      tell_scene();
      look();
      report(time_.elapsed_s(), false);
    }
    // A killed device's sockets close before it can be waited for, and the fault may end the watch between the two.
    constexpr int kLongestDeath_ms = 100;
    if (faulted_ && device_ != nullptr) device_died_ = device_died_ || device_->ends_within(kLongestDeath_ms);
    if (show_) fmt::print(stderr, "\r\x1b[K");
    report(time_.elapsed_s(), true);
    return time_.elapsed_s();
  }

  bool device_died() const { return device_died_; }

  // Ends the controller in order; the heartbeat goes on meanwhile, or a slow stop would look like a dead host. Returns
  // its exit code.
  int finish() {
    constexpr double kLongest_s = 4;  // the controller waits 3 s for a first sample, then ends by itself
    link_.mailbox().set(Command::kStop, true);
    const double from_s = time_.elapsed_s();
    while (next() && time_.elapsed_s() < from_s + kLongest_s) {
    }
    return link_.finish();
  }

 private:
  void tell_joints() {
    std::optional<JointCommand> told;
    if (options_.companion.joints) told = options_.companion.joints();
    if (!told && !joints_.empty()) told = joints_.at(time_.elapsed_s());
    if (told) link_.mailbox().set_joints(*told);
  }

  void tell_live() {
    const LiveSettings before = live_;
    if (options_.companion.live) options_.companion.live(live_);
    settings_.poll(live_, [this](const std::string& path) { return go_over(path); });
    if (!(live_ == before)) link_.mailbox().set_live(live_);
  }

  void tell_scene() {
    const std::string path = options_.companion.scene && ticked_ ? options_.companion.scene() : "";
    if (path.empty()) return;
    const std::string wrong = go_over(path);
    if (options_.companion.changed) options_.companion.changed(wrong);
  }
  // "" when the controller will, otherwise why not.
  std::string go_over(const std::string& path) {
    if (faulted_) return "a fault is latched, and leaves only by a reset";
    // A scene without a tick leaves no record by which another could be told to begin.
    if (!ticked_) return "the run has not made its first tick: ask again";
    const std::string wrong = link_.announce_scene(path);
    if (!wrong.empty()) return wrong;
    const TelemetryScene& announced = link_.telemetry().later_scene[scene_++];
    try {
      scenes_.expect(path, announced.scene_hash);
      if (options_.companion.goes_over) options_.companion.goes_over(path);  // before its first tick can come
    } catch (const std::runtime_error& error) {
      return error.what();  // it stays on the controller's shelf, and is never asked for
    }
    arming_ = false;
    link_.mailbox().set_scene(scene_);
    return "";
  }

  // The next look: false when there is nobody left to look at.
  bool next() {
    if (!time_.next() || !link_.process().running()) return false;
    link_.mailbox().beat();
    if (recorder_ != nullptr) recorder_->drain();
    return true;
  }

  // Its device is gone, and so is the fault that would say so: at rest, or while a stall is ridden, silence is none.
  bool waits_in_vain() {
    device_died_ = device_died_ || (device_ != nullptr && !device_->running());
    return device_died_ && !rendering_;
  }

  void look() {
    TickRecord newest;
    if (!reader_.newest(newest)) return;
    ticked_ = true;
    // Arming is an edge, ignored by a tick that happens to have no fresh sample: offer edges until one is taken.
    if (options_.arm && newest.output.mode == Mode::kIdle && newest.tick >= kTicksBeforeArming) {
      arming_ = !arming_;
      link_.mailbox().set(arming_ ? Command::kArm : 0, false);
    }
    // A latched fault leaves only by an operator's reset; there is none to ask here, so the run is over.
    faulted_ = newest.output.mode == Mode::kFault;
    const bool waits = newest.output.mode == Mode::kIdle || (newest.input.commands & Command::kStall) != 0;
    rendering_ = !faulted_ && !waits;
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
  HostTime& time_;
  DeviceProcess* device_;
  Recorder* recorder_;
  const RunOptions& options_;
  const JointScript& joints_;
  SharedSummary& summary_;
  SceneLog& scenes_;
  std::uint64_t scene_ = 0;  // the newest that was announced
  TelemetryReader reader_;
  SettingsPort settings_;
  LiveSettings live_;
  StatusLine line_;
  bool show_;
  std::unique_ptr<RunSummary> all_, recent_;
  double reported_s_ = 0;
  bool arming_ = false;
  bool ticked_ = false;  // there was a first tick
  bool faulted_ = false;
  bool rendering_ = false;
  bool device_died_ = false;
};

// Records and watches a controller that has just started, then ends it.
RunResult follow(ControllerLink& link, HostTime& time, DeviceProcess* device, const RunOptions& options,
                 const JointScript& joints, const DeviceAddress& address, const ImageFile& image,
                 std::optional<PartFile> record_file) {
  const bool virtual_time = runs_in_virtual_time(options);
  const RecordingHeader header = recording_header(link.telemetry().header);
  SceneLogOptions kept;
  if (record_file) kept.record = options.record;
  kept.exists = options.overwrite ? WhenItExists::kReplace : WhenItExists::kRefuse;
  kept.black_box = options.black_box;
  kept.candump = candump_options(address, virtual_time);
  SceneLog scenes(kept, header, image, std::move(record_file));
  const auto summary = std::make_unique<SharedSummary>();
  Recorder recorder(link.telemetry(), scenes.file(), [&](const TickRecord& record) {
    summary->take(record);
    scenes.add(record);
    if (options.companion.tick) options.companion.tick(record);
  });
  recorder.on_turn([&](std::uint64_t first, bool whole) { return scenes.turn(first, whole); });
  if (options.companion.begins) options.companion.begins(header);
  if (!virtual_time) recorder.start();
  Watch watch(link, time, device, virtual_time ? &recorder : nullptr, options, joints, *summary, scenes);
  RunResult result;
  result.virtual_time = virtual_time;
  result.elapsed_s = watch.run();
  result.device_died = watch.device_died();
  result.interrupted = stop_signal != 0;
  result.controller_exit = watch.finish();
  recorder.stop();  // the controller has ended: the ring holds its last word
  scenes.finish(death_text(result.controller_exit));
  result.dumps = scenes.dumps();
  result.black_box_error = scenes.black_box_error();
  result.later_recordings = scenes.later_recordings();
  result.summary = summary->all();
  result.grasp = scenes.grasp();
  result.lost = recorder.lost();
  result.recorder_error = recorder.error();
  return result;
}

}  // namespace

bool runs_in_virtual_time(const RunOptions& options) {
  const DeviceAddress address = device_address(options.device);
  const bool simulated = wants_simulated_device(address, options.device);
  if (options.time == RunTime::kVirtual && !simulated) {
    throw std::runtime_error(
        fmt::format("virtual time is the simulated device's; {} has its own: use --device loopback, or leave "
                    "--virtual-time out",
                    options.device));
  }
  if (options.time == RunTime::kAutomatic) return simulated && options.device.starts_with("auto");
  return options.time == RunTime::kVirtual;
}

RunResult run_session(const RunOptions& options) {
  const StopSignals signals;
  const DeviceAddress address = device_address(options.device);
  if (options.profile.empty() && address.kind != TransportKind::kLoopback)
    throw std::runtime_error(refuse_profile(true, options.device, "", {}));
  // First of all: a name that is taken is no reason to bake, let alone to move anything.
  std::optional<PartFile> record;
  if (!options.record.empty()) {
    record.emplace(options.record, options.overwrite ? WhenItExists::kReplace : WhenItExists::kRefuse);
  }
  // The simulated device would refuse it too, but as a process that is gone.
  std::vector<HandPose> poses;
  for (const std::string& path : {options.path, options.second_path})
    if (std::string error; !path.empty() && !read_hand_path(path, poses, error)) throw std::runtime_error(error);
  SceneImage scene = prepare_scene(options.scene, options.image, options.record, options.overlays);
  const ImageFile image(scene.image_path);
  const DeviceProfile profile = check_profile(options, address, image.model().params, scene);
  check_bus(address, profile, image.model().params.period_s);
  if (record) require_space(options.record, recording_bytes(options.duration_s, image));
  std::vector<TimedJoints> scripted;
  if (scene.scene && options.path.empty()) scripted = scripted_joints(scene.scene->path);
  const JointScript joints(options.joints, image.model(), scripted);
  // The commands go through the mailbox; the closing button, which closes every finger, is left alone then.
  if (!joints.empty() && scene.scene)
    for (PathPoint& point : scene.scene->path.point) point.closing.clear();
  if (options.repeat_path && scene.scene)
    for (std::vector<PathPoint>* points : {&scene.scene->path.point, &scene.scene->path.second})
      repeat_path(*points, options.duration_s);
  const std::string& folder = options.program_folder;
  const auto program = [&](const char* name) { return folder.empty() ? sibling_program(name) : folder + "/" + name; };

  if (options.before_start) options.before_start();
  const bool virtual_time = runs_in_virtual_time(options);
  std::optional<SocketPair> device_turns, host_turns;
  std::vector<std::pair<int, int>> turns;
  if (virtual_time) {
    device_turns.emplace();
    host_turns.emplace();
    turns = {{device_turns->end(0), ControllerLink::kDeviceTurnDescriptor},
             {host_turns->end(0), ControllerLink::kHostTurnDescriptor}};
  }
  std::optional<DeviceProcess> device;
  if (wants_simulated_device(address, options.device)) {
    device.emplace(program("palpate-device"), scene, options.path, options.device,
                   virtual_time ? 0 : std::max(0, options.priority - kDevicePriorityBelow),
                   virtual_time ? device_turns->end(1) : -1, options.companion.hand_fd,
                   profile.arm ? options.profile : "");
  }
  SecondHand second(options, image.model().params, scene, program("palpate-device"), virtual_time);
  std::vector<std::string> arguments =
      controller_arguments(options, scene.image_path, options.device, device.has_value(), virtual_time);
  second.add_to(arguments, turns);
  ControllerLink link(program("palpate-rt"), std::move(arguments), device ? device->controller_end() : -1, turns);
  second.close_controller_ends();
  if (device) device->close_controller_end();
  if (!virtual_time) {
    RealHostTime time(options.companion.look);
    return follow(link, time, device ? &*device : nullptr, options, joints, address, image, std::move(record));
  }
  device_turns.reset();
  host_turns->close_end(0);
  VirtualHostTime time(host_turns->end(1), options.pace, options.companion.look);
  return follow(link, time, device ? &*device : nullptr, options, joints, address, image, std::move(record));
}

}  // namespace palpate
