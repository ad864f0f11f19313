// The state hash and its field-wise comparison: what replay's verdict rests on.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "rt_core/record.h"
#include "rt_core/state.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

struct Fixture {
  ImageBytes image = tiny_image();
  Model model;
  std::unique_ptr<State> state = std::make_unique<State>();
  Fixture() {
    EXPECT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
    reset(*state);
    state->region[3].id = 7;  // one live region, so that its fields count
  }
};

TEST(StateHash, IgnoresPaddingAndDeadEntries) {
  Fixture f;
  auto copy = std::make_unique<State>();
  std::memset(static_cast<void*>(copy.get()), 0xCD, sizeof(State));  // poison what no field assignment reaches
  *copy = *f.state;
  copy->region[5].stretch_w.x = 1;            // slot 5 is empty
  copy->point[kMaxToolPoints - 1].gap_m = 1;  // beyond n_tool_point
  EXPECT_EQ(hash_state(f.model, *f.state), hash_state(f.model, *copy));
  EXPECT_EQ(first_difference(f.model, *f.state, *copy), nullptr);
}

struct Change {
  const char* field;
  void (*apply)(State&);
};

TEST(StateHash, SeesAndNamesEachLiveField) {
  const Change changes[] = {
      {"tick", [](State& s) { s.tick += 1; }},
      {"device_w", [](State& s) { s.device_previous_w.position_m.z = 1e-300; }},
      {"tool_w", [](State& s) { s.tool_w.orientation.x = 1e-9; }},
      {"contact_stiffness", [](State& s) { s.contact_stiffness[35] = 1; }},
      {"started", [](State& s) { s.rejected_ticks = 1; }},
      {"point.gap_m", [](State& s) { s.point[0].gap_m = -1e-12; }},
      {"point.triangle", [](State& s) { s.point[0].triangle = 2; }},
      {"region.id", [](State& s) { s.region[3].born_tick = 1; }},
      {"region.stretch_w", [](State& s) { s.region[3].stretch_w.y = 1e-12; }},
      {"region.friction", [](State& s) { s.region[3].friction = FrictionMode::kSlip; }},
      {"safety.mode", [](State& s) { s.safety.fault = 1; }},
      {"safety.ramp", [](State& s) { s.safety.ramp = 0.5; }},
      {"safety.last_device_w", [](State& s) { s.safety.last_device_w.torque_Nm.z = 1e-20; }},
  };
  Fixture f;
  for (const Change& change : changes) {
    auto changed = std::make_unique<State>(*f.state);
    change.apply(*changed);
    EXPECT_NE(hash_state(f.model, *f.state), hash_state(f.model, *changed)) << change.field;
    EXPECT_STREQ(first_difference(f.model, *f.state, *changed), change.field);
  }
}

TEST(Record, KeepsLiveRegionsAndZeroesTheRest) {
  Fixture f;
  f.state->tick = 42;
  f.state->region[3].wrench_w.force_N = {1, 2, 3};
  f.state->region[4].id = 8;
  f.state->region[4].lost_ticks = 2;  // remembered, but not in contact
  TickRecord record;
  std::memset(static_cast<void*>(&record), 0xCD, sizeof(record));
  fill_record(f.model, *f.state, Input{}, Output{}, record);
  EXPECT_EQ(record.tick, 41u);
  EXPECT_EQ(record.state_hash, hash_state(f.model, *f.state));
  ASSERT_EQ(record.region_count, 1);
  EXPECT_EQ(record.region[0].id, 7u);
  EXPECT_EQ(record.region[0].force_w, (Vec3{1, 2, 3}));
  EXPECT_EQ(record.region[1].id, 0u);
}

}  // namespace
}  // namespace palpate::test
