// A run as a viewer keeps it: what each tick was given and gave, what happened when, and the State after any tick,
// which is computed again from the inputs.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/record.h"
#include "sim_host/latency/histogram.h"
#include "sim_host/tick_memory.h"

namespace palpate {

// One tick for plots, timeline and panels.
struct TrackTick {
  std::uint64_t tick = 0;
  Input input;
  Vec3 contact_N, device_N;  // of the body on the tool; what the hand feels
  double depth_m = 0, energy_J = 0, surplus_J = 0;
  double given_J = 0;  // by the hands to the devices since the track's first tick: what they pushed against, on its way
  std::uint32_t status = 0, fault = 0;
  Mode mode = Mode::kIdle;
  std::int32_t regions = 0;
  double largest_region_N = 0;  // two regions may press against one another
  std::int32_t wake_ns = 0, compute_ns = 0;
  std::int32_t stage_ns[kStageCount] = {};
};
TrackTick track_tick(const TickRecord& record);

struct TrackEvent {
  enum class Kind { kTouch, kLetGo, kMode, kWarning, kFault, kGap };
  Kind kind = Kind::kTouch;
  std::size_t index = 0;  // of the tick at which it happened
  std::string text;
};

// A plot's pixel columns: least and largest of the ticks in each, so that no peak is lost. Empty columns repeat the one
// before.
struct TrackColumns {
  struct Range {
    float low = 0, high = 0;
  };
  std::vector<Range> contact_N, felt_N, depth_mm, stored_mJ, given_mJ, surplus_mJ;
  std::vector<Range> compute_us, stage_us[kStageCount];
  std::vector<std::int32_t> regions;  // most
  template <class Visitor>
  void each(Visitor visit) {
    for (std::vector<Range>* line : {&contact_N, &felt_N, &depth_mm, &stored_mJ, &given_mJ, &surplus_mJ, &compute_us})
      visit(*line);
    for (std::vector<Range>& line : stage_us) visit(line);
  }
};

struct TrackTiming {
  Histogram compute, stage[kStageCount];
};

// Status bits worth a mark: those of which the text says what to do.
std::uint32_t telling_status(std::uint32_t status);

// Grows while a run goes on; safe to be read and appended to from several threads.
class RunTrack {
 public:
  explicit RunTrack(double period_s) : period_s_(period_s) {}
  // An hour at 1 kHz, 1.4 GB: what comes after that is dropped, and full() says so.
  static constexpr std::size_t kMostTicks = 3'600'000;
  // Ticks come in order; a gap in the sequence is marked.
  void append(const TickRecord& record);
  bool full() const { return size() >= kMostTicks; }

  double period_s() const { return period_s_; }
  std::size_t size() const;
  TrackTick at(std::size_t index) const;
  // Of run time, of a tick that is there or not; the first tick there is may not be the run's first.
  double time_s(std::size_t index) const;
  // The tick shown at a time: the last that is not later; the first, the last there is, when the time is outside.
  std::size_t index_at(double time_s) const;
  // Up to `most` inputs from `first` on, for who computes states.
  std::vector<Input> inputs(std::size_t first, std::size_t most) const;
  // Of the ticks between two times, in `number` columns.
  TrackColumns columns(double from_s, double until_s, std::size_t number) const;
  // Over all ticks so far. In virtual time no tick takes any.
  TrackTiming timing() const;
  std::vector<TrackEvent> events() const;
  std::size_t event_count() const;
  // Over all ticks so far: while force was rendered, the largest of one region, and the tick with the largest on the
  // tool.
  double largest_region_N() const;
  std::size_t strongest() const;
  // Ticks that were lost: the states after the first of them are near the true ones, not the same.
  std::uint64_t lost() const;

 private:
  void note(TrackEvent::Kind kind, std::string text);
  double work_of_hands(const TickRecord& record);
  void find_events(const TrackTick& tick);
  void find_fades(const TrackTick& tick, const TrackTick& before);

  double period_s_;
  mutable std::mutex mutex_;
  std::vector<TrackTick> ticks_;
  std::vector<TrackEvent> events_;
  std::uint64_t next_sequence_ = 0, lost_ = 0;
  TrackTiming timing_;
  Pose handle_w_[2];  // of the last tick
  Wrench felt_w_[2];
  double given_J_ = 0;
  double largest_region_N_ = 0, strongest_N_ = -1;
  std::size_t strongest_ = 0, last_touching_ = 0;
  std::size_t last_fading_ = 0;
  bool touching_ = false, fading_ = false;
  std::uint32_t warned_ = 0;
};

// States of a track. Checkpoints on the way make going back cheap: at most kBetweenCheckpoints ticks are run again.
class TrackStates {
 public:
  static constexpr std::size_t kBetweenCheckpoints = 250;
  // Further apart where states are large, so that all checkpoints together stay below this.
  static constexpr std::size_t kMostCheckpointBytes = 512u << 20;

  // `initial`: before the track's first tick. All must outlive this.
  TrackStates(const Model& model, const RunTrack& track, StatePtr initial);
  // The state after the tick `index`, or the last one there is. Runs at most `budget` ticks and then returns what it
  // has reached: reached() says which; ask again to go on.
  const State& go_to(std::size_t index, std::size_t budget);
  std::size_t reached() const { return next_ - 1; }  // after go_to, when the track is not empty

 private:
  void keep_checkpoint();

  const Model& model_;
  const RunTrack& track_;
  StatePtr state_;
  ScratchPtr scratch_;
  Output output_;
  std::size_t next_ = 0;  // tick that the state stands before
  std::size_t spacing_ = kBetweenCheckpoints;
  std::map<std::size_t, StatePtr> checkpoints_;  // by the tick they stand before
};

}  // namespace palpate
