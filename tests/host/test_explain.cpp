// `palpate explain`, and that every shipped scene states what its ticks may cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "config/scene/scene.h"
#include "sim_host/bake/data_readers.h"
#include "sim_host/bake/explain.h"
#include "sim_host/bake/scene_model.h"
#include "sim_host/status_text.h"

namespace palpate {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string explained(const std::string& scene, const SceneOverlays& overlays = {}) {
  const SceneModel model(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/" + scene + ".toml", overlays);
  return explain(model.model(), model.scene()->budget_instructions);
}

TEST(Explain, NamesStagesDataReadersMemoryAndBudget) {
  SceneOverlays coupled;
  coupled.setting = {"coupling.law=coupled"};
  const std::string text = explained("heart_compass_paper", coupled);
  for (std::int32_t i = 0; i < kStageCount; ++i) EXPECT_THAT(text, HasSubstr(stage_name(static_cast<Stage>(i))));
  EXPECT_THAT(text, HasSubstr("tool points with springs"));
  EXPECT_THAT(text, HasSubstr("nothing: the tool is rigid"));
  EXPECT_THAT(text, HasSubstr("host: sim_host/view/anchors.cpp"));
  EXPECT_THAT(text, HasSubstr("instructions for the worst tick"));
  EXPECT_THAT(text, Not(HasSubstr("compliance_f64")));  // holds nothing
  EXPECT_THAT(text, Not(HasSubstr("a skeleton of")));
  EXPECT_THAT(explained("heart_compass_paper"), HasSubstr("a skeleton of"));  // its coupling is temporal
}

TEST(Explain, KnowsTheMethods) {
  EXPECT_THAT(explained("tools_on_layer"), HasSubstr("whole tips"));
  EXPECT_THAT(explained("grasp_cylinder_2"), HasSubstr("21 joints"));
}

TEST(Explain, SaysWhenNoBudgetIsStated) {
  const SceneModel model(std::string(PALPATE_SOURCE_DIR) + "/config/scenes/tools_on_layer.toml");
  EXPECT_THAT(explain(model.model(), 0), HasSubstr("none stated"));
}

TEST(DataReaders, NameArraysAndParametersOnce) {
  std::set<std::string> known, listed;
#define PALPATE_ENTRY(type, name, ...) known.insert(#name);
  PALPATE_MODEL_ARRAYS(PALPATE_ENTRY)
  PALPATE_MODEL_PARAMS(PALPATE_ENTRY)
#undef PALPATE_ENTRY
  for (const DataReader& r : kDataReaders) {
    EXPECT_TRUE(known.count(r.name) == 1) << r.name;
    EXPECT_TRUE(listed.insert(r.name).second) << r.name << " is listed twice";
  }
}

TEST(Budget, EveryShippedSceneStatesOne) {
  int scenes = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::string(PALPATE_SOURCE_DIR) + "/config/scenes")) {
    if (file.path().extension() != ".toml") continue;
    scenes += 1;
    EXPECT_GT(load_scene(file.path().string()).budget_instructions, 0) << file.path();
  }
  EXPECT_GE(scenes, 16);
}

}  // namespace
}  // namespace palpate
