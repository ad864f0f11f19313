// The compiler: shipped scenes bake, images open and hold what the scene said, the same scene gives the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include "config/bake/compile.h"
#include "config/bake/opened_image.h"
#include "config/scene/config_error.h"
#include "rt_core/image.h"
#include "tests/config/generated_docs.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_SOURCE_DIR "/config/scenes"))
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path().string());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

const char* kSmall = R"(name = "small"
[body]
shape = "ellipsoid"
triangles = 500
[[tool.piece]]
shape = "sphere"
radius_mm = 8
)";
SceneDesc small(const std::string& more = "") { return parse_scene(kSmall + more, "s.toml"); }

std::string error_of(const std::string& more) {
  return test::refusal_by([&] { compile_scene(small(more)); });
}

// Elastic bodies of more elements than the others': a test of their own, which --fast and sanitizers leave out.
bool is_dear(const std::string& path) {
  return path.ends_with("/hollow_cylinder.toml") || path.ends_with("/heart_compass.toml") ||
         path.ends_with("/half_shell.toml");
}

void expect_bakes_opens_and_fits(const std::string& path) {
  SceneDesc scene = load_scene(path);
  // The build bakes them as they are; elements twice as long take 20 of 62 s.
  if (scene.contact.backend == Backend::kElastic) scene.fem.edge_m *= 2;
  const CompileResult baked = compile_scene(scene);
  const OpenedImage image(baked.bytes);
  EXPECT_EQ(image.result().error, ImageError::kNone) << path << ": " << image.result().field;
  EXPECT_EQ(std::filesystem::path(path).stem().string(), image.model().name);
  EXPECT_EQ(baked.report.warnings, weak_keys(scene)) << path;
  const bool skeleton = scene.contact.backend == Backend::kResponse && scene.skeleton.law != SkeletonLaw::kNone;
  EXPECT_EQ(baked.report.fixed_anchors >= 1, skeleton) << path;
  // At 800 instructions each, inside the worst tick's budget: 60,000 for a scene, 250,000 for a hand.
  EXPECT_LE(baked.report.tool_points, scene.articulation == Articulation::kHand ? 60 : 30) << path;
  EXPECT_GE(scene.path.point.size(), 2u) << path;
  EXPECT_EQ(baked.report.image_bytes, baked.bytes.size());
  EXPECT_THAT(report_text(baked.report), HasSubstr("anchors")) << path;
}

TEST(Compile, ShippedScenesBakeOpenAndFit) {
  const std::vector<std::string> scenes = shipped_scenes();
  ASSERT_GE(scenes.size(), 3u);
  for (const std::string& path : scenes)
    if (!is_dear(path)) expect_bakes_opens_and_fits(path);
}

TEST(Compile, DearShippedScenesBakeOpenAndFit) {
  int baked = 0;
  for (const std::string& path : shipped_scenes()) {
    if (!is_dear(path)) continue;
    expect_bakes_opens_and_fits(path);
    ++baked;
  }
  EXPECT_EQ(baked, 3);
}

TEST(Compile, SameSceneSameBytesWhereverItLies) {
  const std::string path = PALPATE_SOURCE_DIR "/config/scenes/heart_compass_paper.toml";
  std::ifstream stream(path);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::vector<std::byte> first = compile_scene(load_scene(path)).bytes;
  EXPECT_EQ(first, compile_scene(load_scene(path)).bytes);
  EXPECT_EQ(first, compile_scene(parse_scene(text, "/elsewhere/other.toml")).bytes);
}

TEST(Compile, LimitsOfSilenceAreTimesWhateverThePeriod) {
  const auto at = [](const std::string& device) {
    return OpenedImage(compile_scene(small("[device]\n" + device)).bytes);
  };
  const auto limits = [](const OpenedImage& image) {
    const ModelParams& p = image.model().params;
    return std::vector<int>{p.silence_hold_ticks, p.silence_passive_ticks, p.silence_fault_ticks, p.late_ticks_max};
  };
  EXPECT_EQ(limits(at("")), (std::vector<int>{3, 5, 50, 10}));
  EXPECT_EQ(limits(at("period_ms = 0.1\n")), (std::vector<int>{30, 50, 500, 100}));
  EXPECT_EQ(limits(at("period_ms = 10\n")), (std::vector<int>{1, 1, 5, 2}));
  // A tick each where the period is longer than all of them, in order still.
  EXPECT_EQ(limits(at("period_ms = 100\n")), (std::vector<int>{1, 1, 2, 2}));
}

TEST(Compile, EveryParameterArrives) {
  SceneDesc scene = small(R"([body.material]
youngs_modulus_Pa = 2e6
poisson_ratio = 0.47
density_kg_per_m3 = 1200
[skeleton]
law = "paper"
section_radius_mm = 6
[contact]
law = "duffing"
weight = "area"
max_depth_mm = 3
cluster_distance_mm = 7
[friction]
law = "return_map"
tangential = "radial"
k = 2
beta = 0.8
mu_dynamic = 0.3
[shape]
interpolation = "displacement_angle_paper"
tail = "linear"
neighbourhood = "log_c1"
radius_mm = 9
[coupling]
law = "temporal_paper"
[device]
period_ms = 2
force_max_N = 5
torque_max_Nm = 0.1
force_rate_max_N_per_s = 1000
coupling_N_per_m = 500
coupling_Nm_per_rad = 0.2
ramp_in_s = 0.2
ramp_out_s = 0.1
silence_hold_ms = 4
silence_passive_ms = 12
silence_fault_ms = 120
late_max_ms = 14
stall_max_ms = 36
speed_max_m_per_s = 2
turn_max_rad_per_s = 12
)");
  scene.coupling.radius_m = 0.004;  // stated in a file it would have no effect with this law
  const OpenedImage image(compile_scene(scene).bytes);
  ASSERT_EQ(image.result().error, ImageError::kNone) << image.result().field;
  const ModelParams& p = image.model().params;
  EXPECT_EQ(p.contact_weight, ContactWeight::kArea);
  EXPECT_EQ(p.friction_law, FrictionLaw::kReturnMap);
  EXPECT_EQ(p.tangential_law, TangentialLaw::kRadial);
  EXPECT_EQ(p.skeleton_law, SkeletonLaw::kPaper);
  EXPECT_EQ(p.shape_law, ShapeLaw::kDisplacementAnglePaper);
  EXPECT_EQ(p.neighbourhood_law, NeighbourhoodLaw::kLogC1);
  EXPECT_EQ(p.coupling_law, CouplingLaw::kTemporalPaper);
  EXPECT_EQ(p.rbf_tail, RbfTail::kLinear);
  EXPECT_EQ(p.silence_hold_ticks, 2);
  EXPECT_EQ(p.silence_passive_ticks, 6);
  EXPECT_EQ(p.silence_fault_ticks, 60);
  EXPECT_EQ(p.late_ticks_max, 7);
  EXPECT_DOUBLE_EQ(p.stall_max_s, 0.036);
  EXPECT_DOUBLE_EQ(p.period_s, 0.002);
  EXPECT_DOUBLE_EQ(p.k1_N_per_m, 40);
  EXPECT_DOUBLE_EQ(p.k3_N_per_m3, 4e8);
  EXPECT_DOUBLE_EQ(p.max_depth_m, 0.003);
  EXPECT_DOUBLE_EQ(p.friction_k_N, 2);
  EXPECT_DOUBLE_EQ(p.friction_beta, 0.8);
  EXPECT_DOUBLE_EQ(p.friction_mu_dynamic, 0.3);
  EXPECT_DOUBLE_EQ(p.cluster_distance_m, 0.007);
  EXPECT_DOUBLE_EQ(p.youngs_modulus_Pa, 2e6);
  EXPECT_DOUBLE_EQ(p.poisson_ratio, 0.47);
  EXPECT_DOUBLE_EQ(p.far_field_radius_m, 0.004);
  EXPECT_DOUBLE_EQ(p.neighbourhood_radius_m, 0.009);
  EXPECT_NEAR(p.surface_size_m, 0.08, 1e-3);  // no vertex need lie on the axis
  EXPECT_DOUBLE_EQ(p.coupling_N_per_m, 500);
  EXPECT_DOUBLE_EQ(p.coupling_Nm_per_rad, 0.2);
  EXPECT_DOUBLE_EQ(p.force_max_N, 5);
  EXPECT_DOUBLE_EQ(p.torque_max_Nm, 0.1);
  EXPECT_DOUBLE_EQ(p.force_rate_max_N_per_s, 1000);
  EXPECT_DOUBLE_EQ(p.ramp_in_s, 0.2);
  EXPECT_DOUBLE_EQ(p.ramp_out_s, 0.1);
  EXPECT_DOUBLE_EQ(p.speed_max_m_per_s, 2);
  EXPECT_DOUBLE_EQ(p.turn_max_rad_per_s, 12);
  EXPECT_EQ(image.model().sizes.n_rbf, 10);
  EXPECT_EQ(image.model().sizes.n_patch, image.model().sizes.n_vertex);
}

// S = V / sum of lengths: for the 40 x 30 x 25 mm ellipsoid the lengths sum to 190 mm; s = pi r (1 - nu^2) / 2.
TEST(Compile, SectionsShareTheVolume) {
  const CompileResult baked = compile_scene(small("[body.material]\npoisson_ratio = 0.47\n"));
  const OpenedImage image(baked.bytes);
  ASSERT_EQ(image.model().anchor.size(), 6u);
  const double area = baked.report.volume_m3 / 0.190;
  int fixed = 0;
  for (const Anchor& a : image.model().anchor) {
    EXPECT_NEAR(a.section_area_m2, area, 1e-6 * area);
    EXPECT_NEAR(a.section_radius_m, std::sqrt(area / kPi), 1e-6 * a.section_radius_m);
    EXPECT_NEAR(a.section_inertia_m4, kPi / 4 * std::pow(a.section_radius_m, 4), 1e-12 * a.section_inertia_m4);
    EXPECT_NEAR(a.release_length_m, kPi * a.section_radius_m * (1 - 0.47 * 0.47) / 2, 1e-12);
    fixed += a.fixed;
    EXPECT_EQ(a.fixed, a.position_m.y < 1e-9 ? 1 : 0);
  }
  EXPECT_EQ(fixed, 1);
}

// Released beams at 6 mm and nu = 0.47: s = 7.3428445 mm.
TEST(Compile, ReleaseLengthOfASixMillimetreBeam) {
  const OpenedImage image(
      compile_scene(small("[body.material]\npoisson_ratio = 0.47\n[skeleton]\nsection_radius_mm = 6\n")).bytes);
  EXPECT_NEAR(image.model().anchor[0].release_length_m, 7.3428445e-3, 1e-10);
}

TEST(Compile, WeightsAreAreasOverTheReference) {
  const OpenedImage automatic(compile_scene(small()).bytes);
  EXPECT_DOUBLE_EQ(automatic.model().tool_point[0].weight, 1.0);
  const OpenedImage stated(compile_scene(small("[contact]\nreference_area_mm2 = 100\n")).bytes);
  EXPECT_NEAR(stated.model().tool_point[0].weight, 4 * kPi * 64 / 100, 1e-9);
}

TEST(Compile, CouplingIsBoundedByTheDevice) {
  const CompileResult baked = compile_scene(small());
  EXPECT_NEAR(baked.report.bound.value, 2500, 1e-9);
  EXPECT_NEAR(baked.report.coupling_N_per_m, 2000, 1e-9);
  EXPECT_EQ(error_of("[device]\ncoupling_N_per_m = 2500\n"), "accepted");
  EXPECT_THAT(error_of("[device]\ncoupling_N_per_m = 2501\n"),
              AllOf(StartsWith("s.toml:9: device.coupling_N_per_m: 2501 N/m is above"), HasSubstr("2500"),
                    HasSubstr("2b / (T + 2 tau)")));
  EXPECT_THAT(error_of("[device]\ncoupling_Nm_per_rad = 5\n"), HasSubstr("device.coupling_Nm_per_rad"));
  EXPECT_THAT(error_of("[device]\ndamping_Ns_per_m = 0\n"), HasSubstr("the device admits only 0 N/m"));
}

TEST(Compile, ImpossibleCombinationsAreRefused) {
  EXPECT_THAT(
      error_of("[shape]\ninterpolation = \"displacement_angle_paper\"\n[skeleton]\nanchors_min = 0\nanchors_max = 2\n"),
      HasSubstr("needs 3 anchors"));
  EXPECT_THAT(error_of("[shape]\ntail = \"linear\"\n[skeleton]\nanchors_min = 0\nanchors_max = 2\n"),
              HasSubstr("singular"));
  EXPECT_THAT(error_of("[coupling]\nlaw = \"mutual_paper\"\n[skeleton]\nanchors_min = 18\n"),
              AllOf(HasSubstr("skeleton.anchors_max"), HasSubstr("at most 17")));
  EXPECT_THAT(error_of("[coupling]\nlaw = \"mutual_paper\"\n[skeleton]\nlaw = \"circular\"\n"),
              AllOf(HasSubstr("coupling.law"), HasSubstr("straight skeleton.law")));
  EXPECT_THAT(error_of("[contact.duffing]\nmass_kg = 1e6\nbeta0sq_eps = 10\n"), HasSubstr("soften the law"));
}

TEST(Compile, ThePapersPoissonRatioIsReplacedLoudly) {
  const CompileResult baked =
      compile_scene(small("[body.material]\npoisson_ratio = 1.0\nlegacy_paper_material = true\n"));
  EXPECT_THAT(baked.report.warnings, testing::Contains(HasSubstr("0.47 is used")));
  EXPECT_DOUBLE_EQ(OpenedImage(baked.bytes).model().params.poisson_ratio, 0.47);
}

TEST(Compile, WithoutASkeletonThereAreNoAnchors) {
  const OpenedImage image(compile_scene(small("[skeleton]\nlaw = \"none\"\n")).bytes);
  ASSERT_EQ(image.result().error, ImageError::kNone) << image.result().field;
  EXPECT_TRUE(image.model().anchor.empty());
  EXPECT_EQ(image.model().sizes.n_rbf, 0);
}

TEST(Compile, EveryShapeBakes) {
  for (const char* body : {"shape = \"sphere\"", "shape = \"cylinder\"", "shape = \"box\"", "shape = \"heart\"",
                           "shape = \"revolution\"\nprofile_mm = [[20, 0], [30, 20], [12, 50], [20, 70]]"}) {
    const std::string text = std::string("name = \"a\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n[body]\n") +
                             body + "\ntriangles = 2000\n";
    const CompileResult baked = compile_scene(parse_scene(text, "s.toml"));
    EXPECT_EQ(OpenedImage(baked.bytes).result().error, ImageError::kNone) << body;
    EXPECT_GE(baked.report.anchors, 6) << body;
  }
}

TEST(Compile, MeshFilesAreRelativeToTheScene) {
  const auto folder = std::filesystem::temp_directory_path() / "palpate_compile_mesh";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "cube.obj")
      << "v -10 0 -10\nv 10 0 -10\nv 10 20 -10\nv -10 20 -10\nv -10 0 10\nv 10 0 10\nv 10 20 10\nv -10 20 10\n"
         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
  const std::string text =
      "name = \"cube\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n[body]\nshape = \"mesh\"\nmesh = \"";
  const CompileResult baked = compile_scene(parse_scene(text + "cube.obj\"\n", (folder / "scene.toml").string()));
  const OpenedImage image(baked.bytes);
  EXPECT_EQ(image.result().error, ImageError::kNone);
  EXPECT_NEAR(baked.report.volume_m3, 8e-6, 1e-12);
  EXPECT_EQ(image.model().anchor.size(), 8u);
  try {
    compile_scene(parse_scene(text + "none.obj\"\n", (folder / "scene.toml").string()));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("scene.toml:7: body.mesh"), HasSubstr("none.obj: no such mesh file")));
  }
  std::filesystem::remove_all(folder);
}

TEST(SaveImage, WritesWholeFilesOrSaysWhyNot) {
  const auto path = std::filesystem::temp_directory_path() / "palpate_save.pal";
  const std::vector<std::byte> bytes = compile_scene(small()).bytes;
  std::string error;
  ASSERT_TRUE(save_image(path.string(), bytes, error)) << error;
  EXPECT_EQ(std::filesystem::file_size(path), bytes.size());
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
  std::filesystem::remove(path);
  EXPECT_FALSE(save_image("/nonexistent/folder/x.pal", bytes, error));
  EXPECT_THAT(error, AllOf(HasSubstr("/nonexistent/folder/x.pal"), HasSubstr("No such file")));
}

TEST(WriteImage, RefusesArraysOutsideTheFormat) {
  ImageContents contents;
  EXPECT_THROW(write_image(contents), ConfigError);
}

TEST(ImageFormat, DocumentationHoldsTheTables) {
  expect_generated(PALPATE_SOURCE_DIR "/docs/image_format.md", "## Tables", image_markdown());
}

}  // namespace
}  // namespace palpate
