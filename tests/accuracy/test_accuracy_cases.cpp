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

// What was found, rounded up; none may be above 3 %, which is what the elastic body is to keep on a single contact.
struct Kept {
  friend void PrintTo(const Kept& kept, std::ostream* out) { *out << kept.name; }
  const char* name;
  double force_largest, stiffness_rms, surface_rms = 0;  // of the surface where the reference has one
  double upright_rms = 0;                                // less its lean, of cases that stand on a knife's edge
};
constexpr double kForceLargest = 0.0301;

void press_case(const std::string& folder, const Kept& kept) {
  const ModelRun run = elastic_run(folder + kept.name + ".toml");
  ASSERT_TRUE(run.error.has_value());
  record("force_largest", run.error->force_largest);
  record("stiffness_rms", run.error->stiffness_rms);
  EXPECT_LE(std::abs(run.error->force_largest), kept.force_largest) << "at " << 1e3 * run.error->at_largest << " mm";
  EXPECT_LE(run.error->stiffness_rms, kept.stiffness_rms);
  EXPECT_EQ(run.unconverged, 0);
  if (!(kept.surface_rms > 0)) return;
  record("surface_rms", run.surface.rms);
  record("surface_largest", run.surface.largest);
  EXPECT_GT(run.surface.still_rms, 0.05);  // the surface moves: there is something to get wrong
  EXPECT_LE(run.surface.rms, kept.surface_rms);
  record("surface_upright_rms", run.surface.upright_rms);
  EXPECT_LE(run.surface.upright_rms, run.surface.rms);
  if (kept.upright_rms > 0) {
    EXPECT_LE(run.surface.upright_rms, kept.upright_rms);
  }
}

// The layer is pressed to two fifths of its thickness (docs/accuracy.md). References of curved bodies were solved again
// on 2026-11-28, with nodes where their support ends.
constexpr Kept kCases[] = {
    {"block", 0.005, 0.005, 0.0035},              // 0.38, 0.31 % on 2026-11-25, its surface 0.33 % on 2026-11-26
    {"cylinder_side", 0.0085, 0.012, 0.0054},     // 0.83, 1.16, 0.53 % on 2026-11-28
    {"ellipsoid", 0.004, 0.004, 0.0044},          // 0.25, 0.26, 0.41 %
    {"half_shell", 0.0105, 0.0102, 0.0152},       // 1.01, 0.99, 1.49 % on 2026-11-28
    {"hollow_cylinder", 0.0065, 0.0096, 0.0121},  // 0.62, 0.94, 1.18 % on 2026-11-28
    {"layer", 0.027, 0.028, 0.0225},              // 2.62, 2.63, 2.2 %
    {"ring", 0.0195, 0.018, 0.0094, 0.0085},      // 1.93, 1.76, 0.91 %, upright 0.79 % on 2026-11-28
    {"ring_beside", 0.0285, 0.0335, 0.012},       // 2.77, 3.25, 1.17 % on 2026-11-28
};
class AccuracyCases : public testing::TestWithParam<Kept> {};

TEST_P(AccuracyCases, ElasticBodyErrsAsPublished) { press_case(kFolder, GetParam()); }

INSTANTIATE_TEST_SUITE_P(Of, AccuracyCases, testing::ValuesIn(kCases),
                         [](const auto& given) { return std::string(given.param.name); });

TEST(AccuracyFolders, EveryCaseIsGated) {
  std::set<std::string> names;
  for (const Kept& kept : kCases) names.insert(kept.name);
  EXPECT_EQ(cases_in(kFolder), names);
}

// Cases that were chosen and committed before they were solved (kept_back/solve.sh). The first width law was never
// tuned to them; the law of 2026-11-25 was made with their errors in view (docs/accuracy.md).
constexpr Kept kKeptBack[] = {
    {"pad", 0.006, 0.006, 0.0148},                // 0.48, 0.48, 1.44 % on 2026-11-25, its surface on 2026-11-26
    {"spheroid", 0.0142, 0.0102, 0.034, 0.0105},  // 1.39, 1.00, 3.3 %, upright 1.0 % on 2026-11-28
    {"torus", 0.0301, 0.0217, 0.0275},            // 2.998, 2.15, 2.73 % on 2026-11-28
    {"tube", 0.02, 0.011, 0.024},                 // 1.93, 1.05, 2.34 % with the reference of 2026-11-27
    {"dome", 0.0285, 0.0225, 0.02},               // 2.82, 2.23, 1.99 % on 2026-11-28
    {"box", 0.017, 0.018, 0.0148},                // 1.54, 1.64, 1.44 %
    {"triaxial", 0.028, 0.029, 0.0088},           // 2.71, 2.77, 0.87 % on 2026-11-28
};

// Cases that were solved after the law of 2026-11-25 was made, slab and loaf after the drawn fields of 2026-11-26, too;
// as found, above the 3 % or not.
constexpr Kept kBlind[] = {
    {"lentil", 0.054, 0.051, 0.0092},        // 5.33, 5.03, 0.9 % on 2026-11-28
    {"foam_ball", 0.149, 0.141, 0.021},      // 14.8, 14.0, 2.09 % on 2026-11-28: curved and compressible
    {"disc", 0.011, 0.013, 0.0152},          // 0.98, 1.20, 1.48 %
    {"small_torus", 0.0192, 0.012, 0.0268},  // 1.90, 1.18, 2.65 % on 2026-11-28
    {"slab", 0.008, 0.007, 0.0092},          // 0.73, 0.63, 0.9 % on 2026-11-26
    {"loaf", 0.0071, 0.0119, 0.0048},        // 0.69, 1.17, 0.47 % on 2026-11-28
};

class AccuracyKeptBack : public testing::TestWithParam<Kept> {};

TEST_P(AccuracyKeptBack, ElasticBodyErrsAsPublished) { press_case(kFolder + "kept_back/", GetParam()); }

TEST(AccuracyFolders, CasesInViewAreWithinThreePerCent) {
  for (const Kept& kept : kCases) EXPECT_LE(kept.force_largest, kForceLargest) << kept.name;
  for (const Kept& kept : kKeptBack) EXPECT_LE(kept.force_largest, kForceLargest) << kept.name;
}

INSTANTIATE_TEST_SUITE_P(Blind, AccuracyKeptBack, testing::ValuesIn(kBlind),
                         [](const auto& given) { return std::string(given.param.name); });
INSTANTIATE_TEST_SUITE_P(Of, AccuracyKeptBack, testing::ValuesIn(kKeptBack),
                         [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace palpate::test
