// Which of many ticks are worth counting: callgrind takes a hundred times longer to write a tick down than to play it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "rt_core/stage_cost.h"

namespace palpate::test {

// Of each stage and of all: a thousand ticks or less. Against all 8,000 of the scripted hand, which take 10 to 12 s for
// 2 to 4: of six scenes the worst tick is the same in five and 198,634 instructions for 199,044 in a grasp by five
// fingers, and the most of a stage is at most 2 % less; three times as many find no dearer one (2026-11-26). ./run test
// --long counts all.
inline constexpr std::size_t kDearest = 100;
// Some between, whatever they cost.
inline bool is_sampled(int tick) { return tick % 40 == 0; }

// What ticks cost by the work they counted of themselves, stage by stage and, last, in all.
class TickPrices {
 public:
  void add(const Work& work) {
    std::array<double, kStageCount + 1> price;
    for (int i = 0; i < kStageCount; ++i)
      price[static_cast<std::size_t>(i)] = counted_instructions(work, static_cast<Stage>(i));
    price[kStageCount] = counted_instructions(work);
    prices_.push_back(price);
  }

  // Adds to `chosen`, which has an entry a tick, the `count` dearest of each stage and of all together.
  void choose_dearest(std::size_t count, std::vector<bool>& chosen) const {
    std::vector<std::size_t> order(prices_.size());
    for (std::size_t i = 0; i <= kStageCount; ++i) {
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return prices_[a][i] > prices_[b][i]; });
      for (std::size_t k = 0; k < std::min(count, order.size()); ++k) chosen[order[k]] = true;
    }
  }

 private:
  std::vector<std::array<double, kStageCount + 1>> prices_;
};

}  // namespace palpate::test
