// The time below the scene: play, scrub, what happened when.
#pragma once

#include <imgui.h>

#include <span>

#include "sim_host/view/player.h"
#include "sim_host/view/run_track.h"

namespace palpate {

struct TimelineRun {
  const RunTrack* track;
  double zero_s = 0;  // of the run's own time, where the timeline has its zero
};

// Of the timeline's time.
struct TimelineSpan {
  double first_s = 0, last_s = 0;
  bool is_live = false;  // a run goes on
};

// Events of the first run stand above the bar, those of a second one below it.
void timeline(ImVec2 low, ImVec2 size, std::span<const TimelineRun> runs, const TimelineSpan& span, Player& player);

}  // namespace palpate
