// Tools from meshes: how they are cut into hulls, and that the hulls are what the mesh was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "config/bake/tool_surface.h"
#include "config/body/mesh_io.h"
#include "config/body/procedural.h"
#include "config/scene/config_error.h"
#include "sim_host/mesh/convex_parts.h"
#include "tests/support/baked_scene.h"
#include "tests/support/refusal.h"

namespace palpate::test {
namespace {

using testing::HasSubstr;

// The prism over a polygon without holes, given with its triangles, from z = 0 to `height`.
SurfaceMesh prism(const std::vector<Vec3>& outline, const std::vector<Corners>& cap, double height) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::int32_t>(outline.size());
  for (const double z : {0.0, height})
    for (const Vec3 p : outline) mesh.vertex_m.push_back({p.x, p.y, z});
  for (const Corners& c : cap) {
    mesh.triangle.push_back({c[0], c[2], c[1]});
    mesh.triangle.push_back({c[0] + n, c[1] + n, c[2] + n});
  }
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t j = (i + 1) % n;
    mesh.triangle.push_back({i, j, j + n});
    mesh.triangle.push_back({i, j + n, i + n});
  }
  return mesh;
}
// 30 x 40 mm, arms 10 and 12 mm wide.
SurfaceMesh an_l() {
  const std::vector<Vec3> outline{{0, 0, 0},        {0.03, 0, 0},    {0.03, 0.012, 0},
                                  {0.01, 0.012, 0}, {0.01, 0.04, 0}, {0, 0.04, 0}};
  return prism(outline, {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}, 0.008);
}
SurfaceMesh cube(double side) {
  const double h = 0.5 * side;
  SurfaceMesh mesh = prism({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, {{0, 1, 2}, {0, 2, 3}}, side);
  for (Vec3& p : mesh.vertex_m) p.z -= h;
  return mesh;
}
double volume_m3(const std::vector<Vec3>& corners) { return signed_volume_m3({corners, convex_hull(corners)}); }

// A file of this process, gone with it.
struct ObjFile {
  ObjFile(const char* name, const SurfaceMesh& mesh)
      : path(testing::TempDir() + "palpate_tool_" + std::to_string(getpid()) + name) {
    write_obj(path, mesh);
  }
  ~ObjFile() { std::remove(path.c_str()); }
  std::string path;
};

std::string scene(const std::string& pieces) {
  return "name = \"s\"\n[body]\nshape = \"box\"\nsize_mm = [80, 40, 80]\n" + pieces;
}
std::string mesh_piece(const std::string& path, const std::string& keys = "margin_mm = 2\npoints = 8\n") {
  return "[[tool.piece]]\nshape = \"mesh\"\nmesh = \"" + path + "\"\n" + keys;
}
std::string refusal(const std::string& text) {
  return refusal_by([&] { parse_scene(text, "s.toml"); });
}

TEST(ConvexParts, AnLIsTwo) {
  const SurfaceMesh mesh = an_l();
  const auto parts = convex_parts(mesh, "l");
  ASSERT_EQ(parts.size(), 2u);
  // Within one another nowhere, together the whole: volumes to rounding.
  EXPECT_NEAR((volume_m3(parts[0]) + volume_m3(parts[1])) / signed_volume_m3(mesh), 1, 1e-9);
}

TEST(ConvexParts, ASceneHasThemAsHullsWhereTheMeshWas) {
  const SurfaceMesh mesh = an_l();
  const ObjFile file("l.obj", mesh);
  const SceneDesc desc =
      parse_scene(scene(mesh_piece(file.path, "points = 8\nposition_mm = [5, 60, 0]\nrotation_deg = [0, 0, 90]\n") +
                        "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n"),
                  "s.toml");
  ASSERT_EQ(desc.piece.size(), 3u);
  EXPECT_EQ(desc.piece[1].shape, PieceShape::kSphere);  // stays where it was written
  double volume = 0;
  std::vector<Vec3> corners;
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    const PieceDesc& piece = desc.piece[i];
    EXPECT_EQ(piece.shape, PieceShape::kHull);
    volume += volume_m3(piece.vertices_m);
    for (const Vec3 p : piece.vertices_m) corners.push_back(piece.position_m + Vec3{-p.y, p.x, p.z});
  }
  EXPECT_NEAR(volume / signed_volume_m3(mesh), 1, 1e-6);  // the file keeps single precision
  for (const Vec3 p : mesh.vertex_m) {
    const Vec3 placed{0.005 - p.y, 0.06 + p.x, p.z};
    EXPECT_TRUE(std::ranges::any_of(corners, [&](Vec3 q) { return norm(q - placed) < 1e-8; }));
  }
}

// Largest difference of the forces while a tool slides 40 mm over the block, 4 mm deeper; the last one's size.
struct Compared {
  double apart_N = 0, force_N = 0;
};
Compared slide_both(const std::string& one, const std::string& other) {
  const BakedScene first(scene(one)), second(scene(other));
  Bench by_one(first.model()), by_other(second.model());
  Compared out;
  for (int i = 0; i <= 40; ++i) {
    const Pose pose{{0.001 * i, 0.05 - 0.0001 * i, 0.003}, {}};
    const Vec3 force = by_one.tick_at(pose, {}).contact_w.force_N;
    out.apart_N = std::max(out.apart_N, norm(force - by_other.tick_at(pose, {}).contact_w.force_N));
    out.force_N = norm(force);
  }
  return out;
}

// A box's margin is part of its sides, a mesh's is added. By the springs alone: friction and far fields are sized by
// the area of the tool, which hulls count without the roundings of their edges.
TEST(ConvexParts, ACubesForceIsTheBoxs) {
  const ObjFile file("cube.obj", cube(0.016));
  const std::string springs = "[friction]\nlaw = \"none\"\n[coupling]\nlaw = \"none\"\n";
  const Compared box =
      slide_both(springs + "[[tool.piece]]\nshape = \"box\"\nsize_mm = [20, 20, 20]\nmargin_mm = 2\npoints = 8\n",
                 springs + mesh_piece(file.path));
  EXPECT_GT(box.force_N, 1);
  EXPECT_LT(box.apart_N, 1e-6 * box.force_N);
  const Compared hull = slide_both(
      "[[tool.piece]]\nshape = \"hull\"\nvertices_mm = [[-8, -8, -8], [8, -8, -8], [8, 8, -8], [-8, 8, -8], [-8, -8, "
      "8], "
      "[8, -8, 8], [8, 8, 8], [-8, 8, 8]]\nmargin_mm = 2\npoints = 8\n",
      mesh_piece(file.path));
  EXPECT_LT(hull.apart_N, 1e-6 * hull.force_N);
}

TEST(ConvexParts, WhatCannotBeATool) {
  SurfaceMesh open = cube(0.016);
  open.triangle.pop_back();
  const ObjFile holed("open.obj", open), round("ball.obj", make_ellipsoid({0.01, 0.01, 0.01}, 400)),
      l("l2.obj", an_l());
  EXPECT_THAT(refusal(scene(mesh_piece(holed.path))), HasSubstr("s.toml:7: tool.piece[0].mesh: "));
  EXPECT_THAT(refusal(scene(mesh_piece(holed.path))), HasSubstr("`palpate mesh` repairs"));
  EXPECT_THAT(refusal(scene(mesh_piece(round.path))), HasSubstr("corners; allowed 64: simplify the mesh"));
  EXPECT_THAT(refusal(scene(mesh_piece("no.obj"))), HasSubstr("no.obj"));
  EXPECT_THAT(refusal(scene("[[tool.piece]]\nshape = \"mesh\"\n")), HasSubstr("tool.piece[0].mesh: missing"));
  EXPECT_THAT(refusal(scene("[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\nmesh = \"a.obj\"\n")),
              HasSubstr("tool.piece[0].mesh: has no effect for this shape"));
  std::string many = mesh_piece(l.path);
  for (int i = 0; i < kMaxPieces - 1; ++i) many += "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n";
  EXPECT_THAT(refusal(scene(many)), HasSubstr("makes 2 convex parts, and 1 of the 64 pieces of a tool are left"));
}

}  // namespace
}  // namespace palpate::test
