#include "sim_host/run_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <thread>

#include "hal/device_address.h"
#include "sim_host/controller_link.h"
#include "sim_host/device_process.h"
#include "sim_host/recorder.h"
#include "sim_host/scene_image.h"
#include "sim_host/status_line.h"

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

// True when the run brings its own simulated device: on the loopback, unless the user named a socket of somebody
// else's. "auto" takes the loopback when there is no CAN interface. Throws when the address cannot be read.
bool wants_simulated_device(const std::string& device) {
  std::string line, error;
  const std::optional<DeviceAddress> address = parse_device_address(device, line, error);
  if (!address) throw std::runtime_error(error);
  return address->kind == TransportKind::kLoopback && device.rfind("loopback:", 0) != 0;
}

// Watches the controller until the time is over, a signal comes or it ends by itself.
class Watch {
 public:
  Watch(ControllerLink& link, const RunOptions& options)
      : link_(link),
        options_(options),
        reader_(link.telemetry()),
        show_(!options.quiet && isatty(STDERR_FILENO) != 0) {}

  void run() {
    const auto end = Clock::now() + std::chrono::duration<double>(options_.duration_s);
    while (Clock::now() < end && stop_signal == 0 && !faulted_ && link_.process().running()) {
      link_.mailbox().beat();
      look();
      std::this_thread::sleep_for(kHeartbeatPeriod);
    }
    if (show_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  void look() {
    TickRecord newest;
    if (!reader_.newest(newest)) return;
    // Arming is an edge, ignored by a tick that happens to have no fresh sample: offer edges until one is taken.
    if (newest.output.mode == Mode::kIdle && newest.sequence >= kTicksBeforeArming) {
      arming_ = !arming_;
      link_.mailbox().set(arming_ ? Command::kArm : 0, false);
    }
    // A latched fault leaves only by an operator's reset; there is none to ask here, so the run is over.
    faulted_ = newest.output.mode == Mode::kFault;
    if (show_) fmt::print(stderr, "\r{}\x1b[K", line_.text(newest));
  }

  ControllerLink& link_;
  const RunOptions& options_;
  TelemetryReader reader_;
  StatusLine line_;
  bool show_;
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

}  // namespace

RunResult run_session(const RunOptions& options) {
  const StopSignals signals;
  const SceneImage scene = prepare_scene(options.scene, options.image, options.record);
  const std::string& folder = options.program_folder;
  const auto program = [&](const char* name) { return folder.empty() ? sibling_program(name) : folder + "/" + name; };

  std::optional<DeviceProcess> device;
  if (wants_simulated_device(options.device)) {
    device.emplace(program("palpate-device"), scene, options.path, options.device,
                   std::max(0, options.priority - kDevicePriorityBelow));
  }
  ControllerLink link(program("palpate-rt"),
                      controller_arguments(options, scene.image_path, options.device, device.has_value()),
                      device ? device->controller_end() : -1);
  if (device) device->close_controller_end();

  RunResult result;
  const auto summary = std::make_unique<RunSummary>();
  const TelemetryHeader& header = link.telemetry().header;
  std::unique_ptr<RecordingWriter> file;
  if (!options.record.empty()) {
    file = std::make_unique<RecordingWriter>(options.record, recording_header(header), header.initial_state);
  }
  Recorder recorder(link.telemetry(), file.get(), [&](const TickRecord& record) { add(*summary, record); });
  recorder.start();
  Watch(link, options).run();
  result.interrupted = stop_signal != 0;
  result.controller_exit = finish(link);
  recorder.stop();  // the controller has ended: the ring holds its last word
  result.summary = *summary;
  result.lost = recorder.lost();
  result.recorder_error = recorder.error();
  return result;
}

}  // namespace palpate
