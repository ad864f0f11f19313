// The state hash and its field-wise comparison: what replay's verdict rests on.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "rt_core/record.h"
#include "rt_core/state.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

struct Fixture {
  ImageBytes image = tiny_image();
  Model model;
  StatePtr state;
  Fixture() {
    EXPECT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
    state = make_state(model);
    state->region[3].id = 7;  // one live region, so that its fields count
  }
};

TEST(StateHash, IgnoresPaddingAndDeadEntries) {
  Fixture f;
  void* block = new_block(state_bytes(f.model));
  std::memset(block, 0xCD, state_bytes(f.model));  // poison what no field's assignment reaches
  const StatePtr poisoned(&create_state(f.model, block));
  poisoned->region[3].id = 7;
  EXPECT_EQ(hash_state(*f.state), hash_state(*poisoned));
  poisoned->region[5].stretch_w.x = 1;  // slot 5 is empty
  poisoned->high_water.contacts = 3;    // told to people only
  EXPECT_EQ(hash_state(*f.state), hash_state(*poisoned));
}

struct Change {
  const char* field;
  void (*apply)(State&);
};

TEST(StateHash, SeesEachLiveField) {
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
    const StatePtr changed = copy_of(*f.state);
    change.apply(*changed);
    EXPECT_NE(hash_state(*f.state), hash_state(*changed)) << change.field;
  }
}

// Byte by byte: whatever a table holds, in a scene that has all of it, counts. (A byte of padding does not; the walk
// over the tables says which bytes are values.)
struct ByteFinder {
  static constexpr bool kRealTime = false;
  std::vector<std::pair<std::ptrdiff_t, std::size_t>> found;
  const State* state = nullptr;
  void enter(const char*, std::int32_t) {}
  void leave() {}
  void skip(const char*, std::int32_t) {}
  template <class T>
  void value(const char*, const T& x) {
    found.emplace_back(reinterpret_cast<const char*>(&x) - reinterpret_cast<const char*>(state), sizeof(T));
  }
};

TEST(StateHash, CountsEveryByteOfTheTables) {
  Model model = test::roomiest_model();
  model.sizes.n_tool_point = 2;
  const StatePtr state = make_state(model);
  for (Region& region : state->region) region.id = 1;
  state->nodal.count = 2;
  ByteFinder finder;
  finder.state = state.get();
  state->visit_all(finder);
  const std::uint64_t before = hash_state(*state);
  auto* bytes = reinterpret_cast<unsigned char*>(state.get());
  std::size_t tried = 0;
  for (const auto& [offset, size] : finder.found) {
    for (std::size_t i = 0; i < size; ++i, ++tried) {
      unsigned char& byte = bytes[offset + static_cast<std::ptrdiff_t>(i)];
      byte ^= 0x10;
      // A count or an identity that is changed shows or hides others; that it changes the hash is all that is asked.
      if (state->nodal.count >= 0 && state->nodal.count <= kMaxContacts) {
        ASSERT_NE(hash_state(*state), before) << "offset " << offset;
      }
      byte ^= 0x10;
    }
  }
  EXPECT_GT(tried, 10'000u);
}

TEST(State, IsLaidOutForItsOwnSceneOnly) {
  const Model large = test::roomiest_model();
  Model small = large;
  small.sizes.n_tool_point = 10;
  const StatePtr of_small = make_state(small);
  EXPECT_TRUE(is_laid_out_for(small, *of_small));
  EXPECT_FALSE(is_laid_out_for(large, *of_small));
  EXPECT_LT(of_small->bytes, 64u * 1024);
  // A pool that points elsewhere, as a crafted recording might have it.
  const StatePtr forged = copy_of(*of_small);
  std::swap_ranges(reinterpret_cast<char*>(&forged->point), reinterpret_cast<char*>(&forged->point + 1),
                   reinterpret_cast<char*>(&forged->region));
  EXPECT_FALSE(is_laid_out_for(small, *forged));
}

TEST(State, ACopyOfTheBlockIsWhole) {
  const Model model = test::roomiest_model();
  const StatePtr a = make_state(model);
  a->point[1].gap_m = 3;
  a->nodal.contact[2].vertex = 4;
  a->articulation.motion_tool[5].position_m.x = 6;
  const StatePtr b = copy_of(*a);
  a->point[1].gap_m = 0;
  EXPECT_EQ(b->point[1].gap_m, 3);
  EXPECT_EQ(b->nodal.contact[2].vertex, 4);
  EXPECT_EQ(b->articulation.motion_tool[5].position_m.x, 6);
  reset(*b);
  EXPECT_EQ(hash_state(*b), hash_state(*make_state(model)));
}

TEST(Record, KeepsLiveRegionsAndZeroesTheRest) {
  Fixture f;
  f.state->tick = 42;
  f.state->region[3].wrench_w.force_N = {1, 2, 3};
  f.state->region[4].id = 8;
  f.state->region[4].lost_ticks = 2;  // remembered, but not in contact
  TickRecord record;
  std::memset(static_cast<void*>(&record), 0xCD, sizeof(record));
  fill_record(*f.state, Input{}, Output{}, record);
  EXPECT_EQ(record.tick, 41u);
  EXPECT_EQ(record.state_hash, hash_state(*f.state));
  ASSERT_EQ(record.region_count, 1);
  EXPECT_EQ(record.region[0].id, 7u);
  EXPECT_EQ(record.region[0].force_w, (Vec3{1, 2, 3}));
  EXPECT_EQ(record.region[1].id, 0u);
}

}  // namespace
}  // namespace palpate::test
