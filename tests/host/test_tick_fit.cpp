// Whether a scene's worst tick fits this machine: the judgement, its words, and that the measurement measures.
#include "sim_host/run/tick_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "rt_core/image.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

TEST(TickFit, FourFifthsOfThePeriodAreTheTicks) {
  TickFit fit{1e6, 790'000, 1e-3};
  EXPECT_TRUE(fit.fits());
  EXPECT_THAT(tick_fit_text(fit), testing::HasSubstr("at most 1000000 instructions"));
  EXPECT_THAT(tick_fit_text(fit), testing::HasSubstr("took 790 us here, of 1000 us"));
  fit.slowest_ns = 810'000;
  EXPECT_FALSE(fit.fits());
  EXPECT_THAT(tick_fit_text(fit), testing::HasSubstr("it may take 80 %"));
  fit.slowest_ns = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fit.fits());
}

// More than a tick of nothing and less than a second: any machine this can run on.
TEST(TickFit, MeasuresATick) {
  test::ImageBytes image = test::tiny_image();
  Model model;
  ASSERT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
  const double ns = measure_slowest_tick_ns(model);
  EXPECT_GT(ns, 100);
  EXPECT_LT(ns, 1e9);
}

}  // namespace
}  // namespace palpate
