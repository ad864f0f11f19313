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
#include "sim_host/view/scene_change.h"
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
  // The scene it is in now. What model(), track() and initial() return is of it, and goes when the run goes over to
  // another and nobody holds it.
  std::shared_ptr<const LiveScene> scene() const;
  const Model& model() const override { return scene()->image.model(); }
  const RunTrack& track() const override { return scene()->track; }
  const State& initial() const override { return *scene()->initial; }
  // Asks it to go over to another.
  SceneChange& change() { return *change_; }
  bool goes_on() const override { return !ended_.load(); }
  std::string notice() const override;
  Steering* steering() override { return has_hand_ ? &steering_ : nullptr; }
  // Asks it to end; result() waits for that.
  void stop() { stopping_.store(true); }
  const RunResult& result();

 private:
  void run(RunOptions options);
  void begin(const RecordingHeader& header, const SceneChoice& first);
  void take(const TickRecord& record);

  Steering steering_;
  bool mouse_, has_hand_;
  std::unique_ptr<SceneChange> change_;
  mutable std::mutex mutex_;  // of the scene
  std::shared_ptr<LiveScene> scene_;
  std::uint64_t offset_ = 0;  // of a record's sequence number and its tick: constant in a scene
  std::atomic<bool> begun_{false}, ended_{false}, stopping_{false};
  std::exception_ptr error_;  // of run_session; read after ended_
  RunResult result_;
  std::thread thread_;
};

// Follows a run of another process by its telemetry (the process id of a palpate-rt) or by the recording it is writing.
// Costs the controller nothing: it never reads what a watcher writes.
std::unique_ptr<LiveRun> attach_to(const std::string& process_or_recording);

}  // namespace palpate
