// Following a recording while it is written, and the table shown meanwhile.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "sim_host/latency/live_table.h"
#include "sim_host/record/recording_follower.h"
#include "sim_host/record/recording_writer.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

TickRecord tick_of(std::uint64_t number) {
  TickRecord record{};
  record.sequence = number;
  record.tick = number - 1;
  record.timing.wake_latency_ns = 7'000;
  record.timing.compute_ns = 12'000;
  return record;
}

class Live : public testing::Test {
 protected:
  Live() {
    path_ = (std::filesystem::temp_directory_path() / ("palpate_live_" + std::to_string(getpid()) + ".plr")).string();
    state_ = test::roomy_state();
    reset(*state_);
    writer_ = std::make_unique<RecordingWriter>(path_, RecordingHeader{}, *state_);
  }
  ~Live() override {
    writer_.reset();
    std::filesystem::remove(path_);
    std::filesystem::remove(path_ + kPartSuffix);
  }
  void write(std::uint64_t ticks) {
    for (std::uint64_t i = 0; i < ticks; ++i) writer_->add(tick_of(++written_));
    writer_->flush();
  }
  std::string path_;
  StatePtr state_;
  std::unique_ptr<RecordingWriter> writer_;
  std::uint64_t written_ = 0;
};

TEST_F(Live, EveryTickArrivesOnceAndInOrder) {
  RecordingFollower follower(path_);
  std::uint64_t expected = 1;
  const auto listen = [&](const TickRecord& record) { EXPECT_EQ(record.sequence, expected++); };
  EXPECT_EQ(follower.read(listen), 0u);
  for (const std::uint64_t ticks : {1u, 20u, 0u, 600u, 3u}) {
    write(ticks);
    EXPECT_EQ(follower.read(listen), ticks);
    EXPECT_FALSE(follower.ended());
  }
  writer_->finish();
  EXPECT_EQ(follower.read(listen), 0u);
  EXPECT_TRUE(follower.ended());
  EXPECT_EQ(expected, 625u);
}

TEST_F(Live, AHalfWrittenChunkIsWaitedFor) {
  write(50);
  const std::string part = path_ + kPartSuffix;
  const auto size = std::filesystem::file_size(part);
  std::ifstream whole(part, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  const std::string copy = path_ + ".copy";
  long put_bytes = 0;
  const auto put = [&](long number) {
    std::ofstream(copy, std::ios::binary | std::ios::app).write(bytes.data() + put_bytes, number - put_bytes);
    put_bytes = number;
  };
  put(static_cast<long>(size) - 100);
  RecordingFollower follower(copy);
  std::uint64_t seen = 0;
  const auto listen = [&](const TickRecord&) { seen += 1; };
  EXPECT_EQ(follower.read(listen), 0u);
  put(static_cast<long>(size));
  EXPECT_EQ(follower.read(listen), 50u);
  std::filesystem::remove(copy);
}

TEST_F(Live, DamageIsNotWaitedFor) {
  write(50);
  std::fstream file(path_ + kPartSuffix, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(-10, std::ios::end);
  file.put('\x55');
  file.close();
  RecordingFollower follower(path_);
  EXPECT_THROW(follower.read([](const TickRecord&) {}), RecordingError);
}

TEST_F(Live, AMissingFileIsNamed) { EXPECT_THROW(RecordingFollower("/nonexistent.plr"), RecordingError); }

TEST(LiveTable, ShowsTheLastSecondBesideTheWholeRun) {
  const auto all = std::make_unique<RunSummary>(), recent = std::make_unique<RunSummary>();
  for (std::uint64_t i = 1; i <= 1000; ++i) add(*all, tick_of(i));
  TickRecord late = tick_of(1001);
  late.timing.wake_latency_ns = 250'000;
  add(*all, late);
  add(*recent, tick_of(1002));
  const std::string text = live_text({all.get(), recent.get(), 75, 3700});
  EXPECT_NE(text.find("1001 ticks in 1m 15s, 1h 00m 25s left"), std::string::npos) << text;
  EXPECT_NE(text.find("wake-up latency        7.0       7.0"), std::string::npos) << text;
  EXPECT_NE(text.find("250.0        1000\n"), std::string::npos) << text;
  EXPECT_NE(text.find("whole tick"), std::string::npos);
}

TEST(LiveTable, DurationsReadWell) {
  EXPECT_EQ(duration_text(7.2), "7s");
  EXPECT_EQ(duration_text(65), "1m 05s");
  EXPECT_EQ(duration_text(-3), "0s");
  EXPECT_EQ(duration_text(7384), "2h 03m 04s");
}

}  // namespace
}  // namespace palpate
