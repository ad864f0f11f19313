// One run of a scene with the project's simulated hand: what every tick was given, where each piece of the tool stood
// then, and how long the tick took. The peers get the same body and the same poses.
#pragma once

#include <string>
#include <vector>

#include "rt_core/io.h"
#include "rt_core/model.h"

namespace palpate::peers {

struct TrackTick {
  std::vector<Pose> piece_w;  // of every piece
  int contacts = 0;           // of ours: the peers' figures are told for the ticks in which we touch, too
  double tick_us = 1e300;     // the least of the passes
};

struct Track {
  double period_s = 0;
  std::vector<TrackTick> tick;
};

// Passes: the run is bit for bit the same each time; the least time of each tick is kept, so that what the machine does
// besides is not told as ours. Throws what loading a scene throws.
Track play(const Model& model, int passes);

}  // namespace palpate::peers
