// error_target: what it refuses; and that it takes the cheapest model that meets it and says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/bake/compile.h"
#include "config/bake/model_choice.h"
#include "config/scene/config_error.h"
#include "rt_core/certificate.h"
#include "tests/elastic/elastic_tick_scene.h"
#include "tests/support/refusal.h"

namespace palpate::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

const std::string kBlock = R"(error_target = "10 %"
name = "block"
[body]
shape = "cylinder"
axis = "y"
radius_mm = 40
height_mm = 40
triangles = 4000
[body.material]
youngs_modulus_Pa = 2.6e6
poisson_ratio = 0.47
[body.fixed]
base_height_mm = 0
[body.fem]
edge_mm = 12
[body.elastic]
soft_modes = 1
linear_modes = 4
check_presses = 1
[contact]
max_depth_mm = 2
[friction]
law = "none"
[[tool.piece]]
shape = "sphere"
radius_mm = 8
)";

std::string error_of(const std::string& scene) {
  return refusal_by([&] { parse_scene(scene, "s.toml"); });
}
std::string with(const std::string& from, const std::string& to) {
  std::string text = kBlock;
  return text.replace(text.find(from), from.size(), to);
}

TEST(ErrorTarget, IsAPercentageOfModelsThatKnowTheMaterial) {
  EXPECT_EQ(error_of(kBlock), "accepted");
  EXPECT_DOUBLE_EQ(error_target_share(parse_scene(kBlock, "s.toml")), 0.1);
  EXPECT_DOUBLE_EQ(parse_scene(with("10 %", "2.5%"), "s.toml").elastic.check_error, 0.025);
  for (const char* wrong : {"10", "0 %", "200 %", "% 3", "three", "3 %%"})
    EXPECT_THAT(error_of(with("10 %", wrong)), HasSubstr("s.toml:1: error_target")) << wrong;
  EXPECT_THAT(error_of(with("[contact]\n", "[contact]\nlaw = \"tool\"\n")), HasSubstr("states the model"));
  EXPECT_THAT(error_of(with("[contact]\n", "[contact]\nbackend = \"nodal\"\n")), HasSubstr("error_target"));
  EXPECT_EQ(error_of(with("[contact]\n", "[contact]\nbackend = \"elastic\"\n")), "accepted");
  EXPECT_THAT(error_of(with("check_presses = 1", "check_presses = 0")), HasSubstr("judged by presses"));
  EXPECT_THAT(error_of(with("check_presses = 1", "check_presses = 1\ncheck_error = 0.02")), HasSubstr("remove one"));
}

// One press of some ten seconds of processor time. On this block a half space is 11.4 % off and the body's far field in
// series 4.0 % (2026-11-23).
TEST(SlowElasticErrorTarget, TakesTheCheapestThatMeetsIt) {
  const CompileResult taken = compile_scene(parse_scene(kBlock, "s.toml"));
  EXPECT_THAT(taken.report.model, Contains(AllOf(HasSubstr("tip: "), HasSubstr("above the target"))));
  EXPECT_THAT(taken.report.model, Contains(AllOf(HasSubstr("tip_series: "), HasSubstr(": taken"))));
  EXPECT_THAT(taken.report.model.back(), HasSubstr("leaves out: how the far field differs"));
  EXPECT_EQ(taken.report.elastic.nodes, 0);  // no elastic body in it
  const Certificate certificate = certificate_of(taken.bytes);
  ASSERT_EQ(certificate.place.size(), 1u);
  EXPECT_GT(certificate.place[0].reference_N, 10);
  EXPECT_LE(certificate.place[0].worst_error, 0.1);
}

}  // namespace
}  // namespace palpate::test
