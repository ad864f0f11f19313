// `palpate certify`: the same seed finds the same; what it says of the dearest tick is what that tick does; the image
// keeps it; and an image that states too little is found out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "config/bake/image_rules.h"
#include "config/bake/image_writer.h"
#include "config/scene/scene.h"
#include "rt_core/stage_cost.h"
#include "rt_core/tick.h"
#include "sim_host/bake/certificate_text.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/certify/page_watch.h"
#include "sim_host/certify/tick_certify.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TickSearchOptions search(std::int64_t ticks, std::uint64_t seed = 1) {
  TickSearchOptions options;
  options.ticks = ticks;
  options.seed = seed;
  return options;
}

class TickCertify : public testing::Test {
 protected:
  Certified certified(std::uint64_t seed = 1) {
    const PathDesc& path = scene_.scene()->path;
    return certify_ticks(scene_.bytes(), scripted_poses(path, 1e-3), path.hand_stiffness_N_per_m, search(3000, seed));
  }
  SceneModel scene_{parse_scene(kBallScene, "ball.toml")};
};

TEST_F(TickCertify, FindsTheSameWithTheSameSeedAndWhatItSaysIsTrue) {
  const Certified one = certified(), again = certified();
  EXPECT_EQ(std::memcmp(one.certificate.stage_instructions, again.certificate.stage_instructions,
                        sizeof one.certificate.stage_instructions),
            0);
  EXPECT_EQ(one.certificate.tick_instructions, again.certificate.tick_instructions);
  EXPECT_GE(one.certificate.ticks, 3000);
  EXPECT_EQ(one.search.beyond_stated, 0);
  EXPECT_LE(one.certificate.tick_instructions, worst_tick_instructions(scene_.model()));
  // The dearest tick, done again.
  const StatePtr state = copy_of(*one.search.dearest.before);
  const ScratchPtr scratch = make_scratch(scene_.model());
  Output output;
  tick(scene_.model(), *state, *scratch, one.search.dearest.input, output);
  EXPECT_EQ(counted_instructions(scratch->work), one.certificate.tick_instructions);
  // It touches some of everything and not all of it.
  EXPECT_GT(one.certificate.image_bytes, 0);
  EXPECT_LE(one.certificate.image_bytes, static_cast<double>(scene_.bytes().size()) + 4096);
  EXPECT_GT(one.certificate.state_bytes, 0);
  EXPECT_GT(one.certificate.scratch_bytes, 0);
  EXPECT_GT(one.times.warm_us, 0);
}

TEST_F(TickCertify, ClimbingFindsDearerTicksThanAnAdversaryAlone) {
  EXPECT_NE(std::string(certified().search.found_by), "");
  const TickSearch few = search_ticks(scene_.model(), {}, search(200)),
                   many = search_ticks(scene_.model(), {}, search(6000));
  EXPECT_GE(many.dearest.instructions, few.dearest.instructions);
}

TEST_F(TickCertify, TheFileKeepsItAndTheSceneIsTheSame) {
  EXPECT_FALSE(is_certified(scene_.bytes()));
  EXPECT_THAT(certificate_text(scene_.bytes()), HasSubstr("not certified: `palpate certify`"));
  const Certified found = certified();
  const std::string path = testing::TempDir() + "palpate_certified.pal";
  std::string error;
  ASSERT_TRUE(save_image(path, with_certificate(scene_.bytes(), found.certificate), error)) << error;
  const ImageFile kept(path);
  EXPECT_EQ(kept.model().scene_hash, scene_.model().scene_hash);
  const Certificate certificate = certificate_of(kept.bytes());
  ASSERT_NE(certificate.tick, nullptr);
  EXPECT_EQ(certificate.tick->tick_instructions, found.certificate.tick_instructions);
  EXPECT_THAT(certificate_text(kept.bytes()), AllOf(HasSubstr("force   not certified"), HasSubstr("tick    dearest ")));
  // Certified again it has one certificate, not two.
  EXPECT_EQ(with_certificate(kept.bytes(), found.certificate).size(), kept.bytes().size());
}

TEST_F(TickCertify, FindsOutAnImageThatStatesTooLittle) {
  ImageContents contents = contents_of(scene_.model());
  const Model model = model_of(contents);
  for (std::int32_t i = 0; i < kStageCount; ++i)
    contents.stage_cost[static_cast<std::size_t>(i)].instructions = least_stage_cost(model, static_cast<Stage>(i));
  EXPECT_GT(search_ticks(model_of(contents), {}, search(1000)).beyond_stated, 0);
}

TEST(PageWatch, CountsThePagesThatACallTouches) {
  const WatchedBlock one(10 * 4096), other(4096);
  const std::array<const WatchedBlock*, 2> blocks = {&one, &other};
  const std::vector<std::size_t> touched = bytes_touched(blocks, [&] {
    one.data()[5] = std::byte{1};
    one.data()[4095] = std::byte{1};
    one.data()[3 * 4096] = one.data()[7 * 4096];
  });
  EXPECT_THAT(touched, testing::ElementsAre(3 * 4096, 0));
}

}  // namespace
}  // namespace palpate
