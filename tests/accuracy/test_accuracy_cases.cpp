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
constexpr double kForceLargest = 0.03;

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
    {"block", 0.005, 0.005, 0.0037},            // 0.38, 0.31 % on 2026-11-25, its surface 0.36 % on 2026-11-28
    {"cylinder_side", 0.0064, 0.01, 0.0045},    // 0.63, 0.99, 0.44 % on 2026-11-28
    {"ellipsoid", 0.0075, 0.007, 0.0046},       // 0.75, 0.69, 0.46 % on 2026-11-28
    {"half_shell", 0.0061, 0.0074, 0.0152},     // 0.61, 0.73, 1.52 % on 2026-11-28
    {"hollow_cylinder", 0.0077, 0.0099, 0.01},  // 0.76, 0.98, 0.99 % on 2026-11-28
    {"layer", 0.027, 0.028, 0.0225},            // 2.62, 2.63, 2.2 %
    {"ring", 0.0118, 0.0118, 0.0123, 0.0071},   // 1.17, 1.17, 1.23 %, upright 0.70 % on 2026-11-28
    {"ring_beside", 0.029, 0.0396, 0.0184},     // 2.89, 3.95, 1.84 % on 2026-11-28
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
// tuned to them; the law of 2026-11-25 was made with their errors in view, that of curved compressible bodies of
// 2026-11-28 with those of foam (docs/accuracy.md).
constexpr Kept kKeptBack[] = {
    {"pad", 0.006, 0.006, 0.0148},              // 0.48, 0.48, 1.44 % on 2026-11-25, its surface on 2026-11-26
    {"spheroid", 0.0127, 0.01, 0.0288, 0.011},  // 1.27, 0.99, 2.87 %, upright 1.10 % on 2026-11-28
    {"torus", 0.0177, 0.0163, 0.027},           // 1.76, 1.62, 2.69 % on 2026-11-28
    {"tube", 0.0185, 0.0112, 0.023},            // 1.84, 1.11, 2.29 % on 2026-11-28
    {"dome", 0.0216, 0.0175, 0.02},             // 2.15, 1.74, 2.00 % on 2026-11-28
    {"box", 0.0266, 0.0156, 0.018},             // 2.65, 1.55, 1.79 % on 2026-11-28
    {"triaxial", 0.0193, 0.0211, 0.0093},       // 1.92, 2.10, 0.92 % on 2026-11-28
    {"foam_ball", 0.02, 0.0197, 0.0254},        // 1.99, 1.96, 2.54 % on 2026-11-28
    {"foam_rod", 0.0266, 0.0273, 0.0099},       // 2.65, 2.72, 0.98 % on 2026-11-28
};

// Cases that were solved after the law of 2026-11-25 was made, slab and loaf after the drawn fields of 2026-11-26, too;
// as found, above the 3 % or not. Two are no longer blind, and stay here because they are above it: foam_dome, 5.99 %
// off until the law's walls were changed with it in view, and foam_saddle, whose force is 2.6 % off at the deepest and
// stands along the tube with 1.2 N of 25 where elements have 0.4. So do three presses half a radius or less from sharp
// edges: edge was solved before the law of edges was made (35 % off until then), rim and corner after it (12.7 and 12.2
// until then, 12.0 and 10.0 when they were solved), and which nodes are sampled there was chosen with all three in
// view.
constexpr Kept kBlind[] = {
    {"foam_saddle", 0.0413, 0.0277, 0.0227},  // 4.12, 2.77, 2.27 % on 2026-11-28
    {"foam_egg", 0.0099, 0.0074, 0.0089},     // 0.99, 0.74, 0.89 % on 2026-11-28
    {"foam_tube", 0.0123, 0.012, 0.0128},     // 1.22, 1.19, 1.27 % on 2026-11-28
    {"foam_dome", 0.0311, 0.0334, 0.028},     // 3.10, 3.33, 2.79 % on 2026-11-28; blind 5.99 %
    {"lentil", 0.0121, 0.0114, 0.0102},       // 1.20, 1.14, 1.01 % on 2026-11-28
    {"disc", 0.011, 0.013, 0.0152},           // 0.98, 1.20, 1.48 %
    {"small_torus", 0.0146, 0.018, 0.0269},   // 1.46, 1.80, 2.68 % on 2026-11-28
    {"slab", 0.008, 0.007, 0.0098},           // 0.73, 0.63, 0.97 % on 2026-11-28
    {"loaf", 0.0109, 0.0099, 0.0045},         // 1.08, 0.99, 0.44 % on 2026-11-28
    {"edge", 0.0429, 0.02, 0.105},            // 4.28, 1.99, 10.5 % on 2026-11-28
    {"rim", 0.0825, 0.0779, 0.111},           // 8.24, 7.78, 11.1 % on 2026-11-28
    {"corner", 0.0807, 0.0644, 0.0851},       // 8.06, 6.43, 8.50 % on 2026-11-28
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
