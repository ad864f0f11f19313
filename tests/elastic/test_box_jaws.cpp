// A gripper of two box jaws on an elastic body: of every jaw all edges and faces, 38 pieces of one tool.
#include <gtest/gtest.h>

#include <string>

#include "rt_core/contact/regions.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"
#include "tests/support/refusal.h"

namespace palpate::test {
namespace {

constexpr double kHeight_m = 0.015;

// A block 30 mm high and 24 deep, whose base is held; `holds` is what else of it is. Of an adversary who puts a jaw
// right into half of it a bake states 3.8 million instructions (2026-11-27): hence the period.
std::string block(double wide_mm, const std::string& holds, const std::string& tool) {
  return "name = \"box_jaws\"\n[body]\nshape = \"box\"\nsize_mm = [" + number(wide_mm) +
         ", 30, 24]\n[body.fem]\nedge_mm = 5\n[body.elastic]\nsoft_modes = 3\nlinear_modes = 20\n[body.material]\n"
         "youngs_modulus_Pa = 2e5\npoisson_ratio = 0.45\ndensity_kg_per_m3 = 1100\n[[body.fixed]]\nbase_height_mm = "
         "0\n" +
         holds + "[contact]\nbackend = \"elastic\"\nmax_depth_mm = 4\n[friction]\nlaw = \"none\"\n" + tool +
         "[device]\nname = \"sim-6dof\"\nperiod_ms = 2\n[path]\npoint = [ { time_s = 0, position_mm = [0, 45, 0] } ]\n";
}
// Its inner face is at `face_mm` when closed, and 4 mm further out when open.
std::string jaw(double face_mm, const std::string& keys = "") {
  const double side = face_mm < 0 ? -1 : 1;
  return "[[tool.piece]]\nshape = \"box\"\nsize_mm = [10, 12, 16]\nmargin_mm = 1.5\nposition_mm = [" +
         number(face_mm + 5 * side) + ", 0, 0]\n" + keys;
}
std::string gripper(double face_mm) {
  return "[gripper]\nclosing_s = 1\nstop_force_N = 1000\n" + jaw(face_mm, "slide_mm = [4, 0, 0]\n") +
         jaw(-face_mm, "slide_mm = [-4, 0, 0]\npart = 1\n");
}

// What all jaws on one side push with, outwards.
double push_N(const State& state, double side) {
  double sum = 0;
  for (const Region& region : state.region)
    if (is_in_contact(region) && side * region.centre_w.x > 0) sum += side * region.wrench_w.force_N.x;
  return sum;
}
void close(Bench& bench) {
  for (int i = 0; i < 1100; ++i) bench.tick_at({{0, kHeight_m, 0}, {}}, closing_all(1));
}

// Either jaw touches with its face and that face's four edges, each a region of one tip, and both push as hard (the
// elements are not mirrored).
TEST(BoxJaws, PinchABlockFromBothSides) {
  const BakedScene baked(parse_scene(block(24, "", gripper(10)), "test.toml"));
  EXPECT_EQ(baked.model().tool_point.size(), 36u);
  Bench bench(baked.model());
  close(bench);
  EXPECT_EQ(bench.output.regions, 10);
  for (const Region& region : bench.state->region) EXPECT_EQ(region.point_count, is_in_contact(region) ? 1 : 0);
  const double right = push_N(*bench.state, 1), left = push_N(*bench.state, -1);
  EXPECT_GT(right, 5);
  EXPECT_NEAR(right / left, 1, 0.01);
  EXPECT_EQ(bench.output.status & Status::kNotConverged, 0u);
}

// One jaw on half of the block, which slides along a wall where the other half was: the same press by another bake,
// with one force instead of two that lean on one another.
TEST(BoxJaws, PinchAsOneJawOfHalfABlock) {
  const BakedScene whole(parse_scene(block(24, "", gripper(10)), "test.toml"));
  const BakedScene half(parse_scene(block(12,
                                          "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-6.1, -1, -13]\nto_mm = "
                                          "[-5.9, 31, 13]\nholds = \"x\"\n",
                                          jaw(4)),
                                    "test.toml"));
  Bench pinch(whole.model()), press(half.model());
  close(pinch);
  for (int i = 0; i <= 600; ++i) press.tick_at({{3e-3 - 5e-6 * i, kHeight_m, 0}, {}}, {});
  for (int i = 0; i < 5; ++i) press.tick_at({{0, kHeight_m, 0}, {}}, {});
  const double of_two = push_N(*pinch.state, 1), of_one = push_N(*press.state, 1);
  RecordProperty("share", std::to_string(of_two / of_one));
  EXPECT_NEAR(of_two / of_one, 1, 0.03);  // 0.988 (2026-11-27)
}

// Three boxes fit a tool, four do not; what State and Scratch take stays within 256 KiB.
TEST(BoxJaws, ThreeBoxesFitATool) {
  const std::string three = jaw(10) + jaw(-10) + jaw(40);
  const BakedScene baked(parse_scene(block(24, "", three), "test.toml"));
  EXPECT_LE(state_bytes(baked.model()) + scratch_bytes(baked.model()), 256u * 1024u);
  const std::string said = refusal_by([&] { parse_scene(block(24, "", three + jaw(60)), "test.toml"); });
  EXPECT_NE(said.find("of the 64 pieces of a tool are left"), std::string::npos) << said;
}

TEST(BoxJaws, AreAnOverlayOfTheShippedScene) {
  const std::string folder = std::string(PALPATE_SOURCE_DIR) + "/config/scenes/";
  const SceneDesc scene = load_scene(folder + "pinch_block.toml", {{folder + "hands/box_jaws.toml"}, {}});
  EXPECT_EQ(scene.piece.size(), 38u);  // two boxes, 24 edges, 12 faces
  EXPECT_EQ(scene.contact.backend, Backend::kElastic);
}

}  // namespace
}  // namespace palpate::test
