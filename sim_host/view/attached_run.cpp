// Watching a run of another process.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/part_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_follower.h"
#include "sim_host/rings/telemetry_door.h"
#include "sim_host/view/live_run.h"

namespace palpate {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{10};

// A thread that takes what is new until it is told to end or there is nothing more to come.
class Watcher : public LiveRun {
 public:
  ~Watcher() override { end(); }
  const RunTrack& track() const override { return *track_; }
  const State& initial() const override { return *initial_; }
  bool goes_on() const override { return !over_.load(); }
  std::string notice() const override {
    if (track_->full()) return "an hour is over: what comes now is not shown; close and attach again";
    return over_.load() ? "the run is over" : remark_;
  }

 protected:
  // False: nothing more will come.
  virtual bool take() = 0;
  void begin(const Model& model, std::int64_t period_ns) {
    track_ = std::make_unique<RunTrack>(1e-9 * static_cast<double>(period_ns));
    if (!initial_) initial_ = make_state(model);
  }
  void start() {
    thread_ = std::thread([this] {
      while (!ending_.load() && take()) std::this_thread::sleep_for(kLook);
      over_.store(true);
    });
  }
  void end() {
    ending_.store(true);
    if (thread_.joinable()) thread_.join();
  }
  std::unique_ptr<RunTrack> track_;
  StatePtr initial_;
  std::string remark_;

 private:
  std::atomic<bool> ending_{false}, over_{false};
  std::thread thread_;
};

// The telemetry of a controller, whose sealed memory any process of the same user may map read-only.
class WatchedRing : public Watcher {
 public:
  explicit WatchedRing(const std::string& where) : telemetry_(attach_telemetry(where)) {
    const RecordingHeader header = recording_header(telemetry_.region());
    image_ = std::make_unique<ImageFile>(header.image_path);
    if (image_->model().scene_hash != header.scene_hash)
      throw std::runtime_error(std::string(header.image_path) + ": has changed since the controller read it");
    begin(image_->model(), header.period_ns);
    reader_ = std::make_unique<TelemetryReader>(telemetry_.region());
    remark_ = "attached: what was before is not known, the shape is near the run's";
    start();
  }
  ~WatchedRing() override { end(); }
  const Model& model() const override { return image_->model(); }

 private:
  bool take() override {
    TickRecord record;
    if (newest_scene(telemetry_.region()) != scene_) return false;  // it went over to another: attach again
    const std::uint64_t first = scene_ != nullptr ? scene_->first_sequence.load() : 1;
    while (reader_->next(record))
      if (record.sequence >= first) track_->append(record);
    return std::filesystem::exists("/proc/" + std::to_string(telemetry_.controller));
  }

  AttachedTelemetry telemetry_;
  const TelemetryScene* scene_ = newest_scene(telemetry_.region());
  std::unique_ptr<ImageFile> image_;
  std::unique_ptr<TelemetryReader> reader_;
};

class WatchedRecording : public Watcher {
 public:
  explicit WatchedRecording(const std::string& path) : follower_(path) {
    const std::string part = path + kPartSuffix;
    const MappedFile file(std::filesystem::exists(part) ? part : path);
    const RecordingReader reader(file.bytes());
    scene_ = std::make_unique<RecordedScene>(reader, "");
    if (reader.state_known()) initial_ = reader.initial_state(scene_->model());
    begin(scene_->model(), follower_.header().period_ns);
    start();
  }
  ~WatchedRecording() override { end(); }
  const Model& model() const override { return scene_->model(); }

 private:
  bool take() override {
    try {
      follower_.read([this](const TickRecord& record) { track_->append(record); });
    } catch (const RecordingError&) {
      return false;  // damaged: what was read before stays
    }
    return !follower_.ended();
  }

  RecordingFollower follower_;
  std::unique_ptr<RecordedScene> scene_;
};

}  // namespace

std::unique_ptr<LiveRun> attach_to(const std::string& where) {
  const bool number = std::ranges::all_of(where, [](unsigned char c) { return std::isdigit(c) != 0; });
  std::error_code none;
  if ((number && !where.empty()) || std::filesystem::is_socket(where, none))
    return std::make_unique<WatchedRing>(where);
  return std::make_unique<WatchedRecording>(where);
}

}  // namespace palpate
