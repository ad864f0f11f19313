// The mesh library in its own process: files that keep it busy for ever, or want all memory, end with a clear error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "config/body/body.h"
#include "config/body/mesh_io.h"
#include "config/body/procedural.h"
#include "config/body/self_intersection.h"
#include "config/scene/config_error.h"
#include "config/scene/scene.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

using testing::HasSubstr;

class MeshImport : public testing::Test {
 protected:
  MeshImport() {
    folder_ = std::filesystem::temp_directory_path() / ("palpate_import_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~MeshImport() override { std::filesystem::remove_all(folder_); }
  std::string error_of(const std::string& name, const std::string& text) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return test::refusal_by([&] { read_mesh(path, 1e-3, {1, std::uint64_t{1} << 30}); });
  }
  std::filesystem::path folder_;
};

// assimp 5.2.5 reads such a header for ever (2026-11-22).
TEST_F(MeshImport, AFileThatKeepsTheLibraryBusyForEverEndsWithItsTime) {
  const std::string error = error_of("endless.ply", "ply\nformat ascii 1.0\nelement vertex 4\n");
  EXPECT_THAT(error, HasSubstr("endless.ply"));
  EXPECT_THAT(error, HasSubstr("within 1 s of processor time"));
}

TEST_F(MeshImport, AFileThatPromisesMoreThanItHoldsIsRefused) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(error_of("promise.ply", head + "element face 4000000000\nproperty list uchar int vertex_indices\n"
                                             "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n"),
              HasSubstr("promise.ply"));
  EXPECT_THAT(error_of("empty.obj", "# nothing\n"), HasSubstr("empty.obj"));
  EXPECT_THAT(error_of("noise.stl", std::string(500, '\xa7')), HasSubstr("noise.stl"));
}

// Triangles of a sphere around `centre`, appended.
void add_sphere(SurfaceMesh& mesh, Vec3 centre_m, double radius_m, int rings) {
  const auto base = static_cast<std::int32_t>(mesh.vertex_m.size());
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      const double polar = std::numbers::pi * i / rings, around = std::numbers::pi * j / rings;
      mesh.vertex_m.push_back(centre_m + radius_m * Vec3{std::sin(polar) * std::cos(around),
                                                         std::sin(polar) * std::sin(around), std::cos(polar)});
    }
  const auto at = [&](int i, int j) { return base + 2 * rings * i + j % (2 * rings); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      mesh.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

TEST(SelfIntersection, ASphereHasNoneTwoThatOverlapHaveManyTwoApartNone) {
  SurfaceMesh mesh;
  add_sphere(mesh, {}, 0.03, 30);
  EXPECT_EQ(find_self_intersections(mesh).pairs, 0);
  SurfaceMesh apart = mesh;
  add_sphere(apart, {0.0611, 0.001, 0}, 0.03, 30);
  EXPECT_EQ(find_self_intersections(apart).pairs, 0);
  add_sphere(mesh, {0.0411, 0.0013, 0.0007}, 0.03, 30);
  const SelfIntersections found = find_self_intersections(mesh);
  EXPECT_GT(found.pairs, 50);
  EXPECT_TRUE(found.complete);
  // The spheres meet in the plane half way: x = 20.6 mm, within a triangle's size (3 mm).
  EXPECT_NEAR(found.where_m.x, 0.0206, 0.004);
}

// One vertex pulled through the opposite wall: the mesh stays closed and manifold, and baked without a word before.
TEST(SelfIntersection, ASpikeThroughTheOppositeWallIsFound) {
  SurfaceMesh mesh;
  add_sphere(mesh, {}, 0.03, 20);
  mesh.vertex_m[400] = 1.2 * Vec3{-mesh.vertex_m[400].x, -mesh.vertex_m[400].y, -mesh.vertex_m[400].z};
  EXPECT_GT(find_self_intersections(mesh).pairs, 0);
}

// The baker refuses it, and says where: the spike leaves the sphere opposite its own vertex.
TEST(SelfIntersection, ABodyThatGoesThroughItselfIsRefusedWithThePlace) {
  SurfaceMesh mesh;
  add_sphere(mesh, {}, 0.03, 20);
  const auto scene_of = [&](const char* file) {
    const std::string path = testing::TempDir() + file;
    std::ofstream out(path);
    for (const Vec3& v : mesh.vertex_m) out << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (const Corners& t : mesh.triangle) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    SceneDesc scene = parse_scene("name = \"s\"\n[body]\nshape = \"mesh\"\nscale = 1.0\nmesh = \"" + path +
                                      "\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n",
                                  "s.toml");
    return scene;
  };
  std::vector<std::string> warnings;
  EXPECT_NO_THROW(make_body(scene_of("whole.obj"), warnings));
  const Vec3 tip = 1.2 * -mesh.vertex_m[400];
  mesh.vertex_m[400] = tip;
  try {
    make_body(scene_of("spike.obj"), warnings);
    FAIL() << "a body that goes through itself was taken";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    for (const char* word : {"s.toml:", "body.mesh", "goes through itself at (", "mm, triangle ", "mesh editor"})
      EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
  }
}

// Every edge of the dent meets an edge of the other side: nothing goes through the inside of a triangle.
TEST(SelfIntersection, SheetsThatMeetEdgeThroughEdgeAreSeen) {
  SurfaceMesh mesh = make_ellipsoid({0.03, 0.03, 0.03}, 1500);
  for (Vec3& p : mesh.vertex_m)
    if (norm(p - Vec3{0, 0.06, 0}) < 0.006) p.y -= 0.07;
  EXPECT_GT(find_self_intersections(mesh).pairs, 0);
}

TEST(SelfIntersection, ASpentBudgetIsSaid) {
  SurfaceMesh mesh;
  add_sphere(mesh, {}, 0.03, 30);
  EXPECT_FALSE(find_self_intersections(mesh, 1000).complete);
}

}  // namespace
}  // namespace palpate
