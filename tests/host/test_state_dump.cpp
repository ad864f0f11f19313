#include <gtest/gtest.h>

#include <algorithm>

#include "sim_host/record/state_dump.h"
#include "tests/support/roomy.h"
#include "tests/support/state_difference.h"

namespace palpate {
namespace {

TEST(StateDump, NamesTheFirstFieldThatDiffers) {
  const StatePtr a = test::roomy_state();
  a->region[3].id = 7;
  a->nodal.count = 3;
  EXPECT_EQ(test::first_state_difference(*a, *copy_of(*a)), "");
  const auto named = [&](auto change) {
    const StatePtr b = copy_of(*a);
    change(*b);
    return test::first_state_difference(*a, *b);
  };
  EXPECT_EQ(named([](State& s) { s.tick += 1; }), "tick");
  EXPECT_EQ(named([](State& s) { s.device_previous_w.position_m.z = 1e-300; }), "device_previous_w");
  EXPECT_EQ(named([](State& s) { s.contact_stiffness[35] = 1; }), "contact_stiffness");
  EXPECT_EQ(named([](State& s) { s.point[1].gap_m = -1e-12; }), "point[1].gap_m");
  EXPECT_EQ(named([](State& s) { s.region[3].friction = FrictionMode::kSlip; }), "region[3].friction");
  EXPECT_EQ(named([](State& s) { s.region[4].id = 1; }), "region[4].id");
  EXPECT_EQ(named([](State& s) { s.safety.last_device_w.torque_Nm.z = 1e-20; }), "safety.last_device_w");
  EXPECT_EQ(named([](State& s) { s.nodal.contact[2].force_w.x = 1; }), "nodal.contact[2].force_w");
  EXPECT_EQ(named([](State& s) { s.articulation.piece_force_tool_N[4].x = 1; }), "articulation.piece_force_tool_N");
}

TEST(StateDump, ListsWhatIsInUse) {
  const StatePtr state = test::roomy_state();
  const auto lines = list_state(*state);
  const auto has = [&](const std::string& name) {
    return std::any_of(lines.begin(), lines.end(), [&](const auto& line) { return line.first == name; });
  };
  EXPECT_TRUE(has("point[0].triangle"));
  EXPECT_TRUE(has("safety.mode"));
  EXPECT_FALSE(has("region[0].id")) << "an empty slot";
  EXPECT_TRUE(has("region[0]")) << "which says so";
  EXPECT_FALSE(has("nodal.contact[0].vertex")) << "beyond the count";
}

}  // namespace
}  // namespace palpate
