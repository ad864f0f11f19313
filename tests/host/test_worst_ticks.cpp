// The list of worst ticks against sorting everything, and what it prints.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "sim_host/latency/worst_ticks.h"

namespace palpate {
namespace {

TickRecord tick_of(std::uint64_t number, std::int32_t wake_ns, std::int32_t compute_ns) {
  TickRecord record{};
  record.tick = number;
  record.timing.wake_latency_ns = wake_ns;
  record.timing.compute_ns = compute_ns;
  record.timing.stage_ns[static_cast<int>(Stage::kSolve)] = compute_ns / 2;
  return record;
}

TEST(WorstTicks, KeepsTheSameAsSortingEverything) {
  std::mt19937 random(7);
  for (const std::size_t number : {0u, 1u, 5u, 16u, 17u, 500u}) {
    auto worst = std::make_unique<WorstTicks>();
    std::vector<TickRecord> all;
    for (std::size_t i = 0; i < number; ++i) {
      all.push_back(tick_of(i, static_cast<std::int32_t>(random() % 50), static_cast<std::int32_t>(random() % 50)));
      add(*worst, all.back());
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const TickRecord& a, const TickRecord& b) { return busy_ns(a.timing) > busy_ns(b.timing); });
    ASSERT_EQ(static_cast<std::size_t>(worst->count), std::min<std::size_t>(number, kWorstTicksKept));
    for (std::int32_t i = 0; i < worst->count; ++i) {
      EXPECT_EQ(worst->record[i].tick, all[static_cast<std::size_t>(i)].tick) << number << " " << i;
    }
  }
}

TEST(WorstTicks, TableHasTheParts) {
  WorstTicks worst;
  EXPECT_EQ(worst_ticks_text(worst, 3), "");
  add(worst, tick_of(12, 100'000, 40'000));
  add(worst, tick_of(13, 10'000, 30'000));
  const std::string text = worst_ticks_text(worst, 1);
  EXPECT_NE(text.find("12     140.0     100.0       0.0      40.0"), std::string::npos) << text;
  EXPECT_NE(text.find("solve 20.0"), std::string::npos) << text;
  EXPECT_EQ(text.find(" 13 "), std::string::npos) << text;
  EXPECT_EQ(worst_ticks_text(worst, 0), "");
}

}  // namespace
}  // namespace palpate
