// Every shape of tool piece keeps what its card promises: support, gap, tool points, surface and keys agree, and a tool
// of it can be baked and felt. Run over the whole table: a new shape is tested by being in it.
#include <gtest/gtest.h>

#include <random>

#include "config/bake/tool_points.h"
#include "config/scene/config_error.h"
#include "config/tool/piece_card.h"
#include "rt_core/tool/shapes.h"
#include "tests/support/baked_scene.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

using test::BakedScene;
using test::Bench;

// A piece of the shape, given by the keys of its card alone.
PieceDesc example(PieceShape shape) {
  PieceDesc piece;
  piece.shape = shape;
  for (const CardKey& size : card_of(shape).sizes) {
    const std::string key = size.key;
    if (key == "radius_mm") piece.radius_m = 0.010;
    if (key == "length_mm") piece.length_m = 0.030;
    if (key == "size_mm") piece.size_m = {0.024, 0.016, 0.012};
    if (key == "vertices_mm")
      piece.vertices_m = {{-0.008, -0.006, -0.005}, {0.009, -0.005, -0.006}, {0, 0.010, -0.004}, {0.001, 0.001, 0.009}};
  }
  piece.points = 26;
  return piece;
}

std::string example_toml(PieceShape shape, int points) {
  std::string text = "[[tool.piece]]\nshape = \"" + std::string(word_of(shape)) + "\"\n";
  for (const CardKey& size : card_of(shape).sizes) {
    const std::string key = size.key;
    text += key + (key == "radius_mm"   ? " = 10\n"
                   : key == "length_mm" ? " = 30\n"
                   : key == "size_mm"   ? " = [24, 16, 12]\n"
                                        : " = [[-8, -6, -5], [9, -5, -6], [0, 10, -4], [1, 1, 9]]\n");
  }
  return text + "points = " + std::to_string(points) + "\n";
}

struct Made {
  PieceCore core;
  Tool tool;
  const ToolPiece& piece() const { return tool.piece[0]; }
  template <class Vector>
  PieceGapOf<Vector> gap(const Vector& p) const {
    return piece_gap(piece(), p, tool.hull_face);
  }
};
Made make(PieceShape shape) { return {piece_core(example(shape)), make_tool({example(shape)})}; }

class PieceCards : public testing::TestWithParam<PieceShape> {
 protected:
  Made made = make(GetParam());
  // A hull's stand for its corners by one sphere, most of which lies inside.
  const bool samples_are_surface = GetParam() != PieceShape::kHull;
  std::mt19937 random{7};
  Vec3 random_point(double reach) {
    std::uniform_real_distribution<double> along(-reach, reach);
    return {along(random), along(random), along(random)};
  }
};

// A piece frame's samples have gap 0; the largest of them along a direction is the support's point, to their spacing.
TEST_P(PieceCards, SupportGapAndSamplesAreOneSurface) {
  const std::vector<SurfaceSample> sample = surface_samples(made.core);
  ASSERT_FALSE(sample.empty());
  const double reach = made.piece().bounding_radius_m;
  if (samples_are_surface)
    for (std::size_t i = 0; i < sample.size(); i += 97) {
      ASSERT_NEAR(made.gap(sample[i].position_m).gap_m, 0, 1e-12 + 1e-9 * reach);
    }
  for (int i = 0; i < 50; ++i) {
    const Vec3 direction = unit_or(random_point(1), {1, 0, 0});
    const Vec3 support =
        core_support(made.piece(), made.tool.hull_vertex_m, direction) + made.core.margin_m * direction;
    double farthest = -kHuge;
    for (const SurfaceSample& s : sample) farthest = std::max(farthest, dot(s.position_m, direction));
    EXPECT_LE(farthest, dot(support, direction) + 1e-12);
    // Samples are at most a fifth of the margin apart on curved parts (hulls: six to a corner's sphere).
    EXPECT_GE(farthest, dot(support, direction) - (GetParam() == PieceShape::kHull ? made.core.margin_m : 2e-4));
    EXPECT_NEAR(made.gap(support).gap_m, 0, 1e-12);
  }
}

TEST_P(PieceCards, GapGrowsByOneAlongItsNormal) {
  const double h = 1e-7, reach = 2 * made.piece().bounding_radius_m;
  int smooth = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(reach);
    const PieceGap gap = made.gap(p);
    ASSERT_NEAR(norm(gap.normal), 1, 1e-12);
    const PieceGap out = made.gap(p + h * gap.normal), in = made.gap(p - h * gap.normal);
    if (norm(out.normal - in.normal) > 1e-3) continue;  // across a bisector the nearest feature changes
    ++smooth;
    ASSERT_NEAR((out.gap_m - in.gap_m) / (2 * h), 1, 1e-6);
    // No point is nearer than the gap says: a distance grows no faster than one walks.
    const Vec3 q = random_point(reach);
    ASSERT_LE(std::abs(made.gap(q).gap_m - gap.gap_m), norm(q - p) + 1e-12);
  }
  EXPECT_GT(smooth, 1900);
}

TEST_P(PieceCards, FourAtATimeGivesTheSameBits) {
  for (int i = 0; i < 200; ++i) {
    Vec3x4 p{};
    Vec3 point[4];
    for (std::uint32_t k = 0; k < 4; ++k) {
      point[k] = random_point(0.03);
      p.set(k, point[k]);
    }
    const PieceGapOf<Vec3x4> four = made.gap(p);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const PieceGap one = made.gap(point[k]);
      EXPECT_EQ(four.gap_m[k], one.gap_m);
      EXPECT_EQ(four.normal[k], one.normal);
    }
  }
}

// The surface closes: the sum of area times normal vanishes, and a third of that of area times height is a volume.
TEST_P(PieceCards, SurfaceIsClosed) {
  if (!samples_are_surface) return;
  Vec3 sum;
  double area = 0, volume = 0;
  for (const SurfaceSample& s : surface_samples(made.core)) {
    const Vec3 n = made.gap(s.position_m).normal;
    sum += s.area_m2 * n;
    area += s.area_m2;
    volume += s.area_m2 * dot(n, s.position_m) / 3;
  }
  EXPECT_LT(norm(sum), 2e-3 * area);
  const double reach = made.piece().bounding_radius_m;
  EXPECT_GT(volume, 0);
  EXPECT_LT(volume, 4.0 / 3 * 3.1416 * reach * reach * reach);
}

TEST_P(PieceCards, ToolPointsLieInTheCoreAndShareTheArea) {
  double area = 0, whole = 0;
  ASSERT_GT(made.piece().point_count, 0);
  ASSERT_LE(made.piece().point_count, 26);
  for (const ToolPoint& point : made.tool.point) {
    EXPECT_EQ(point.margin_m, made.core.margin_m);
    EXPECT_GT(point.area_m2, 0);
    EXPECT_LE(norm(point.position_tool_m) + point.margin_m, made.piece().bounding_radius_m + 1e-12);
    EXPECT_LE(made.gap(point.position_tool_m).gap_m, -point.margin_m + 1e-12);
    area += point.area_m2;
  }
  for (const SurfaceSample& s : surface_samples(made.core)) {
    whole += s.area_m2;
    ASSERT_LE(norm(s.position_m), made.piece().bounding_radius_m + 1e-12);
  }
  EXPECT_NEAR(area, whole, 1e-9 * whole);
}

TEST_P(PieceCards, DrawingHasItsCore) {
  const PieceCard& card = card_of(GetParam());
  ASSERT_NE(card.profile == nullptr, card.corners == nullptr);
  const CoreProfile profile = card.profile != nullptr ? card.profile(made.core) : CoreProfile{};
  for (const ProfilePoint p : profile.point) {
    EXPECT_LE(std::hypot(p.radius_m, p.height_m), card.reach_m(made.core) + 1e-12);
  }
  if (card.corners != nullptr) {
    EXPECT_GE(card.corners(made.core).size(), 4u);
  }
}

std::string refusal(const std::string& text) {
  return test::refusal_by(
      [&] { parse_scene("name = \"s\"\n[body]\nshape = \"sphere\"\nradius_mm = 30\n" + text, "s.toml"); });
}

TEST_P(PieceCards, EverySizeIsNeededAndNoOther) {
  const std::string whole = example_toml(GetParam(), 26);
  EXPECT_EQ(refusal(whole), "accepted");
  for (const char* key : {"radius_mm", "length_mm", "size_mm", "vertices_mm", "margin_mm"}) {
    const auto at = whole.find(key);
    if (at != std::string::npos) {
      const std::string without = whole.substr(0, at) + whole.substr(whole.find('\n', at) + 1);
      EXPECT_NE(refusal(without).find(std::string(key) + ": missing"), std::string::npos) << refusal(without);
    } else if (std::string(key) != "margin_mm" || card_of(GetParam()).margin == nullptr) {
      const bool list = std::string(key) == "size_mm", lists = std::string(key) == "vertices_mm";
      const std::string with = whole + key + (list ? " = [9, 9, 9]\n" : lists ? " = [[1, 2, 3]]\n" : " = 9\n");
      EXPECT_NE(refusal(with).find(std::string(key) + ": has no effect"), std::string::npos) << refusal(with);
    }
  }
  if (!card_of(GetParam()).has_ends) {
    EXPECT_NE(refusal(whole + "touches = \"plus_z\"\n").find("no end face"), std::string::npos);
  }
}

// Pressed into a body from above for 1000 ticks: everything stays finite, and there is contact that pushes back.
void press(const std::string& scene_text, double top_m, Vec3 lowest_m) {
  const BakedScene scene(scene_text);
  Bench bench(scene.model());
  double largest_N = 0;
  for (int i = 0; i < 1000; ++i) {
    const double depth = 0.004 * std::min(1.0, i / 600.0);
    const Output& out = bench.tick_at({Vec3{0, top_m - depth, 0} - lowest_m, {}}, {});
    ASSERT_TRUE(is_finite(out.contact_w.force_N) && is_finite(out.device_w.force_N)) << "tick " << i;
    largest_N = std::max(largest_N, out.contact_w.force_N.y);
    if (i == 999) {
      EXPECT_GT(out.contacts, 0);
    }
  }
  EXPECT_GT(largest_N, 0.01);
}

// Lowest point of a piece whose axes are the world's.
Vec3 lowest_m(const Made& made) {
  const Vec3 down{0, -1, 0};
  return core_support(made.piece(), made.tool.hull_vertex_m, down) + made.core.margin_m * down;
}

TEST_P(PieceCards, BakesAndTicksAsToolPoints) {
  press("name = \"s\"\n[body]\nshape = \"ellipsoid\"\nhalf_axes_mm = [40, 30, 25]\ntriangles = 800\n" +
            example_toml(GetParam(), 26),
        0.060, lowest_m(made));
}

// Four elements a side: a node lies under the piece's lowest point, however slim it is.
TEST_P(PieceCards, BakesAndTicksAgainstNodes) {
  press(
      "name = \"s\"\n[body]\nshape = \"box\"\nsize_mm = [40, 20, 40]\n[body.fem]\nedge_mm = 10\nstrain_gauges = 0\n"
      "[body.material]\nyoungs_modulus_Pa = 2e5\npoisson_ratio = 0.45\n[contact]\nbackend = \"nodal\"\n"
      "[friction]\nlaw = \"none\"\n" +
          example_toml(GetParam(), 26),
      0.020, lowest_m(made));
}

std::vector<PieceShape> all_shapes() {
  std::vector<PieceShape> shapes;
  for (std::int32_t i = 0; i < ChoiceOf<PieceShape>::kCount; ++i) shapes.push_back(static_cast<PieceShape>(i));
  return shapes;
}
INSTANTIATE_TEST_SUITE_P(Shapes, PieceCards, testing::ValuesIn(all_shapes()),
                         [](const auto& shape) { return std::string(word_of(shape.param)); });

}  // namespace
}  // namespace palpate
