// What the baker refuses about whole tips and tables: every text names the key, the reason and the remedy.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "config/bake/compile.h"
#include "config/scene/config_error.h"
#include "tests/support/baked_scene.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

struct Parts {
  std::string body = "shape = \"box\"\nsize_mm = [60, 20, 60]\ntriangles = 800\n";
  std::string contact = "law = \"tool\"\n";
  std::string piece = "shape = \"sphere\"\nradius_mm = 6\n";
  std::string friction = "law = \"none\"\n";
  std::string rest = "";
};

std::string refusal(const Parts& p) {
  const std::string text = "name = \"s\"\n[body]\n" + p.body + "[skeleton]\nlaw = \"none\"\n[friction]\n" + p.friction +
                           "[[tool.piece]]\n" + p.piece + "[contact]\n" + p.contact + p.rest;
  return test::refusal_by([&] { compile_scene(parse_scene(text, "s.toml")); });
}

struct Case {
  Parts parts;
  const char* words[3];
};

TEST(TipRefusals, NameKeyReasonAndRemedy) {
  const std::string cap = "shape = \"cylinder\"\nradius_mm = 2\nlength_mm = 10\n";
  const std::string cone = "shape = \"cone\"\nradius_mm = 5\nlength_mm = 5\n";
  const std::string hull = "shape = \"hull\"\nvertices_mm = [[0,0,0], [5,0,0], [0,5,0], [0,0,5]]\nmargin_mm = 1\n";
  const std::string ball = "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 6\nposition_mm = [20, 0, 0]\n";
  const std::string round = "shape = \"ellipsoid\"\nhalf_axes_mm = [40, 30, 25]\ntriangles = 3000\n";
  const std::string tool = "law = \"tool\"\n";
  std::string pairs;
  for (int i = 0; i <= kMaxTipPairs; ++i) pairs += "[[contact.pair]]\npiece_a = 0\npiece_b = 1\n";
  const Case cases[] = {
      {{.piece = hull}, {"tool.piece[0].shape", "has no tip law", "points = 0"}},
      {{.piece = "shape = \"box\"\nsize_mm = [4, 4, 4]\n"},
       {"tool.piece[0].shape", "has no tip law", "sphere, capsule"}},
      {{.piece = cone + "touches = \"minus_z\"\n"}, {"tool.piece[0].touches", "presses with its apex", "plus_z"}},
      {{.piece = cap}, {"tool.piece[0].touches", "presses with one end", "minus_z"}},
      {{.piece = cap + "touches = \"plus_z\"\npoints = 3\n"},
       {"tool.piece[0].points", "a tip has one point", "0 or 1"}},
      {{.friction = "law = \"return_map\"\n"}, {"friction.law", "springs of tool points", "presliding"}},
      {{.rest = "[coupling]\nlaw = \"temporal_paper\"\n"}, {"coupling.law", "cubic springs", "none, coupled"}},
      {{.rest = "[[contact.pair]]\npiece_a = 0\npiece_b = 0\n"},
       {"contact.pair[0].piece_a", "two different", "0 to 0"}},
      {{.rest = pairs + ball}, {"contact.pair", "29 pairs", "up to 28"}},
      {{.contact = tool + "max_depth_mm = 7\n"},
       {"contact.max_depth_mm", "more than the sphere's radius of 6 mm", "lower it"}},
      {{.contact = tool + "[contact.tip]\nbody_radius_1_mm = -5\nbody_radius_2_mm = 0\n"},
       {"contact.tip.body_radius_1_mm", "they conform", "smaller sphere"}},
      {{.body = round}, {"contact.tip.body_radius_1_mm", "has no single curvature", "both principal radii"}},
      {{.contact = tool + "[contact.series]\nc0_mm_per_N = -1\n"},
       {"contact", "unstable at", "lower contact.max_depth_mm"}},
      {{.contact = "law = \"table\"\n"}, {"contact.table.file", "missing", "source = \"fem\""}},
      {{.contact = "law = \"table\"\n[contact.table]\nfile = \"/nonexistent.csv\"\n"},
       {"contact.table.file", "/nonexistent.csv: cannot be read", "path and permissions"}},
      {{.contact = "law = \"cubic\"\n[contact.table]\nfile = \"a.csv\"\n"},
       {"contact.table", "no effect unless contact.law = \"table\"", "remove the table"}},
  };
  for (const Case& one : cases) {
    const std::string text = refusal(one.parts);
    EXPECT_EQ(text.rfind("s.toml:", 0), 0u) << text;
    for (const char* word : one.words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
  }
  EXPECT_EQ(refusal({}), "accepted");
}

// Of two balls, 2 and 8 mm, each law ends where the ball's does or at the depth that a scene has by default.
TEST(TipRefusals, NobodyStatedADepthThatASmallBallCannotHave) {
  const std::string text =
      "name = \"s\"\n[body]\nshape = \"box\"\nsize_mm = [60, 20, 60]\ntriangles = 800\n[skeleton]\nlaw = \"none\"\n"
      "[friction]\nlaw = \"none\"\n[contact]\nlaw = \"tool\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 2\n"
      "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\nposition_mm = [20, 0, 0]\n";
  const test::BakedScene baked(text);
  ASSERT_EQ(baked.model().tip_law.size(), 2u);
  EXPECT_DOUBLE_EQ(baked.model().tip_law[0].depth_max_m, 0.002);
  EXPECT_DOUBLE_EQ(baked.model().tip_law[1].depth_max_m, 0.006);
}

// Presses measured at places: too near to one another, too far from the body, too shallow.
TEST(TipRefusals, MeasuredPlacesAndDepths) {
  const std::string path = (std::filesystem::temp_directory_path() / "palpate_MeasuredPlacesAndDepths.csv").string();
  const auto bake = [&](const std::string& rows) {
    std::ofstream(path) << "x_mm,y_mm,z_mm,depth_mm,force_N\n" + rows;
    return Parts{.contact = "law = \"table\"\nmax_depth_mm = 5\n[contact.table]\nfile = \"" + path + "\"\n"};
  };
  const std::string same = refusal(bake("0,20,0,0,0\n0,20,0,5,1\n0.1,20,0,0,0\n0.1,20,0,5,1\n"));
  EXPECT_NE(same.find("two presses of " + path + " are nearest to the same vertex"), std::string::npos) << same;
  const Parts far = bake("0,20,0,0,0\n0,20,0,3,1\n0,90,0,0,0\n0,90,0,5,1\n");
  const CompileResult baked = compile_scene(parse_scene("name = \"s\"\n[body]\n" + far.body +
                                                            "[skeleton]\nlaw = \"none\"\n[friction]\nlaw = \"none\"\n"
                                                            "[[tool.piece]]\n" +
                                                            far.piece + "[contact]\n" + far.contact,
                                                        "s.toml"));
  std::filesystem::remove(path);
  std::string warnings;
  for (const std::string& w : baked.report.warnings) warnings += w + "\n";
  EXPECT_NE(warnings.find(" mm from the nearest vertex"), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("a press ends at 3 mm, before contact.max_depth_mm"), std::string::npos) << warnings;
}

}  // namespace
}  // namespace palpate
