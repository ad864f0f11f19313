// A run that goes on while somebody looks at it: started here with a simulated or a real device, or somebody else's
// that is only watched.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "sim_host/bake/image_file.h"
#include "sim_host/run/run_session.h"
#include "sim_host/view/run_track.h"
#include "sim_host/view/steering.h"

namespace palpate {

class LiveRun {
 public:
  virtual ~LiveRun() = default;
  virtual const Model& model() const = 0;
  virtual const RunTrack& track() const = 0;
  // Before the track's first tick, as far as it is known.
  virtual const State& initial() const = 0;
  virtual bool goes_on() const = 0;
  // What a person who looks must know, or "".
  virtual std::string notice() const = 0;
  virtual Steering* steering() { return nullptr; }
};

// Starts the controller, and the simulated device where none is named, as `palpate run` does.
class StartedRun : public LiveRun {
 public:
  // `mouse`: the simulated hand rests where its motion begins until it is pulled, and fingers stay open until they are
  // closed; otherwise it makes the scene's motion until then. Returns when the controller is there. Throws what
  // run_session throws.
  StartedRun(RunOptions options, bool mouse);
  // Ends the run in order: force ramps to zero first.
  ~StartedRun() override;
  const Model& model() const override { return image_->model(); }
  const RunTrack& track() const override { return *track_; }
  const State& initial() const override { return *initial_; }
  bool goes_on() const override { return !ended_.load(); }
  std::string notice() const override;
  Steering* steering() override { return has_hand_ ? &steering_ : nullptr; }
  // Asks it to end; result() waits for that.
  void stop() { stopping_.store(true); }
  const RunResult& result();

 private:
  void run(RunOptions options);
  void begin(const RecordingHeader& header);

  Steering steering_;
  bool mouse_, has_hand_;
  std::unique_ptr<ImageFile> image_;
  std::unique_ptr<RunTrack> track_;
  StatePtr initial_;
  std::atomic<bool> begun_{false}, ended_{false}, stopping_{false};
  std::exception_ptr error_;  // of run_session; read after ended_
  RunResult result_;
  std::thread thread_;
};

// Follows a run of another process by its telemetry (the process id of a palpate-rt) or by the recording it is writing.
// Costs the controller nothing: it never reads what a watcher writes.
std::unique_ptr<LiveRun> attach_to(const std::string& process_or_recording);

}  // namespace palpate
