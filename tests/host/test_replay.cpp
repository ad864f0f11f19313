// Replay: a run recorded in memory comes out identical; a changed input, a changed result, a gap, another scene and
// damage are each named.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

#include "rt_core/tick.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/record/replay.h"
#include "sim_host/record/state_check.h"
#include "tests/host/tiny_run.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

constexpr std::uint64_t kTicks = 400;

struct RecordedRun {
  RecordedRun() : image(test::tiny_image()) {
    EXPECT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
    initial = make_state(model);
  }
  // Runs the core and records it; `spoil` may change a record before it is written.
  void record(const std::function<void(TickRecord&)>& spoil = {}) {
    path = (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_replay.plr")).string();
    RecordingHeader header;
    header.scene_hash = model.scene_hash;
    std::strcpy(header.scene_name, "tiny");
    std::strcpy(header.image_path, "tiny.pal");
    RecordingWriter writer(path, header, *initial);
    StatePtr state = copy_of(*initial);
    if (check_state(model, *state).field != nullptr)
      state = make_state(model);  // a hostile file, made by nobody's tick
    test::play_tiny_run(model, *state, kTicks, [&](TickRecord& record) {
      if (spoil) spoil(record);
      if (record.sequence != 0) writer.add(record);
    });
    writer.finish();
  }
  ReplayResult replay_it() {
    const MappedFile file(path);
    std::filesystem::remove(path);
    RecordingReader reader(file.bytes());
    return replay(reader, model);
  }

  test::ImageBytes image;
  Model model;
  StatePtr initial;
  std::string path;
};

TEST(Replay, SameInputsGiveTheSameBits) {
  RecordedRun run;
  double force = 0;
  run.record([&](TickRecord& record) { force = std::max(force, norm(record.output.device_w.force_N)); });
  EXPECT_GT(force, 0.01) << "the run must touch the body, or it proves little";
  const ReplayResult result = run.replay_it();
  EXPECT_TRUE(result.identical()) << result.stage << " " << result.field << " " << result.recorded << " "
                                  << result.replayed;
  EXPECT_EQ(result.ticks, kTicks);
}

TEST(Replay, StartsFromTheRecordedStateNotFromZero) {
  RecordedRun run;
  run.initial->next_region_id = 1000;
  run.initial->tick = 77;
  run.record();
  EXPECT_TRUE(run.replay_it().identical());
}

TEST(Replay, OneAlteredInputIsFoundAtItsTick) {
  RecordedRun run;
  run.record([](TickRecord& record) {
    if (record.tick == 200) record.input.pose_w.position_m.z += 1e-9;
  });
  const ReplayResult result = run.replay_it();
  ASSERT_TRUE(result.differs);
  EXPECT_EQ(result.tick, 200u);
  EXPECT_EQ(result.ticks, 200u);
  EXPECT_NE(result.stage, "");
  EXPECT_NE(result.recorded, result.replayed);
}

TEST(Replay, AlteredResultsNameStageAndField) {
  const auto first_difference_of = [](auto spoil) {
    RecordedRun run;
    run.record([&](TickRecord& record) {
      if (record.tick == 150) spoil(record);
    });
    const ReplayResult result = run.replay_it();
    EXPECT_TRUE(result.differs);
    EXPECT_EQ(result.tick, 150u);
    return result.stage + ":" + result.field;
  };
  EXPECT_EQ(first_difference_of([](TickRecord& r) { r.output.contact_w.force_N.x += 1e-12; }),
            "account:output.contact_w");
  EXPECT_EQ(first_difference_of([](TickRecord& r) { r.output.device_w.torque_Nm.z += 1; }), "safety:output.device_w");
  EXPECT_EQ(first_difference_of([](TickRecord& r) { r.output.mode = Mode::kHold; }), "safety:output.mode");
  EXPECT_EQ(first_difference_of([](TickRecord& r) { r.output.contacts += 1; }), "rows:output.contacts");
  EXPECT_EQ(first_difference_of([](TickRecord& r) { r.output.regions += 1; }), "rows:output.regions");
  EXPECT_EQ(first_difference_of([](TickRecord& r) { r.state_hash ^= 1; }),
            "state:state_hash (no recorded output differs)");
  // Two differences: the earlier stage is the one to look at.
  EXPECT_EQ(first_difference_of([](TickRecord& r) {
              r.output.ramp = 9;
              r.output.energy_J = 9;
            }),
            "account:output.energy_J");
}

// Every field of a record's outputs, from the tables themselves: 100 N of tampering with palm_w once replayed as
// identical (2026-11-21).
TEST(Replay, EveryFieldOfTheOutputIsCompared) {
  TickRecord clean{};
  clean.region_count = 1;
  ReplayResult result;
  EXPECT_FALSE(first_record_difference(clean, clean, result));
  std::size_t bytes_of_output = 0, bytes_of_region = 0;
  const auto expect_seen = [&](auto spoil, const std::string& name) {
    TickRecord spoilt = clean;
    spoil(spoilt);
    ReplayResult found;
    EXPECT_TRUE(first_record_difference(clean, spoilt, found)) << name;
    EXPECT_EQ(found.field, name);
  };
  // The last bit of the field: of a vector's last component, say.
  const auto flip = [](auto& field) { reinterpret_cast<unsigned char*>(&field)[sizeof(field) - 1] ^= 1; };
#define PALPATE_FIELD(type, name, stage, meaning)                                      \
  expect_seen([&](TickRecord& record) { flip(record.output.name); }, "output." #name); \
  bytes_of_output += sizeof(type);
  PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
#define PALPATE_FIELD(type, name, stage, meaning)                                            \
  expect_seen([&](TickRecord& record) { flip(record.region[0].name); }, "region[0]." #name); \
  bytes_of_region += sizeof(type);
  PALPATE_REGION_RECORD_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  EXPECT_EQ(bytes_of_output, sizeof(Output)) << "no byte outside the table";
  EXPECT_EQ(bytes_of_region, sizeof(RegionRecord));
  expect_seen([](TickRecord& record) { record.high_water.contacts += 1; }, "high_water.contacts");
  expect_seen([](TickRecord& record) { record.high_water.regions += 1; }, "high_water.regions");
  expect_seen([](TickRecord& record) { record.high_water.traversal_stack += 1; }, "high_water.traversal_stack");
  expect_seen([](TickRecord& record) { record.high_water.gjk_support_calls += 1; }, "high_water.gjk_support_calls");
  expect_seen([](TickRecord& record) { record.tick += 1; }, "tick");
  expect_seen([](TickRecord& record) { record.region_count = 0; }, "region_count");
}

TEST(Replay, AnInitialStateThatTheSceneCannotHaveIsRefused) {
  const auto error_of = [](auto spoil) {
    RecordedRun run;
    spoil(*run.initial);
    run.record();
    try {
      run.replay_it();
    } catch (const RecordingError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(error_of([](State& s) { s.point[0].triangle = 1 << 30; }).find("point.triangle[0]"), std::string::npos);
  EXPECT_NE(error_of([](State& s) { s.nodal.count = 3; }).find("nodal.count"), std::string::npos);
  EXPECT_EQ(error_of([](State&) {}), "accepted");
}

TEST(Replay, GapEndsTheVerificationAndIsCounted) {
  RecordedRun run;
  run.record([](TickRecord& record) {
    if (record.sequence >= 100 && record.sequence < 110) record.sequence = 0;  // not written
  });
  const ReplayResult result = run.replay_it();
  EXPECT_FALSE(result.identical());
  EXPECT_FALSE(result.differs);
  EXPECT_EQ(result.lost, 10u);
  EXPECT_EQ(result.ticks, 99u);
}

TEST(Replay, AnotherSceneIsRefusedNamingBoth) {
  RecordedRun run;
  run.record();
  const std::uint64_t recorded = run.model.scene_hash;
  run.image.params().k1_N_per_m += 1;
  run.image.seal();
  ASSERT_EQ(open_image(run.image.bytes(), run.model).error, ImageError::kNone);
  try {
    run.replay_it();
    FAIL() << "accepted another scene";
  } catch (const RecordingError& error) {
    char text[2][17];
    std::snprintf(text[0], sizeof(text[0]), "%016llx", static_cast<unsigned long long>(recorded));
    std::snprintf(text[1], sizeof(text[1]), "%016llx", static_cast<unsigned long long>(run.model.scene_hash));
    EXPECT_NE(std::strstr(error.what(), text[0]), nullptr) << error.what();
    EXPECT_NE(std::strstr(error.what(), text[1]), nullptr) << error.what();
  }
}

TEST(Replay, CutRecordingIsVerifiedAsFarAsItGoes) {
  RecordedRun run;
  run.record();
  std::filesystem::resize_file(run.path, std::filesystem::file_size(run.path) - 5000);
  const ReplayResult result = run.replay_it();
  EXPECT_FALSE(result.identical());
  EXPECT_FALSE(result.differs);
  EXPECT_NE(result.damage.find("offset "), std::string::npos);
  EXPECT_GT(result.ticks, 0u);
}

TEST(Replay, BrokenImageFileNamesTheField) {
  const std::string path = (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_bad.pal")).string();
  test::ImageBytes image = test::tiny_image();
  image.params().period_s = -1;
  image.seal();
  std::FILE* file = std::fopen(path.c_str(), "wb");
  ASSERT_NE(file, nullptr);
  std::fwrite(image.bytes().data(), 1, image.bytes().size(), file);
  std::fclose(file);
  try {
    const ImageFile broken(path);
    FAIL() << "accepted a broken image";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::strstr(error.what(), "period_s"), nullptr) << error.what();
    EXPECT_NE(std::strstr(error.what(), path.c_str()), nullptr) << error.what();
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace palpate
