// Values of options, as a person types them.
#include <gtest/gtest.h>

#include "sim_host/cli_checks.h"

namespace palpate {
namespace {

double told_s(const std::string& text) {
  CLI::App app;
  double seconds = -1;
  app.add_option("--duration", seconds)->transform(duration_in(0.1, 86400));
  app.parse("--duration " + text);
  return seconds;
}

TEST(OptionChecks, DurationsHaveUnitsOrAreSeconds) {
  EXPECT_EQ(told_s("10"), 10);
  EXPECT_EQ(told_s("0.25"), 0.25);
  EXPECT_EQ(told_s("10s"), 10);
  EXPECT_EQ(told_s("5m"), 300);
  EXPECT_EQ(told_s("1h30m"), 5400);
  for (const char* wrong : {"0", "25h", "-1", "x", "10x", "nan", "inf", "1h30"})
    EXPECT_THROW(told_s(wrong), CLI::ValidationError) << wrong;
}

}  // namespace
}  // namespace palpate
