// The black box: what is written with a fault and when the controller dies, that a slice replays from the middle of a
// run, and that its log of frames is in the format candump writes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>

#include "rt_core/tick.h"
#include "sim_host/record/black_box.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/replay.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

// A line of `candump -L` (can-utils 2020.11), taken apart strictly.
struct LogLine {
  std::int64_t time_us = 0;
  std::string interface;
  Frame frame;
};

bool parse_line(const std::string& text, LogLine& line) {
  static const std::regex kFormat(
      R"(\((\d{10})\.(\d{6})\) ([A-Za-z0-9_.-]{1,15}) ([0-7][0-9A-F]{2})#(#[0-9A-F])?((?:[0-9A-F]{2})*))");
  std::smatch match;
  if (!std::regex_match(text, match, kFormat)) return false;
  line.time_us = std::stoll(match[1]) * 1'000'000 + std::stoll(match[2]);
  line.interface = match[3];
  line.frame.id = static_cast<std::uint32_t>(std::stoul(match[4], nullptr, 16));
  line.frame.fd = match[5].matched;
  const std::string data = match[6];
  if (data.size() / 2 > (line.frame.fd ? 64u : 8u)) return false;
  line.frame.length = static_cast<std::uint8_t>(data.size() / 2);
  for (std::size_t i = 0; i < data.size() / 2; ++i) {
    line.frame.data[i] = static_cast<std::uint8_t>(std::stoul(data.substr(2 * i, 2), nullptr, 16));
  }
  return true;
}

std::span<const std::uint8_t> payload(const Frame& frame) { return {frame.data, frame.length}; }

class BlackBoxTest : public testing::Test {
 protected:
  BlackBoxTest() : image_(test::tiny_image()) {
    EXPECT_EQ(open_image(image_.bytes(), model_).error, ImageError::kNone);
    state_ = make_state(model_);
    core_ = make_state(model_);
    scratch_ = make_scratch(model_);
    folder_ = std::filesystem::temp_directory_path() / ("palpate_box_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    header_.scene_hash = model_.scene_hash;
    options_.interface = "can0";
    options_.wall_minus_monotonic_ns = 1'795'233'705'000'000'000;
  }
  ~BlackBoxTest() override { std::filesystem::remove_all(folder_); }

  std::unique_ptr<BlackBox> box(const Model* model) {
    return std::make_unique<BlackBox>((folder_ / "run").string(), header_, *state_, model, options_);
  }
  // Ticks the core `ticks` times, its tool going up and down on the body; the device reports an error at `fault_at`.
  void run(BlackBox& box, std::uint64_t ticks, std::uint64_t fault_at,
           const std::function<bool(TickRecord&)>& keep = {}) {
    for (std::uint64_t i = 0; i < ticks; ++i, ++sequence_) {
      Input input;
      const double phase = 1e-3 * static_cast<double>(sequence_);
      input.pose_w.position_m = {0.01 * std::sin(phase), 0.005, 0.06 - 0.05 * std::abs(std::sin(5 * phase))};
      input.commands = sequence_ > 5 ? Command::kArm : 0;
      if (sequence_ == fault_at) input.device_fault = Fault::kDeviceReported;
      if (sequence_ % 50 == 17) input.stale_ticks = 1;
      Output output;
      tick(model_, *core_, *scratch_, input, output);
      TickRecord record{};
      fill_record(*core_, input, output, record);
      record.sequence = sequence_;
      record.timing.deadline_ns = static_cast<std::int64_t>(sequence_) * 1'000'000;
      record.timing.wake_latency_ns = 40'000;
      record.timing.receive_ns = 5'000;
      record.timing.compute_ns = 20'000;
      record.timing.transmit_ns = 4'000;
      if (!keep || keep(record)) box.add(record);
    }
  }
  std::vector<LogLine> log_lines(const std::string& path) {
    std::vector<LogLine> lines;
    std::ifstream file(path);
    for (std::string text; std::getline(file, text);) {
      LogLine line;
      EXPECT_TRUE(parse_line(text, line)) << text;
      lines.push_back(line);
    }
    return lines;
  }
  ReplayResult replay_slice(const std::string& path, std::uint64_t& first) {
    const MappedFile file(path);
    RecordingReader reader(file.bytes());
    first = reader.first_sequence();
    return replay(reader, model_);
  }

  test::ImageBytes image_;
  Model model_;
  StatePtr state_, core_;
  ScratchPtr scratch_;
  std::uint64_t sequence_ = 1;
  RecordingHeader header_;
  CandumpOptions options_;
  std::filesystem::path folder_;
};

TEST_F(BlackBoxTest, NothingIsWrittenWithoutAFault) {
  const auto nothing = box(&model_);
  run(*nothing, 300, 0);
  nothing->finish("");
  EXPECT_TRUE(nothing->dumps().empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(BlackBoxTest, SliceFromTheMiddleOfARunReplaysToTheSameBits) {
  const auto recorder = box(&model_);
  constexpr std::uint64_t kFault = 6000;
  run(*recorder, kFault + 1000, kFault);
  recorder->finish("");
  ASSERT_EQ(recorder->error(), "");
  ASSERT_EQ(recorder->dumps().size(), 1u);
  const BlackBoxDump& dump = recorder->dumps()[0];
  EXPECT_EQ(dump.cause, "DeviceReported");
  EXPECT_EQ(dump.sequence, kFault);
  EXPECT_EQ(dump.ticks, kBlackBoxTicks);
  EXPECT_TRUE(dump.replayable);
  EXPECT_EQ(dump.recording, (folder_ / "run.fault-1.plr").string());
  std::uint64_t first = 0;
  const ReplayResult result = replay_slice(dump.recording, first);
  EXPECT_TRUE(result.identical()) << result.stage << " " << result.field << " " << result.damage;
  EXPECT_EQ(result.ticks, kBlackBoxTicks);
  EXPECT_EQ(first, kFault + kBlackBoxTicksAfter - kBlackBoxTicks + 1);
}

TEST_F(BlackBoxTest, DeathOfTheControllerIsWrittenToo) {
  const auto recorder = box(nullptr);  // a run shorter than the box replays from the run's own start: no model needed
  run(*recorder, 300, 0);
  recorder->finish("controller killed by signal 9");
  ASSERT_EQ(recorder->dumps().size(), 1u);
  EXPECT_EQ(recorder->dumps()[0].cause, "controller killed by signal 9");
  EXPECT_EQ(recorder->dumps()[0].sequence, 300u);
  std::uint64_t first = 0;
  EXPECT_TRUE(replay_slice(recorder->dumps()[0].recording, first).identical());
  EXPECT_EQ(first, 1u);
}

TEST_F(BlackBoxTest, AFaultJustBeforeTheEndIsNotForgotten) {
  const auto recorder = box(&model_);
  run(*recorder, 100, 98);
  EXPECT_TRUE(recorder->dumps().empty());
  recorder->finish("controller killed by signal 9");
  ASSERT_EQ(recorder->dumps().size(), 1u);
  EXPECT_EQ(recorder->dumps()[0].cause, "DeviceReported then controller killed by signal 9");
}

TEST_F(BlackBoxTest, WithoutTheStateASliceCanOnlyBeListed) {
  const auto expect_listed_only = [&](const BlackBox& recorder) {
    ASSERT_EQ(recorder.dumps().size(), 1u);
    EXPECT_FALSE(recorder.dumps()[0].replayable);
    const MappedFile file(recorder.dumps()[0].recording);
    RecordingReader reader(file.bytes());
    EXPECT_FALSE(reader.state_known());
    EXPECT_THROW(replay(reader, model_), RecordingError);
    TickRecord record;
    std::uint64_t number = 0;
    while (reader.next(record)) number += 1;
    EXPECT_EQ(number, kBlackBoxTicks);
    EXPECT_EQ(reader.error(), "");
  };
  const auto no_model = box(nullptr);
  run(*no_model, 5000, 4700);
  no_model->finish("");
  expect_listed_only(*no_model);
}

TEST_F(BlackBoxTest, LostRecordsEndTheStateAndAreInTheSlice) {
  const auto recorder = box(&model_);
  run(*recorder, 9000, 8000, [](const TickRecord& record) {
    const std::uint64_t n = record.sequence;
    return !(n >= 1000 && n < 1010) && n != 7000;  // the first gap has left the box, the second has not
  });
  recorder->finish("");
  ASSERT_EQ(recorder->dumps().size(), 1u);
  EXPECT_FALSE(recorder->dumps()[0].replayable);
  const MappedFile file(recorder->dumps()[0].recording);
  RecordingReader reader(file.bytes());
  TickRecord record;
  while (reader.next(record)) {
  }
  EXPECT_EQ(reader.error(), "");
  EXPECT_EQ(reader.lost(), 1u);
}

TEST_F(BlackBoxTest, ARunThatDoesNotReproduceIsNotCalledReplayable) {
  const auto recorder = box(&model_);
  run(*recorder, 6000, 5900, [](TickRecord& record) {
    if (record.sequence == 300) record.state_hash ^= 1;
    return true;
  });
  recorder->finish("");
  ASSERT_EQ(recorder->dumps().size(), 1u);
  EXPECT_FALSE(recorder->dumps()[0].replayable);
}

TEST_F(BlackBoxTest, LogHoldsTheFramesOfEveryTick) {
  const auto recorder = box(&model_);
  run(*recorder, 400, 300);
  recorder->finish("");
  ASSERT_EQ(recorder->dumps().size(), 1u);
  const std::vector<LogLine> lines = log_lines(recorder->dumps()[0].log);
  ASSERT_FALSE(lines.empty());
  std::size_t commands = 0, statuses = 0;
  std::int64_t last_us = 0;
  bool saw_error = false;
  for (const LogLine& line : lines) {
    EXPECT_GE(line.time_us, last_us);
    last_us = line.time_us;
    EXPECT_EQ(line.interface, "can0");
    EXPECT_TRUE(line.frame.fd);
    wire::Status status;
    wire::Command command;
    if (line.frame.id == wire::kStatusId + 1) {
      ASSERT_EQ(wire::decode(payload(line.frame), 1, status), wire::DecodeResult::kOk);
      statuses += 1;
      saw_error = saw_error || (status.flags & DeviceFlag::kError) != 0;
    } else {
      ASSERT_EQ(line.frame.id, wire::kCommandId + 1);
      ASSERT_EQ(wire::decode(payload(line.frame), 1, command), wire::DecodeResult::kOk);
      commands += 1;
      EXPECT_EQ(command.sequence, commands);
    }
  }
  EXPECT_EQ(commands, 400u);
  EXPECT_EQ(statuses, 400u - 8u) << "ticks 17, 67, ... had no fresh sample";
  EXPECT_TRUE(saw_error);
}

TEST_F(BlackBoxTest, ClassicLogDecodesToTheRecordedPoseAndForce) {
  options_.profile = WireProfile::kClassic;
  options_.node = 3;
  TickRecord record{};
  record.sequence = 300;
  record.timing.deadline_ns = 5'000'000;
  record.input.pose_w.position_m = {0.012, -0.034, 0.056};
  record.output.device_w = {{1.25, -2.5, 0.125}, {0.01, 0.02, -0.03}};
  std::string text;
  CandumpLog(options_).add(record, text);
  std::istringstream stream(text);
  std::vector<LogLine> lines;
  for (std::string one; std::getline(stream, one);) ASSERT_TRUE(parse_line(one, lines.emplace_back())) << one;
  ASSERT_EQ(lines.size(), 4u);
  wire::ClassicPosition position;
  wire::ClassicOrientation orientation;
  wire::ClassicForce force;
  wire::ClassicTorque torque;
  ASSERT_EQ(wire::decode(payload(lines[0].frame), 3, position), wire::DecodeResult::kOk);
  ASSERT_EQ(wire::decode(payload(lines[1].frame), 3, orientation), wire::DecodeResult::kOk);
  ASSERT_EQ(wire::decode(payload(lines[2].frame), 3, force), wire::DecodeResult::kOk);
  ASSERT_EQ(wire::decode(payload(lines[3].frame), 3, torque), wire::DecodeResult::kOk);
  Vec3 position_m, force_N, torque_Nm;
  Quat rotation;
  wire::get_pose(position, orientation, position_m, rotation);
  wire::get_wrench(force, torque, force_N, torque_Nm);
  EXPECT_NEAR(norm(position_m - record.input.pose_w.position_m), 0, 1e-5);  // one count
  EXPECT_NEAR(norm(force_N - record.output.device_w.force_N), 0, 1e-3);
  EXPECT_NEAR(norm(torque_Nm - record.output.device_w.torque_Nm), 0, 1e-3);
  EXPECT_EQ(force.sequence, 300u & 0xFFu);
  EXPECT_FALSE(lines[0].frame.fd);
}

// The very bytes, once: what `candump -L` prints for these frames.
TEST(CandumpLine, IsByteForByteWhatCandumpWrites) {
  Frame frame;
  frame.id = 0x12;
  frame.length = 3;
  frame.data[0] = 0xDE, frame.data[1] = 0x0A, frame.data[2] = 0xFF;
  EXPECT_EQ(candump_line(1'795'233'705'012'345'678, "can0", frame), "(1795233705.012345) can0 012#DE0AFF\n");
  frame.fd = true;
  EXPECT_EQ(candump_line(1'000'000'999, "vcan1", frame), "(0000000001.000000) vcan1 012##1DE0AFF\n");
  frame = {};
  EXPECT_EQ(candump_line(0, "can0", frame), "(0000000000.000000) can0 000#\n");
}

}  // namespace
}  // namespace palpate
