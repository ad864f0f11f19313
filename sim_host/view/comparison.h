// Two runs against one another: one time for both, and how far they are apart.
#pragma once

#include <array>

#include "sim_host/view/run_track.h"

namespace palpate {

// Where the common time is zero: both runs' own zero, or the first touch of each.
enum class Alignment { kTime, kTouch };

class Comparison {
 public:
  static constexpr std::size_t kRuns = 2;
  // Neither track is empty; both must outlive this. Their tick periods may differ. Throws std::runtime_error naming
  // the run (`names`) that has no first touch to be aligned by, and when they share no time.
  Comparison(const RunTrack& a, const RunTrack& b, Alignment alignment, const std::array<std::string, kRuns>& names);

  Alignment alignment() const { return alignment_; }
  const RunTrack& track(std::size_t run) const { return *track_[run]; }
  // The run's own time at which the common time is zero.
  double zero_s(std::size_t run) const { return zero_s_[run]; }
  // Of the common time: from the earlier beginning to the later end.
  double first_s() const { return first_s_; }
  double last_s() const { return last_s_; }
  bool is_there(std::size_t run, double common_s) const;
  // The tick shown of a run: its first or last where the common time is outside it.
  std::size_t index_at(std::size_t run, double common_s) const;
  // As RunTrack::columns over the common time; not-a-number where the run has no ticks.
  TrackColumns columns(std::size_t run, double from_s, double until_s, std::size_t number) const;

  // Over the time in which both render force, each holding its last tick; of the slower one's ticks.
  struct Difference {
    std::size_t ticks = 0;                              // none: nothing else is known
    double rms_N = 0, largest_N = 0, largest_at_s = 0;  // of the force vectors on the tool
    double rms_mm = 0, largest_mm = 0;                  // of the depth
    double strongest_at_s = 0;                          // where the weaker of both forces is largest
  };
  const Difference& difference() const { return difference_; }

 private:
  void measure(double from_s, double until_s);

  std::array<const RunTrack*, kRuns> track_;
  Alignment alignment_;
  std::array<double, kRuns> zero_s_{}, begin_s_{}, end_s_{};  // begin and end: common time
  double first_s_ = 0, last_s_ = 0;
  Difference difference_;
};

// Whether one camera and one scale show both: throws std::runtime_error when one body is more than ten times as large
// as the other, and its touch would be a dot.
void check_sizes(const Model& a, const Model& b, const std::array<std::string, 2>& names);

}  // namespace palpate
