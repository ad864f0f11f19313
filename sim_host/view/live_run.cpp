#include "sim_host/view/live_run.h"

#include <chrono>

#include "hal/bus/device_address.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

bool has_simulated_hand(const std::string& device) {
  return device.starts_with("auto") || device.starts_with("loopback");
}

}  // namespace

StartedRun::StartedRun(RunOptions options, bool mouse) : mouse_(mouse), has_hand_(has_simulated_hand(options.device)) {
  if (mouse_) steering_.hold();
  RunCompanion& companion = options.companion;
  // As often as a mouse speaks: every 10 ms.
  companion.look = std::chrono::milliseconds(10);
  companion.begins = [this, first = SceneChoice{options.scene, options.overlays}](const RecordingHeader& header) {
    begin(header, first);
  };
  companion.tick = [this](const TickRecord& record) { take(record); };
  companion.scene = [this] { return change_->image_wanted(); };
  companion.changed = [this](const std::string& wrong) {
    if (!wrong.empty()) change_->refused(wrong);
  };
  // While force ramps out: the next hand begins open.
  companion.goes_over = [this](const std::string& image) {
    steering_.take_up(change_->accepted(image)->image.model());
  };
  companion.goes_on = [this] { return !stopping_.load(); };
  companion.joints = [this] { return steering_.told(mouse_); };
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

void StartedRun::begin(const RecordingHeader& header, const SceneChoice& first) {
  scene_ = std::make_shared<LiveScene>(first, header.image_path);
  change_ = std::make_unique<SceneChange>(first, header.image_path);
  steering_.take_up(scene_->image.model());
  begun_.store(true);
}

void StartedRun::take(const TickRecord& record) {
  const std::uint64_t offset = record.sequence - record.tick;
  if (scene_->track.size() > 0 && offset != offset_) {
    if (std::shared_ptr<LiveScene> next = change_->arrived()) {
      const std::lock_guard lock(mutex_);
      scene_ = std::move(next);
    }
  }
  offset_ = offset;
  scene_->track.append(record);
}

std::shared_ptr<const LiveScene> StartedRun::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
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
  const std::shared_ptr<const LiveScene> now = scene();
  if (now->track.full()) return "an hour is over: what comes now is not shown; close and start again";
  if (!goes_on()) {
    const std::size_t size = now->track.size();
    const std::uint32_t fault = size > 0 ? now->track.at(size - 1).fault : 0;
    return fault == 0 ? "the run is over" : "the run ended with a fault: " + bit_names(fault_bit_texts(), fault);
  }
  if (const SceneChange::News news = change_->news(); news.going_on()) return news.title + ": " + news.words;
  if (!mouse_ || !has_hand_) return "";
  const bool fresh = steering_.pulls() == 0;
  return fresh ? "Drag the tool with the mouse: it is the device" : "";
}

}  // namespace palpate
