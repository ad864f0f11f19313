// The telemetry ring and the command mailbox: order, loss, torn copies, hostile contents. The two-thread tests aim at
// a reader that copies while the writer overwrites; they cannot prove that no interleaving fails, which is what the
// argument in telemetry.h is for. They are run under ThreadSanitizer as well.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <thread>

#include "sim_host/rings/mailbox.h"
#include "sim_host/rings/telemetry.h"

namespace palpate {
namespace {

// Zeroed like a fresh memfd.
template <typename T>
struct Zeroed {
  Zeroed() : bytes(new (std::align_val_t{64}) unsigned char[sizeof(T)]()) {}
  ~Zeroed() { ::operator delete[](bytes, std::align_val_t{64}); }
  Zeroed(const Zeroed&) = delete;
  Zeroed& operator=(const Zeroed&) = delete;
  T& operator*() { return *reinterpret_cast<T*>(bytes); }
  T* operator->() { return &**this; }
  unsigned char* bytes;
};
using Telemetry = Zeroed<TelemetryRegion>;

void open_writer(TelemetryWriter& writer, TelemetryRegion& region) {
  Model model;
  model.scene_hash = 0x1234;
  model.name = "ring";
  writer.open(region, model, 1'000'000, "build", "ring.pal");
}

// Every word of the record carries the sequence number, so that a mixture of two records shows.
void fill(TickRecord& record, std::uint64_t number) {
  for (std::size_t i = 0; i < kRecordWords; ++i) std::memcpy(reinterpret_cast<char*>(&record) + 8 * i, &number, 8);
}
bool whole(const TickRecord& record) {
  for (std::size_t i = 0; i < kRecordWords; ++i) {
    std::uint64_t word;
    std::memcpy(&word, reinterpret_cast<const char*>(&record) + 8 * i, 8);
    if (word != record.sequence) return false;
  }
  return true;
}

TEST(Ring, DeliversEveryRecordInOrder) {
  Telemetry region;
  TelemetryWriter writer;
  open_writer(writer, *region);
  ASSERT_EQ(check_telemetry(*region), nullptr);
  EXPECT_STREQ(region->header.scene_name, "ring");
  TelemetryReader reader(*region);
  TickRecord record{}, got{};
  EXPECT_FALSE(reader.next(got));
  EXPECT_FALSE(reader.newest(got));
  for (std::uint64_t i = 1; i <= 3 * kTelemetryCapacity; ++i) {
    fill(record, i);
    writer.write(record);
    ASSERT_TRUE(reader.newest(got));
    ASSERT_EQ(got.sequence, i);
    ASSERT_TRUE(reader.next(got));
    ASSERT_EQ(got.sequence, i);
    ASSERT_TRUE(whole(got));
    ASSERT_FALSE(reader.next(got));
  }
  EXPECT_EQ(reader.lost(), 0u);
}

TEST(Ring, SlowReaderLosesOnlyItsOwnRecordsAndKnowsHowMany) {
  Telemetry region;
  TelemetryWriter writer;
  open_writer(writer, *region);
  TelemetryReader slow(*region), quick(*region);
  TickRecord record{}, got{};
  const std::uint64_t written = 3 * kTelemetryCapacity + 17;
  std::uint64_t quick_count = 0;
  for (std::uint64_t i = 1; i <= written; ++i) {
    fill(record, i);
    writer.write(record);
    quick_count += quick.next(got) ? 1U : 0U;
  }
  std::uint64_t slow_count = 0, last = 0;
  while (slow.next(got)) {
    ASSERT_GT(got.sequence, last);
    ASSERT_TRUE(whole(got));
    last = got.sequence;
    ++slow_count;
  }
  EXPECT_EQ(last, written);
  EXPECT_EQ(slow_count + slow.lost(), written);
  EXPECT_GT(slow_count, kTelemetryCapacity / 2);
  EXPECT_EQ(quick_count, written);
  EXPECT_EQ(quick.lost(), 0u);
}

TEST(Ring, TwoThreadsNeverSeeATornRecord) {
  Telemetry region;
  TelemetryWriter writer;
  open_writer(writer, *region);
  // Enough to lap the ring several times and keep the test below a second, also under ThreadSanitizer.
  constexpr std::uint64_t kWritten = 6 * kTelemetryCapacity;
  std::atomic<bool> done{false};
  std::thread producer([&] {
    TickRecord record{};
    for (std::uint64_t i = 1; i <= kWritten; ++i) {
      fill(record, i);
      writer.write(record);
    }
    done.store(true);
  });
  TelemetryReader reader(*region);
  TickRecord record{};
  std::uint64_t received = 0, torn = 0, snapshots_torn = 0, last = 0;
  const auto take_all = [&] {
    while (reader.next(record)) {
      torn += whole(record) && record.sequence > last ? 0U : 1U;
      last = record.sequence;
      ++received;
    }
    if (reader.newest(record)) snapshots_torn += whole(record) ? 0U : 1U;
  };
  while (!done.load()) take_all();
  producer.join();
  while (last < kWritten) take_all();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(snapshots_torn, 0u);
  EXPECT_EQ(received + reader.lost(), kWritten);
}

TEST(Ring, HeaderOfAnotherBuildIsNamed) {
  Telemetry region;
  TelemetryWriter writer;
  EXPECT_STREQ(check_telemetry(*region), "magic");
  open_writer(writer, *region);
  region->header.version += 1;
  EXPECT_STREQ(check_telemetry(*region), "version");
  open_writer(writer, *region);
  region->header.layout_hash ^= 1;
  EXPECT_STREQ(check_telemetry(*region), "layout hash");
  open_writer(writer, *region);
  region->header.record_words -= 1;
  EXPECT_STREQ(check_telemetry(*region), "record size");
  open_writer(writer, *region);
  region->header.capacity *= 2;
  EXPECT_STREQ(check_telemetry(*region), "capacity");
  open_writer(writer, *region);
  region->header.total_bytes -= 1;
  EXPECT_STREQ(check_telemetry(*region), "total size");
}

TEST(Ring, LongTextsAreCutAndTerminated) {
  Telemetry region;
  TelemetryWriter writer;
  Model model;
  const std::string name(1000, 'n'), path(5000, 'p');
  model.name = name.c_str();
  writer.open(*region, model, 1, path.c_str(), path.c_str());
  EXPECT_EQ(std::strlen(region->header.scene_name), static_cast<std::size_t>(kNameBytes - 1));
  EXPECT_EQ(std::strlen(region->header.build_id), kBuildIdBytes - 1);
  EXPECT_EQ(std::strlen(region->header.image_path), kImagePathBytes - 1);
}

TEST(Ring, HostileContentsNeverCrashOrTrapTheReader) {
  Telemetry region;
  std::mt19937_64 random(20261121);
  const std::uint64_t nasty[] = {0, 1, 2, kTelemetryCapacity, ~0ull, ~0ull - 1, 1ull << 63, 5000};
  auto* words = reinterpret_cast<std::uint64_t*>(region.bytes);
  TelemetryReader reader(*region);
  TickRecord record{};
  for (int round = 0; round < 200; ++round) {
    for (int k = 0; k < 5000; ++k) words[random() % (sizeof(TelemetryRegion) / 8)] = random();
    for (auto& slot : region->slot) slot.sequence.store(nasty[random() % 8] + random() % 3);
    region->newest.store(nasty[random() % 8]);
    region->snapshot_version.store(nasty[random() % 8]);
    for (int i = 0; i < 50; ++i) {  // each call is bounded: the test ends
      reader.next(record);
      reader.newest(record);
    }
  }
  TelemetryReader fresh(*region);  // the counter runs backwards: nothing is believed
  region->newest.store(0);
  EXPECT_FALSE(fresh.next(record));
}

TEST(Mailbox, DeliversTheNewestCommand) {
  Zeroed<MailboxRegion> region;
  MailboxReader reader(*region);
  HostCommand command;
  EXPECT_EQ(reader.poll(command), MailboxResult::kBusy);  // nothing written yet
  MailboxWriter writer(*region);
  ASSERT_EQ(check_mailbox(*region), nullptr);
  EXPECT_EQ(reader.poll(command), MailboxResult::kBusy);
  writer.set(Command::kArm, false);
  writer.set(Command::kStop, true);
  writer.beat();
  ASSERT_EQ(reader.poll(command), MailboxResult::kAccepted);
  EXPECT_EQ(command.commands, Command::kStop);
  EXPECT_EQ(command.quit, 1u);
  EXPECT_EQ(command.generation, 2u);
  EXPECT_EQ(command.heartbeat, 1u);
  EXPECT_EQ(reader.poll(command), MailboxResult::kAccepted);  // level, not event: read again
}

TEST(Mailbox, WriterThatDiedInTheMiddleKeepsTheLastCommand) {
  Zeroed<MailboxRegion> region;
  MailboxReader reader(*region);
  MailboxWriter writer(*region);
  HostCommand command;
  writer.set(Command::kArm, false);
  ASSERT_EQ(reader.poll(command), MailboxResult::kAccepted);
  region->sequence.store(region->sequence.load() + 1);  // odd for ever
  region->word[1].store(~0ull);
  EXPECT_EQ(reader.poll(command), MailboxResult::kBusy);
  EXPECT_EQ(command.commands, Command::kArm);
}

TEST(Mailbox, InvalidContentsAreRefused) {
  const auto result_of = [](auto spoil) {
    Zeroed<MailboxRegion> region;
    MailboxReader reader(*region);
    MailboxWriter writer(*region);
    HostCommand command;
    writer.set(Command::kArm, false);
    writer.set(Command::kStop, false);
    EXPECT_EQ(reader.poll(command), MailboxResult::kAccepted);
    HostCommand bad = command;
    spoil(bad);
    std::uint64_t words[kCommandWords];
    std::memcpy(words, &bad, sizeof(bad));
    for (std::size_t i = 0; i < kCommandWords; ++i) region->word[i].store(words[i]);
    const MailboxResult result = reader.poll(command);
    EXPECT_EQ(command.commands, Command::kStop) << "a refused command must not leak";
    return result;
  };
  EXPECT_EQ(result_of([](HostCommand&) {}), MailboxResult::kAccepted);
  EXPECT_EQ(result_of([](HostCommand& c) { c.commands |= 1u << 7; }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.quit = 2; }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.live = {0.5f, 0, 0.05f, 1}; }), MailboxResult::kAccepted);
  EXPECT_EQ(result_of([](HostCommand& c) { c.live.force_limit = 1.01f; }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.live.stiffness = std::numeric_limits<float>::quiet_NaN(); }),
            MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.generation -= 1; }), MailboxResult::kInvalid);
  // Joint commands: fractions, finite positions, known joints.
  EXPECT_EQ(result_of([](HostCommand& c) { c.joints.closing[4] = 1; }), MailboxResult::kAccepted);
  EXPECT_EQ(result_of([](HostCommand& c) { c.joints.closing[4] = 1.001f; }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.joints.closing[0] = std::nanf(""); }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.joints.target[20] = -10.5f; }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.joints.target[0] = std::nanf(""); }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.joints.direct = 1u << kMaxJoints; }), MailboxResult::kInvalid);
  EXPECT_EQ(result_of([](HostCommand& c) { c.joints.reserved = 1; }), MailboxResult::kInvalid);
}

TEST(Mailbox, ConstantPartIsChecked) {
  Zeroed<MailboxRegion> region;
  EXPECT_STREQ(check_mailbox(*region), "magic");
  MailboxWriter writer(*region);
  region->version += 1;
  EXPECT_STREQ(check_mailbox(*region), "version");
  region->version -= 1;
  region->command_words += 1;
  EXPECT_STREQ(check_mailbox(*region), "command size");
  region->command_words -= 1;
  region->total_bytes += 1;
  EXPECT_STREQ(check_mailbox(*region), "total size");
}

TEST(Mailbox, TwoThreadsNeverMixTwoCommands) {
  Zeroed<MailboxRegion> region;
  MailboxWriter writer(*region);
  std::atomic<bool> done{false};
  constexpr std::uint64_t kWritten = 100'000;
  std::thread producer([&] {
    // Odd generations stop, even ones arm; the heartbeat follows the generation by at most one.
    for (std::uint64_t i = 1; i <= kWritten; ++i) {
      writer.set(i % 2 != 0 ? Command::kStop : Command::kArm, false);
      writer.beat();
    }
    done.store(true);
  });
  MailboxReader reader(*region);
  HostCommand command;
  std::uint64_t mixed = 0, invalid = 0;
  const auto check = [&] {
    const MailboxResult result = reader.poll(command);
    invalid += result == MailboxResult::kInvalid ? 1 : 0;
    if (result != MailboxResult::kAccepted) return;
    const bool stops = command.commands == Command::kStop;
    const bool beats = command.heartbeat == command.generation || command.heartbeat + 1 == command.generation;
    if (stops != (command.generation % 2 != 0) || !beats) ++mixed;
  };
  while (!done.load()) check();
  producer.join();
  check();
  EXPECT_EQ(mixed, 0u);
  EXPECT_EQ(invalid, 0u);
  EXPECT_EQ(command.generation, kWritten);
}

}  // namespace
}  // namespace palpate
