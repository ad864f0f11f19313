// Recordings as files: one writer, no name taken over, no link followed; the scene inside; whatever is cut off where,
// what was complete comes back.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include "rt_core/tick.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recover.h"
#include "sim_host/record/replay.h"
#include "tests/support/refusal.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class RecordingFile : public testing::Test {
 protected:
  RecordingFile() : image_(test::tiny_image()) {
    EXPECT_EQ(open_image(image_.bytes(), model_).error, ImageError::kNone);
    state_ = make_state(model_);
    folder_ = std::filesystem::temp_directory_path() / ("palpate_files_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "run.plr").string();
    part_ = path_ + kPartSuffix;
    header_.scene_hash = model_.scene_hash;
    header_.period_ns = 1'000'000;
    std::strcpy(header_.build_id, "this");
    std::strcpy(header_.image_path, (folder_ / "tiny.pal").c_str());
  }
  ~RecordingFile() override { std::filesystem::remove_all(folder_); }

  // Ticks `from` to `to` of one and the same run, recorded or left unfinished.
  std::vector<TickRecord> records(std::uint64_t ticks) {
    std::vector<TickRecord> all;
    const StatePtr state = copy_of(*state_);
    const ScratchPtr scratch = make_scratch(model_);
    for (std::uint64_t i = 0; i < ticks; ++i) {
      Input input;
      input.pose_w.position_m = {0.01, 0.005, 0.02 - 1e-4 * static_cast<double>(i)};
      input.commands = i > 2 ? Command::kArm : 0;
      Output output;
      tick(model_, *state, *scratch, input, output);
      TickRecord record{};
      fill_record(*state, input, output, record);
      record.sequence = i + 1;
      record.timing.deadline_ns = static_cast<std::int64_t>(i) * 1'000'000;
      all.push_back(record);
    }
    return all;
  }
  std::unique_ptr<RecordingWriter> writer() {
    return std::make_unique<RecordingWriter>(PartFile(path_, WhenItExists::kRefuse), header_, block_of(*state_),
                                             pack_image(image_.bytes()));
  }
  ReplayResult replay_inside(const std::string& path) {
    const MappedFile file(path);
    RecordingReader reader(file.bytes());
    const RecordedScene scene(reader, "");
    return replay(reader, scene.model());
  }

  test::ImageBytes image_;
  Model model_;
  StatePtr state_;
  std::filesystem::path folder_;
  std::string path_, part_;
  RecordingHeader header_;
};

TEST_F(RecordingFile, HasItsNameOnlyWhenItIsComplete) {
  const std::vector<TickRecord> run = records(20);
  const auto file = writer();
  for (const TickRecord& record : run) file->add(record);
  file->flush();
  EXPECT_FALSE(std::filesystem::exists(path_));
  EXPECT_TRUE(std::filesystem::exists(part_));
  file->finish();
  EXPECT_TRUE(std::filesystem::exists(path_));
  EXPECT_FALSE(std::filesystem::exists(part_));
  EXPECT_TRUE(replay_inside(path_).identical()) << "from the image inside: there is no tiny.pal";
}

// Two runs with the same --record once lost 6,064 records and both said "record run.plr" (2026-11-21).
TEST_F(RecordingFile, TheSecondOfTwoWritersIsRefusedAndNothingIsLost) {
  const std::vector<TickRecord> run = records(20);
  const auto first = writer();
  first->add(run[0]);
  const std::string error = test::refusal_by<std::runtime_error>([&] { writer(); });
  EXPECT_NE(error.find("process " + std::to_string(getpid())), std::string::npos) << error;
  for (std::size_t i = 1; i < run.size(); ++i) first->add(run[i]);
  first->finish();
  EXPECT_EQ(replay_inside(path_).ticks, 20u);
  // And a finished one is not replaced either, unless that is what the user asked for.
  EXPECT_NE(test::refusal_by<std::runtime_error>([&] { writer(); }).find("--overwrite"), std::string::npos);
  const std::string before = text_of(path_);
  {
    RecordingWriter over(PartFile(path_, WhenItExists::kReplace), header_, block_of(*state_));
    over.add(run[0]);
    EXPECT_EQ(text_of(path_), before) << "the old one stays until the new one is complete";
    over.finish();
  }
  EXPECT_NE(text_of(path_), before);
}

TEST_F(RecordingFile, ANameTakenMeanwhileIsNotReplaced) {
  const auto file = writer();
  file->add(records(1)[0]);
  std::ofstream(path_) << "somebody else's";
  EXPECT_NE(test::refusal_by<std::runtime_error>([&] { file->finish(); }).find("cannot be renamed"), std::string::npos);
  EXPECT_EQ(text_of(path_), "somebody else's");
  EXPECT_TRUE(std::filesystem::exists(part_));
}

TEST_F(RecordingFile, LinksAreNotFollowed) {
  const std::filesystem::path victim = folder_ / "victim";
  std::ofstream(victim) << "precious";
  std::filesystem::create_symlink(victim, part_);
  EXPECT_NE(test::refusal_by<std::runtime_error>([&] { writer(); }).find("link"), std::string::npos);
  std::filesystem::remove(part_);
  std::filesystem::create_symlink(victim, path_);
  EXPECT_NE(test::refusal_by<std::runtime_error>([&] { writer(); }).find("exists already"), std::string::npos);
  std::filesystem::remove(path_);
  std::filesystem::create_symlink(folder_ / "nowhere", path_);
  EXPECT_NE(test::refusal_by<std::runtime_error>([&] { writer(); }).find("exists already"), std::string::npos)
      << "a dangling link is a name too";
  EXPECT_EQ(text_of(victim), "precious");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "nowhere"));
}

TEST_F(RecordingFile, ARunWithoutATickLeavesNothingBehind) {
  { const auto file = writer(); }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(RecordingFile, FreeNamesCountUpPastWhatIsThere) {
  EXPECT_EQ(free_name(path_), path_);
  std::ofstream(path_) << "x";
  EXPECT_EQ(free_name(path_), (folder_ / "run-2.plr").string());
  std::ofstream(folder_ / "run-2.plr.part") << "x";
  EXPECT_EQ(free_name(path_), (folder_ / "run-3.plr").string());
}

TEST_F(RecordingFile, ADiskThatIsTooSmallIsRefusedBeforeTheStart) {
  EXPECT_EQ(test::refusal_by<std::runtime_error>([&] { require_space(path_, 1000); }), "accepted");
  const std::string error = test::refusal_by<std::runtime_error>([&] { require_space(path_, 1e18); });
  EXPECT_NE(error.find("1000000000000 MB"), std::string::npos) << error;
  EXPECT_NE(error.find("--no-record"), std::string::npos) << error;
}

TEST_F(RecordingFile, TheImageInsideServesWhenTheFileIsAnotherByNow) {
  const auto file = writer();
  for (const TickRecord& record : records(5)) file->add(record);
  file->finish();
  test::ImageBytes other = test::tiny_image();
  other.params().k1_N_per_m += 1;
  other.seal();
  std::ofstream(folder_ / "tiny.pal", std::ios::binary)
      .write(reinterpret_cast<const char*>(other.bytes().data()), static_cast<long>(other.bytes().size()));
  EXPECT_TRUE(replay_inside(path_).identical());
}

TEST_F(RecordingFile, WithoutAnyImageTheUserIsTold) {
  {
    RecordingWriter file(path_, header_, *state_);
    file.add(records(1)[0]);
    file.finish();
  }
  const std::string error = test::refusal_by<std::runtime_error>([&] { replay_inside(path_); });
  EXPECT_NE(error.find("--image"), std::string::npos) << error;
}

TEST_F(RecordingFile, AnImageInsideThatLiesIsRefused) {
  const auto error_with = [&](std::vector<PackedPiece> pieces) {
    std::filesystem::remove(path_);
    RecordingWriter file(PartFile(path_, WhenItExists::kRefuse), header_, block_of(*state_), pieces);
    file.add(records(1)[0]);
    file.finish();
    return test::refusal_by<std::runtime_error>([&] { replay_inside(path_); });
  };
  std::vector<PackedPiece> pieces = pack_image(image_.bytes());
  EXPECT_EQ(error_with(pieces), "accepted");
  auto spoilt = pieces;
  spoilt[0].bytes[spoilt[0].bytes.size() / 2] ^= std::byte{1};
  EXPECT_NE(error_with(spoilt), "accepted");
  spoilt = pieces;
  spoilt[0].unpacked_bytes = ~0u;
  EXPECT_NE(error_with(spoilt).find("too large"), std::string::npos);
  spoilt = pieces;
  spoilt[0].unpacked_bytes -= 1;
  EXPECT_NE(error_with(spoilt).find("unpacked"), std::string::npos);
  test::ImageBytes other = test::tiny_image();
  other.params().k1_N_per_m += 1;
  other.seal();
  EXPECT_NE(error_with(pack_image(other.bytes())).find("another scene"), std::string::npos);
}

// The writer killed at every byte: what is on the disk then is the file cut there. Every tick of every chunk that was
// whole comes back, from the first byte of the first chunk of ticks on.
TEST_F(RecordingFile, CutAtEveryByteWhatWasCompleteIsRecovered) {
  const std::vector<TickRecord> run = records(3);
  std::vector<std::pair<std::size_t, std::uint64_t>> complete;  // size of the file, ticks that are whole then
  {
    const auto file = writer();
    for (std::size_t i = 0; i < run.size(); ++i) {  // chunks of one tick and of two
      file->add(run[i]);
      if (i == 1) continue;
      file->flush();
      complete.emplace_back(std::filesystem::file_size(part_), i + 1);
    }
    std::filesystem::copy_file(part_, folder_ / "whole");
    file->finish();
    complete.emplace_back(std::filesystem::file_size(path_), run.size());
  }
  const std::string bytes = text_of(path_);
  std::filesystem::remove(path_);
  // Before the first ticks the cuts are many and alike (State and image): every 61st of those, all of the others.
  const std::size_t first = complete[0].first - sizeof(TickRecord);
  for (std::size_t size = 0; size <= bytes.size(); size += size < first ? 61 : 1) {
    std::ofstream(part_, std::ios::binary).write(bytes.data(), static_cast<long>(size));
    std::uint64_t expected = 0;
    for (const auto& [at, ticks] : complete)
      if (size >= at) expected = ticks;
    if (expected == 0) {
      EXPECT_THROW(recover_recording(part_, ""), RecordingError) << size;
      EXPECT_TRUE(std::filesystem::exists(part_)) << "what cannot be read is not thrown away";
      std::filesystem::remove(part_);
      continue;
    }
    const Recovered recovered = recover_recording(part_, "");
    ASSERT_EQ(recovered.records, expected) << size;
    const ReplayResult result = replay_inside(path_);
    ASSERT_TRUE(result.identical()) << size << " " << result.damage;
    ASSERT_EQ(result.ticks, expected) << size;
    std::filesystem::remove(path_);
    ASSERT_TRUE(std::filesystem::exists(part_) == false) << size;
  }
}

TEST_F(RecordingFile, TheControllersOwnFileIsJoinedToTheHosts) {
  const std::vector<TickRecord> run = records(40);
  const auto write = [&](const std::string& path, std::size_t from, std::size_t to, bool finish, const char* build) {
    RecordingHeader header = header_;
    std::strcpy(header.build_id, build);
    RecordingWriter file(PartFile(path, WhenItExists::kReplace), header, block_of(*state_), pack_image(image_.bytes()));
    if (from > 0) file.begin_slice(from + 1, false);
    for (std::size_t i = from; i < to; ++i) file.add(run[i]);
    if (finish) file.finish();
  };
  const auto recovered_ticks = [&](std::size_t from, std::size_t to, const char* build) {
    std::filesystem::remove(path_);
    write(path_, 0, 25, false, "this");
    write(crash_path(path_), from, to, true, build);
    const Recovered result = recover_recording(part_, "");
    EXPECT_EQ(result.crash_path.empty(), result.from_crash == 0);
    EXPECT_TRUE(replay_inside(path_).identical());
    return result.records;
  };
  EXPECT_EQ(recovered_ticks(10, 40, "this"), 40u);
  EXPECT_EQ(recovered_ticks(24, 40, "this"), 40u);
  EXPECT_EQ(recovered_ticks(10, 20, "this"), 25u);
  EXPECT_EQ(recovered_ticks(25, 40, "this"), 25u) << "nothing shows that it is the same run";
  EXPECT_EQ(recovered_ticks(10, 40, "that"), 25u);
  EXPECT_EQ(crash_path("a/run.plr"), "a/run.crash.plr");
}

TEST_F(RecordingFile, WhatIsStillWrittenIsNotRecovered) {
  const auto file = writer();
  file->add(records(1)[0]);
  file->flush();
  const std::string error =
      test::refusal_by<std::runtime_error>([&] { recover_recording(part_, (folder_ / "other.plr").string()); });
  EXPECT_NE(error.find("still writing"), std::string::npos) << error;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other.plr"));
}

}  // namespace
}  // namespace palpate
