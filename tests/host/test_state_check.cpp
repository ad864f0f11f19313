// check_state: a state left behind by ticks passes; each index, count, enumeration and number that no tick leaves
// behind is named; and whatever random bytes it accepts, ticks may be given.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "rt_core/tick.h"
#include "sim_host/record/state_check.h"
#include "tests/support/roomy.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

class StateCheck : public testing::Test {
 protected:
  StateCheck() : image_(test::tiny_image()) {
    EXPECT_EQ(open_image(image_.bytes(), model_).error, ImageError::kNone);
    state_ = make_state(model_);
    scratch_ = make_scratch(model_);
  }
  // Presses on the tetrahedron, so that point, region and friction memory are alive.
  void press(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      Input input;
      input.pose_w.position_m = {0.01, 0.005 + 1e-5 * i, 0.012};
      input.commands = i > 2 ? Command::kArm : 0;
      Output output;
      tick(model_, *state_, *scratch_, input, output);
      ASSERT_EQ(check_state(model_, *state_).field, nullptr) << check_state(model_, *state_).field << " tick " << i;
    }
  }
  template <class Spoil>
  std::string fault(Spoil spoil) {
    const StatePtr spoilt = copy_of(*state_);
    spoil(*spoilt);
    const StateFault found = check_state(model_, *spoilt);
    return found.field == nullptr ? "" : found.field;
  }

  test::ImageBytes image_;
  Model model_;
  StatePtr state_;
  ScratchPtr scratch_;
};

TEST_F(StateCheck, EveryStateThatTicksLeaveBehindPasses) {
  EXPECT_EQ(fault([](State&) {}), "");
  press(100);
  ASSERT_NE(state_->region[0].id, 0u) << "the press must touch, or this proves little";
}

TEST_F(StateCheck, EachFieldThatIsIndexedWithIsNamed) {
  press(60);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault([](State& s) { s.point[0].triangle = 4; }), "point.triangle");
  EXPECT_EQ(fault([](State& s) { s.point[0].triangle = -2; }), "point.triangle");
  EXPECT_EQ(fault([](State& s) { s.point[0].region = kMaxRegions; }), "point.region");
  EXPECT_EQ(fault([](State& s) { s.point[0].closest_w.y = kNaN; }), "point");
  EXPECT_EQ(fault([](State& s) { s.region[0].friction = static_cast<FrictionMode>(3); }), "region.friction");
  EXPECT_EQ(fault([](State& s) { s.region[0].lost_ticks = -1; }), "region.lost_ticks");
  EXPECT_EQ(fault([](State& s) { s.region[0].lost_ticks = 51; }), "region.lost_ticks");
  EXPECT_EQ(fault([](State& s) { s.rejected_ticks = kMaxRejectedTicks + 1; }), "rejected_ticks");
  EXPECT_EQ(fault([](State& s) { s.region[0].point_count = -1; }), "region.point_count");
  EXPECT_EQ(fault([](State& s) { s.region[0].stretch_w.z = kNaN; }), "region");
  EXPECT_EQ(fault([](State& s) { s.region[1] = s.region[0]; }), "region.id");
  EXPECT_EQ(fault([](State& s) { s.region[0].id = s.next_region_id; }), "region.id");
  EXPECT_EQ(fault([](State& s) { s.nodal.count = -1; }), "nodal.count");
  EXPECT_EQ(fault([](State& s) { s.nodal.count = kMaxContacts + 1; }), "nodal.count");
  EXPECT_EQ(fault([](State& s) { s.nodal.count = 1; }), "nodal.count") << "this scene has no nodes";
  EXPECT_EQ(fault([](State& s) { s.safety.mode = static_cast<Mode>(6); }), "safety.mode");
  EXPECT_EQ(fault([](State& s) { s.safety.ramp = 1.5; }), "safety.ramp");
  EXPECT_EQ(fault([](State& s) { s.tool_w.orientation = {0, 0, 0, 0}; }), "tool_w");
  EXPECT_EQ(fault([](State& s) { s.device_w.position_m.x = kNaN; }), "device_w");
  EXPECT_EQ(fault([](State& s) { s.safety.last_good_w.torque_Nm.x = kNaN; }), "safety.last_good_w");
  EXPECT_EQ(fault([](State& s) { s.contact_stiffness[35] = kNaN; }), "contact_stiffness");
  EXPECT_EQ(fault([](State& s) { s.articulation.closing[4] = 2; }), "articulation.closing");
}

// Bytes of a live state overwritten at random. What is accepted is ticked: under the address sanitizer this is the
// proof, without it at least nothing may crash and no force may leave its limits.
TEST_F(StateCheck, RandomBytesAreRefusedOrHarmless) {
  press(60);
  std::mt19937_64 random(11);
  int refused = 0, accepted = 0;
  for (int round = 0; round < 4000; ++round) {
    const StatePtr spoilt = copy_of(*state_);
    auto* bytes = reinterpret_cast<unsigned char*>(spoilt.get());
    const int changes = 1 + static_cast<int>(random() % 4);
    // Half of them in the fields, where poses and the layout of the pools are.
    const std::size_t reach = round % 2 == 0 ? sizeof(State) : state_->bytes;
    for (int i = 0; i < changes; ++i) bytes[random() % reach] = static_cast<unsigned char>(random());
    if (check_state(model_, *spoilt).field != nullptr) {
      refused += 1;
      continue;
    }
    accepted += 1;
    for (int i = 0; i < 3; ++i) {
      Input input;
      input.pose_w.position_m = {0.01, 0.005, 0.012};
      Output output;
      tick(model_, *spoilt, *scratch_, input, output);
      ASSERT_LE(norm(output.device_w.force_N), model_.params.force_max_N * (1 + 1e-12));
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(accepted, 100);  // most of the state is of regions and nodes that this scene does not have
}

}  // namespace
}  // namespace palpate
