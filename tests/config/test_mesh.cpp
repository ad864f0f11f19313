// Meshes: derived quantities against closed forms, and a refusal for every kind of broken surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "config/body/mesh.h"
#include "config/body/mesh_io.h"
#include "config/body/procedural.h"
#include "config/scene/config_error.h"
#include "rt_core/surface/closest_point.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string check(const SurfaceMesh& mesh) {
  return test::refusal_by([&] { check_mesh(mesh, "body"); });
}

SurfaceMesh box() { return make_box({0.02, 0.03, 0.04}, 200); }

TEST(Mesh, BoxIsExact) {
  const SurfaceMesh mesh = box();
  EXPECT_EQ(check(mesh), "accepted");
  EXPECT_NEAR(signed_volume_m3(mesh), 24e-6, 1e-18);
  EXPECT_NEAR(surface_area_m2(mesh), 52e-4, 1e-15);
  const Vec3 centre = volume_centre_m(mesh);
  EXPECT_NEAR(centre.x, 0, 1e-15);
  EXPECT_NEAR(centre.y, 0.015, 1e-15);
  EXPECT_NEAR(centre.z, 0, 1e-15);
}

// At a box corner the angle-weighted normal is (1,1,1)/sqrt(3) whatever the triangulation.
TEST(Mesh, NormalsAreAngleWeighted) {
  const SurfaceMesh mesh = box();
  const std::vector<Vec3> normal = vertex_normals(mesh);
  int corners = 0;
  for (std::size_t i = 0; i < normal.size(); ++i) {
    EXPECT_NEAR(norm(normal[i]), 1, 1e-12);
    const Vec3 p = mesh.vertex_m[i];
    if (std::abs(p.x) < 0.00999 || std::abs(p.y - 0.015) < 0.01499 || std::abs(p.z) < 0.01999) continue;
    ++corners;
    EXPECT_NEAR(normal[i].x * (p.x > 0 ? 1 : -1), 1 / std::sqrt(3), 1e-12);
    EXPECT_NEAR(normal[i].y * (p.y > 0.015 ? 1 : -1), 1 / std::sqrt(3), 1e-12);
    EXPECT_NEAR(normal[i].z * (p.z > 0 ? 1 : -1), 1 / std::sqrt(3), 1e-12);
  }
  EXPECT_EQ(corners, 8);
}

TEST(Mesh, AdjacencyIsMutual) {
  const SurfaceMesh mesh = make_ellipsoid({0.04, 0.03, 0.025}, 500);
  const std::vector<Corners> adjacent = triangle_adjacency(mesh);
  for (std::size_t t = 0; t < adjacent.size(); ++t)
    for (const std::int32_t other : adjacent[t]) {
      ASSERT_GE(other, 0);
      const Corners& back = adjacent[static_cast<std::size_t>(other)];
      EXPECT_THAT(back, testing::Contains(static_cast<std::int32_t>(t)));
    }
}

TEST(Mesh, EmptyIsRefused) { EXPECT_THAT(check({}), HasSubstr("empty")); }
TEST(Mesh, NanVertexIsNamed) {
  SurfaceMesh mesh = box();
  mesh.vertex_m[17].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(check(mesh), HasSubstr("vertex 17 is not a finite number"));
}
TEST(Mesh, IndexOutOfRangeIsNamed) {
  SurfaceMesh mesh = box();
  mesh.triangle[5][1] = 100000;
  EXPECT_THAT(check(mesh), HasSubstr("triangle 5 refers to vertex 100000"));
  mesh.triangle[5][1] = -1;
  EXPECT_THAT(check(mesh), HasSubstr("triangle 5 refers to vertex -1"));
}
TEST(Mesh, LooseVertexIsNamed) {
  SurfaceMesh mesh = box();
  mesh.vertex_m.push_back({0, 0, 0});
  EXPECT_THAT(check(mesh), HasSubstr("belongs to no triangle"));
}
TEST(Mesh, ZeroAreaIsNamed) {
  SurfaceMesh mesh = box();
  mesh.triangle[7][2] = mesh.triangle[7][1];
  EXPECT_THAT(check(mesh), HasSubstr("triangle 7 has zero area"));
}
TEST(Mesh, HoleIsCountedAndPlaced) {
  SurfaceMesh mesh = box();
  mesh.triangle.erase(mesh.triangle.begin() + 40);
  EXPECT_THAT(check(mesh), AllOf(HasSubstr("open: 3 edges"), HasSubstr("mm")));
}
TEST(Mesh, NonManifoldEdgeIsCounted) {
  SurfaceMesh mesh = box();
  const Corners c = mesh.triangle[0];
  mesh.vertex_m.push_back({0.001, 0.002, 0.003});
  mesh.triangle.push_back({c[0], c[1], static_cast<std::int32_t>(mesh.vertex_m.size()) - 1});
  EXPECT_THAT(check(mesh), HasSubstr("1 edge shared by more than two triangles"));
}
TEST(Mesh, TurnedTriangleIsCountedAndFixed) {
  SurfaceMesh mesh = box();
  std::swap(mesh.triangle[9][0], mesh.triangle[9][1]);
  EXPECT_THAT(check(mesh), AllOf(HasSubstr("disagree"), HasSubstr("3 edges"), HasSubstr("fix_orientation")));
  orient_mesh(mesh);
  EXPECT_EQ(check(mesh), "accepted");
}
TEST(Mesh, InsideOutIsNamedAndFixed) {
  SurfaceMesh mesh = box();
  for (Corners& c : mesh.triangle) std::swap(c[0], c[2]);
  EXPECT_THAT(check(mesh), AllOf(HasSubstr("inside out"), HasSubstr("fix_orientation")));
  orient_mesh(mesh);
  EXPECT_EQ(check(mesh), "accepted");
  EXPECT_NEAR(signed_volume_m3(mesh), 24e-6, 1e-18);
}
TEST(Mesh, TwoPiecesAreRefused) {
  SurfaceMesh mesh = box();
  const SurfaceMesh other = box();
  const auto base = static_cast<std::int32_t>(mesh.vertex_m.size());
  for (const Vec3& p : other.vertex_m) mesh.vertex_m.push_back(p + Vec3{1, 0, 0});
  for (const Corners& c : other.triangle) mesh.triangle.push_back({base + c[0], base + c[1], base + c[2]});
  EXPECT_THAT(check(mesh), HasSubstr("2 separate pieces"));
}
TEST(Mesh, SheetsTouchingAtAVertexAreRefused) {
  SurfaceMesh mesh = box();
  const SurfaceMesh other = box();
  const auto base = static_cast<std::int32_t>(mesh.vertex_m.size());
  const Vec3 shift = mesh.vertex_m[0] + other.vertex_m[0];
  for (const Vec3& p : other.vertex_m) mesh.vertex_m.push_back(shift - p);
  for (const Corners& c : other.triangle) {
    Corners moved{base + c[0], base + c[2], base + c[1]};  // mirrored, hence turned
    for (std::int32_t& i : moved) i = i == base ? 0 : i;
    mesh.triangle.push_back(moved);
  }
  mesh.vertex_m[static_cast<std::size_t>(base)] = {};
  // The shared vertex's twin is no longer used; give the index back.
  mesh.vertex_m.erase(mesh.vertex_m.begin() + base);
  for (std::size_t t = other.triangle.size(); t < mesh.triangle.size(); ++t)
    for (std::int32_t& i : mesh.triangle[t]) i = i > base ? i - 1 : i;
  EXPECT_THAT(check(mesh), HasSubstr("two sheets of the surface touch at vertex 0"));
}
// Two cones on one rim: each apex is in `around` triangles.
TEST(Mesh, AFanLargerThanAQueryIsRefused) {
  for (const std::int32_t around : {kMaxVertexTriangles, kMaxVertexTriangles + 1}) {
    SurfaceMesh mesh;
    mesh.vertex_m = {{0, 0, -0.05}, {0, 0, 0.05}};
    for (std::int32_t i = 0; i < around; ++i) {
      const double a = 2 * kPi * i / around;
      mesh.vertex_m.push_back({0.05 * std::cos(a), 0.05 * std::sin(a), 0});
      const std::int32_t here = 2 + i, next = 2 + (i + 1) % around;
      mesh.triangle.push_back({0, next, here});
      mesh.triangle.push_back({1, here, next});
    }
    if (around <= kMaxVertexTriangles)
      EXPECT_EQ(check(mesh), "accepted");
    else
      EXPECT_THAT(check(mesh), AllOf(HasSubstr("2049 triangles meet in vertex 0"), HasSubstr("rings of larger")));
  }
}
TEST(Mesh, ImplausibleScaleSuggestsTheKey) {
  SurfaceMesh mesh = box();
  for (Vec3& p : mesh.vertex_m) p = 1000.0 * p;
  EXPECT_THAT(check(mesh), AllOf(HasSubstr("40 m across"), HasSubstr("body.scale")));
  for (Vec3& p : mesh.vertex_m) p = 1e-8 * p;
  EXPECT_THAT(check(mesh), HasSubstr("body.scale"));
}

TEST(Procedural, CountsAreNearTheRequest) {
  EXPECT_EQ(make_ellipsoid({0.04, 0.03, 0.025}, 3000).triangle.size(), 2880u);
  EXPECT_EQ(make_ellipsoid({0.04, 0.03, 0.025}, 30000).triangle.size(), 30420u);
  EXPECT_EQ(make_ellipsoid({0.04, 0.03, 0.025}, 1000000).triangle.size(), 1003520u);
  for (const std::int32_t n : {500, 5000}) {
    EXPECT_NEAR(static_cast<double>(make_cylinder(0.02, 0.06, n).triangle.size()), n, 0.25 * n);
    EXPECT_NEAR(static_cast<double>(make_box({0.02, 0.03, 0.05}, n).triangle.size()), n, 0.25 * n);
    EXPECT_NEAR(static_cast<double>(make_heart(0.08, n).triangle.size()), n, 0.25 * n);
  }
}

// Parallels and meridians every 180 / n degrees: 4 n (n - 1) triangles and, by Euler's formula, half of that and two
// vertices. Cui & Xiao 2008, Table III, print 3480 and 1742: n = 30.
TEST(Procedural, ASphereOfRingsHasThePublishedCounts) {
  const SurfaceMesh sphere = make_ellipsoid({0.034, 0.034, 0.034}, 3480, SpherePattern::kRings);
  EXPECT_EQ(sphere.triangle.size(), 3480u);
  EXPECT_EQ(sphere.vertex_m.size(), 1742u);
  EXPECT_EQ(make_ellipsoid({0.04, 0.03, 0.025}, kFewestTriangles, SpherePattern::kRings).triangle.size(), 80u);
  EXPECT_EQ(make_ellipsoid({0.04, 0.03, 0.025}, 3000, SpherePattern::kRings).triangle.size(), 4u * 28 * 27);
  for (const Vec3 half : {Vec3{0.034, 0.034, 0.034}, Vec3{0.04, 0.03, 0.025}}) {
    const SurfaceMesh mesh = make_ellipsoid(half, 3480, SpherePattern::kRings);
    EXPECT_EQ(check(mesh), "accepted");
    const double volume = 4.0 / 3 * kPi * half.x * half.y * half.z;
    EXPECT_NEAR(signed_volume_m3(mesh), volume, 0.006 * volume);
    for (const Vec3& p : mesh.vertex_m)
      EXPECT_NEAR(squared_norm(Vec3{p.x / half.x, p.y / half.y - 1, p.z / half.z}), 1, 1e-12);
  }
}

// Volumes converge from below to the exact ones: an inscribed polyhedron misses of order 1/n.
TEST(Procedural, SurfacesAreClosedAndHaveTheirVolume) {
  const double ellipsoid = 4.0 / 3 * kPi * 0.04 * 0.03 * 0.025;
  const SurfaceMesh e = make_ellipsoid({0.04, 0.03, 0.025}, 3000);
  EXPECT_EQ(check(e), "accepted");
  EXPECT_NEAR(signed_volume_m3(e), ellipsoid, 0.006 * ellipsoid);
  EXPECT_LT(signed_volume_m3(e), ellipsoid);
  for (const Vec3& p : e.vertex_m)
    EXPECT_NEAR(p.x * p.x / 16e-4 + (p.y - 0.03) * (p.y - 0.03) / 9e-4 + p.z * p.z / 6.25e-4, 1, 1e-12);
  const SurfaceMesh c = make_cylinder(0.02, 0.06, 3000);
  EXPECT_EQ(check(c), "accepted");
  EXPECT_NEAR(signed_volume_m3(c), kPi * 4e-4 * 0.06, 0.01 * kPi * 4e-4 * 0.06);
  const SurfaceMesh h = make_heart(0.08, 5000);
  EXPECT_EQ(check(h), "accepted");
  EXPECT_NEAR(bounds_of(h).size_m().x, 0.08, 1e-12);
  // Cone: profile from the base to the apex.
  const SurfaceMesh k = make_revolution({{0.03, 0}, {0, 0.05}}, 3000);
  EXPECT_EQ(check(k), "accepted");
  EXPECT_NEAR(signed_volume_m3(k), kPi * 9e-4 * 0.05 / 3, 0.01 * kPi * 9e-4 * 0.05 / 3);
  for (const SurfaceMesh* mesh : {&e, &c, &h, &k}) EXPECT_NEAR(bounds_of(*mesh).lower_m.y, 0, 1e-12);
}

// A profile of a sphere: the smoothed surface stays within half a per cent of it.
TEST(Procedural, RevolutionFollowsASmoothProfile) {
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= 12; ++i) {
    const double a = kPi * i / 12;
    profile.push_back({i == 0 || i == 12 ? 0 : 0.03 * std::sin(a), 0.03 - 0.03 * std::cos(a)});
  }
  const SurfaceMesh mesh = make_revolution(profile, 4000);
  EXPECT_EQ(check(mesh), "accepted");
  for (const Vec3& p : mesh.vertex_m) EXPECT_NEAR(norm(p - Vec3{0, 0.03, 0}), 0.03, 1.5e-4);
}

// The heart has two lobes with a notch between them, a point below, and is symmetric left to right.
TEST(Procedural, HeartLooksLikeOne) {
  const SurfaceMesh h = make_heart(0.08, 5000);
  const double top = bounds_of(h).upper_m.y;
  double notch = 0;
  for (const Vec3& p : h.vertex_m)
    if (std::hypot(p.x, p.z) < 2e-3) notch = std::max(notch, p.y);
  EXPECT_GT(top - notch, 3e-3);
  const Vec3 centre = volume_centre_m(h);
  EXPECT_NEAR(centre.x, 0, 1e-5);
  EXPECT_GT(centre.y, 0.5 * top);  // more of it is above
}

class MeshFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("palpate_mesh_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  // What reading and checking `path` complains about.
  static std::string complaint(const std::string& path, double scale = 1e-3) {
    return test::refusal_by([&] { check_mesh(read_mesh(path, scale).mesh, path); });
  }
  std::filesystem::path folder_;
};

SurfaceMesh ball() { return make_ellipsoid({0.02, 0.02, 0.02}, 320); }

std::string obj_text(const SurfaceMesh& mesh) {
  std::string text;
  char line[128];
  for (const Vec3& p : mesh.vertex_m) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
    text += line;
  }
  for (const Corners& c : mesh.triangle) {
    std::snprintf(line, sizeof line, "f %d %d %d\n", c[0] + 1, c[1] + 1, c[2] + 1);
    text += line;
  }
  return text;
}
std::string stl_bytes(const SurfaceMesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const Corners& c : mesh.triangle) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const std::int32_t i : c) {
      const Vec3 p = 1e3 * mesh.vertex_m[static_cast<std::size_t>(i)];
      for (const double x : {p.x, p.y, p.z}) put(static_cast<float>(x));
    }
    put(static_cast<std::uint16_t>(0));
  }
  return bytes;
}
std::string ply_text(const SurfaceMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertex_m.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(mesh.triangle.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  char line[128];
  for (const Vec3& p : mesh.vertex_m) {
    std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
    text += line;
  }
  for (const Corners& c : mesh.triangle) {
    std::snprintf(line, sizeof line, "3 %d %d %d\n", c[0], c[1], c[2]);
    text += line;
  }
  return text;
}

TEST_F(MeshFileTest, ReadsAllFormats) {
  const SurfaceMesh mesh = ball();
  for (const std::string& path :
       {write("a.obj", obj_text(mesh)), write("a.stl", stl_bytes(mesh)), write("a.PLY", ply_text(mesh))}) {
    const MeshFile file = read_mesh(path, 1e-3);
    EXPECT_EQ(complaint(path), "accepted") << path;
    EXPECT_EQ(file.mesh.vertex_m.size(), mesh.vertex_m.size()) << path;  // welded: STL repeats every vertex
    EXPECT_EQ(file.mesh.triangle.size(), mesh.triangle.size()) << path;
    EXPECT_NEAR(signed_volume_m3(file.mesh), signed_volume_m3(mesh), 1e-6 * signed_volume_m3(mesh)) << path;
  }
}

TEST_F(MeshFileTest, TriangulatesPolygons) {
  const std::string cube =
      "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
  const std::string path = write("cube.obj", cube);
  EXPECT_EQ(complaint(path), "accepted");
  EXPECT_EQ(read_mesh(path, 1e-3).mesh.triangle.size(), 12u);
}

TEST_F(MeshFileTest, NamesMissingEmptyAndUnknownFiles) {
  EXPECT_THAT(complaint((folder_ / "none.obj").string()), AllOf(HasSubstr("none.obj"), HasSubstr("no such mesh file")));
  EXPECT_THAT(complaint(write("e.stl", "")), HasSubstr("the mesh file is empty"));
  EXPECT_THAT(complaint(write("x.fbx", "abc")), HasSubstr("unknown mesh format '.fbx'"));
  EXPECT_THAT(complaint(write("v.obj", "v 0 0 0\nv 1 0 0\n")), HasSubstr("v.obj"));
  EXPECT_THAT(complaint(folder_.string() + "/"), HasSubstr("unknown mesh format"));
}

// A file cut anywhere is never accepted, because the surface is closed only with its last triangle.
TEST_F(MeshFileTest, TruncatedFilesAreRefused) {
  const SurfaceMesh mesh = ball();
  const std::map<std::string, std::string> files = {
      {"t.obj", obj_text(mesh)}, {"t.stl", stl_bytes(mesh)}, {"t.ply", ply_text(mesh)}};
  for (const auto& [name, bytes] : files)
    for (int part = 1; part < 40; ++part) {
      const std::size_t n = bytes.size() * static_cast<std::size_t>(part) / 40;
      EXPECT_THAT(complaint(write(name, bytes.substr(0, n))), HasSubstr(name)) << name << " cut at " << n;
    }
}

TEST_F(MeshFileTest, BrokenContentIsRefused) {
  const SurfaceMesh mesh = ball();
  std::string obj = obj_text(mesh);
  EXPECT_THAT(complaint(write("index.obj", obj + "f 1 2 99999\n")), HasSubstr("index.obj"));
  std::string nan = obj;
  nan.replace(0, nan.find('\n'), "v nan 0 0");
  EXPECT_THAT(complaint(write("nan.obj", nan)), HasSubstr("nan.obj"));
  EXPECT_THAT(complaint(write("text.ply", "ply\nthis is not a mesh\n")), HasSubstr("text.ply"));
  EXPECT_THAT(complaint(write("scale.obj", obj), 1.0), HasSubstr("body.scale"));
}

}  // namespace
}  // namespace palpate
