// Frame times against the figures of the literature, and refusals.
#include <gtest/gtest.h>

#include "hal/bus/bus_budget.h"

namespace palpate {
namespace {

TEST(BusBudget, ClassicFramesMatchTheWorstCaseFormula) {
  for (int s = 0; s <= 8; ++s) {
    EXPECT_EQ(classic_bits(s, false), 55 + 10 * s);
    EXPECT_EQ(classic_bits(s, true), 80 + 10 * s);
  }
}

TEST(BusBudget, FdFramesMatchTheTable) {
  const BusRate rate{1e6, 5e6};
  const int bytes[] = {8, 12, 16, 20, 24, 32, 48, 64};
  const double us[] = {56.6, 64.6, 72.6, 81.6, 89.6, 105.6, 137.6, 169.6};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(fd_us(bytes[i], false, rate), us[i], 1e-9);
  EXPECT_EQ(fd_nominal_bits(false) + fd_data_bits(8, false), 147);  // as the kernel's can_frame_bits counts
  EXPECT_EQ(fd_nominal_bits(false) + fd_data_bits(64, false), 712);
  EXPECT_NEAR(fd_us(64, false, {1e6, 8e6}), 118.75, 1e-9);
  EXPECT_NEAR(fd_us(64, false, {1e6, 2e6}), 373.0, 1e-9);
  EXPECT_NEAR(fd_us(32, true, rate) + fd_us(32, false, rate), 234.4, 1e-9);  // one extended down, one standard up
}

// Schemes at 1 Mbit/s, microseconds per period, without errors and margin.
TEST(BusBudget, KnownSchemesAddUp) {
  BusBudget b;
  b.rate = {1e6, 1e6};
  b.errors = 0;
  b.margin = 0;
  const auto used = [&b](std::vector<BusMessage> messages) {
    b.messages = std::move(messages);
    return check_bus_budget(b);
  };
  const auto per_axis = [](int n) {
    return std::vector<BusMessage>{{"down", 4, false, false, n}, {"up", 6, false, false, n}, {"sync", 0}};
  };
  EXPECT_NEAR(used(per_axis(3)).used_us, 685, 1e-9);
  EXPECT_NEAR(used(per_axis(4)).used_us, 895, 1e-9);
  EXPECT_NEAR(used(per_axis(6)).used_us, 1315, 1e-9);
  EXPECT_FALSE(used(per_axis(6)).fits);
  EXPECT_NEAR(used({{"down", 8, false, false, 2}, {"up", 4, false, false, 6}, {"sync", 0}}).used_us, 895, 1e-9);
  EXPECT_NEAR(used({{"both", 8, false, false, 6}}).used_us, 810, 1e-9);
  EXPECT_FALSE(used({{"both", 8, false, false, 8}}).fits);
}

// 20 B down 81.6 + 32 B up 105.6, 2 nominal bits more each, and one error: 31 + 107.6 us.
TEST(BusBudget, TheProjectsNodeFitsAtOneKilohertz) {
  const BusVerdict fd = check_bus_budget(haptic_node_budget(true));
  EXPECT_NEAR(fd.used_us, 83.6 + 107.6 + 31 + 107.6, 1e-9);
  EXPECT_NEAR(fd.available_us, 900, 1e-9);
  EXPECT_TRUE(fd.fits);
  EXPECT_NEAR(check_bus_budget(haptic_node_budget(true, 1, true)).used_us, 139.6 + 107.6 + 31 + 139.6, 1e-9);
  const BusVerdict classic = check_bus_budget(haptic_node_budget(false));
  EXPECT_NEAR(classic.used_us, 4 * 135 + 31 + 135, 1e-9);
  EXPECT_TRUE(classic.fits);
  const BusVerdict two = check_bus_budget(haptic_node_budget(false, 2));
  EXPECT_FALSE(two.fits);
  EXPECT_NE(two.text.find("REFUSED"), std::string::npos);
  EXPECT_NE(two.text.find("1246.0"), std::string::npos) << two.text;
}

TEST(BusBudget, NonsenseIsRefusedWithItsReason) {
  BusBudget b = haptic_node_budget(true);
  b.rate.nominal_bit_per_s = 2e6;
  EXPECT_NE(check_bus_budget(b).text.find("nominal bit rate"), std::string::npos);
  b = haptic_node_budget(true);
  b.messages[0].bytes = 21;
  EXPECT_NE(check_bus_budget(b).text.find("21 bytes"), std::string::npos);
  b = haptic_node_budget(true);
  b.margin = 1;
  EXPECT_FALSE(check_bus_budget(b).fits);
}

}  // namespace
}  // namespace palpate
