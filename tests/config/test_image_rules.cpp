// What the loader would refuse is refused when the scene is baked, by the scene's own key.
#include <gtest/gtest.h>

#include "config/bake/compile.h"
#include "config/bake/image_rules.h"
#include "config/scene/config_error.h"
#include "rt_core/image_check.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

template <class Scene>
std::string refusal(Scene&& scene) {
  return test::refusal_by([&] { compile_scene(scene()); });
}

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

SceneDesc hand_with(const std::string& law, const std::string& friction) {
  return parse_scene(
      "name = \"s\"\n[body]\nshape = \"cylinder\"\nradius_mm = 22\nheight_mm = 120\n[contact]\nlaw = \"" + law +
          "\"\n[friction]\nlaw = \"" + friction +
          "\"\n[hand]\nfingers = \"two\"\ngrasp_mm = [-30, 68, -28]\ngrasp_deg = [0, -90, 0]\n",
      "s.toml");
}

// A hand's parts are not in the scene's list of pieces: the rule is asked of the pieces as they are in the image.
TEST(ImageRules, HandWithLawsOfWholeTipsIsRefused) {
  for (const char* law : {"tool", "table"}) {
    const std::string text = refusal([&] {
      SceneDesc scene = hand_with("duffing", "mindlin");
      scene.contact.law = std::string(law) == "tool" ? ContactLaw::kTool : ContactLaw::kTable;
      scene.table.file = "presses.csv";
      return scene;
    });
    expect_words(text, {"s.toml", "hand", "a tip has one point", "duffing"});
  }
  EXPECT_EQ(refusal([] { return hand_with("duffing", "mindlin"); }), "accepted");
}

// No key's own range stands for these: the loader's last word, as it is.
TEST(ImageRules, WhatOnlyTheLoaderChecksIsRefusedToo) {
  SceneDesc scene = parse_scene(
      "name = \"s\"\n[body]\nshape = \"sphere\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n", "s.toml");
  scene.friction.beta = 2;  // beyond the schema's range: a scene made in code
  expect_words(refusal([&] { return scene; }), {"s.toml", "friction_beta", "outside its range"});
}

// A period has room for 3 instructions a nanosecond; what may take more is refused with both numbers.
TEST(ImageRules, AWorstTickThatCannotFitItsPeriodIsRefused) {
  const auto scene_of = [](const std::string& period_ms) {
    return parse_scene(
        "name = \"s\"\n[body]\nshape = \"sphere\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n"
        "[device]\nperiod_ms = " +
            period_ms + "\n",
        "s.toml");
  };
  EXPECT_EQ(refusal([&] { return scene_of("1"); }), "accepted");
  expect_words(refusal([&] { return scene_of("0.02"); }),
               {"s.toml", "device.period_ms", "worst tick", "60000", "longer period"});
}

// The rules themselves, over a model.
TEST(ImageRules, MethodsTakeTheirOwnFrictionAndPieces) {
  ToolPiece piece{};
  Model model;
  model.piece = {&piece, 1};
  const auto verdict = [&] { return std::string(check_method(model).field); };
  EXPECT_EQ(verdict(), "");
  model.params.friction_law = FrictionLaw::kCoulomb;
  EXPECT_EQ(verdict(), "friction_law");
  model.params.backend = Backend::kNodal;
  EXPECT_EQ(verdict(), "");
  piece.shape = PieceShape::kHull;
  EXPECT_EQ(verdict(), "piece.hull_faces");
  EXPECT_EQ(check_method(model).error, ImageError::kCombination);
  piece.face_count = 4;
  EXPECT_EQ(verdict(), "");
  model.params.backend = Backend::kResponse;
  model.params.response_law = ResponseLaw::kTip;
  model.params.friction_law = FrictionLaw::kReturnMap;
  EXPECT_EQ(verdict(), "friction_law");
  model.params.friction_law = FrictionLaw::kMindlin;
  EXPECT_EQ(verdict(), "");
  piece.point_count = 2;
  EXPECT_EQ(verdict(), "piece.tip_points");
}

}  // namespace
}  // namespace palpate
