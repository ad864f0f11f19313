// Keys that would do nothing beside the others are refused with file, line, key, why and what to do; and what is let
// pass does something: another value of it makes another image.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "config/bake/compile.h"
#include "config/scene/config_error.h"
#include "config/scene/scene.h"
#include "config/scene/schema.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// What is added begins on line 8.
const std::string kBall = R"(name = "ball"
[body]
shape = "sphere"
triangles = 1200
[[tool.piece]]
shape = "sphere"
radius_mm = 8
)";

// Tests of this file run side by side.
std::string own_file() { return testing::TempDir() + "palpate_effect_" + std::to_string(getpid()) + ".toml"; }

std::string error_of(const std::string& text) {
  return test::refusal_by([&] { parse_scene(text, "s.toml"); });
}

struct Idle {
  const char* name;
  const char* context;  // where the key does nothing
  const char* key;      // "table.key=value"
  const char* because;
  const char* at_work;  // a context where it does something
};

const char* const kNoSkeleton = "[contact]\nlaw = \"tool\"\n[skeleton]\nlaw = \"none\"\n";
const Idle kIdle[] = {
    {"modulus_of_numbers", "[contact]\nlaw = \"duffing\"\n[skeleton]\nlaw = \"none\"\n[coupling]\nlaw = \"none\"\n",
     "body.material.youngs_modulus_Pa=2e5", "given by numbers of its own", ""},
    {"modulus_of_nothing_carried",
     "[contact]\nlaw = \"duffing\"\n[skeleton]\nlaw = \"none\"\n[coupling]\nlaw = \"none\"\n",
     "body.material.youngs_modulus_Pa=3e5", "given by numbers of its own",
     "[contact]\nlaw = \"duffing\"\n[coupling]\nlaw = \"temporal_paper\"\n"},
    {"modulus_under_a_table", "[contact]\nlaw = \"table\"\n[contact.table]\nfile = \"press.csv\"\n",
     "body.material.youngs_modulus_Pa=2e5", "contact.backend = \"elastic\"",
     "[contact]\nlaw = \"table\"\n[contact.table]\nsource = \"fem\"\n"},
    {"ratio_of_numbers", "[coupling]\nlaw = \"none\"\n[friction]\nlaw = \"none\"\n", "body.material.poisson_ratio=0.3",
     "given by numbers of its own", "[coupling]\nlaw = \"none\"\n[friction]\nlaw = \"mindlin\"\n"},
    {"relaxation_times", "", "body.material.relaxation_s=[1, 2, 3]", "of which nothing relaxes",
     "[body.material]\nrelaxation_share = [0.1, 0.1, 0.1]\n"},
    {"transient_frequency", "", "contact.transient.frequency_Hz=150", "of which nothing rings",
     "[contact.transient]\namplitude_N_per_m_s = 2\nfrequency_Hz = 100\ndecay_per_s = 80\n"},
    {"transient_decay", "", "contact.transient.decay_per_s=40", "of which nothing rings",
     "[contact.transient]\namplitude_N_per_m_s = 2\nfrequency_Hz = 100\ndecay_per_s = 80\n"},
    {"legacy_material", "", "body.material.legacy_paper_material=true", "poisson_ratio that is possible",
     "[body.material]\npoisson_ratio = 1\n"},
    {"supports", kNoSkeleton, "body.fixed.base_height_mm=5", "its law does not know what holds it", ""},
    {"anchors", kNoSkeleton, "skeleton.anchors=mesh", "without a skeleton", ""},
    {"anchors_min", kNoSkeleton, "skeleton.anchors_min=7", "without a skeleton", ""},
    {"anchors_max", kNoSkeleton, "skeleton.anchors_max=7", "without a skeleton", ""},
    {"section", kNoSkeleton, "skeleton.section_radius_mm=3", "without a skeleton", ""},
    {"interpolation", kNoSkeleton, "shape.interpolation=displacement_angle_paper", "without a skeleton", ""},
    {"tail", kNoSkeleton, "shape.tail=linear", "without a skeleton", ""},
    {"dent", "[shape]\nneighbourhood = \"none\"\n", "shape.radius_mm=5", "draws no dent", ""},
    {"clusters", "[contact]\nbackend = \"elastic\"\n[body.material]\npoisson_ratio = 0.45\n",
     "contact.cluster_distance_mm=4", "every tip is a region of its own", ""},
    {"weight", "[contact]\nlaw = \"tool\"\n", "contact.weight=area", "no tool points to weigh", ""},
    {"area", "[contact]\nweight = \"area\"\n[coupling]\nlaw = \"none\"\n", "contact.reference_area_mm2=50",
     "no force is weighed", ""},
    {"far_field", "[coupling]\nlaw = \"none\"\n", "coupling.radius_mm=5", "no far field", ""},
    {"far_field_of_one_tip", "[contact]\nlaw = \"tool\"\n", "coupling.radius_mm=5", "several tips",
     "[contact]\nlaw = \"tool\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\nposition_mm = [40, 0, 0]\n"},
    {"temporal", "[skeleton]\nlaw = \"none\"\n", "coupling.law=temporal_paper", "without a skeleton", ""},
    {"coefficient", "[friction]\nlaw = \"none\"\n", "friction.mu_ref=0.3", "friction.law = \"none\"", ""},
    {"limit", "[friction]\nlaw = \"none\"\n", "friction.k=3", "friction.law = \"none\"", ""},
    {"exponent", "[friction]\nlaw = \"none\"\n", "friction.beta=0.8", "friction.law = \"none\"", ""},
    {"sliding", "[friction]\nlaw = \"none\"\n", "friction.mu_dynamic=0.2", "friction.law = \"none\"", ""},
    {"tangential", "[friction]\nlaw = \"mindlin\"\n", "friction.tangential=radial", "\"return_map\" or \"paper\"", ""},
    {"reference_force", "[friction]\nbeta = 1\n", "friction.reference_force_N=3", "no coefficient depends", ""},
    {"tip_radius",
     "[contact]\nlaw = \"tool\"\n[[tool.piece]]\nshape = \"cone\"\nradius_mm = 8\nlength_mm = 8\ntouches = "
     "\"plus_z\"\n",
     "contact.tip.radius_mm=5", "on cones", "[contact]\nlaw = \"tool\"\n"},
    {"tip_angle", "[contact]\nlaw = \"tool\"\n", "contact.tip.half_angle_deg=40", "without a cone",
     "[contact]\nlaw = \"tool\"\n[[tool.piece]]\nshape = \"cone\"\nradius_mm = 8\nlength_mm = 8\ntouches = "
     "\"plus_z\"\n"},
    {"layer_base", "[contact]\nlaw = \"tool\"\n", "contact.layer.base=slip", "without contact.layer.thickness_mm",
     "[contact]\nlaw = \"tool\"\n[contact.layer]\nthickness_mm = 60\n"},
    {"grip", "", "device.grip_mm=[1, 2, 3]", "where no hand holds the body", "[device]\nholds = \"body\"\n"},
    {"friction_sweeps",
     "[contact]\nbackend = \"nodal\"\n[body.material]\npoisson_ratio = 0.45\n[friction]\nlaw = \"none\"\n",
     "contact.nodal.friction_sweeps=2", "friction.law = \"none\"",
     "[contact]\nbackend = \"nodal\"\n[body.material]\npoisson_ratio = 0.45\n[friction]\nlaw = \"coulomb\"\n"},
};

// The scene, with a cone instead of the ball where the context brings one.
std::string scene_in(const std::string& context) {
  const bool brings = context.find("cone") != std::string::npos;
  return brings ? kBall.substr(0, kBall.find("[[tool")) + context : kBall + context;
}
std::string error_with(const std::string& context, const std::string& setting) {
  const std::string file = own_file();
  std::ofstream(file) << scene_in(context);
  SceneOverlays overlays;
  overlays.setting = {setting};
  return test::refusal_by([&] { load_scene(file, overlays); });
}

class IdleKeys : public testing::TestWithParam<Idle> {};
TEST_P(IdleKeys, AreRefusedAndOthersAreNot) {
  const Idle& idle = GetParam();
  const std::string key = std::string(idle.key).substr(0, std::string(idle.key).find('='));
  ASSERT_EQ(error_with(idle.context, "name=other"), "accepted") << "the context itself";
  const std::string table = key.substr(0, key.rfind('.'));
  EXPECT_THAT(error_with(idle.context, idle.key),
              AllOf(HasSubstr(key == "body.fixed.base_height_mm" ? table : key), HasSubstr(": has no effect "),
                    HasSubstr(idle.because), HasSubstr("; ")));
  EXPECT_EQ(error_with(idle.at_work, idle.key), "accepted");
}
INSTANTIATE_TEST_SUITE_P(All, IdleKeys, testing::ValuesIn(kIdle),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(SceneEffect, NamesFileLineAndKey) {
  EXPECT_THAT(error_of(kBall + "[friction]\nlaw = \"none\"\nmu_ref = 0.3\n"),
              StartsWith("s.toml:10: friction.mu_ref: has no effect"));
  EXPECT_THAT(error_of(kBall + "[[tool.piece]]\nshape = \"cylinder\"\nradius_mm = 8\nlength_mm = 9\npoints = 0\n"
                               "touches = \"plus_z\"\n"),
              StartsWith("s.toml:13: tool.piece[1].touches: has no effect"));
}

// What the file says of friction is no mistake when somebody only tries the scene without.
TEST(SceneEffect, WhatAnOverlayPutsOutOfWorkIsWarnedOf) {
  const std::string file = own_file();
  std::ofstream(file) << kBall + "[friction]\nmu_ref = 0.3\n";
  SceneOverlays overlays;
  overlays.setting = {"friction.law=none"};
  EXPECT_THAT(weak_keys(load_scene(file, overlays)),
              testing::ElementsAre(HasSubstr(":9: friction.mu_ref: has no effect with friction.law = \"none\"")));
  overlays.setting = {"friction.law=none", "friction.beta=0.8"};
  EXPECT_THROW(load_scene(file, overlays), ConfigError);
}

TEST(SceneEffect, AModulusThatNoPressFollowsIsWarnedOf) {
  const std::string modulus = "[body.material]\nyoungs_modulus_Pa = 2e5\n";
  const auto warned = [&](const std::string& more) { return weak_keys(parse_scene(kBall + modulus + more, "s.toml")); };
  EXPECT_THAT(warned("[contact]\nlaw = \"duffing\"\n"),
              testing::ElementsAre(AllOf(StartsWith("s.toml:9: body.material.youngs_modulus_Pa"),
                                         HasSubstr("law = \"duffing\""), HasSubstr("\"elastic\""))));
  EXPECT_THAT(warned("[contact]\nlaw = \"hertz\"\n"), testing::IsEmpty());
  EXPECT_THAT(weak_keys(parse_scene(kBall, "s.toml")), testing::IsEmpty());
}

// Values of the key, in its own unit, of which one at least is not what the context has.
std::vector<std::string> values_of(const KeySpec& key) {
  std::vector<std::string> values;
  for (const char* word : key.choices) values.push_back(word);
  const double low = std::max(key.lowest, 1e-3), high = std::min(key.highest, 1e6);
  if (key.kind == KeyKind::kNumber || key.kind == KeyKind::kNumberOrAuto)
    for (const double share : {0.5, 0.3}) values.push_back(number_text(low * std::pow(high / low, share)));
  if (key.kind == KeyKind::kInteger)
    for (const int step : {4, 9, 700}) values.push_back(std::to_string(static_cast<int>(key.lowest) + step));
  if (key.kind == KeyKind::kBool) values = {"true"};
  if (key.kind == KeyKind::kBoolOrAuto) values = {"true", "false"};
  return values;
}

// What a scene may cost is no part of its image; this ball's six anchors meet any of these bounds.
bool is_met_already(const std::string& key) {
  constexpr const char* kOthers[] = {"budget_instructions",  "body.fixed.region",    "body.fixed.base_height_mm",
                                     "skeleton.anchors_min", "skeleton.anchors_max", "body.triangles",
                                     "contact.backend"};
  return std::ranges::find(kOthers, key) != std::end(kOthers);
}

// Each key alone laid over a context: refused, or the image is another for one of its values.
void expect_every_key_works(const std::string& context) {
  const std::string file = own_file();
  std::ofstream(file) << kBall + context;
  const auto baked = [&](const std::string& setting) {
    SceneOverlays overlays;
    if (!setting.empty()) overlays.setting = {setting};
    try {
      return compile_scene(load_scene(file, overlays)).bytes;
    } catch (const ConfigError&) {
      return std::vector<std::byte>();
    }
  };
  const std::vector<std::byte> plain = baked("");
  ASSERT_FALSE(plain.empty());
  int at_work = 0;
  for (const TableSpec& table : scene_schema()) {
    if (table.count != TableCount::kOne && std::string(table.name) != "body.fixed") continue;
    for (const char* other : {"path", "hand", "gripper", "device"})
      if (std::string(table.name) == other)
        goto next;  // of the hand that tries it, of other tools, of the simulated device
    for (const KeySpec& key : table.keys) {
      const std::string path = std::string(table.name) + (*table.name == 0 ? "" : ".") + key.key;
      if (is_met_already(path)) continue;
      bool accepted = false, differs = false;
      for (const std::string& value : values_of(key)) {
        const std::vector<std::byte> bytes = baked(path + "=" + value);
        accepted |= !bytes.empty();
        differs |= !bytes.empty() && bytes != plain;
        if (differs) break;
      }
      EXPECT_TRUE(differs || !accepted) << path << " is accepted and does nothing in\n" << context;
      at_work += differs ? 1 : 0;
    }
  next:;
  }
  EXPECT_GT(at_work, 12);
}

TEST(SceneEffect, WhatIsAcceptedWorksOnPoints) { expect_every_key_works(""); }
TEST(SceneEffect, WhatIsAcceptedWorksOnTips) { expect_every_key_works("[contact]\nlaw = \"tool\"\n"); }
TEST(SceneEffect, WhatIsAcceptedWorksWithoutExtras) {
  expect_every_key_works(
      "[skeleton]\nlaw = \"none\"\n[friction]\nlaw = \"none\"\n[coupling]\nlaw = \"none\"\n[shape]\nneighbourhood = "
      "\"none\"\n");
}

}  // namespace
}  // namespace palpate
