// A writer that overwrites a record while it is being copied, every time at the same word: the reader must notice. (The
// tests with two threads in test_ring.cpp pass without the check on this machine: the moment is too short to be met.)
#include <gtest/gtest.h>

#include <cstring>
#include <new>

#include "sim_host/rings/mailbox.h"
#include "sim_host/rings/telemetry.h"
#include "tests/support/interrupted_copy.h"

namespace palpate {
namespace {

using test::InterruptedCopy;

// Every word of a record carries its number.
TickRecord record_of(std::uint64_t number) {
  TickRecord record{};
  for (std::size_t i = 0; i < kRecordWords; ++i) std::memcpy(reinterpret_cast<char*>(&record) + 8 * i, &number, 8);
  return record;
}
bool whole(const TickRecord& record) {
  const TickRecord expected = record_of(record.sequence);
  return std::memcmp(&record, &expected, sizeof record) == 0;
}

struct Ring {
  Ring() : copy(sizeof(TelemetryRegion)), region(*new (copy.memory()) TelemetryRegion) {
    Model model;
    model.name = "ring";
    writer.open(region, model, 1'000'000, "build", "ring.pal");
  }
  void write(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) writer.write(record_of(++written));
  }
  std::size_t offset_of(const void* at) const {
    return static_cast<std::size_t>(static_cast<const std::byte*>(at) - reinterpret_cast<const std::byte*>(&region));
  }
  // First page boundary strictly within so many words.
  template <std::size_t N>
  bool boundary_in(const std::atomic<std::uint64_t> (&word)[N], std::size_t& boundary) const {
    boundary = (offset_of(&word[1]) / InterruptedCopy::kPage + 1) * InterruptedCopy::kPage;
    return boundary > offset_of(&word[1]) && boundary < offset_of(&word[N - 1]);
  }
  InterruptedCopy copy;
  TelemetryRegion& region;
  TelemetryWriter writer;
  std::uint64_t written = 0;
};

TEST(TornCopy, OfATelemetryRecordIsNoticed) {
  int tried = 0;
  for (std::uint64_t number = 1; number < 64 && tried < 3; ++number) {
    Ring ring;
    std::size_t boundary = 0;
    if (!ring.boundary_in(ring.region.slot[number % kTelemetryCapacity].word, boundary)) continue;
    tried += 1;
    ring.write(number);
    TelemetryReader reader(ring.region);
    TickRecord got{};
    for (std::uint64_t i = 1; i < number; ++i) ASSERT_TRUE(reader.next(got));
    ring.copy.interrupt_at(boundary, [&] { ring.write(kTelemetryCapacity); });
    const bool received = reader.next(got);
    ASSERT_TRUE(ring.copy.fired()) << "the copy was not interrupted: this proves nothing";
    EXPECT_TRUE(!received || whole(got)) << "record " << got.sequence << " is a mixture";
    EXPECT_TRUE(!received || got.sequence > number);
  }
  EXPECT_EQ(tried, 3);
}

TEST(TornCopy, OfACommandIsNoticed) {
  // The page boundary lies within the command's words: a whole number of the region's alignment from its start.
  constexpr std::size_t kBoundary = 2 * alignof(MailboxRegion);
  static_assert(kBoundary > offsetof(MailboxRegion, word) + sizeof(std::uint64_t));
  static_assert(kBoundary < offsetof(MailboxRegion, word) + (kCommandWords - 1) * sizeof(std::uint64_t));
  InterruptedCopy copy(sizeof(MailboxRegion) + InterruptedCopy::kPage);
  auto& region = *new (copy.memory() + InterruptedCopy::kPage - kBoundary) MailboxRegion;
  MailboxWriter writer(region);
  JointCommand joints;
  for (float& target : joints.target) target = 1;
  writer.set_joints(joints);
  MailboxReader reader(region);
  HostCommand command;
  ASSERT_EQ(reader.poll(command), MailboxResult::kAccepted);
  copy.interrupt_at(InterruptedCopy::kPage, [&] {
    for (float& target : joints.target) target = 2;
    writer.set_joints(joints);
  });
  const MailboxResult result = reader.poll(command);
  ASSERT_TRUE(copy.fired());
  EXPECT_NE(result, MailboxResult::kInvalid);
  const float all = result == MailboxResult::kAccepted ? 2.0f : 1.0f;
  EXPECT_EQ(command.generation, result == MailboxResult::kAccepted ? 2u : 1u);
  for (const float target : command.joints.target) EXPECT_EQ(target, all);
}

}  // namespace
}  // namespace palpate
