// The list of stages is one: what docs/architecture.md says of them, what the probe is told, and the list in the code.
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

struct Named {
  std::string shown, function;
  bool operator==(const Named&) const = default;
};

std::vector<Named> stages_of_the_code() {
  return {
#define PALPATE_STAGE(name, function, shown, what) {shown, #function},
      PALPATE_STAGES(PALPATE_STAGE)
#undef PALPATE_STAGE
  };
}

// Rows of the table whose head is "| stage | function | ...": first two cells, quotes of code left out.
std::vector<Named> stages_of_the_docs() {
  std::ifstream file(PALPATE_SOURCE_DIR "/docs/architecture.md");
  std::vector<Named> rows;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("| stage | function |", 0) == 0) inside = true;
    if (inside && line.empty()) break;
    if (!inside || line.rfind("| stage", 0) == 0 || line.rfind("|---", 0) == 0) continue;
    const std::size_t bar = line.find(" | `"), end = line.find("` |");
    if (bar == std::string::npos || end == std::string::npos) {
      ADD_FAILURE() << line;
      continue;
    }
    rows.push_back({line.substr(2, bar - 2), line.substr(bar + 4, end - bar - 4)});
  }
  return rows;
}

TEST(Stages, DocsListThemInTheirOrder) {
  const std::vector<Named> docs = stages_of_the_docs(), code = stages_of_the_code();
  ASSERT_EQ(docs.size(), code.size());
  for (std::size_t i = 0; i < code.size(); ++i) {
    EXPECT_EQ(docs[i].shown, code[i].shown) << "row " << i;
    EXPECT_EQ(docs[i].function, code[i].function) << "row " << i;
  }
}

void note(void* context, Stage stage) PALPATE_RT {
  auto& seen = *static_cast<std::int32_t*>(context);
  seen = seen == static_cast<std::int32_t>(stage) ? seen + 1 : -1;  // -1: out of order, for good
}

TEST(Stages, TheProbeIsToldOfEachOnceInOrder) {
  ImageBytes image = tiny_image();
  Model model;
  ASSERT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  std::int32_t seen = 0;
  tick(model, *state, *scratch, {}, output, {note, &seen});
  EXPECT_EQ(seen, kStageCount);
}

// An image that states less for a stage than it takes, yet enough for the loader, shows in the tick that finds it out.
TEST(Stages, WorkBeyondWhatTheImageStatesIsSaid) {
  for (const bool honest : {true, false}) {
    ImageBytes image = tiny_image();
    Model model;
    ASSERT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
    if (!honest) {
      constexpr Stage kStage = Stage::kFindRows;
      image.array<StageCost>(k_stage_cost)[static_cast<int>(kStage)] = {least_stage_cost(model, kStage)};
      image.seal();
      ASSERT_EQ(open_image(image.bytes(), model).error, ImageError::kNone);
    }
    StatePtr state = make_state(model);
    ScratchPtr scratch = make_scratch(model);
    Input input;
    input.drive = Drive::kTool;
    Output output;
    std::uint32_t seen = 0;
    for (int i = 0; i < 100; ++i) {
      input.pose_w.position_m = model.vertex_m[0] * (2 - 0.01 * i);
      tick(model, *state, *scratch, input, output);
      seen |= output.status;
    }
    EXPECT_EQ((seen & Status::kWorkBeyondStated) != 0, !honest);
  }
}

}  // namespace
}  // namespace palpate::test
