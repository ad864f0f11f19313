// The table that `palpate replay --dump` writes, against the records themselves: every member by its own name, and
// every bit of it. NumPy's reading is held against the same table in tests/python/test_palpate.py.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <vector>

#include "sim_host/record/record_csv.h"
#include "tests/host/csv_rows.h"

namespace palpate {
namespace {

// Takes what it compares out of the row, so that what is left was not asked for.
class Check {
 public:
  explicit Check(test::CsvRow row) : row_(std::move(row)) {}
  ~Check() {
    for (const auto& [name, value] : row_) ADD_FAILURE() << "column " << name << " is of no member";
  }
  void operator()(const std::string& name, double value) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(take(name).c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value))
        << name;
  }
  void operator()(const std::string& name, float value) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(std::strtof(take(name).c_str(), nullptr)),
              std::bit_cast<std::uint32_t>(value))
        << name;
  }
  template <class T>
  requires std::is_integral_v<T>
  void operator()(const std::string& name, T value) { EXPECT_EQ(take(name), std::to_string(value)) << name; }
  template <class T>
  requires std::is_enum_v<T>
  void operator()(const std::string& name, T value) { (*this)(name, static_cast<std::int32_t>(value)); }
  template <class T, std::size_t N>
  void operator()(const std::string& name, const T (&values)[N]) {
    for (std::size_t i = 0; i < N; ++i) (*this)(name + "_" + std::to_string(i), values[i]);
  }
  void operator()(const std::string& name, Vec3 v) {
    (*this)(name + "_x", v.x);
    (*this)(name + "_y", v.y);
    (*this)(name + "_z", v.z);
  }
  void operator()(const std::string& name, Wrench w) {
    (*this)(stem(name) + "_force_N", w.force_N);
    (*this)(stem(name) + "_torque_Nm", w.torque_Nm);
  }
  void operator()(const std::string& name, Pose p) {
    const std::string of = stem(name) + "_orientation_";
    (*this)(stem(name) + "_position_m", p.position_m);
    (*this)(of + "w", p.orientation.w);
    (*this)(of + "x", p.orientation.x);
    (*this)(of + "y", p.orientation.y);
    (*this)(of + "z", p.orientation.z);
  }

 private:
  static std::string stem(const std::string& name) { return name.substr(0, name.size() - 2); }  // without _w
  std::string take(const std::string& name) {
    const auto at = row_.find(name);
    if (at == row_.end()) return ADD_FAILURE() << "no column " << name, "";
    const std::string value = at->second;
    row_.erase(at);
    return value;
  }
  test::CsvRow row_;
};

// Any bits but those of numbers that are none, of which text keeps no payload.
TickRecord random_record(std::mt19937_64& random) {
  TickRecord record;
  auto* bytes = reinterpret_cast<char*>(&record);
  for (std::size_t i = 0; i < sizeof record; i += 8) {
    const std::uint64_t word = random() & 0xBFFFFFFFBFFFFFFFull;  // no exponent is all ones, of float64 nor float32
    std::memcpy(bytes + i, &word, 8);
  }
  record.region_count = static_cast<std::int32_t>(random() % (kMaxRegions + 1));
  return record;
}

void check_tick(const test::CsvRow& row, const TickRecord& r) {
  Check check(row);
  check("sequence", r.sequence);
  check("tick", r.tick);
  check("state_hash", r.state_hash);
  check("deadline_ns", r.timing.deadline_ns);
  check("wake_latency_ns", r.timing.wake_latency_ns);
  check("receive_ns", r.timing.receive_ns);
  check("compute_ns", r.timing.compute_ns);
  check("transmit_ns", r.timing.transmit_ns);
  check("publish_ns", r.timing.publish_ns);
  check("stage_ns", r.timing.stage_ns);
  check("input_w", r.input.pose_w);
  check("stale_ticks", r.input.stale_ticks);
  check("commands", r.input.commands);
  check("device_fault", r.input.device_fault);
  check("overrun_ticks", r.input.overrun_ticks);
  check("buttons", r.input.buttons);
  check("drive", r.input.drive);
  check("closing", r.input.joints.closing);
  check("joint_target", r.input.joints.target);
  check("joint_direct", r.input.joints.direct);
#define PALPATE_FIELD(name, lowest, highest, key, meaning) check("live_" #name, r.input.live.name);
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  check("command_lag", r.input.command_lag);
  check("input_second_w", r.input.second_w);
#define PALPATE_FIELD(type, name, stage, meaning) \
  if (std::string_view(#name) != "reserved") check(#name, r.output.name);
  PALPATE_OUTPUT_FIELDS(PALPATE_FIELD)
#undef PALPATE_FIELD
  check("most_contacts", r.high_water.contacts);
  check("most_regions", r.high_water.regions);
  check("most_traversal_stack", r.high_water.traversal_stack);
  check("most_gjk_support_calls", r.high_water.gjk_support_calls);
  check("region_count", r.region_count);
}

void check_region(const test::CsvRow& row, const TickRecord& record, const RegionRecord& r) {
  Check check(row);
  check("sequence", record.sequence);
  check("tick", record.tick);
  check("id", r.id);
  check("point_count", r.point_count);
  check("centre_w", r.centre_w);
  check("force_w", r.force_w);
  check("normal_w", r.normal_w);
  check("depth_equivalent_m", r.depth_equivalent_m);
  check("friction", r.friction);
}

TEST(RecordCsv, EveryMemberOfTickAndRegionReadsBackToItsBits) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("palpate_csv_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path ticks = folder / "ticks.csv", regions = folder / "regions.csv";
  std::mt19937_64 random(3);
  std::vector<TickRecord> records;
  for (int i = 0; i < 200; ++i) records.push_back(random_record(random));
  {
    RecordCsv csv(ticks, regions);
    for (const TickRecord& record : records) csv.add(record);
  }
  const std::vector<test::CsvRow> tick_rows = test::csv_rows(ticks), region_rows = test::csv_rows(regions);
  std::filesystem::remove_all(folder);
  ASSERT_EQ(tick_rows.size(), records.size());
  std::size_t region = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    check_tick(tick_rows[i], records[i]);
    for (std::int32_t k = 0; k < records[i].region_count; ++k, ++region) {
      ASSERT_LT(region, region_rows.size());
      check_region(region_rows[region], records[i], records[i].region[k]);
    }
  }
  EXPECT_EQ(region, region_rows.size());
}

TEST(RecordCsv, AFileThatCannotBeCreatedIsSaid) {
  EXPECT_THROW(RecordCsv("/nonexistent/ticks.csv", ""), std::runtime_error);
}

}  // namespace
}  // namespace palpate
