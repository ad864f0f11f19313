// Instructions per tick and stage, counted by callgrind: the same on every run and every machine, whatever else it
// does.
#pragma once

#include <array>
#include <span>
#include <string>

#include "rt_core/model.h"
#include "rt_core/status.h"
#include "sim_host/press/pose_csv.h"

namespace palpate {

struct TickCount {
  bool counted = false;
  std::string why_not;
  std::int64_t worst = 0, mean = 0;  // of a tick, the first left out
  std::int32_t ticks = 0;
  std::array<std::int64_t, kStageCount> worst_stage{};  // of the worst tick
};

// Plays the poses by `palpate press` under valgrind, which must be installed. Never throws: the answer may be "no".
TickCount count_ticks(const std::string& image_path, std::span<const TimedPose> poses);
// Reads callgrind's combined file with one part per tick; the first tick, which searches the whole surface, is left
// out.
TickCount read_callgrind(const std::string& path);

}  // namespace palpate
