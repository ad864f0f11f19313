// Tetrahedral meshes: boundary, middle nodes, and every error of the checks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "config/fem/linear_body.h"
#include "config/fem/tet_element.h"
#include "config/fem/tet_procedural.h"
#include "config/index.h"
#include "tests/fem/expect_error.h"

namespace palpate {
namespace {

std::string check_error(const TetMesh& mesh) {
  return test::refusal_by([&] { check_tet_mesh(mesh, "block"); });
}

TetMesh block() { return make_box_tets({0.04, 0.03, 0.05}, {2, 2, 2}); }

double volume_of(const TetMesh& mesh) {
  double volume = 0;
  for (const Tet& tet : mesh.tet) volume += corner_volume_m3(mesh, tet);
  return volume;
}

TEST(TetMesh, BoxIsSound) {
  const TetMesh mesh = block();
  check_tet_mesh(mesh, "block");
  EXPECT_EQ(mesh.tet.size(), 48u);
  EXPECT_EQ(mesh.node_m.size(), 125u);
  EXPECT_NEAR(volume_of(mesh), 6e-5, 1e-18);
  const TetSurface surface = surface_of(mesh);
  EXPECT_EQ(surface.node.size(), 98u);            // 125 minus the inner 3 x 3 x 3
  EXPECT_EQ(surface.mesh.triangle.size(), 192u);  // 6 sides of 8 faces of 4 triangles
  EXPECT_NEAR(signed_volume_m3(surface.mesh), 6e-5, 1e-18);
  EXPECT_TRUE(std::is_sorted(surface.node.begin(), surface.node.end()));
}

// An even number of cells along x or z makes the mirrored box its own mirror image there, element by element and bit by
// bit.
TEST(TetMesh, MirroredBoxIsItsOwnMirrorImageToTheBit) {
  using Place = std::array<double, 3>;
  const auto elements = [](const TetMesh& mesh, Vec3 sign) {
    std::set<std::vector<Place>> all;
    for (const Tet& tet : mesh.tet) {
      std::vector<Place> places;
      for (const std::int32_t i : tet.node) {
        const Vec3 p = mesh.node_m[static_cast<std::size_t>(i)];
        places.push_back({sign.x * p.x, p.y, sign.z * p.z});
      }
      std::sort(places.begin(), places.end());
      all.insert(places);
    }
    return all;
  };
  for (const std::array<std::int32_t, 3> cells : {std::array{4, 3, 2}, {3, 1, 4}, {2, 2, 5}, {3, 2, 1}, {1, 1, 1}}) {
    const TetMesh mesh = make_mirrored_box_tets({0.024, 0.031, 0.017}, cells);
    check_tet_mesh(mesh, "box");
    EXPECT_NEAR(volume_of(mesh), 0.024 * 0.031 * 0.017, 1e-18);
    EXPECT_EQ(mesh.tet.size(), static_cast<std::size_t>(6 * cells[0] * cells[1] * cells[2]));
    EXPECT_EQ(mesh.node_m.size(),
              static_cast<std::size_t>((2 * cells[0] + 1) * (2 * cells[1] + 1) * (2 * cells[2] + 1)));
    const auto as_made = elements(mesh, {1, 1, 1});
    EXPECT_EQ(as_made.size(), mesh.tet.size());
    EXPECT_EQ(elements(mesh, {-1, 1, 1}) == as_made, cells[0] % 2 == 0);
    EXPECT_EQ(elements(mesh, {1, 1, -1}) == as_made, cells[2] % 2 == 0);
  }
}

// Any choice of quadratic elements must give a closed surface with every boundary node on it.
TEST(TetMesh, MixedOrderHasAClosedBoundaryWithAllItsNodes) {
  TetMesh linear = block();
  linear.node_m.resize(27);
  for (Tet& tet : linear.tet) std::fill(tet.node.begin() + 4, tet.node.end(), -1);
  for (std::size_t seed = 0; seed < 20; ++seed) {
    TetMesh mesh = linear;
    std::vector<char> wanted(mesh.tet.size(), 0);
    for (std::size_t t = seed; t < wanted.size(); t += 5 + seed % 7) wanted[t] = 1;
    add_middle_nodes(mesh, wanted);
    check_tet_mesh(mesh, "mixed");
    const TetSurface surface = surface_of(mesh);
    EXPECT_NEAR(signed_volume_m3(surface.mesh), 6e-5, 1e-18);
    std::size_t on_boundary = 0;
    for (const Vec3 p : mesh.node_m)
      on_boundary += std::abs(std::abs(p.x) - 0.02) < 1e-12 || std::abs(p.y) < 1e-12 || std::abs(p.y - 0.03) < 1e-12 ||
                     std::abs(std::abs(p.z) - 0.025) < 1e-12;
    EXPECT_EQ(surface.node.size(), on_boundary);
  }
}

TEST(TetMesh, InvertedTetrahedronIsNamed) {
  TetMesh mesh = block();
  std::swap(mesh.tet[17].node[0], mesh.tet[17].node[1]);
  const std::string text = check_error(mesh);
  EXPECT_SAYS(text, "block: tetrahedron 17 is inverted (volume -");
  EXPECT_SAYS(text, "exchange two of its corners");
}

TEST(TetMesh, FlatTetrahedronIsNamed) {
  TetMesh mesh;
  mesh.node_m = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.004, 0.004, 1e-14}};
  mesh.tet.resize(1);
  for (std::size_t k = 0; k < 4; ++k) mesh.tet[0].node[k] = static_cast<std::int32_t>(k);
  EXPECT_SAYS(check_error(mesh), "block: tetrahedron 0 has no volume, at (0, 0, 0) mm");
}

TEST(TetMesh, FoldedCurvedElementIsNamed) {
  TetMesh mesh = block();
  // The middle node of an edge, moved most of the way to one end.
  const Tet& tet = mesh.tet[5];
  mesh.node_m[at(tet.node[4])] = 0.95 * mesh.node_m[at(tet.node[0])] + 0.05 * mesh.node_m[at(tet.node[1])];
  EXPECT_SAYS(check_error(mesh), "folds: a middle node lies too far from its edge");
}

TEST(TetMesh, DuplicatedAndUnusedNodesAreNamed) {
  TetMesh loose = block();
  loose.node_m.push_back({0.1, 0.2, 0.3});
  EXPECT_SAYS(check_error(loose), "1 nodes belong to no tetrahedron, the first is node 125 at (100, 200, 300) mm");
  TetMesh twin = block();
  const auto copy = static_cast<std::int32_t>(twin.node_m.size());
  twin.node_m.push_back(twin.node_m[0]);
  std::replace(twin.tet[0].node.begin(), twin.tet[0].node.end(), 0, copy);  // other elements keep the first
  EXPECT_SAYS(check_error(twin), "nodes 0 and 125 lie in the same place, at (-20, 0, -25) mm");
}

TEST(TetMesh, NumbersOutOfRangeAndNotFinite) {
  TetMesh range = block();
  range.tet[3].node[2] = 400;
  EXPECT_SAYS(check_error(range), "tetrahedron 3 refers to node 400; allowed 0 to 124");
  TetMesh negative = block();
  negative.tet[3].node[2] = -1;
  EXPECT_SAYS(check_error(negative), "tetrahedron 3 refers to node -1");
  TetMesh nan = block();
  nan.node_m[7].y = std::nan("");
  EXPECT_SAYS(check_error(nan), "node 7 is not a finite number");
  EXPECT_SAYS(check_error(TetMesh{}), "holds no tetrahedra");
}

TEST(TetMesh, OverlappingElementsAreNamed) {
  TetMesh repeated = block();
  repeated.tet.push_back(repeated.tet[4]);
  EXPECT_SAYS(check_error(repeated), "tetrahedron 48");
}

TEST(TetMesh, DisagreementAboutAMiddleNodeIsNamed) {
  TetMesh mesh = block();
  const std::int32_t middle = mesh.tet[0].node[4];
  const auto copy = static_cast<std::int32_t>(mesh.node_m.size());
  mesh.node_m.push_back(mesh.node_m[at(middle)] + Vec3{1e-5, 0, 0});
  mesh.tet[0].node[4] = copy;
  EXPECT_SAYS(check_error(mesh), "disagree about the middle node of the edge");
}

// Two blocks that touch along one edge, and two that are apart.
TEST(TetMesh, NonManifoldAndSeparateBoundariesAreRefused) {
  TetMesh mesh;
  mesh.node_m = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}, {0, -0.01, 0}, {0, 0, -0.01}, {-0.01, -0.001, 0}};
  const auto tet = [&](std::array<std::int32_t, 4> corners) {
    Tet t;
    std::copy(corners.begin(), corners.end(), t.node.begin());
    if (corner_volume_m3(mesh, t) < 0) std::swap(t.node[0], t.node[1]);
    return t;
  };
  TetMesh edge = mesh;
  edge.tet = {tet({0, 1, 2, 3}), tet({0, 1, 4, 5})};
  edge.node_m.resize(6);
  EXPECT_SAYS(check_error(edge), "shared by more than two triangles");
  TetMesh vertex = mesh;
  vertex.tet = {tet({0, 1, 2, 3}), tet({0, 6, 4, 5})};
  EXPECT_SAYS(check_error(vertex), "two sheets of the surface touch at vertex 0");
}

TEST(Material, LimitsOfPoissonAndYoung) {
  for (const double nu : {0.5, 0.6, 1.0, -1.0, -2.0, std::nan("")})
    EXPECT_SAYS(test::refusal_by([&] { check_material({1e6, nu}, "block"); }), "Poisson's ratio is");
  for (const double nu : {-0.99, 0.0, 0.49, 0.4999999}) EXPECT_NO_THROW(check_material({1e6, nu}, "block")) << nu;
  for (const double young : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_SAYS(test::refusal_by([&] { check_material({young, 0.3}, "block"); }), "Young's modulus");
}

TEST(Material, LinearElementsAreRefusedWhereTheyLock) {
  TetMesh mesh = block();
  mesh.node_m.resize(27);
  for (Tet& tet : mesh.tet) std::fill(tet.node.begin() + 4, tet.node.end(), -1);
  const Supports supports = hold_where(mesh, [](Vec3 p) { return p.y == 0; });
  EXPECT_SAYS(test::refusal_by([&] {
                LinearBody(mesh, {1e6, 0.495}, supports, "block");
              }),
              "make all elements quadratic");
  EXPECT_NO_THROW(LinearBody(mesh, {1e6, 0.49}, supports, "block"));
}

TEST(Supports, FreeRigidMotionsAreSpelledOut) {
  const TetMesh mesh = block();
  const auto said = [&](const Supports& supports) {
    return test::refusal_by([&] { check_supports(mesh, supports, "block"); });
  };
  const Supports none(mesh.node_m.size(), 0);
  const std::string all = said(none);
  for (const char* part : {"slide along x", "slide along y", "slide along z", "turn about an axis along x",
                           "turn about an axis along y", "turn about an axis along z"})
    EXPECT_SAYS(all, part);
  // One node held: it turns about that node.
  const std::string one = said(hold_where(mesh, [](Vec3 p) { return norm(p - Vec3{-0.02, 0, -0.025}) < 1e-9; }));
  EXPECT_SAYS(one, "turn about an axis along x through (0, 0, -25) mm");
  EXPECT_EQ(one.find("slide"), std::string::npos) << one;
  // A hinge: the nodes of one edge along z.
  const std::string hinge = said(hold_where(mesh, [](Vec3 p) { return p.x < -0.0199 && p.y == 0; }));
  EXPECT_SAYS(hinge, "it can turn about an axis along z through (-20, 0, 0) mm;");
  // A plane on which it slides.
  Supports sliding = none;
  for (std::size_t i = 0; i < sliding.size(); ++i)
    if (mesh.node_m[i].y == 0) sliding[i] = 2;
  EXPECT_SAYS(said(sliding),
              "it can turn about an axis along y through (0, 15, 0) mm, slide along x and slide along z;");
  // A diagonal hinge.
  const std::string diagonal =
      said(hold_where(mesh, [](Vec3 p) { return std::abs(p.x * 0.03 + p.y * 0.04 - 0.0006) < 1e-9 && p.z > 0.024; }));
  EXPECT_SAYS(diagonal, "along (0.8, -0.6, 0)");
  EXPECT_EQ(said(hold_where(mesh, [](Vec3 p) { return p.y == 0; })), "accepted");
}

TEST(Supports, WrongNumberOfEntries) {
  const TetMesh mesh = block();
  EXPECT_SAYS(test::refusal_by([&] { check_supports(mesh, Supports(7, 7), "block"); }), "given for 7 nodes of 125");
}

TEST(Clip, MeshesAreSoundAndSymmetric) {
  const double pi = std::acos(-1.0);
  // 260 degrees of a ring 10/12 mm and two half discs of radius 1 mm, 10 mm wide.
  const double exact = 1e-9 * 10 * (130.0 / 180 * pi * (144 - 100) + pi);
  for (std::int32_t level = 1; level <= kMostClipLevel; ++level) {
    const TetMesh mesh = make_clip_mesh(level);
    check_tet_mesh(mesh, "clip");
    double volume = 0;
    for (const Tet& tet : mesh.tet)
      for (const TetPoint& p : tet_rule_14()) volume += p.weight * map_tet(mesh, tet, p.lambda).determinant_m3 / 6;
    EXPECT_NEAR(volume / exact, 1.0, 2e-4) << level;  // parabolas instead of arcs of 15 degrees
    std::set<std::array<long long, 3>> places;
    const auto place = [](double x, double y, double z) {
      return std::array{std::llround(x * 1e10), std::llround(y * 1e10), std::llround(z * 1e10)};
    };
    for (const Vec3 p : mesh.node_m) places.insert(place(p.x, p.y, p.z));
    for (const Vec3 p : mesh.node_m) EXPECT_TRUE(places.contains(place(-p.x, p.y, p.z)));
    const Supports supports = clip_supports(mesh);
    for (std::size_t i = 0; i < supports.size(); ++i) {
      const Vec3 p = mesh.node_m[i];
      const bool held = std::hypot(p.x, p.y) > 0.012 - 1e-9 && std::atan2(std::abs(p.x), -p.y) < 20.0001 / 180 * pi;
      EXPECT_EQ(supports[i] != 0, held);
    }
    if (level == 1) {
      EXPECT_EQ(mesh.node_m.size(), 717u);
      EXPECT_EQ(mesh.tet.size(), 282u);
    }
  }
  EXPECT_SAYS(test::refusal_by([] { make_clip_mesh(4); }), "allowed 1 (coarse) to 3");
}

// A push that is symmetric about x = 0 gives a symmetric answer: the mesh itself is symmetric.
TEST(Clip, SymmetricLoadGivesSymmetricDisplacement) {
  const TetMesh mesh = make_clip_mesh(1);
  std::vector<Vec3> force(mesh.node_m.size());
  for (std::size_t i = 0; i < force.size(); ++i)
    if (mesh.node_m[i].y > 0.005) force[i] = {mesh.node_m[i].x > 0 ? 1.0 : -1.0, -0.5, 0};
  const std::vector<Vec3> u = LinearBody(mesh, {2e9, 0.35}, clip_supports(mesh), "clip").solve_m(force);
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    for (std::size_t j = 0; j < u.size(); ++j) {
      const Vec3 p = mesh.node_m[i], q = mesh.node_m[j];
      if (norm(Vec3{-p.x, p.y, p.z} - q) > 1e-9) continue;
      largest = std::max(largest, norm(u[i]));
      difference = std::max(difference, norm(Vec3{-u[i].x, u[i].y, u[i].z} - u[j]));
    }
  EXPECT_LT(difference, 1e-9 * largest);
}

}  // namespace
}  // namespace palpate
