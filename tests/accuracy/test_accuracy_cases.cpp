// The cases of docs/accuracy.md as a gate: the elastic body, as each case's scene states it, pressed by ticks along its
// reference. The figures are those of `palpate report`, by its own functions.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <ostream>
#include <set>
#include <string>

#include "config/scene/scene.h"
#include "sim_host/report/model_run.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

const std::string kFolder = PALPATE_SOURCE_DIR "/tests/accuracy/";

// Names of the scenes in a folder.
std::set<std::string> cases_in(const std::string& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  return names;
}

ModelRun elastic_run(const std::string& path) {
  const ReferenceCurve reference = read_reference(reference_path(path));
  ModelRunOptions options;
  options.count = false;
  options.repeats = 0;
  ModelRun run = run_model(*find_variant("elastic"), load_scene(path, {}), reference.press, &reference, options);
  EXPECT_EQ(run.refused, "");
  return run;
}

// Into the report (--gtest_output=xml): what the page quotes.
void record(const char* name, double share) { testing::Test::RecordProperty(name, std::to_string(100 * share) + " %"); }

// What the elastic body is to keep on a single contact, over the whole path.
constexpr double kForceLargest = 0.03, kStiffnessRms = 0.10;

class AccuracyCases : public testing::TestWithParam<const char*> {};

TEST_P(AccuracyCases, ElasticBodyIsWithinThreePerCent) {
  const ModelRun run = elastic_run(kFolder + GetParam() + ".toml");
  ASSERT_TRUE(run.error.has_value());
  record("force_largest", run.error->force_largest);
  record("stiffness_rms", run.error->stiffness_rms);
  EXPECT_LE(std::abs(run.error->force_largest), kForceLargest) << "at " << 1e3 * run.error->at_largest << " mm";
  EXPECT_LE(run.error->stiffness_rms, kStiffnessRms);
  EXPECT_EQ(run.unconverged, 0);
}

constexpr const char* kCases[] = {"block",           "cylinder_side", "ellipsoid", "half_shell",
                                  "hollow_cylinder", "layer",         "ring"};
INSTANTIATE_TEST_SUITE_P(Of, AccuracyCases, testing::ValuesIn(kCases),
                         [](const auto& given) { return std::string(given.param); });

TEST(AccuracyFolders, EveryCaseIsGated) {
  EXPECT_EQ(cases_in(kFolder), std::set<std::string>(std::begin(kCases), std::end(kCases)));
}

// Cases that were chosen and committed before they were solved (kept_back/solve.sh). Nothing is tuned to them: the
// bounds are what was found, and some are far above what is wanted (docs/accuracy.md).
struct KeptBack {
  friend void PrintTo(const KeptBack& kept, std::ostream* out) { *out << kept.name; }
  const char* name;
  double force_largest, stiffness_rms, surface_rms;
};
constexpr KeptBack kKeptBack[] = {
    {"pad", 0.18, 0.165, 0.085},        // 17.2, 15.6, 7.7 % on 2026-11-25
    {"spheroid", 0.023, 0.025, 0.052},  // 2.1, 1.9, 4.7 %; 1.9, 1.8, 4.1 % before the places' forces on the modes
    {"torus", 0.175, 0.17, 0.075},      // 16.6, 15.8, 6.8 %
    {"tube", 0.02, 0.013, 0.03},        // 1.6, 1.1, 2.3 %
    {"dome", 0.05, 0.04, 0.03},         // 4.5, 3.2, 2.7 %
    {"box", 0.083, 0.08, 0.053},        // 7.6, 7.3, 4.7 %
    {"triaxial", 0.058, 0.058, 0.033},  // 5.2, 5.1, 3.0 %
};

class AccuracyKeptBack : public testing::TestWithParam<KeptBack> {};

TEST_P(AccuracyKeptBack, ElasticBodyErrsAsPublished) {
  const KeptBack& kept = GetParam();
  const ModelRun run = elastic_run(kFolder + "kept_back/" + kept.name + ".toml");
  ASSERT_TRUE(run.error.has_value());
  record("force_largest", run.error->force_largest);
  record("stiffness_rms", run.error->stiffness_rms);
  record("surface_rms", run.surface.rms);
  record("surface_largest", run.surface.largest);
  EXPECT_LE(std::abs(run.error->force_largest), kept.force_largest);
  EXPECT_LE(run.error->stiffness_rms, kept.stiffness_rms);
  EXPECT_GT(run.surface.still_rms, 0.05);  // the surface moves: there is something to get wrong
  EXPECT_LE(run.surface.rms, kept.surface_rms);
  EXPECT_EQ(run.unconverged, 0);
}

INSTANTIATE_TEST_SUITE_P(Of, AccuracyKeptBack, testing::ValuesIn(kKeptBack),
                         [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace palpate::test
