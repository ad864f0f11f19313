// Going over to another scene while a run goes on: at zero force, armed anew, refused where it does not fit, and never
// out of a latched fault. Tick by tick on the smallest scene; then a whole run of three processes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "sim_host/bake/scene_image.h"
#include "sim_host/run/switching_controller.h"
#include "tests/support/ball_run.h"
#include "tests/support/replayed.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

constexpr std::uint32_t kNever = 1'000'000'000;

class SceneSwitch : public testing::Test {
 protected:
  SceneSwitch() {
    folder_ = std::filesystem::temp_directory_path() / ("palpate_switch_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    EXPECT_EQ(open_image(bytes_.bytes(), model_).error, ImageError::kNone);
    telemetry_.open(*region_, model_, 1'000'000, "build", "first.pal");
    writer_.set(0, false);
  }
  ~SceneSwitch() override { std::filesystem::remove_all(folder_); }

  // Of the same tetrahedron, changed.
  template <class Change>
  std::string image_with(const Change& change) {
    test::ImageBytes image = test::tiny_image();
    change(image);
    image.seal();
    const std::filesystem::path path = folder_ / ("image" + std::to_string(++images_) + ".pal");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.bytes().data()), static_cast<std::streamsize>(image.bytes().size()));
    return path.string();
  }
  std::string stiffer() {
    return image_with([](test::ImageBytes& image) { image.params().k1_N_per_m = 400; });
  }

  // One tick with the tool `depth_m` into the middle of a face.
  const TickRecord& tick_at(double depth_m, std::uint32_t commands = 0, std::uint32_t fault = 0,
                            std::uint32_t stale_ticks = 0) {
    Input input;
    const double out_m = (0.03 / std::sqrt(3.0) + 0.01 - depth_m) / std::sqrt(3.0);
    input.pose_w.position_m = {-out_m, -out_m, -out_m};
    input.device_fault = fault;
    input.stale_ticks = stale_ticks;
    writer_.beat();
    input.commands = port_.poll() | commands;
    controller_.step(input, output_, {});
    TickRecord record{};
    controller_.fill(input, output_, record);
    record.sequence = records_.size() + 1;
    telemetry_.write(record);
    records_.push_back(record);
    return records_.back();
  }
  // Outside, armed, then slowly in, until it pushes.
  void press() {
    for (int i = 0; i < 20; ++i) tick_at(-0.004);
    tick_at(-0.004, Command::kArm);
    for (int i = 0; i < 300; ++i) tick_at(-0.004 + 6e-5 * std::min(i, 200));
    ASSERT_EQ(output_.mode, Mode::kForce);
    ASSERT_GT(norm(output_.device_w.force_N), 0.5);
  }
  double largest_step_N() const {
    double largest_N = 0;
    for (std::size_t i = 1; i < records_.size(); ++i)
      largest_N =
          std::max(largest_N, norm(records_[i].output.device_w.force_N - records_[i - 1].output.device_w.force_N));
    return largest_N;
  }

  std::filesystem::path folder_;
  int images_ = 0;
  test::ImageBytes bytes_ = test::tiny_image();
  Model model_;
  StatePtr state_ = (open_image(bytes_.bytes(), model_), make_state(model_));
  ScratchPtr scratch_ = make_scratch(model_);
  SceneShelf shelf_{model_, [](const Model&) { return std::string(); }};
  std::unique_ptr<TelemetryRegion> region_ = std::make_unique<TelemetryRegion>();
  TelemetryWriter telemetry_;
  MailboxRegion mailbox_{};
  MailboxWriter writer_{mailbox_};
  std::atomic<bool> interrupted_{false}, stop_{false};
  HostPort port_{&mailbox_, kNever, interrupted_, stop_};
  SwitchingController controller_{model_, *state_, *scratch_, shelf_, port_, &telemetry_};
  Output output_;
  std::vector<TickRecord> records_;
};

TEST_F(SceneSwitch, HappensAtZeroForceAndForceComesBackOnlyWhenArmedAnew) {
  press();
  ASSERT_EQ(shelf_.add(stiffer()), "");
  const std::size_t asked = records_.size();
  writer_.set_scene(1);
  // Arming is held all the while: it was meant for the scene before.
  for (int i = 0; i < 100; ++i) tick_at(0.008, Command::kArm);
  ASSERT_EQ(controller_.number(), 1u);
  std::size_t first = asked;
  while (first < records_.size() && records_[first].tick != 0) ++first;
  ASSERT_LT(first, asked + 30) << "ramp_out_s is 20 ms";
  EXPECT_EQ(records_[first - 1].output.device_w, Wrench{});
  EXPECT_EQ(records_[first - 1].output.mode, Mode::kIdle);
  for (std::size_t i = first; i < records_.size(); ++i) {
    EXPECT_EQ(records_[i].tick, i - first);
    EXPECT_EQ(records_[i].output.device_w, Wrench{}) << "not armed";
  }
  for (int i = 0; i < 20; ++i) tick_at(-0.004);
  tick_at(-0.004, Command::kArm);
  for (int i = 0; i < 300; ++i) tick_at(-0.004 + 6e-5 * std::min(i, 200));
  EXPECT_EQ(output_.mode, Mode::kForce);
  EXPECT_GT(norm(output_.device_w.force_N), 0.5);
  EXPECT_LE(largest_step_N(), 0.1 * test::tiny_params().force_max_N) << "docs/faults.md";

  // From its first record on the new scene replays by itself, bit for bit.
  Model next;
  const std::string path = (folder_ / "image1.pal").string();
  std::string error;
  const PrivateFile image = PrivateFile::read(path, error);
  ASSERT_EQ(open_image(image.bytes(), next).error, ImageError::kNone);
  const StatePtr state = make_state(next);
  const ScratchPtr scratch = make_scratch(next);
  for (std::size_t i = first; i < records_.size(); ++i) {
    Output output;
    tick(next, *state, *scratch, records_[i].input, output);
    ASSERT_EQ(hash_state(*state), records_[i].state_hash) << i;
  }
  EXPECT_EQ(next.params.k1_N_per_m, 400);
  const TelemetryScene* told = newest_scene(*region_);
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->first_sequence.load(), first + 1);
}

TEST_F(SceneSwitch, ALatchedFaultStaysAndSoDoesTheScene) {
  press();
  ASSERT_EQ(shelf_.add(stiffer()), "");
  tick_at(0.008, 0, Fault::kDeviceReported);
  writer_.set_scene(1);
  for (int i = 0; i < 200; ++i) tick_at(0.008);
  EXPECT_EQ(controller_.number(), 0u);
  EXPECT_EQ(output_.mode, Mode::kFault);
  EXPECT_EQ(output_.fault, Fault::kDeviceReported);
  EXPECT_EQ(output_.device_w, Wrench{});
  tick_at(0.008, Command::kReset);  // the operator's
  for (int i = 0; i < 3; ++i) tick_at(0.008);
  EXPECT_EQ(controller_.number(), 1u);
  EXPECT_EQ(output_.mode, Mode::kIdle);
}

TEST_F(SceneSwitch, AFaultWhileTheForceRampsOutStopsTheChange) {
  press();
  ASSERT_EQ(shelf_.add(stiffer()), "");
  writer_.set_scene(1);
  for (int i = 0; i < 5; ++i) tick_at(0.008);
  ASSERT_GT(norm(output_.device_w.force_N), 0);
  for (int i = 0; i < 100; ++i) tick_at(0.008, 0, Fault::kBusOff);
  EXPECT_EQ(controller_.number(), 0u);
  EXPECT_EQ(output_.mode, Mode::kFault);
  EXPECT_LE(largest_step_N(), 0.1 * test::tiny_params().force_max_N);
}

TEST_F(SceneSwitch, WaitsForAFreshSample) {
  ASSERT_EQ(shelf_.add(stiffer()), "");
  tick_at(-0.004);
  writer_.set_scene(1);
  for (std::uint32_t stale = 1; stale <= 15; ++stale) tick_at(-0.004, 0, 0, stale);
  EXPECT_EQ(controller_.number(), 0u);
  tick_at(-0.004);
  EXPECT_EQ(controller_.number(), 1u);
}

TEST_F(SceneSwitch, ANumberNobodyAnnouncedIsNotTakenUpAndNoneGoesBack) {
  writer_.set_scene(7);
  for (int i = 0; i < 10; ++i) tick_at(-0.004);
  EXPECT_EQ(controller_.number(), 0u);
  EXPECT_EQ(port_.faults(), 0u);
  writer_.set_scene(3);
  tick_at(-0.004);
  EXPECT_EQ(port_.faults(), Fault::kCommandInvalid);
}

TEST_F(SceneSwitch, WhatDoesNotFitIsRefusedWithTheReason) {
  using test::ImageBytes;
  const auto why = [&](auto change) { return shelf_.add(image_with(change)); };
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  expect(why([](ImageBytes& i) { i.params().period_s = 5e-4; }), "period_s is 0.0005, and must be the run's 0.001");
  expect(why([](ImageBytes& i) { i.params().force_max_N = 9; }), "force_max_N is 9, and must not exceed the run's 8.5");
  expect(why([](ImageBytes& i) { i.params().torque_max_Nm = 0.3; }), "torque_max_Nm");
  expect(why([](ImageBytes& i) { i.params().delay_s = 0.002; }), "delay_s");
  expect(why([](ImageBytes& i) { i.params().held_part = HeldPart::kBoth; }), "held_part");
  expect(why([](ImageBytes& i) { i.params().silence_fault_ticks = 40; }), "silence_fault_ticks");
  expect(shelf_.add((folder_ / "none.pal").string()), "none.pal: cannot read");
  const std::string damaged = stiffer();
  {
    std::fstream file(damaged, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(600);
    file.put('x');
  }
  expect(shelf_.add(damaged), "checksum");
  std::filesystem::resize_file(damaged, 100);
  expect(shelf_.add(damaged), "bake the scene again");
  SceneShelf picky(model_, [](const Model&) { return std::string("its profile says no"); });
  expect(picky.add(stiffer()), "its profile says no");
  EXPECT_EQ(shelf_.count(), 0u) << "nothing of it is on the shelf";
  for (std::size_t i = 0; i < kMostLaterScenes; ++i) ASSERT_EQ(shelf_.add(stiffer()), "");
  expect(shelf_.add(stiffer()), "at most 16");
}

class SwitchingRun : public BallRun {
 protected:
  SwitchingRun() {
    options_.time = RunTime::kVirtual;
    options_.record = (folder_ / "run.plr").string();
    options_.black_box = (folder_ / "run").string();
    options_.duration_s = 1.6;
    options_.repeat_path = true;
    options_.companion.tick = [this](const TickRecord& record) { records_.push_back(record); };
    options_.companion.changed = [this](const std::string& wrong) { answers_.push_back(wrong); };
    options_.companion.scene = [this] {
      const bool now = !asked_ && records_.size() > 400;
      asked_ = asked_ || now;
      return now ? image_ : std::string();
    };
  }
  std::string bake(const std::string& name, const std::vector<std::string>& settings) {
    SceneOverlays overlays;
    overlays.setting = settings;
    const std::string image = (folder_ / name).string();
    prepare_scene(options_.scene, image, "", overlays);
    return image;
  }

  std::string image_;
  bool asked_ = false;
  std::vector<std::string> answers_;
  std::vector<TickRecord> records_;
};

TEST_F(SwitchingRun, TwoScenesTwoRecordingsNoFaultAndBothReplay) {
  image_ = bake("smaller.pal", {"body.radius_mm=29"});
  const RunResult result = run_session(options_);
  ASSERT_EQ(answers_, std::vector<std::string>{""});
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_EQ(result.controller_exit, 0);
  EXPECT_EQ(result.lost, 0u);
  ASSERT_EQ(result.later_recordings.size(), 1u);
  EXPECT_EQ(result.later_recordings[0], (folder_ / "run.scene-2.plr").string());
  std::size_t first = 1;
  while (first < records_.size() && records_[first].tick != 0) ++first;
  ASSERT_LT(first, records_.size());
  EXPECT_EQ(records_[first - 1].output.device_w, Wrench{});
  EXPECT_EQ(records_[first].output.device_w, Wrench{});
  EXPECT_EQ(records_.back().sequence, records_.size()) << "sequence numbers go on";
  double before_N = 0, after_N = 0;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    double& most_N = i < first ? before_N : after_N;
    most_N = std::max(most_N, norm(records_[i].output.contact_w.force_N));
  }
  EXPECT_GT(before_N, 0.3);
  EXPECT_GT(after_N, 0);
  EXPECT_LT(after_N, before_N) << "2 mm less of a body, less deep";
  EXPECT_EQ(test::replayed(options_.record), "identical");
  EXPECT_EQ(test::replayed(result.later_recordings[0]), "identical");
}

TEST_F(SwitchingRun, WhatIsRefusedChangesNothing) {
  image_ = bake("slow.pal", {"device.period_ms=2"});
  const RunResult result = run_session(options_);
  ASSERT_EQ(answers_.size(), 1u);
  EXPECT_NE(answers_[0].find("period_s is 0.002"), std::string::npos) << answers_[0];
  EXPECT_TRUE(result.later_recordings.empty());
  EXPECT_EQ(result.summary.fault, 0u);
  EXPECT_EQ(test::replayed(options_.record), "identical");
}

}  // namespace
}  // namespace palpate
