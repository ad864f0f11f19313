// Mesh files of Gmsh and VTK, and the program gmsh.
#include "config/fem/tet_io.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/body/procedural.h"
#include "config/fem/tet_element.h"
#include "tests/fem/expect_error.h"
#include "tests/fem/temporary_folder.h"

namespace palpate {
namespace {

// Written by gmsh 4.8 from a surface of four triangles, -order 2.
constexpr const char* kMsh22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
11
1 0 0 0
2 10 0 0
3 0 10 0
4 0 0 10
5 0 5 0
6 5 5 0
7 5 0 0
8 5 0 5
9 0 0 5
10 0 5 5
99 1 2 3
$EndNodes
$Elements
2
1 9 2 0 1 1 3 2 5 6 7
5 11 2 0 1 1 3 4 2 5 10 9 7 8 6
$EndElements
)";
constexpr const char* kMsh41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
0 0 1 1
1 0 0 0 10 10 10 0 0
1 0 0 0 10 10 10 0 1 1
$EndEntities
$Nodes
2 5 1 5
2 1 1 4
1
2
3
4
0 0 0 0.5 0.5
10 0 0 0.1 0.2
0 10 0 0.3 0.4
0 0 10 0.5 0.6
3 1 0 1
5
-10 0 0
$EndNodes
$Elements
2 3 1 5
2 1 2 1
1 1 3 2
3 1 4 2
5 1 3 4 2
6 1 4 3 5
$EndElements
)";
constexpr const char* kVtu = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">
  <UnstructuredGrid>
    <Piece NumberOfPoints="10" NumberOfCells="2">
      <Points>
        <DataArray type="Float64" NumberOfComponents="3" format="ascii">
          0 0 0  10 0 0  0 10 0  0 0 10  5 0 0  5 5 0  0 5 0  0 0 5  5 0 5  0 5 5
        </DataArray>
      </Points>
      <Cells>
        <DataArray type="Int64" Name="connectivity" format="ascii">0 1 2  0 1 2 3 4 5 6 7 8 9</DataArray>
        <DataArray type="Int64" Name="offsets" format="ascii">3 13</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">5 24</DataArray>
      </Cells>
    </Piece>
  </UnstructuredGrid>
</VTKFile>
)";

std::string changed(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}
std::string read_error(const std::string& name, const std::string& text) {
  const TestFolder folder;
  return test::refusal_by([&] { read_tet_mesh(folder.write(name, text), 1); });
}

TEST(TetIo, Msh22QuadraticWithOurOrderOfEdges) {
  const TestFolder folder;
  const TetFile file = read_tet_mesh(folder.write("a.msh", kMsh22), 1e-3);
  ASSERT_EQ(file.mesh.tet.size(), 1u);
  EXPECT_EQ(file.mesh.node_m.size(), 10u);
  EXPECT_EQ(file.unused_nodes, 1);
  EXPECT_EQ(file.other_elements, 1);
  EXPECT_TRUE(file.mesh.tet[0].is_quadratic());
  EXPECT_FALSE(is_curved(file.mesh, file.mesh.tet[0]));  // every middle node in the middle of its own edge
  EXPECT_NEAR(corner_volume_m3(file.mesh, file.mesh.tet[0]), 1e-6 / 6, 1e-18);
  check_tet_mesh(file.mesh, "a.msh");
}

TEST(TetIo, Msh41WithBlocksAndParametricNodes) {
  const TestFolder folder;
  const TetFile file = read_tet_mesh(folder.write("a.msh", kMsh41), 1e-3);
  ASSERT_EQ(file.mesh.tet.size(), 2u);
  EXPECT_EQ(file.mesh.node_m.size(), 5u);
  EXPECT_EQ(file.mesh.node_m[4], (Vec3{-0.01, 0, 0}));
  check_tet_mesh(file.mesh, "a.msh");
}

TEST(TetIo, VtuQuadratic) {
  const TestFolder folder;
  const TetFile file = read_tet_mesh(folder.write("a.VTU", kVtu), 1e-3);
  ASSERT_EQ(file.mesh.tet.size(), 1u);
  EXPECT_EQ(file.other_elements, 1);
  EXPECT_FALSE(is_curved(file.mesh, file.mesh.tet[0]));
  check_tet_mesh(file.mesh, "a.vtu");
}

TEST(TetIo, BrokenGmshFilesAreExplained) {
  const std::string good = kMsh22;
  EXPECT_SAYS(read_error("a.msh", changed(good, "2.2 0 8", "2.2 1 8")), "a.msh:2: the mesh is binary");
  EXPECT_SAYS(read_error("a.msh", changed(good, "2.2 0 8", "4.0 0 8")), "mesh format 4.0 is not supported");
  EXPECT_SAYS(read_error("a.msh", changed(good, "3 0 10 0", "3 0 ten 0")), "a.msh:8: 'ten' stands where a node's");
  EXPECT_SAYS(read_error("a.msh", changed(good, "3 0 10 0", "2 0 10 0")), "node 2 is given twice");
  EXPECT_SAYS(read_error("a.msh", changed(good, "7 8 6", "7 8 66")), "has the node 66, which the file does not hold");
  EXPECT_SAYS(read_error("a.msh", changed(good, "5 11 2 0 1", "5 5 2 0 1")), "element type 5 is not supported");
  EXPECT_SAYS(read_error("a.msh", changed(good, "\n11\n1 0", "\n99999999999\n1 0")), "which the file cannot hold");
  EXPECT_SAYS(read_error("a.msh", good.substr(0, 150)), "truncated");
  EXPECT_SAYS(read_error("a.msh", changed(good, "$EndNodes", "$EndThings")), "should be");
  EXPECT_SAYS(read_error("a.msh", "solid x\n"), "is this a Gmsh mesh?");
  EXPECT_SAYS(read_error("a.msh", ""), "is this a Gmsh mesh?");
  EXPECT_SAYS(read_error("a.msh", good.substr(0, good.find("$Elements"))), "no tetrahedra");
}

TEST(TetIo, BrokenVtkFilesAreExplained) {
  const std::string good = kVtu;
  EXPECT_SAYS(read_error("a.vtu", changed(good, "format=\"ascii\"", "format=\"appended\"")),
              "a.vtu:6: array \"Points\"");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "Points=\"10\"", "Points=\"11\"")),
              "30 coordinates for NumberOfPoints");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "5 24", "5 12")), "cell 1 has type 12");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "5 24", "5 10")), "cell 1 has 10 nodes; its type 10 needs 4");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "3 13", "3 14")), "offset 14 of cell 1");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "7 8 9<", "7 8 10<")), "node 10, which the file does not hold");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "3 13", "3 x")), "not a number");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "Name=\"types\"", "Name=\"kinds\"")), "there is no array \"types\"");
  EXPECT_SAYS(read_error("a.vtu", changed(good, "\"UnstructuredGrid\"", "\"PolyData\"")), "found \"PolyData\"");
  EXPECT_SAYS(read_error("a.vtu", good.substr(0, 300)), "not well-formed XML");
  const std::string empty = changed(changed(good, "0 1 2  0 1 2 3 4 5 6 7 8 9<", "<"), "3 13", "0 0");
  EXPECT_SAYS(read_error("a.vtu", empty), "cell 1 has 0 nodes; its type 24 needs 10");
}

TEST(TetIo, MissingFileAndUnknownExtension) {
  EXPECT_THROW(read_tet_mesh("no/such/file.msh", 1), ConfigError);
  EXPECT_THROW(read_tet_mesh("no/such/file.vtu", 1), ConfigError);
  EXPECT_SAYS(read_error("a.stl", "solid"), "allowed .msh (Gmsh) and .vtu (VTK)");
}

TEST(Gmsh, FillsAnEllipsoidTheSameWayTwice) {
  const SurfaceMesh surface = make_ellipsoid({0.040, 0.030, 0.025}, 500);
  const TetMesh mesh = tetrahedralise(surface, 0.010, "ellipsoid");
  check_tet_mesh(mesh, "ellipsoid");
  double volume = 0;
  for (const Tet& tet : mesh.tet) volume += corner_volume_m3(mesh, tet);
  EXPECT_NEAR(volume, signed_volume_m3(surface), 1e-12 * volume);
  // The surface's own vertices are the boundary, and there are nodes inside.
  EXPECT_EQ(surface_of(mesh).node.size(), surface.vertex_m.size());
  EXPECT_GT(mesh.node_m.size(), surface.vertex_m.size());
  const TetMesh again = tetrahedralise(surface, 0.010, "ellipsoid");
  ASSERT_EQ(again.tet.size(), mesh.tet.size());
  EXPECT_EQ(again.node_m, mesh.node_m);
  for (std::size_t t = 0; t < mesh.tet.size(); ++t) EXPECT_EQ(again.tet[t].node, mesh.tet[t].node);
}

// Middle nodes moved onto the true surface: parabolas instead of chords, a hundredth of the volume error.
TEST(Gmsh, CurvedEdgesFollowTheEllipsoid) {
  const Vec3 half{0.040, 0.030, 0.025};
  const double exact = 4.0 / 3 * std::acos(-1.0) * half.x * half.y * half.z;
  TetMesh mesh = tetrahedralise(make_ellipsoid(half, 500), 0.010, "ellipsoid");
  double straight = 0, curved = 0;
  for (const Tet& tet : mesh.tet) straight += corner_volume_m3(mesh, tet);
  add_middle_nodes(mesh, {}, [&](Vec3 p, std::int32_t, std::int32_t) {
    const Vec3 q{p.x / half.x, p.y / half.y - 1, p.z / half.z};  // the ellipsoid stands on y = 0
    const Vec3 u = unit_or(q, {});
    return Vec3{half.x * u.x, half.y * (u.y + 1), half.z * u.z};
  });
  check_tet_mesh(mesh, "ellipsoid");
  for (const Tet& tet : mesh.tet)
    for (const TetPoint& p : tet_rule_14()) curved += p.weight * map_tet(mesh, tet, p.lambda).determinant_m3 / 6;
  EXPECT_GT(1 - straight / exact, 0.01);
  EXPECT_LT(std::abs(1 - curved / exact), 1e-4);
}

TEST(Gmsh, OpenAndSelfIntersectingSurfacesAreRefused) {
  SurfaceMesh open = make_box({0.04, 0.04, 0.04}, 100);
  open.triangle.pop_back();
  EXPECT_THROW(tetrahedralise(open, 0.01, "box"), ConfigError);
  SurfaceMesh crossed = make_box({0.04, 0.04, 0.04}, 100);
  std::size_t top = 0;
  for (std::size_t i = 0; i < crossed.vertex_m.size(); ++i)
    if (crossed.vertex_m[i].y > 0.039 && std::abs(crossed.vertex_m[i].x) < 0.015 &&
        std::abs(crossed.vertex_m[i].z) < 0.015)
      top = i;
  crossed.vertex_m[top].y = -0.02;  // through the bottom
  EXPECT_SAYS(test::refusal_by([&] { tetrahedralise(crossed, 0.01, "box"); }), "cut itself? It said: Error");
  EXPECT_THROW(tetrahedralise(make_box({0.04, 0.04, 0.04}, 100), 0, "box"), ConfigError);
}

}  // namespace
}  // namespace palpate
