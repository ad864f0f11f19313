// What a scene means that states no law of contact: E, where it is stated, must be felt.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "config/scene/scene.h"

namespace palpate {
namespace {

using testing::HasSubstr;

const std::string kBody = "name = \"soft\"\n[body]\nshape = \"ellipsoid\"\ntriangles = 500\n";
const std::string kModulus = "[body.material]\nyoungs_modulus_Pa = 8e3\npoisson_ratio = 0.47\n";
const std::string kBall = "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n";
const std::string kBox = "[[tool.piece]]\nshape = \"box\"\nsize_mm = [9, 9, 9]\npoints = 8\n";

SceneDesc scene_of(const std::string& text) { return parse_scene(text, "s.toml"); }

TEST(DefaultModel, AStatedModulusIsThatOfAnElasticBody) {
  const SceneDesc scene = scene_of(kBody + kModulus + kBall);
  EXPECT_EQ(scene.contact.backend, Backend::kElastic);
  EXPECT_EQ(scene.contact.law, ContactLaw::kTool);
  EXPECT_EQ(scene.friction.law, FrictionLaw::kMindlin);
  EXPECT_THAT(scene.default_model, HasSubstr("an elastic body"));
  EXPECT_THAT(weak_keys(scene), testing::IsEmpty());
}

// The error that a hand would not notice, unless the scene says how its error is judged or that it is not.
TEST(DefaultModel, WhereNothingIsSaidOfItsErrorThreePerCentAreWanted) {
  const auto target = [](const std::string& more, const std::string& elastic) {
    return error_target_share(scene_of(more + kBody + kModulus + elastic + kBall));
  };
  EXPECT_DOUBLE_EQ(target("", ""), 0.03);
  EXPECT_DOUBLE_EQ(target("error_target = \"1 %\"\n", ""), 0.01);
  EXPECT_TRUE(is_auto(target("error_target = \"none\"\n", "")));
  for (const char* key : {"soft_modes = 4", "check_presses = 0"})
    EXPECT_TRUE(is_auto(target("", std::string("[body.elastic]\n") + key + "\n"))) << key;
  EXPECT_TRUE(is_auto(target("", "[body.elastic]\ncheck_error = 0.1\n")));
  EXPECT_TRUE(is_auto(target("", "[contact]\nbackend = \"elastic\"\n")));
  EXPECT_TRUE(is_auto(error_target_share(scene_of(kBody + kModulus + kBox))));
}

TEST(DefaultModel, WhatAnElasticBodyDoesNotTakeIsPressedByHertz) {
  const std::string hand = "[gripper]\nclosing_s = 0.2\n" + kBall + "slide_mm = [0, 1, 0]\n";
  for (const std::string& rest :
       {kBox, hand, "[contact]\nweight = \"area\"\n" + kBall, "[skeleton]\nlaw = \"stiffness\"\n" + kBall}) {
    const SceneDesc scene = scene_of(kBody + kModulus + rest);
    EXPECT_EQ(scene.contact.backend, Backend::kResponse) << rest;
    EXPECT_EQ(scene.contact.law, ContactLaw::kHertz) << rest;
    EXPECT_THAT(scene.default_model, HasSubstr("Hertz")) << rest;
    EXPECT_THAT(weak_keys(scene), testing::IsEmpty()) << rest;
  }
}

TEST(DefaultModel, StatedLawsAndScenesWithoutAModulusStayAsTheyAre) {
  for (const std::string& text : {kBody + kBall, kBody + kModulus + "[contact]\nlaw = \"duffing\"\n" + kBall,
                                  kBody + kModulus + "[contact.duffing]\nmass_kg = 0.2\n" + kBall}) {
    const SceneDesc scene = scene_of(text);
    EXPECT_EQ(scene.contact.law, ContactLaw::kDuffing) << text;
    EXPECT_EQ(scene.contact.backend, Backend::kResponse) << text;
    EXPECT_THAT(scene.default_model, testing::IsEmpty()) << text;
  }
}

// Its own mistake is what a scene is told of, whatever would have been taken.
TEST(DefaultModel, AMistakeElsewhereIsSaidAsItIs) {
  try {
    scene_of(kBody + kModulus + "[path]\npoint = 3\n" + kBall);
    FAIL() << "taken";
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("path.point"));
  }
}

}  // namespace
}  // namespace palpate
