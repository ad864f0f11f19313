// The recording file: round trip, losses, every truncation and every flipped byte, other layouts.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorder.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/recording_writer.h"
#include "tests/support/roomy.h"

namespace palpate {
namespace {

std::string temporary(const char* name) {
  return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_" + name)).string();
}

std::vector<std::byte> read_all(const std::string& path) {
  const MappedFile file(path);
  return {file.bytes().begin(), file.bytes().end()};
}

RecordingHeader header_of(const char* build) {
  RecordingHeader header;
  header.scene_hash = 0xabcdef;
  header.period_ns = 1'000'000;
  std::strcpy(header.scene_name, "scene");
  std::strcpy(header.build_id, build);
  std::strcpy(header.image_path, "scene.pal");
  return header;
}

TickRecord record_of(std::uint64_t sequence) {
  TickRecord record{};
  record.sequence = sequence;
  record.tick = sequence - 1;
  record.state_hash = sequence * 0x9E3779B97F4A7C15ull;
  record.input.pose_w.position_m.x = 1e-3 * static_cast<double>(sequence);
  record.region_count = static_cast<std::int32_t>(sequence % 3);
  for (std::int32_t i = 0; i < record.region_count; ++i) record.region[i].id = static_cast<std::uint32_t>(sequence) + 7;
  return record;
}

// A recording of 5 records in 3 chunks, with one gap of 2.
std::vector<std::byte> small_recording() {
  const std::string path = temporary("small.plr");
  const StatePtr state = test::roomy_state();
  state->next_region_id = 42;
  {
    RecordingWriter writer(path, header_of("build A"), *state);
    writer.add(record_of(1));
    writer.add(record_of(2));
    writer.flush();
    writer.add(record_of(3));
    writer.add_lost(4, 2);
    writer.add(record_of(6));
    writer.add(record_of(7));
    writer.finish();
  }
  std::vector<std::byte> bytes = read_all(path);
  std::filesystem::remove(path);
  return bytes;
}

// Reads everything; the error text, or "" for a whole recording. `records` counts the intact ones, in order.
std::string read_back(std::span<const std::byte> bytes, std::uint64_t& records) {
  records = 0;
  try {
    RecordingReader reader(bytes);
    TickRecord record;
    const std::uint64_t sequences[] = {1, 2, 3, 6, 7};
    while (reader.next(record)) {
      EXPECT_LT(records, std::size(sequences));
      const TickRecord expected = record_of(sequences[std::min<std::uint64_t>(records, 4)]);
      EXPECT_EQ(std::memcmp(&record, &expected, sizeof(record)), 0) << "record " << records;
      ++records;
    }
    EXPECT_EQ(reader.records(), records);
    return reader.error();
  } catch (const RecordingError& error) {
    return error.what();
  }
}

TEST(Recording, RoundTrip) {
  const std::vector<std::byte> bytes = small_recording();
  RecordingReader reader(bytes);
  EXPECT_STREQ(reader.header().build_id, "build A");
  EXPECT_STREQ(reader.header().image_path, "scene.pal");
  EXPECT_EQ(reader.header().scene_hash, 0xabcdefu);
  EXPECT_EQ(reader.initial_state(test::roomiest_model())->next_region_id, 42u);
  std::uint64_t records = 0;
  EXPECT_EQ(read_back(bytes, records), "");
  EXPECT_EQ(records, 5u);
  TickRecord record;
  while (reader.next(record)) {
  }
  EXPECT_EQ(reader.lost(), 2u);
  EXPECT_FALSE(reader.next(record));
}

TEST(Recording, EveryTruncationIsReportedAndKeepsWhatCameBefore) {
  const std::vector<std::byte> bytes = small_recording();
  std::uint64_t most = 0;
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    std::uint64_t records = 0;
    const std::string error = read_back(std::span(bytes).first(length), records);
    ASSERT_NE(error.find("offset "), std::string::npos) << "length " << length << ": " << error;
    ASSERT_GE(records, most) << "length " << length;  // a longer prefix never yields less
    most = records;
  }
  EXPECT_EQ(most, 5u);
}

// Every byte of the file's head, of the records and of the footer; of the initial state between them, one chunk under
// one checksum and nine tenths of the file, every eleventh: each read is as long as the file, and 11 and 8 are coprime.
TEST(Recording, EveryFlippedByteIsReportedAndKeepsWhatCameBefore) {
  std::vector<std::byte> bytes = small_recording();
  constexpr std::size_t kHead = 1024, kTail = 8192;
  ASSERT_GT(bytes.size(), kHead + kTail);
  std::uint64_t most = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    if (at > kHead && at + kTail < bytes.size() && at % 11 != 0) continue;
    // One bit, another one for every position, so that all eight are covered.
    const std::byte original = bytes[at];
    bytes[at] ^= std::byte{1} << (at % 8);
    std::uint64_t records = 0;
    const std::string error = read_back(bytes, records);
    bytes[at] = original;
    ASSERT_NE(error.find("offset "), std::string::npos) << "byte " << at << ": " << error;
    ASSERT_GE(records, most) << "byte " << at;
    most = records;
  }
  EXPECT_EQ(most, 5u);  // the footer was the last to be flipped
}

TEST(Recording, BytesAfterTheFooterAreReported) {
  std::vector<std::byte> bytes = small_recording();
  bytes.push_back(std::byte{0});
  std::uint64_t records = 0;
  EXPECT_NE(read_back(bytes, records).find("after the footer"), std::string::npos);
  EXPECT_EQ(records, 5u);
}

TEST(Recording, AnotherLayoutIsRefusedNamingTheBuild) {
  const std::string path = temporary("layout.plr");
  RecordingHeader header = header_of("build of the past");
  header.layout_hash ^= 1;
  { RecordingWriter(path, header, *test::roomy_state()).finish(); }
  const std::vector<std::byte> bytes = read_all(path);
  std::filesystem::remove(path);
  std::uint64_t records = 0;
  const std::string error = read_back(bytes, records);
  EXPECT_NE(error.find("another data layout"), std::string::npos) << error;
  EXPECT_NE(error.find("build of the past"), std::string::npos) << error;
}

TEST(Recording, OtherFilesAreRefused) {
  std::uint64_t records = 0;
  std::vector<std::byte> text(1000, std::byte{'#'});
  EXPECT_NE(read_back(text, records).find("not a Palpate recording"), std::string::npos);
  EXPECT_THROW(MappedFile("/nonexistent/file.plr"), RecordingError);
  EXPECT_THROW(MappedFile("/tmp"), RecordingError);
  EXPECT_THROW(RecordingWriter("/nonexistent/file.plr", header_of("x"), *test::roomy_state()), RecordingError);
}

TEST(Recording, FileOfAKilledHostHoldsEverythingFlushed) {
  const std::string path = temporary("killed.plr");
  RecordingWriter writer(path, header_of("x"), *test::roomy_state());
  writer.add(record_of(1));
  writer.add(record_of(2));
  writer.flush();
  std::uint64_t records = 0;
  const std::string error = read_back(read_all(writer.part_path()), records);
  std::filesystem::remove(writer.part_path());
  EXPECT_NE(error.find("ends without its footer"), std::string::npos) << error;
  EXPECT_EQ(records, 2u);
}

TEST(Recording, RecorderDrainsEverythingAndDeclaresLosses) {
  const auto region = std::make_unique<TelemetryRegion>();
  TelemetryWriter ring;
  Model model;
  model.name = "recorder";
  ring.open(*region, model, 1'000'000, "build", "image");
  const std::string path = temporary("recorder.plr");
  std::uint64_t heard = 0;
  // Overrun before the recorder starts: those records are lost, and the file says so.
  const std::uint64_t before = kTelemetryCapacity + 500, after = 300;
  TickRecord record = record_of(1);
  for (std::uint64_t i = 0; i < before; ++i) ring.write(record);
  {
    RecordingWriter file(path, recording_header(region->header), *test::roomy_state());
    Recorder recorder(*region, &file, [&](const TickRecord&) { ++heard; });
    recorder.start();
    for (std::uint64_t i = 0; i < after; ++i) ring.write(record);
    recorder.stop();
    EXPECT_EQ(recorder.error(), "");
    EXPECT_EQ(recorder.records() + recorder.lost(), before + after);
    EXPECT_GT(recorder.lost(), 0u);
    EXPECT_EQ(heard, recorder.records());
  }
  const MappedFile file(path);
  RecordingReader reader(file.bytes());
  std::uint64_t last = 0, gap = 0;
  while (reader.next(record)) {
    gap += record.sequence - last - 1;
    last = record.sequence;
  }
  std::filesystem::remove(path);
  EXPECT_EQ(reader.error(), "");
  EXPECT_EQ(last, before + after);
  EXPECT_EQ(gap, reader.lost());
}

TEST(Recording, FullDiskIsReportedAndDoesNotStopTheRun) {
  EXPECT_THROW(RecordingWriter("/dev/full", header_of("x"), *test::roomy_state()), RecordingError);
  const auto region = std::make_unique<TelemetryRegion>();
  TelemetryWriter ring;
  Model model;
  ring.open(*region, model, 1, "b", "i");
  const std::string path = temporary("full.plr");
  RecordingWriter file(path, header_of("x"), *test::roomy_state());
  Recorder recorder(*region, &file, {});
  // A file-size limit stands in for the full disk; its signal would end the process.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit tight{64 * 1024, before.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  TickRecord record = record_of(2);
  for (int i = 0; i < 1000; ++i) ring.write(record);
  testing::internal::CaptureStderr();
  recorder.drain();
  const std::string at_once = testing::internal::GetCapturedStderr();
  testing::internal::CaptureStderr();
  for (int i = 0; i < 1000; ++i) ring.write(record);
  recorder.stop();
  const std::string later = testing::internal::GetCapturedStderr();
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_FALSE(std::filesystem::exists(path)) << "only a complete recording gets its name";
  std::filesystem::remove(path + kPartSuffix);
  EXPECT_NE(recorder.error().find("cannot write"), std::string::npos) << recorder.error();
  EXPECT_EQ(recorder.records(), 2000u);  // it kept listening
  EXPECT_NE(at_once.find("recording stops here, the run goes on: "), std::string::npos) << "'" << at_once << "'";
  EXPECT_NE(at_once.find("cannot write"), std::string::npos) << at_once;
  EXPECT_EQ(later, "") << "said once";
}

}  // namespace
}  // namespace palpate
