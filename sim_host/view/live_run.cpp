#include "sim_host/view/live_run.h"

#include <chrono>

#include "hal/bus/device_address.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

bool has_simulated_hand(const std::string& device) {
  return device.starts_with("auto") || device.starts_with("loopback");
}

JointCommand all_fingers(float closing) {
  JointCommand command;
  for (float& finger : command.closing) finger = closing;
  return command;
}

}  // namespace

StartedRun::StartedRun(RunOptions options, bool mouse) : mouse_(mouse), has_hand_(has_simulated_hand(options.device)) {
  if (mouse_) steering_.hold();
  RunCompanion& companion = options.companion;
  // As often as a mouse speaks: every 10 ms.
  companion.look = std::chrono::milliseconds(10);
  companion.begins = [this](const RecordingHeader& header) { begin(header); };
  companion.tick = [this](const TickRecord& record) { track_->append(record); };
  companion.goes_on = [this] { return !stopping_.load(); };
  companion.joints = [this]() -> std::optional<JointCommand> {
    const float closing = steering_.closing();
    if (closing < 0 && !mouse_) return std::nullopt;
    return all_fingers(std::max(0.0f, closing));
  };
  companion.live = [this](LiveSettings& wanted) { steering_.apply_settings(wanted); };
  if (has_hand_) companion.hand_fd = steering_.fd();
  thread_ = std::thread([this, options] { run(options); });
  while (!begun_.load() && !ended_.load()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  if (begun_.load()) return;
  thread_.join();
  if (error_) std::rethrow_exception(error_);
  throw std::runtime_error("the run ended before it began");
}

StartedRun::~StartedRun() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void StartedRun::begin(const RecordingHeader& header) {
  image_ = std::make_unique<ImageFile>(header.image_path);
  track_ = std::make_unique<RunTrack>(1e-9 * static_cast<double>(header.period_ns));
  initial_ = make_state(image_->model());
  begun_.store(true);
}

void StartedRun::run(RunOptions options) {
  try {
    result_ = run_session(options);
  } catch (...) {
    error_ = std::current_exception();
  }
  ended_.store(true);
}

const RunResult& StartedRun::result() {
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(error_);
  return result_;
}

std::string StartedRun::notice() const {
  if (track_->full()) return "an hour is over: what comes now is not shown; close and start again";
  if (!goes_on()) {
    const std::size_t size = track_->size();
    const std::uint32_t fault = size > 0 ? track_->at(size - 1).fault : 0;
    return fault == 0 ? "the run is over" : "the run ended with a fault: " + bit_names(fault_bit_texts(), fault);
  }
  if (!mouse_ || !has_hand_) return "";
  const bool fresh = steering_.pulls() == 0;
  return fresh ? "Drag the tool with the mouse: it is the device" : "";
}

}  // namespace palpate
