// What replay writes as tables and as CAN traffic says what the records say.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "sim_host/record/recording_exports.h"
#include "sim_host/view/view_scales.h"
#include "tests/host/csv_rows.h"
#include "tests/host/tiny_run.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

class Exports : public testing::Test {
 protected:
  static constexpr std::uint64_t kTicks = 1200;
  std::string file(const char* name) {
    return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)).string();
  }
  ~Exports() override {
    for (const std::string& path : {options_.ticks, options_.regions, options_.candump, options_.npz})
      std::filesystem::remove(path);
  }
  void export_run() {
    Model model;
    ASSERT_EQ(open_image(image_.bytes(), model).error, ImageError::kNone);
    const StatePtr state = make_state(model);
    RecordingExports exports(options_);
    test::play_tiny_run(model, *state, kTicks, [&](TickRecord& record) {
      record.timing.deadline_ns = static_cast<std::int64_t>(record.tick) * 1'000'000;
      exports.add(record);
      records_.push_back(record);
      // Numbers of pictures are those of records.
      const ForceSum sum = force_sum(*state);
      EXPECT_EQ(sum.regions, record.output.regions);
      EXPECT_LT(norm(sum.sum_N - record.output.contact_w.force_N), 1e-12 * (1 + norm(sum.sum_N)));
    });
    exports.finish();
  }
  test::ImageBytes image_ = test::tiny_image();
  ExportOptions options_{file("_ticks.csv"), file("_regions.csv"), file("_can.log"), false, 1, file(".npz"), 1'000'000};
  std::vector<TickRecord> records_;
};

TEST_F(Exports, RegionsAddUpToTheContactOfTheirTick) {
  export_run();
  const std::vector<test::CsvRow> ticks = test::csv_rows(options_.ticks), regions = test::csv_rows(options_.regions);
  ASSERT_EQ(ticks.size(), kTicks);
  std::map<std::string, Vec3> sum;
  std::size_t expected = 0;
  for (const TickRecord& record : records_) expected += static_cast<std::size_t>(record.region_count);
  EXPECT_GT(expected, 100u) << "the run must touch";
  ASSERT_EQ(regions.size(), expected);
  for (const test::CsvRow& row : regions) {
    sum[row.at("tick")] +=
        {std::stod(row.at("force_w_x")), std::stod(row.at("force_w_y")), std::stod(row.at("force_w_z"))};
    EXPECT_NEAR(
        std::hypot(std::stod(row.at("normal_w_x")), std::stod(row.at("normal_w_y")), std::stod(row.at("normal_w_z"))),
        1, 1e-8);
    for (const char* column : {"id", "point_count", "centre_w_x", "depth_equivalent_m", "friction"})
      EXPECT_TRUE(row.contains(column)) << column;
  }
  for (const test::CsvRow& row : ticks) {
    const Vec3 force{std::stod(row.at("contact_force_N_x")), std::stod(row.at("contact_force_N_y")),
                     std::stod(row.at("contact_force_N_z"))};
    // Nine digits each.
    EXPECT_LT(norm(force - sum[row.at("tick")]), 3e-8 * (1 + norm(force))) << row.at("tick");
  }
}

TEST_F(Exports, TheTicksHaveTheTorqueOfTheContactToo) {
  export_run();
  const std::vector<test::CsvRow> ticks = test::csv_rows(options_.ticks);
  for (std::size_t i = 0; i < kTicks; i += 50) {
    const Vec3 torque = records_[i].output.contact_w.torque_Nm;
    EXPECT_NEAR(std::stod(ticks[i].at("contact_torque_Nm_z")), torque.z, 1e-8 * (1 + std::abs(torque.z)));
    EXPECT_NEAR(std::stod(ticks[i].at("tool_orientation_w")), records_[i].output.tool_w.orientation.w, 1e-5);
  }
}

TEST_F(Exports, TrafficHasAStatusAndACommandForEachTick) {
  export_run();
  std::ifstream log(options_.candump);
  std::size_t lines = 0;
  for (std::string line; std::getline(log, line); ++lines) {
    EXPECT_EQ(line.front(), '(');
    EXPECT_NE(line.find(") palpate0 "), std::string::npos) << line;
    EXPECT_NE(line.find("##1"), std::string::npos) << "an FD frame with a switched bit rate: " << line;
  }
  EXPECT_EQ(lines, 2 * kTicks);
}

// NumPy's own reading is held against the tables in tests/commands/exports.py; here, that the rows are the records'
// bytes.
TEST_F(Exports, TheArraysHoldTheRecordsBytes) {
  export_run();
  std::ifstream file(options_.npz, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::string first(reinterpret_cast<const char*>(&records_.front()), offsetof(TickRecord, region));
  const std::string last(reinterpret_cast<const char*>(&records_.back()), offsetof(TickRecord, region));
  const std::size_t at = bytes.find(first);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(at % 64, bytes.find("\x93NUMPY", bytes.find("ticks.npy")) % 64) << "rows begin 64 bytes on, or a multiple";
  EXPECT_EQ(bytes.compare(at + (kTicks - 1) * first.size(), last.size(), last), 0);
}

TEST(ExportErrors, AFolderThatIsNotThereIsNamed) {
  for (std::string ExportOptions::*file :
       {&ExportOptions::ticks, &ExportOptions::regions, &ExportOptions::candump, &ExportOptions::npz}) {
    ExportOptions options;
    options.*file = "/nonexistent/a";
    const std::string said = test::refusal_by<std::runtime_error>([&] { RecordingExports exports(options); });
    EXPECT_NE(said.find("/nonexistent/a"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace palpate
