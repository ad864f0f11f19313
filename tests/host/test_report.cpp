// The report's own arithmetic: errors of curves, tables, references, callgrind's file, and the page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "config/scene/config_error.h"
#include "sim_host/report/case_report.h"
#include "sim_host/report/read_path.h"
#include "tests/support/refusal.h"

namespace palpate::test {
namespace {

using testing::HasSubstr;

// F = k d^1.5 over 0 to 4 mm.
ForcePath hertz(double k, int points = 41) {
  ForcePath path;
  for (int i = 0; i < points; ++i) {
    const double d = 4e-3 * i / (points - 1);
    path.x.push_back(d);
    path.force_N.push_back({0, k * std::pow(d, 1.5), 0});
  }
  return path;
}

class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text)
      : path((std::filesystem::temp_directory_path() / ("palpate-report-" + name)).string()) {
    std::ofstream(path) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::string path;
};

TEST(CurveError, ProportionalForceErrsAlikeAboveTheFloor) {
  const CurveError error = curve_error(hertz(1e5), hertz(1.1e5));
  EXPECT_NEAR(error.force_largest, 0.1, 1e-12);
  EXPECT_NEAR(error.stiffness_largest, 0.1, 1e-12);
  EXPECT_NEAR(error.energy, 0.1, 1e-12);
  EXPECT_LT(error.force_rms, 0.1);  // near zero the floor makes it less
  EXPECT_GT(error.force_rms, 0.09);
  EXPECT_NEAR(error.direction_rad, 0, 1e-12);
  EXPECT_LT(error.force_unnoticed, 0.15);  // 10 % is above 7 % but below the floor's reach
  EXPECT_NEAR(error.stiffness_unnoticed, 1, 1e-12);
}

TEST(CurveError, SignOfTheLargestErrorIsThatOfTheForce) {
  EXPECT_NEAR(curve_error(hertz(1e5), hertz(0.5e5)).force_largest, -0.5, 1e-12);
}

TEST(CurveError, TurnedForceIsAnErrorOfDirection) {
  ForcePath turned = hertz(1e5);
  for (Vec3& f : turned.force_N) f = norm(f) * Vec3{std::sin(0.1), std::cos(0.1), 0};
  const CurveError error = curve_error(hertz(1e5), turned);
  EXPECT_NEAR(error.direction_rad, 0.1, 1e-9);
  EXPECT_NEAR(std::abs(error.force_largest), 2 * std::sin(0.05), 1e-9);
}

// The other curve is interpolated where the reference has its points: a fine one of the same law errs by the chord.
TEST(CurveError, OtherSamplingOfTheSameCurveIsNoError) {
  EXPECT_LT(std::abs(curve_error(hertz(1e5, 9), hertz(1e5, 801)).force_largest), 1e-3);
}

TEST(CurveError, CurvesWithoutACommonRangeAreRefused) {
  ForcePath far = hertz(1e5);
  for (double& x : far.x) x += 1;
  EXPECT_THAT(refusal_by<std::exception>([&] { curve_error(hertz(1e5), far); }),
              HasSubstr("fewer than three points in common"));
}

TEST(LargestStep, FindsAJumpAndNotATrend) {
  std::vector<Vec3> force;
  for (int i = 0; i < 100; ++i) force.push_back({0, 1 + 0.01 * i, 0});
  EXPECT_LT(largest_step_N(force), 1e-12);
  for (int i = 50; i < 100; ++i) force[static_cast<std::size_t>(i)].y += 0.5;
  // The jump is in its own trend too, by one of 17 steps.
  EXPECT_NEAR(largest_step_N(force), 0.5 * 16 / 17, 1e-9);
}

TEST(ReadPath, KeepsTheFirstPressOfARecording) {
  const TemporaryFile file("press.csv",
                           "tick,penetration_mm,fx_N,fy_N,fz_N,status\n0,0,0,0,0,-\n1,1,0,2,0,-\n2,2,0,5,0,-\n"
                           "3,1,0,2,0,-\n4,3,0,9,0,-\n");
  const CsvTable table = read_csv_table(file.path);
  const ForcePath path = path_of(table, Abscissa::kDepth, true);
  ASSERT_EQ(path.x.size(), 4u);  // the way back is left out
  EXPECT_NEAR(path.x[3], 3e-3, 1e-12);
  EXPECT_NEAR(path.force_N[3].y, 9, 1e-12);
}

TEST(ReadPath, SaysWhichColumnIsMissing) {
  const TemporaryFile file("bare.csv", "a,b\n1,2\n");
  const CsvTable table = read_csv_table(file.path);
  EXPECT_THAT(refusal_by<std::exception>([&] { path_of(table, Abscissa::kRow, true); }),
              HasSubstr("no column force_N; there are a, b"));
  EXPECT_THAT(refusal_by<std::exception>([&] { common_abscissa(table, table, Abscissa::kDepth); }),
              HasSubstr("no column depth_mm"));
  const TemporaryFile ragged("ragged.csv", "a,b\n1,2\n3\n");
  EXPECT_THAT(refusal_by<std::exception>([&] { read_csv_table(ragged.path); }),
              HasSubstr(":3: 1 cells, the header has 2"));
}

ReferenceCurve reference() {
  ReferenceCurve curve;
  curve.press = {{0.001, 0.06, 0}, {0, 1, 0}, 0.008, 0.003};
  curve.depth_m = {0.001, 0.002, 0.003};
  curve.force_N = {{0, 1, 0}, {0, 3, 0}, {0.1, 6, 0}};
  curve.coarse_N = {1.02, 3, std::nan("")};
  curve.solver = "T10";
  curve.mesh = "7 nodes";
  curve.made = "2026-11-22";
  return curve;
}

TEST(Reference, ComesBackFromItsFile) {
  const TemporaryFile file("reference.csv", "");
  write_reference(file.path, reference());
  const ReferenceCurve back = read_reference(file.path);
  EXPECT_NEAR(norm(back.press.place_m - Vec3{0.001, 0.06, 0}), 0, 1e-12);
  EXPECT_NEAR(back.press.radius_m, 0.008, 1e-12);
  EXPECT_NEAR(back.press.depth_m, 0.003, 1e-12);
  EXPECT_NEAR(back.force_N[2].x, 0.1, 1e-9);
  EXPECT_NEAR(back.uncertainty(), 0.02, 1e-9);  // what the coarse mesh did not reach is no difference
  EXPECT_EQ(back.made, "2026-11-22");
}

TEST(Reference, ItsSurfaceLiesBesideIt) {
  const TemporaryFile file("moved.reference.csv", ""), surface("moved.surface.csv", "");
  ReferenceCurve curve = reference();
  curve.surface = {3e-3, {{{1e-3, 2e-3, 3e-3}, {0, -2.5e-3, 1e-4}, 4e-6}, {{0, 0, 0}, {0, 0, 0}, 1e-6}}};
  write_reference(file.path, curve);
  EXPECT_EQ(reference_surface_path(file.path), surface.path);
  const ReferenceSurface back = read_reference(file.path).surface;
  ASSERT_EQ(back.place.size(), 2u);
  EXPECT_NEAR(back.depth_m, 3e-3, 1e-12);
  EXPECT_NEAR(norm(back.place[0].rest_m - curve.surface.place[0].rest_m), 0, 1e-9);
  EXPECT_NEAR(norm(back.place[0].displacement_m - curve.surface.place[0].displacement_m), 0, 1e-7);
  EXPECT_NEAR(back.place[0].area_m2, 4e-6, 1e-12);
}

TEST(Reference, DepthsThatFallAreRefused) {
  const TemporaryFile file("fall.csv",
                           "# place_mm = 0 0 0\n# normal = 0 1 0\n# radius_mm = 8\ndepth_mm,fx_N,fy_N,fz_N\n"
                           "1,0,1,0\n0.5,0,2,0\n2,0,3,0\n");
  EXPECT_THAT(refusal_by<std::exception>([&] { read_reference(file.path); }),
              HasSubstr("must rise from above 0, and row 2"));
}

TEST(TickCount, ReadsTheWorstTickAndItsStages) {
  const std::string tick = "fn=palpate::tick(palpate::Model const&)\n10 5\ncfn=palpate::sense(int)\ncalls=1 3\n11 ";
  const std::string solve =
      "fn=palpate::contact(palpate::Model const&)\n12 1\ncfn=palpate::(anonymous namespace)::Tips::"
      "solve(int)\ncalls=1 4\n13 ";
  const TemporaryFile file("callgrind", "part: 1\n" + tick + "9\ntotals: 999\npart: 2\n" + tick + "20\n" + solve +
                                            "70\ntotals: 100\npart: 3\n" + tick + "30\n" + solve +
                                            "160\ntotals: 200\npart: 4\ntotals: 0\n");
  const TickCount count = read_callgrind(file.path);
  ASSERT_TRUE(count.counted);
  EXPECT_EQ(count.ticks, 2);  // the first searches the whole surface
  EXPECT_EQ(count.worst, 200);
  EXPECT_EQ(count.mean, 150);
  EXPECT_EQ(count.worst_stage[static_cast<std::size_t>(Stage::kSense)], 30);
  EXPECT_EQ(count.worst_stage[static_cast<std::size_t>(Stage::kSolve)], 160);
}

TEST(Variants, EveryModelOfTheBlockChecksOrSaysWhyNot) {
  const SceneDesc scene = load_scene(PALPATE_SOURCE_DIR "/tests/accuracy/block.toml");
  const PressPlace press{{0, 0.06, 0}, {0, 1, 0}, 6.35e-3, 3e-3};
  for (const ModelVariant& variant : model_variants())
    EXPECT_EQ(refusal_by<std::exception>([&] { scene_of(variant, scene, press); }), "accepted") << variant.name;
  const SceneDesc tip = scene_of(*find_variant("tip"), scene, press);
  EXPECT_EQ(tip.material.youngs_modulus_Pa, scene.material.youngs_modulus_Pa);
  EXPECT_EQ(tip.contact.law, ContactLaw::kTool);
  const SceneDesc ring = load_scene(PALPATE_SOURCE_DIR "/tests/accuracy/ring.toml");
  EXPECT_THAT(refusal_by<std::exception>([&] { scene_of(*find_variant("tip_layer"), ring, press); }),
              HasSubstr("a layer is"));
}

// One case from scene to page: the tip on the layer, whose force is Hertz' times what the reference file says.
TEST(Report, RunsAModelAndKeepsItsFigures) {
  const SceneDesc scene = load_scene(PALPATE_SOURCE_DIR "/tests/accuracy/layer.toml");
  CaseReport report;
  report.name = "layer";
  report.reference = read_reference(PALPATE_SOURCE_DIR "/tests/accuracy/layer.reference.csv");
  report.press = report.reference->press;
  ModelRunOptions options;
  options.count = false;
  options.repeats = 1;
  report.runs.push_back(run_model(*find_variant("tip_layer"), scene, report.press, &*report.reference, options));
  const ModelRun& run = report.runs[0];
  ASSERT_EQ(run.refused, "");
  ASSERT_TRUE(run.error.has_value());
  // Small-strain theory of the layer against large strain; 3.2 % at most on 2026-11-22.
  EXPECT_LT(std::abs(run.error->force_largest), 0.1);
  EXPECT_GT(run.hash, 0u);
  const ModelRun back = run_of_json(run_json(run));
  EXPECT_EQ(back.hash, run.hash);
  EXPECT_EQ(back.error->force_rms, run.error->force_rms);
  EXPECT_EQ(back.path.force_N.size(), run.path.force_N.size());
  const std::string page = report_html({report}, {"2026-11-22", "build", "machine <x>"});
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("machine &lt;x&gt;"));
  EXPECT_THAT(page, HasSubstr("tip_layer"));
  EXPECT_EQ(page.find("src="), std::string::npos);  // self-contained
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_THAT(report_markdown({report}, {}), HasSubstr("| tip_layer |"));
}

}  // namespace
}  // namespace palpate::test
