// Fault scripts: what is read, and what is refused with which words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/device/fault_script.h"

namespace palpate {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& text) {
  std::vector<FaultLine> lines;
  std::string error;
  return parse_fault_script(text, lines, error) ? "accepted" : error;
}

TEST(FaultScript, ReadsKindsValuesAndCommentsInOrderOfTime) {
  std::vector<FaultLine> lines;
  std::string error;
  ASSERT_TRUE(
      parse_fault_script("# a bad day\n3 jump -2.5\n\n  1.5 lose 20 # many\n1.5 bus-off\r\n2 silence\n", lines, error))
      << error;
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0].fault, DeviceFault::kLose);
  EXPECT_EQ(lines[0].value, 20);
  EXPECT_EQ(lines[1].fault, DeviceFault::kBusOff);
  EXPECT_EQ(lines[2].value, 0.1);  // the table's
  EXPECT_EQ(lines[3].fault, DeviceFault::kJump);
  EXPECT_EQ(lines[3].at_s, 3);
  EXPECT_EQ(lines[3].value, -2.5);
}

TEST(FaultScript, RefusesWithLineAndRange) {
  EXPECT_THAT(refusal("1 lose 2\nsoon lose"), HasSubstr("line 2: 'soon' is not a time"));
  EXPECT_THAT(refusal("-1 lose"), HasSubstr("0 to 1e+06"));
  EXPECT_THAT(refusal("nan lose"), HasSubstr("not a time"));
  EXPECT_THAT(refusal("1 forget"), HasSubstr("no fault 'forget'; known are lose, duplicate"));
  EXPECT_THAT(refusal("1"), HasSubstr("no fault ''"));
  EXPECT_THAT(refusal("1 delay 31"), HasSubstr("delay: '31' is not a number in the range 1 to 30"));
  EXPECT_THAT(refusal("1 lose 2x"), HasSubstr("'2x'"));
  EXPECT_THAT(refusal("1 bus-off 3"), HasSubstr("takes no value"));
  EXPECT_THAT(refusal("1 lose 2 3"), HasSubstr("one word too many"));
}

TEST(FaultScript, HelpNamesEveryKind) {
  EXPECT_THAT(fault_script_help(), HasSubstr("silence"));
  EXPECT_THAT(fault_script_help(), HasSubstr("emergency stop"));
}

}  // namespace
}  // namespace palpate
