// Check presses of the baker: their reference, what they change in the image, and what they say.
#include <gtest/gtest.h>

#include <cmath>

#include "config/bake/elastic_check.h"
#include "config/bake/elastic_mesh.h"
#include "config/bake/image_rules.h"
#include "config/parallel.h"
#include "config/scene/config_error.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

std::string with_checks(std::string scene, const std::string& keys) {
  const std::string table = "[body.elastic]\n";
  return scene.insert(scene.find(table) + table.size(), keys);
}

// The arch of the tick's tests, whose finer reference is known: a quarter in H27, 5175 nodes, 1.3 mm at the contact.
class CheckedArch : public testing::Test {
 protected:
  static constexpr const char* kKeys = "check_presses = 1\ncheck_error = 0.001\nlinear_modes = 4\n";
  static const BakedScene& scene() {
    static const BakedScene baked(with_checks(elastic_scene(arch(10), 35, 9, 15, 2), kKeys));
    return baked;
  }
};

TEST_F(CheckedArch, ReferenceIsThatOfFinerElements) {
  const SceneDesc desc = parse_scene(elastic_scene(arch(10), 35, 9, 15, 2), "test.toml");
  const ImageContents image = contents_of(scene().model());
  std::vector<std::string> warnings;
  const TetMesh mesh = make_elastic_mesh(desc, image, warnings);
  CheckPress press{{0, 0.07, 0}, {0, 1, 0}, 0.015, {1e-3, 2e-3, 4e-3}, false, {}};
  press_elements(desc, image, mesh, press);
  constexpr double kFine_N[] = {8.2184, 18.9725};  // the third is beyond what the device renders, three times 8.5 N
  ASSERT_EQ(press.reference_N.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    RecordProperty("error_" + std::to_string(i), std::to_string(100 * (press.reference_N[i] / kFine_N[i] - 1)) + " %");
    // Elements of 9 mm away from the contact, as the baker has them.
    EXPECT_NEAR(press.reference_N[i] / kFine_N[i], 1, 0.02);
  }
}

TEST_F(CheckedArch, SaysWhereItPressedAndThatATargetIsMissed) {
  const ElasticReport& report = scene().report.elastic;
  ASSERT_EQ(report.check.size(), 1u);
  const ElasticReport::Check& check = report.check[0];
  EXPECT_NEAR(norm(check.place_m - Vec3{0, 0.07, 0}), 0, 0.02);  // farthest from what is held, away from the ends
  EXPECT_GT(check.depth_m, 1e-3);
  EXPECT_LT(std::abs(check.force_N / check.reference_N - 1), 0.1);
  EXPECT_GE(check.worst_error, std::abs(check.force_N / check.reference_N - 1) - 1e-12);
  ASSERT_EQ(scene().report.warnings.size(), 1u);
  EXPECT_NE(scene().report.warnings[0].find("body.elastic.check_presses"), std::string::npos);
  EXPECT_NE(scene().report.warnings[0].find("above body.elastic.check_error of 0.1 %"), std::string::npos);
  EXPECT_NE(report_text(scene().report).find("ball of 15 mm at"), std::string::npos);
}

// The range in the image is that of the presses: no deeper one is taken for checked.
TEST_F(CheckedArch, TickSaysWhatWasNotChecked) {
  const ElasticReport::Check& check = scene().report.elastic.check[0];
  const Vec3 top = check.place_m + Vec3{0, 0.015, 0};
  Bench bench(scene().model());
  move_to(bench, top, top - Vec3{0, check.depth_m, 0}, 5e-5);
  EXPECT_EQ(bench.output.status & Status::kDepthBeyondRange, 0u);
  move_to(bench, top - Vec3{0, check.depth_m, 0}, top - Vec3{0, 2 * check.depth_m, 0}, 5e-5);
  EXPECT_NE(bench.output.status & Status::kDepthBeyondRange, 0u);
}

TEST(ElasticCheck, PiecesAreDoneOnceByHoweverManyThreads) {
  for (const unsigned jobs : {0U, 1U, 3U, 50U}) {
    std::vector<int> done(20);
    for_each_piece(done.size(), jobs, [&](std::size_t i) { ++done[i]; });
    EXPECT_EQ(done, std::vector<int>(20, 1)) << jobs;
    try {
      for_each_piece(done.size(), jobs, [&](std::size_t i) {
        ++done[i];
        if (i % 7 == 3) throw ConfigError(std::to_string(i));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const ConfigError& error) {
      EXPECT_STREQ(error.what(), "3");
    }
    EXPECT_EQ(done, std::vector<int>(20, 2)) << jobs;
  }
}

TEST(ElasticCheck, OneThreadAndThreeMakeTheSameImage) {
  const SceneDesc scene = parse_scene(elastic_scene(arch(10), 35, 9, 15, 2), "test.toml");
  EXPECT_TRUE(compile_scene(scene, {{}, 1}).bytes == compile_scene(scene, {{}, 3}).bytes);
}

// A cup of 50,458 nodes takes 2.7e10 multiplications a factor, and 175 and 117 s a press (2026-11-28).
TEST(ElasticCheck, PressesOfLargeBodiesAreFewerUnlessStated) {
  EXPECT_EQ(affordable_presses(5, 1e9), 5);
  EXPECT_EQ(affordable_presses(5, 2.7e10), 4);
  EXPECT_EQ(affordable_presses(5, 2e11), 0);
  EXPECT_EQ(affordable_presses(0, 1e9), 0);
}

TEST(ElasticCheck, KeysWithoutPressesAreRefused) {
  const std::string scene = elastic_scene(arch(10), 35, 9, 15, 2);
  EXPECT_THROW(parse_scene(with_checks(scene, "check_error = 0.02\n"), "test.toml"), ConfigError);
  EXPECT_NO_THROW(parse_scene(with_checks(scene, "check_presses = 3\ncheck_error = 0.02\n"), "test.toml"));
}

}  // namespace
}  // namespace palpate::test
