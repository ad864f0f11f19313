// Rings and tubes between two balls and between two plates, of which the upper half is pressed: by symmetry its lower
// edge stays in its plane, where nothing rubs. References: docs/models_large_strain.md, scenes D and E. And plates that
// are wider than the body.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "config/body/mesh_io.h"
#include "rt_core/status.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

constexpr int kAround = 32, kThrough = 3;
constexpr double kInner_mm = 20, kOuter_mm = 30;

// Half a tube of radii 20 and 30 mm about z, above y = 0: a closed surface.
class HalfTube {
 public:
  HalfTube(double length_mm, int along) : length_mm_(length_mm), along_(along) {
    for (int i = 0; i < kAround; ++i)
      for (int j = 0; j < along; ++j) {
        quad({kThrough, i, j}, {kThrough, i + 1, j}, {kThrough, i + 1, j + 1}, {kThrough, i, j + 1});
        quad({0, i, j}, {0, i, j + 1}, {0, i + 1, j + 1}, {0, i + 1, j});
      }
    for (int k = 0; k < kThrough; ++k) {
      for (int i = 0; i < kAround; ++i) {
        quad({k, i, along}, {k + 1, i, along}, {k + 1, i + 1, along}, {k, i + 1, along});
        quad({k, i, 0}, {k, i + 1, 0}, {k + 1, i + 1, 0}, {k + 1, i, 0});
      }
      for (int j = 0; j < along; ++j) {
        quad({k, 0, j}, {k + 1, 0, j}, {k + 1, 0, j + 1}, {k, 0, j + 1});
        quad({k, kAround, j}, {k, kAround, j + 1}, {k + 1, kAround, j + 1}, {k + 1, kAround, j});
      }
    }
  }
  SurfaceMesh mesh;

 private:
  struct Node {
    int through, around, along;
    auto operator<=>(const Node&) const = default;
  };
  std::int32_t at(const Node& n) {
    const auto [entry, is_new] = index_.try_emplace(n, static_cast<std::int32_t>(index_.size()));
    if (is_new) {
      const double radius = kInner_mm + (kOuter_mm - kInner_mm) * n.through / kThrough,
                   angle = std::numbers::pi * n.around / kAround,
                   z = length_mm_ * (static_cast<double>(n.along) / along_ - 0.5);
      mesh.vertex_m.push_back(1e-3 * Vec3{radius * std::cos(angle), radius * std::sin(angle), z});
    }
    return entry->second;
  }
  void quad(const Node& a, const Node& b, const Node& c, const Node& d) {
    mesh.triangle.push_back({at(a), at(b), at(c)});
    mesh.triangle.push_back({at(a), at(c), at(d)});
  }

  double length_mm_;
  int along_;
  std::map<Node, std::int32_t> index_;
};

// `held`: [[body.fixed]] beside the cut's plane.
std::string scene(const std::string& body, const std::string& held, double edge_mm, const std::string& tool,
                  double depth_max_mm) {
  return "name = \"between\"\n[body]\n" + body +
         "[body.material]\nyoungs_modulus_Pa = 3e6\npoisson_ratio = 0.45\ndensity_kg_per_m3 = 1100\n" + held +
         "[body.fem]\nedge_mm = " + number(edge_mm) +
         "\n[body.elastic]\nsoft_modes = 4\nlinear_modes = 20\ncheck_presses = 0\n[contact]\nbackend = \"elastic\"\n"
         "max_depth_mm = " +
         number(depth_max_mm) + "\n[friction]\nlaw = \"none\"\n[[tool.piece]]\n" + tool +
         "[device]\nname = \"sim-6dof\"\n[path]\npoint = [ { time_s = 0, position_mm = [0, 120, 0] } ]\n";
}
std::string half_tube(double length_mm, int along, const std::string& name) {
  const std::string path = testing::TempDir() + name + ".obj";
  write_obj(path, HalfTube(length_mm, along).mesh);
  return "shape = \"mesh\"\nfix_orientation = true\nmesh = \"" + path + "\"\n";
}
std::string holds(const char* from, const char* to, const char* axis) {
  return std::string("[[body.fixed]]\nregion = \"box\"\nfrom_mm = ") + from + "\nto_mm = " + to + "\nholds = \"" +
         axis + "\"\n";
}
// By symmetry, and what would be free else: x in the plane of symmetry, z on the cut.
const std::string kCut = holds("[-40, -1, -40]", "[40, 0.01, 40]", "y");
const std::string kWide = "shape = \"box\"\nsize_mm = [60, 10, 60]\nmargin_mm = 1\n";
constexpr double kHalfPlate_m = 5e-3;

// 0.6 % at most (2026-11-29), with facets a third shorter as well.
TEST(BetweenBalls, ATubeGivesAsElementsSay) {
  const BakedScene baked(scene(half_tube(60, 24, "palpate_half_tube"),
                               kCut + holds("[-2, 18, -31]", "[2, 31, -26]", "x") +
                                   holds("[-2, 18, 26]", "[2, 31, 31]", "x") +
                                   holds("[-31, -1, -2]", "[31, 1, 2]", "z"),
                               5, "shape = \"sphere\"\nradius_mm = 8\n", 7));
  const double reference_N[] = {5.372, 12.073, 19.018, 25.899, 32.605, 39.055, 45.339, 51.354};  // 320 H27
  Bench bench(baked.model());
  Vec3 at{0, 38.5e-3, 0};
  double largest = 0;
  for (int mm = 1; mm <= 8; ++mm) {
    const Vec3 to{0, (38 - mm) * 1e-3, 0};
    const double force_N = move_to(bench, at, to).contact_w.force_N.y;
    at = to;
    largest = std::max(largest, std::abs(force_N / reference_N[mm - 1] - 1));
    EXPECT_NEAR(force_N, reference_N[mm - 1], 0.01 * reference_N[mm - 1]) << mm << " mm";
  }
  RecordProperty("largest", std::to_string(100 * largest) + " %");
}

// To a quarter of its diameter, and still whenever it is held. 3.5 % at most (2026-11-29; 5.7 and 7.9 with facets a
// third shorter and elements of 4 and 3 mm): one place tells of a line of contact that grows wider.
TEST(BetweenPlates, ARingGivesAsElementsSay) {
  const BakedScene baked(scene(
      half_tube(10, 6, "palpate_half_ring"),
      kCut + holds("[-1.5, 15, -6]", "[1.5, 25, 6]", "x") + holds("[-31, -1, -1]", "[31, 0.01, 1]", "z"), 4, kWide, 3));
  const std::pair<double, double> reference[] = {{1, 0.8209}, {4, 3.1876}, {8, 6.0487}, {12, 8.6687}, {16, 11.257}};
  Bench bench(baked.model());
  Vec3 at{0, 30.3e-3 + kHalfPlate_m, 0};
  double largest = 0;
  for (const auto& [both_mm, reference_N] : reference) {
    const Vec3 to{0, (30 - 0.5 * both_mm) * 1e-3 + kHalfPlate_m, 0};
    const double force_N = move_to(bench, at, to).contact_w.force_N.y;
    at = to;
    largest = std::max(largest, std::abs(force_N / reference_N - 1));
    EXPECT_NEAR(force_N, reference_N, 0.045 * reference_N) << both_mm << " mm";
    EXPECT_LT(change_while_held_N(bench, {at, {}}, 30), 1e-4 * force_N) << both_mm << " mm";
    EXPECT_EQ(bench.output.status & Status::kNotConverged, 0u);
  }
  RecordProperty("largest", std::to_string(100 * largest) + " %");
}

// Before a plate knew how the body leans back under it, it went from corner to corner of the block in every tick, with
// 0 to 277 N, and from end to end of the tube (2026-11-28).
TEST(BetweenPlates, APlateWiderThanTheBodyIsStill) {
  const std::string block = "shape = \"box\"\nsize_mm = [30, 30, 30]\ntriangles = 2000\n";
  const std::string tube =
      "shape = \"hollow_cylinder\"\nradius_mm = 30\nheight_mm = 40\nwall_mm = 10\naxis = \"z\"\ntriangles = 3000\n";
  struct Case {
    const std::string& body;
    const char* base;
    double top_m, edge_mm;
  };
  for (const Case& one : {Case{block, "1", 30e-3, 6}, Case{tube, "6", 60e-3, 5}}) {
    SCOPED_TRACE(one.body);
    const BakedScene baked(
        scene(one.body, std::string("[body.fixed]\nbase_height_mm = ") + one.base + "\n", one.edge_mm, kWide, 3));
    Bench bench(baked.model());
    Vec3 at{0, one.top_m + kHalfPlate_m + 4e-3, 0};
    double before_N = 0;
    for (const double depth_mm : {0.1, 0.25, 0.5, 1.0}) {
      const Vec3 to{0, one.top_m + kHalfPlate_m - 1e-3 * depth_mm, 0};
      const Vec3 force_N = move_to(bench, at, to).contact_w.force_N;
      at = to;
      EXPECT_GT(force_N.y, before_N) << depth_mm;
      EXPECT_LT(norm(force_N - Vec3{0, force_N.y, 0}), 0.01 * force_N.y) << depth_mm;
      EXPECT_LT(change_while_held_N(bench, {at, {}}, 30), 1e-4 * force_N.y) << depth_mm;
      before_N = force_N.y;
    }
  }
}

}  // namespace
}  // namespace palpate::test
