// The latency report and cyclictest's two formats. The golden texts follow the output of cyclictest 2.40 (rt-tests 2.4)
// with the same histogram, byte for byte but for the number of rows.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "sim_host/latency/latency.h"
#include "sim_host/record/recording_writer.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

MicrosecondHistogram example() {
  MicrosecondHistogram thread;
  for (const std::int64_t ns : {8'999, 9'000, 9'999, 12'001, 37'000, 2'000'000, 2'500'900}) add(thread, ns);
  return thread;
}

TEST(Cyclictest, TextHasItsRowsAndTotals) {
  const std::string text = cyclictest_text({example()});
  EXPECT_TRUE(text.starts_with("# Histogram\n000000 000000\n000001 000000\n"));
  EXPECT_NE(text.find("\n000008 000001\n000009 000002\n000010 000000\n"), std::string::npos);
  EXPECT_TRUE(
      text.ends_with("\n001999 000000\n# Total: 000000005\n# Min Latencies: 00008\n# Avg Latencies: 00653\n"
                     "# Max Latencies: 02500\n# Histogram Overflows: 00002\n"
                     "# Histogram Overflow at cycle number:\n# Thread 0: 00005 00006\n\n"))
      << text.substr(text.find("# Total"));
}

TEST(Cyclictest, SeveralThreadsAreColumns) {
  const std::string text = cyclictest_text({example(), MicrosecondHistogram{}});
  EXPECT_NE(text.find("\n000009 000002\t000000\n"), std::string::npos);
  EXPECT_NE(text.find("# Total: 000000005 000000000\n"), std::string::npos);
  EXPECT_NE(text.find("# Thread 0: 00005 00006\n# Thread 1:\n\n"), std::string::npos);
}

TEST(Cyclictest, OverflowListIsCut) {
  MicrosecondHistogram thread;
  for (int i = 0; i < 100; ++i) add(thread, 3'000'000);
  EXPECT_NE(cyclictest_text({thread}).find(" 00063 # 00036 others\n"), std::string::npos);
}

TEST(Cyclictest, JsonHasTheSameKeysAndTypes) {
  CyclictestRun run = this_system();
  run.command_line = "palpate latency";
  run.start_time = rfc2822_time(1'795'233'705);
  run.end_time = rfc2822_time(0);
  const nlohmann::json root = nlohmann::json::parse(cyclictest_json({example()}, run));
  EXPECT_EQ(root.at("file_version"), 1);
  EXPECT_EQ(root.at("cmdline:"), "palpate latency");
  EXPECT_TRUE(root.at("rt_test_version:").is_string());
  EXPECT_EQ(root.at("start_time"), "Sat, 21 Nov 2026 04:01:45 +0000");
  EXPECT_EQ(root.at("end_time"), "Thu, 01 Jan 1970 00:00:00 +0000");
  EXPECT_EQ(root.at("return_code"), 0);
  for (const char* key : {"sysname", "nodename", "release", "version", "machine"}) {
    EXPECT_TRUE(root.at("sysinfo").at(key).is_string());
  }
  EXPECT_TRUE(root.at("sysinfo").at("realtime").is_number_integer());
  EXPECT_EQ(root.at("num_threads"), 1);
  EXPECT_EQ(root.at("resolution_in_ns"), 0);
  const nlohmann::json& thread = root.at("thread").at("0");
  EXPECT_EQ(thread.at("histogram"), (nlohmann::json{{"8", 1}, {"9", 2}, {"12", 1}, {"37", 1}}));
  EXPECT_EQ(thread.at("cycles"), 7);
  EXPECT_EQ(thread.at("min"), 8);
  EXPECT_EQ(thread.at("max"), 2500);
  EXPECT_DOUBLE_EQ(thread.at("avg"), 653.57);
  EXPECT_TRUE(thread.contains("cpu") && thread.contains("node"));
}

TickRecord tick_record(std::uint64_t tick, std::int32_t wake_ns, std::int32_t compute_ns, std::uint32_t missed) {
  TickRecord record{};
  record.sequence = tick + 1;
  record.tick = tick;
  record.timing.deadline_ns = static_cast<std::int64_t>(tick) * 1'000'000;
  record.timing.wake_latency_ns = wake_ns;
  record.timing.compute_ns = compute_ns;
  record.input.overrun_ticks = missed;
  return record;
}

TEST(Latency, SaysWhereTheTimeWent) {
  auto data = std::make_unique<LatencyData>();
  for (std::uint64_t tick = 0; tick < 1000; ++tick) add(*data, tick_record(tick, 10'000, 20'000, 0));
  add(*data, tick_record(1000, 150'000, 20'000, 0));
  const std::string text = latency_text(*data);
  EXPECT_NE(text.find("GOOD: no deadline missed; the longest tick (wake-up included) used 17.0 % of the period"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Longest tick: number 1000, 170 µs, 150 µs of it waking up"), std::string::npos) << text;
  EXPECT_NE(text.find("66 % computing"), std::string::npos) << text;
}

TEST(Latency, SaysWhenItIsBadOrTight) {
  auto data = std::make_unique<LatencyData>();
  add(*data, tick_record(0, 10'000, 700'000, 0));
  EXPECT_NE(latency_text(*data).find("TIGHT"), std::string::npos);
  add(*data, tick_record(1, 10'000, 20'000, 3));
  EXPECT_NE(latency_text(*data).find("BAD: 3 deadlines missed in 2 ticks"), std::string::npos);
  EXPECT_NE(latency_text(*std::make_unique<LatencyData>()).find("No ticks"), std::string::npos);
}

TEST(Latency, ReadsARecording) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("palpate_latency_" + std::to_string(getpid()) + ".plr");
  {
    RecordingHeader header;
    header.period_ns = 1'000'000;
    const auto state = test::roomy_state();
    reset(*state);
    RecordingWriter writer(path.string(), header, *state);
    for (std::uint64_t tick = 0; tick < 50; ++tick) writer.add(tick_record(tick, 5'000, 9'000, 0));
    writer.add_lost(51, 2);
    writer.finish();
  }
  const LatencyData data = latency_of_recording(path.string());
  std::filesystem::remove(path);
  EXPECT_EQ(data.period_ns, 1'000'000);
  EXPECT_EQ(data.summary.ticks, 50u);
  EXPECT_EQ(data.summary.busy.max_ns, 14'000);
  EXPECT_EQ(data.wake.cycles, 50u);
  EXPECT_EQ(data.damage, "2 records are missing");
}

TEST(Latency, MeasuresThisMachine) {
  MeasureOptions options;
  options.duration_s = 0.05;
  options.priority = 0;
  std::string verdicts;
  const LatencyData data = measure_wake_up(options, verdicts);
  EXPECT_EQ(data.summary.ticks, 50u);
  EXPECT_EQ(data.summary.wake.total, 50u);
  EXPECT_GT(data.summary.wake.max_ns, 0);  // nothing wakes before its deadline
  EXPECT_FALSE(verdicts.empty());
  EXPECT_NE(latency_text(data).find("wake-up"), std::string::npos);
}

}  // namespace
}  // namespace palpate
