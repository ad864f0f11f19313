// The dearest tick of a scene: looked for by somebody who means the tool to take as long as it can, along the scene's
// own path, and by climbing from the dearest found, over poses, joints and what went before. By the work that a tick
// counts of itself and its prices (rt_core/work.h), which no counted tick exceeded: the same figures everywhere.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "sim_host/tick_memory.h"

namespace palpate {

struct TickSearchOptions {
  std::int64_t ticks = 200'000;  // in all; half of them climb
  std::uint64_t seed = 1;
  std::function<void(double share)> progress;
};

struct DearTick {
  double instructions = 0;
  StatePtr before;  // state and input that make it
  Input input;
};

struct TickSearch {
  std::array<double, kStageCount> stage{};  // the dearest of each, not of one tick
  DearTick dearest;
  const char* found_by = "";
  std::int64_t ticks = 0;
  std::int64_t beyond_stated = 0;  // ticks of which a stage took more than the image states
};

// `path`: the inputs of the scene's own path; may be empty.
TickSearch search_ticks(const Model& model, std::span<const Input> path, const TickSearchOptions& options);

}  // namespace palpate
