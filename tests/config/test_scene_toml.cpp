// The reader: what a scene says arrives in SI; every kind of mistake is refused with file, line, key and what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "config/bake/compile.h"
#include "config/bake/contact_fit.h"
#include "config/scene/config_error.h"
#include "config/scene/scene.h"
#include "config/scene/schema.h"
#include "tests/config/generated_docs.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const char* kSmall = R"(name = "small"
[body]
shape = "sphere"
radius_mm = 30
[[tool.piece]]
shape = "sphere"
radius_mm = 5
)";

std::string error_of(const std::string& text) {
  return test::refusal_by([&] { parse_scene(text, "s.toml"); });
}

TEST(SceneToml, ReadsUnitsAndKeepsDefaults) {
  const SceneDesc scene = parse_scene(std::string(kSmall) +
                                          "[contact]\nmax_depth_mm = 2.5\n[device]\ndelay_ms = 2\n"
                                          "[path]\npoint = [{time_s = 0, position_mm = [1, 2, 3], "
                                          "rotation_deg = [0, 0, 180]}]\n",
                                      "dir/s.toml");
  EXPECT_EQ(scene.name, "small");
  EXPECT_DOUBLE_EQ(scene.body.radius_m, 0.030);
  EXPECT_DOUBLE_EQ(scene.contact.max_depth_m, 0.0025);
  EXPECT_DOUBLE_EQ(scene.device.delay_s, 0.002);
  EXPECT_DOUBLE_EQ(scene.device.force_max_N, DeviceDesc{}.force_max_N);
  ASSERT_EQ(scene.path.point.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.path.point[0].position_m.y, 0.002);
  EXPECT_DOUBLE_EQ(scene.path.point[0].rotation_rad.z, 3.14159265358979323846);
  EXPECT_EQ(scene.source.directory, "dir/");
  EXPECT_EQ(scene.source.where("contact.max_depth_mm"), "dir/s.toml:9: contact.max_depth_mm");
}

TEST(SceneToml, SqueezeIsOneNumberOrOnePerFinger) {
  const auto squeeze_m = [](const std::string& value) {
    return parse_scene("name = \"a\"\n[hand]\nsqueeze_mm = " + value + "\n[body]\nshape = \"sphere\"\n", "s.toml")
        .hand.squeeze_m;
  };
  EXPECT_THAT(squeeze_m("2"), testing::Each(0.002));
  EXPECT_THAT(squeeze_m("[3.5, 3, 1.5, 2, 4]"),
              testing::Pointwise(testing::DoubleEq(), {3.5e-3, 3e-3, 1.5e-3, 2e-3, 4e-3}));
}

struct Mistake {
  const char* name;
  std::string text;
  int line;  // 0: the error has no line
  const char* key;
  const char* says;
};

std::string with(const std::string& lines) { return kSmall + lines; }

// kSmall has 7 lines, so added text starts on line 8.
const Mistake kMistakes[] = {
    {"syntax", with("[contact\n"), 8, "", "not valid TOML"},
    {"syntax_value", with("[contact]\nmax_depth_mm = = 3\n"), 9, "", "not valid TOML"},
    {"duplicate_key", with("[contact]\nmax_depth_mm = 3\nmax_depth_mm = 4\n"), 10, "", "not valid TOML"},
    {"not_text", std::string("name = \"a\"\n\x01\x02"), 2, "", "not valid TOML"},
    {"wrong_type", with("[contact]\nmax_depth_mm = \"deep\"\n"), 9, "contact.max_depth_mm",
     "wrong type; allowed 0.001"},
    {"wrong_type_bool", with("[contact]\nmax_depth_mm = true\n"), 9, "contact.max_depth_mm", "wrong type"},
    {"not_whole", with("[skeleton]\nanchors_min = 6.5\n"), 9, "skeleton.anchors_min", "whole number, 0 to 32"},
    {"not_bool", with("[body.material]\nlegacy_paper_material = 1\n"), 9, "body.material.legacy_paper_material",
     "true or false"},
    {"not_text_value", "name = 5\n[body]\nshape = \"sphere\"\n", 1, "name", "text of 1 to 63 characters"},
    {"text_too_long", "name = \"" + std::string(64, 'x') + "\"\n", 1, "name", "64 bytes"},
    {"unknown_key", with("[contact]\nmax_dpeth_mm = 3\n"), 9, "contact.max_dpeth_mm", "did you mean 'max_depth_mm'?"},
    {"missing_unit", with("[contact]\nmax_depth = 3\n"), 9, "contact.max_depth", "did you mean 'max_depth_mm'?"},
    {"unknown_table", with("[frictoin]\nk = 1\n"), 8, "frictoin", "did you mean 'friction'?"},
    {"unknown_strange", with("[contact]\nzzzzzzzz = 3\n"), 9, "contact.zzzzzzzz", "docs/scene_format.md"},
    {"unknown_in_piece", with("colour = \"red\"\n"), 8, "tool.piece[0].colour", "unknown key"},
    {"too_large", with("[contact]\nmax_depth_mm = 4000\n"), 9, "contact.max_depth_mm",
     "4000 is out of range; allowed 0.001 to 1000 mm"},
    {"too_small", with("[device]\nforce_max_N = -1\n"), 9, "device.force_max_N", "allowed 0.01 to 32.767 N"},
    {"nan", with("[contact]\nmax_depth_mm = nan\n"), 9, "contact.max_depth_mm", "out of range"},
    {"infinite", with("[contact]\nmax_depth_mm = inf\n"), 9, "contact.max_depth_mm", "out of range"},
    {"bad_choice", with("[contact]\nlaw = \"dufing\"\n"), 9, "contact.law", "Did you mean 'duffing'?"},
    {"short_vector", with("position_mm = [1, 2]\n"), 8, "tool.piece[0].position_mm", "[x, y, z]"},
    {"bad_vector_entry", with("position_mm = [1, \"b\", 2]\n"), 8, "tool.piece[0].position_mm", "wrong type"},
    {"table_is_number", "contact = 5\n" + std::string(kSmall), 1, "contact", "write [contact]"},
    {"list_is_table", "name = \"a\"\n[tool.piece]\nshape = \"sphere\"\n", 2, "tool.piece", "[[tool.piece]]"},
    {"list_of_numbers", "name = \"a\"\n[path]\npoint = [1, 2]\n", 3, "path.point[0]", "must be a table"},
    {"missing_name", "[body]\nshape = \"sphere\"\n", 1, "name", "missing"},
    {"missing_shape", "name = \"a\"\n[body]\nradius_mm = 3\n", 2, "body.shape", "missing; add it: one of ellipsoid"},
    {"missing_body", "name = \"a\"\n", 0, "body.shape", "missing"},
    {"missing_time", with("[[path.point]]\nposition_mm = [0, 0, 0]\n"), 8, "path.point[0].time_s", "missing"},
    {"missing_radius", "name = \"a\"\n[body]\nshape = \"sphere\"\n[[tool.piece]]\nshape = \"capsule\"\nlength_mm = 5\n",
     0, "tool.piece[0].radius_mm", "missing"},
    {"no_tool", "name = \"a\"\n[body]\nshape = \"sphere\"\n", 0, "tool.piece", "0 pieces; allowed 1 to 64"},
    {"no_points", with("points = 0\n"), 5, "tool.piece", "0 tool points in all"},
    {"no_effect", with("length_mm = 5\n"), 8, "tool.piece[0].length_mm", "no effect"},
    {"no_effect_body", "name = \"a\"\n[body]\nshape = \"sphere\"\nwidth_mm = 5\n", 4, "body.width_mm", "no effect"},
    {"no_effect_law", with("[contact.hertz]\nfit_depth_mm = 1\n"), 8, "contact.hertz", "no effect unless"},
    {"margin_too_large", with("[[tool.piece]]\nshape = \"cylinder\"\nradius_mm = 5\nlength_mm = 8\nmargin_mm = 4.5\n"),
     12, "tool.piece[1].margin_mm", "allowed up to 4 mm"},
    {"short_capsule", with("[[tool.piece]]\nshape = \"capsule\"\nradius_mm = 5\nlength_mm = 8\n"), 11,
     "tool.piece[1].length_mm", "twice the radius"},
    {"box_points", with("[[tool.piece]]\nshape = \"box\"\nsize_mm = [5, 5, 5]\npoints = 7\n"), 11,
     "tool.piece[1].points", "8 corners"},
    {"sphere_end", with("touches = \"plus_z\"\n"), 8, "tool.piece[0].touches", "no end face"},
    {"too_many_points", with("[[tool.piece]]\nshape = \"capsule\"\nradius_mm = 5\nlength_mm = 80\npoints = 2048\n"), 5,
     "tool.piece", "2049 tool points"},
    {"transient_alone", with("[contact.transient]\namplitude_N_per_m_s = 2\ndecay_per_s = 80\n"), 0,
     "contact.transient.frequency_Hz", "must be stated beside amplitude_N_per_m_s"},
    {"transient_too_fast", with("[contact.transient]\namplitude_N_per_m_s = 2\ndecay_per_s = 80\nfrequency_Hz = 450\n"),
     11, "contact.transient.frequency_Hz", "at most 400"},
    {"anchors_crossed", with("[skeleton]\nanchors_min = 9\nanchors_max = 8\n"), 9, "skeleton.anchors_min",
     "larger than skeleton.anchors_max = 8"},
    {"poisson", with("[body.material]\npoisson_ratio = 0.6\n"), 9, "body.material.poisson_ratio",
     "thermodynamically impossible; allowed -0.999 to 0.5"},
    {"two_frictions", with("[friction]\nk = 10\nmu_ref = 0.5\n"), 9, "friction.k", "keep one"},
    {"squeeze_short", with("[hand]\nsqueeze_mm = [3, 3, 2]\n"), 9, "hand.squeeze_mm",
     "a list of 3; allowed 0.01 to 20 mm, or 5 of them as a list; write one number, or [thumb, index"},
    {"squeeze_finger", with("[hand]\nsqueeze_mm = [3, 3, 2,\n 0, 3]\n"), 10, "hand.squeeze_mm",
     "0 is out of range; allowed 0.01 to 20 mm, or 5 of them as a list"},
    {"squeeze_word", with("[hand]\nsqueeze_mm = \"hard\"\n"), 9, "hand.squeeze_mm",
     "wrong type; allowed 0.01 to 20 mm"},
    {"no_force", with("[contact]\nlaw = \"cubic\"\n"), 0, "contact.cubic", "no force"},
    {"no_duffing", with("[contact.duffing]\nomega0 = 0\nbeta0sq_eps = 0\n"), 8, "contact.duffing", "no force"},
    {"profile_down", "name = \"a\"\n[body]\nshape = \"revolution\"\nprofile_mm = [[5, 9], [5, 0]]\n", 4,
     "body.profile_mm", "bottom to top"},
    {"profile_axis", "name = \"a\"\n[body]\nshape = \"revolution\"\nprofile_mm = [[5, 0], [0, 4], [5, 9]]\n", 4,
     "body.profile_mm", "touches the axis"},
    {"profile_short", "name = \"a\"\n[body]\nshape = \"revolution\"\nprofile_mm = [[5, 0]]\n", 4, "body.profile_mm",
     "at least 2"},
    {"no_mesh", "name = \"a\"\n[body]\nshape = \"mesh\"\n", 0, "body.mesh", "missing"},
    {"late_path", with("[[path.point]]\ntime_s = 1\n"), 9, "path.point[0].time_s", "must be at time 0"},
    {"path_order", with("[path]\npoint = [{time_s = 0}, {time_s = 2},\n {time_s = 2}]\n"), 10, "path.point[2].time_s",
     "times must increase"},
    {"encoder_word", with("[device]\nsmooth_encoder = \"on\"\n"), 9, "device.smooth_encoder",
     "wrong type; allowed \"auto\", true or false"},
    {"held_encoder", with("[device]\nholds = \"body\"\nsmooth_encoder = true\n"), 10, "device.smooth_encoder",
     "held body"},
    {"held_gripper", with("slide_mm = [5, 0, 0]\n[gripper]\n[device]\nholds = \"body\"\n"), 11, "device.holds",
     "a rigid tool only"},
    {"silence", with("[device]\nsilence_fault_ms = 5\n"), 9, "device.silence_fault_ms", "must be above"},
};

class Mistakes : public testing::TestWithParam<Mistake> {};
TEST_P(Mistakes, AreNamed) {
  const Mistake& m = GetParam();
  const std::string place = m.line > 0 ? "s.toml:" + std::to_string(m.line) + ": " : "s.toml: ";
  EXPECT_THAT(error_of(m.text), AllOf(StartsWith(place + m.key), HasSubstr(m.says)));
}
INSTANTIATE_TEST_SUITE_P(All, Mistakes, testing::ValuesIn(kMistakes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(SceneToml, TheSmallSceneIsRight) { EXPECT_EQ(error_of(kSmall), "accepted"); }

// Undefined behaviour of toml++ until 2026-11-22: letters from U+00A1 to U+0499 where a key may begin.
TEST(SceneToml, ALetterWithAnAccentAsAKeyIsRefused) {
  for (const char* text : {"name = \"a\"\n\u00e9 = 1\n", "name = \"a\"\n[b\u048dd]\n"})
    EXPECT_THAT(error_of(text), HasSubstr("s.toml:2")) << text;
}

TEST(SceneToml, MissingFileIsNamed) {
  EXPECT_THROW(
      {
        try {
          load_scene("/nonexistent/x.toml");
        } catch (const ConfigError& e) {
          EXPECT_THAT(e.what(), HasSubstr("/nonexistent/x.toml: no such scene file"));
          throw;
        }
      },
      ConfigError);
}

// Cutting a good scene anywhere never crashes: it is read or refused.
TEST(SceneToml, EveryTruncationIsReadOrRefused) {
  std::ifstream stream(PALPATE_SOURCE_DIR "/config/scenes/ellipsoid_mallet.toml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_GT(text.size(), 1000u);
  for (std::size_t n = 0; n < text.size(); n += 3) {
    try {
      parse_scene(text.substr(0, n), "cut.toml");
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), StartsWith("cut.toml"));
    }
  }
}

// Every default lies in its own range, so that writing a default into a scene changes nothing.
// A profile whose frame magnifies motion twice: the handle's force and work are a device's with half the damping, twice
// the encoder step and twice the torque, whose coupling is half as stiff. What the profile does not give is not
// touched.
TEST(SceneToml, AMagnifiedProfileIsTheDeviceAsTheSceneHasIt) {
  const std::string scene = testing::TempDir() + "magnified.toml", profile = testing::TempDir() + "profile.toml";
  std::ofstream(scene) << kSmall << "[device]\ninertia_kg_m2 = 3e-4\n";
  const auto loaded = [&](const std::string& frame) {
    std::ofstream(profile) << "[device]\ndamping_Ns_per_m = 2\nmass_kg = 1\nfriction_N = 1\nencoder_step_mm = 0.03\n"
                              "torque_max_Nm = 0.1\ndamping_Nms_per_rad = 2e-3\nfriction_Nm = 1\n"
                           << frame;
    SceneOverlays overlays;
    overlays.file = {profile};
    return load_scene(scene, overlays);
  };
  const SceneDesc plain = loaded(""), twice = loaded("[frame]\nscale = 2\n");
  EXPECT_DOUBLE_EQ(twice.device.damping_Ns_per_m, 1);
  EXPECT_DOUBLE_EQ(twice.device.mass_kg, 0.5);
  EXPECT_DOUBLE_EQ(twice.device.friction_N, 1);
  EXPECT_DOUBLE_EQ(twice.device.encoder_step_m, 6e-5);
  EXPECT_DOUBLE_EQ(twice.device.torque_max_Nm, 0.2);
  EXPECT_DOUBLE_EQ(twice.device.inertia_kg_m2, 3e-4);  // the scene's own
  const CompileReport a = compile_scene(plain).report, b = compile_scene(twice).report;
  EXPECT_DOUBLE_EQ(a.coupling_N_per_m, 0.8 * 2 * 2 / (1e-3 + 2 * 5e-4));
  EXPECT_DOUBLE_EQ(b.coupling_N_per_m, 0.5 * a.coupling_N_per_m);
  EXPECT_DOUBLE_EQ(b.coupling_Nm_per_rad, 2 * a.coupling_Nm_per_rad);
  for (const char* scale : {"0", "-1", "101", "nan", "\"2\""})
    EXPECT_THAT(test::refusal_by([&] { loaded("[frame]\nscale = " + std::string(scale) + "\n"); }),
                HasSubstr("profile.toml:10: frame.scale: must be a number in the range 0.01 to 100"));
}

// Left open, the handle is smoothed where the stated friction holds it; what a scene says stands.
TEST(SceneToml, TheEncoderIsSmoothedWhereFrictionHoldsTheHandle) {
  const auto smooths = [](const std::string& device) {
    const Smoothing s = compile_scene(parse_scene(kSmall + ("[device]\n" + device), "s.toml")).report.smoothing;
    const auto law = [](const SmoothingNeed& need) { return need.law == EncoderLaw::kEdges ? "by edges " : ""; };
    return (s.position ? std::string("position ") + law(s.of_position) : "") +
           (s.angle ? std::string("angle ") + law(s.of_angle) : "");
  };
  EXPECT_EQ(smooths(""), "position angle ");  // the shipped device: 0.06 N of 0.059, 0.5 mN m of 0.48
  EXPECT_EQ(smooths("smooth_encoder = \"auto\"\n"), "position angle ");
  EXPECT_EQ(smooths("smooth_encoder = false\n"), "");
  const std::string k2 = "coupling_N_per_m = 2000\n";  // a step is 60 mN
  EXPECT_EQ(smooths("friction_N = 0.055\n" + k2), "position by edges angle ");
  EXPECT_EQ(smooths("friction_N = 0.038\n" + k2), "position by edges angle ");
  EXPECT_EQ(smooths("friction_N = 0.037\n" + k2), "angle ");
  EXPECT_EQ(smooths("friction_N = 0.037\nsmooth_encoder = true\n" + k2), "position by edges angle ");
  EXPECT_EQ(smooths("friction_N = 0.055\nmass_kg = 0.7\n" + k2), "angle ");
  EXPECT_EQ(smooths("friction_Nm = 4.5e-4\ncoupling_Nm_per_rad = 0.8\n"), "position ");
  const std::string stiff_turn = "damping_Nms_per_rad = 0.01\ncoupling_Nm_per_rad = 2.5\n";  // 2.5 mN m a step
  EXPECT_EQ(smooths("friction_Nm = 2.6e-3\n" + stiff_turn), "position angle ");
  EXPECT_EQ(smooths("friction_Nm = 1.6e-3\n" + stiff_turn), "position angle by edges ");
  EXPECT_EQ(smooths("local_kHz = 10\n"), "angle by edges ");  // gripped firmly
  EXPECT_EQ(smooths("encoder_step_mm = 0\n"), "angle ");
  EXPECT_EQ(smooths("holds = \"body\"\n"), "");
  // A device with a loop of its own smooths by itself: the controller is told the step alone.
  const auto params = [](const std::string& device) {
    ModelParams p{};
    p.coupling_N_per_m = 2000, p.coupling_Nm_per_rad = 0.8;
    set_times(parse_scene(kSmall + ("[device]\n" + device), "s.toml"), p);
    return p;
  };
  const auto law = [&](const std::string& device) { return params(device).encoder_law_m; };
  EXPECT_EQ(law("friction_N = 0.055\n"), EncoderLaw::kEdges);
  EXPECT_EQ(law("friction_N = 0.055\nlocal_kHz = 10\n"), EncoderLaw::kMotion);
  EXPECT_EQ(law("friction_N = 0.037\n"), EncoderLaw::kMotion);
  // By its edges it is on its track while what it feels asks for 0.98 K Delta of the friction there is, or more
  // above 2250 N/m; a handle that always is has no such bound.
  EXPECT_NEAR(params("friction_N = 0.055\n").track_below_N_per_m, 0.055 / (0.98 * 3e-5), 1e-6);
  EXPECT_EQ(params("friction_N = 0.07\n").track_below_N_per_m, 0);
  EXPECT_NEAR(track_stiffness_N_per_m(0.2, 3e-5, 0.1), std::pow(0.2 * 153 * std::sqrt(0.1) / 3e-5, 2.0 / 3), 1e-3);
}

TEST(Schema, DefaultsLieInTheirRanges) {
  for (const TableSpec& table : scene_schema()) {
    SceneDesc scene;
    void* fields = table.open(scene);
    for (const KeySpec& key : table.keys) {
      const bool fingers = key.kind == KeyKind::kNumberOrFingers;
      if (!fingers && key.kind != KeyKind::kNumber && key.kind != KeyKind::kNumberOrAuto) continue;
      void* const field = key.field(fields);
      const double value =
          (fingers ? static_cast<FingerNumbers*>(field)->front() : *static_cast<double*>(field)) / key.scale;
      if (is_auto(value)) continue;
      EXPECT_GE(value, key.lowest * (1 - 1e-12)) << table.name << "." << key.key;
      EXPECT_LE(value, key.highest * (1 + 1e-12)) << table.name << "." << key.key;
    }
  }
}

TEST(Schema, DocumentationHoldsItVerbatim) {
  expect_generated(PALPATE_SOURCE_DIR "/docs/scene_format.md", "## Keys", schema_markdown());
}

// k1 = 1e3 m omega0^2, k3 = 1e9 c m beta0^2 eps: the paper's triple gives 40 N/m and 3.0e8 N/m^3.
TEST(ContactFit, DuffingInMillimetresAndNewtons) {
  SceneDesc scene;
  scene.duffing.coefficient = DuffingCoefficient::kPaper;
  ContactCoefficients c = contact_coefficients(scene);
  EXPECT_NEAR(c.k1_N_per_m, 40, 1e-12 * 40);
  EXPECT_NEAR(c.k3_N_per_m3, 3.0e8, 1e-12 * 3e8);
  scene.duffing.coefficient = DuffingCoefficient::kStatic;
  c = contact_coefficients(scene);
  EXPECT_NEAR(c.k3_N_per_m3, 4.0e8, 1e-12 * 4e8);
}

// Sphere of 20 mm, E = 3e6, nu = 0.47, matched at 4 mm: 12 given digits.
TEST(ContactFit, HertzMatchesValueAndSlope) {
  SceneDesc scene;
  scene.contact.law = ContactLaw::kHertz;
  scene.material.poisson_ratio = 0.47;
  scene.hertz = {0.020, 0.004};
  const ContactCoefficients c = contact_coefficients(scene);
  EXPECT_NEAR(c.k1_N_per_m, 34440.785175, 1e-6);
  EXPECT_NEAR(c.k3_N_per_m3, 7.17516357816e8, 1e-3);
  EXPECT_NEAR(c.k1_N_per_m * 0.004 + c.k3_N_per_m3 * 6.4e-8, 183.684187601, 1e-9);
}

// mu_ref = 0.8 at 5 N with beta = 0.75: K = 0.8 * 5^0.25.
TEST(ContactFit, FrictionFromReference) {
  FrictionDesc friction;
  friction.mu_ref = 0.8;
  FrictionCoefficients c = friction_coefficients(friction);
  EXPECT_NEAR(c.k_N, 1.1962790250, 1e-9);
  EXPECT_NEAR(c.mu_dynamic, 0.64, 1e-12);
  friction.mu_ref = kAuto;
  friction.k = 10;
  c = friction_coefficients(friction);
  EXPECT_DOUBLE_EQ(c.k_N, 10);
  EXPECT_NEAR(c.mu_static_ref, 10 / std::pow(5.0, 0.25), 1e-12);
}

TEST(ContactFit, AdmissibleStiffnessIsTheSmallerBound) {
  // 2 * 2.5 / (1e-3 + 2 * 0.5e-3) = 2500; 2 * 0.06 / 3e-5 = 4000.
  StiffnessBound bound = admissible_stiffness(2.5, 0.06, 3e-5, 1e-3, 5e-4);
  EXPECT_NEAR(bound.value, 2500, 1e-9);
  EXPECT_TRUE(bound.by_damping);
  bound = admissible_stiffness(2.5, 0.03, 3e-5, 1e-3, 5e-4);
  EXPECT_NEAR(bound.value, 2000, 1e-9);
  EXPECT_FALSE(bound.by_damping);
  EXPECT_NEAR(admissible_stiffness(2.5, 0, 0, 1e-3, 0).value, 5000, 1e-9);
}

}  // namespace
}  // namespace palpate
