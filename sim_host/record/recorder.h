// Drains the telemetry ring on an ordinary thread: into a recording, if there is one, and into a listener (summary).
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include "sim_host/record/recording_writer.h"
#include "sim_host/rings/telemetry.h"

namespace palpate {

class Recorder {
 public:
  // `file` may be null. `listen` is called on the recorder's thread with every record received. All must outlive this.
  Recorder(const TelemetryRegion& region, RecordingWriter* file, std::function<void(const TickRecord&)> listen);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Asked when a record is the first of another scene (its tick counts anew): finishes the file and goes on with the
  // one it is given, null: none. `whole`: it is the scene's very first tick.
  using Turn = std::function<RecordingWriter*(std::uint64_t first, bool whole)>;
  void on_turn(Turn turn) { turn_ = std::move(turn); }
  // Drains on a thread of its own until stop(). Without it somebody else calls drain(): a run in virtual time, in which
  // the records of a chunk, and with them the file's bytes, must not depend on when a thread woke up.
  void start();
  // Takes what is in the ring.
  void drain();
  // Takes what is still in the ring, finishes the file and ends the thread. Call when the controller no longer writes,
  // or is not to be listened to any more.
  void stop();
  // After stop(): empty, or why the file is incomplete. Said on stderr as soon as it is known.
  const std::string& error() const { return error_; }
  std::uint64_t records() const { return records_; }
  std::uint64_t lost() const { return lost_; }

 private:
  void run();
  void finish();
  void finish_file();
  void turn_at(const TickRecord& record);
  template <typename Action>
  void on_file(Action action);

  TelemetryReader reader_;
  RecordingWriter* file_;
  std::function<void(const TickRecord&)> listen_;
  Turn turn_;
  std::uint64_t offset_ = 1;  // sequence minus tick: constant within a scene
  std::uint64_t expected_ = 1;
  std::uint64_t records_ = 0;
  std::uint64_t lost_ = 0;
  std::string error_;
  bool finished_ = false;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace palpate
