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
  TickFit fit{1e6, 0.79, 1e-3};
  EXPECT_TRUE(fit.fits());
  EXPECT_THAT(tick_fit_text(fit),
              testing::HasSubstr("at most 1000000 instructions, 790 us on this machine, of 1000 us"));
  fit.instruction_ns = 0.81;
  EXPECT_FALSE(fit.fits());
  EXPECT_THAT(tick_fit_text(fit), testing::HasSubstr("it may take 80 %"));
  fit.instruction_ns = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fit.fits());
}

// Between a hundred and a hundredth of an instruction in a nanosecond: any machine this can run on.
TEST(TickFit, MeasuresAnInstruction) {
  test::ImageBytes image = test::tiny_image();
  Model model;
  ASSERT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
  const double ns = measure_instruction_ns(model);
  EXPECT_GT(ns, 0.01);
  EXPECT_LT(ns, 100);
}

}  // namespace
}  // namespace palpate
