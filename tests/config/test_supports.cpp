// What a scene can say about where its body is and what holds it: regions, components, place and turn.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "config/bake/fem_body.h"
#include "config/body/anchors.h"
#include "config/body/body.h"
#include "config/body/supports.h"
#include "config/fem/linear_body.h"
#include "config/response/corner_normals.h"
#include "config/scene/config_error.h"
#include "tests/support/baked_scene.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

const char* const kTool = "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n";

// A box of 120 x 10 x 10 mm for finite elements of 5 mm; it stands on y = 0 around the origin.
std::string bar(const std::string& fixed, const std::string& body_keys = "") {
  return "name = \"bar\"\n[body]\nshape = \"box\"\nsize_mm = [120, 10, 10]\n" + body_keys +
         "[body.material]\nyoungs_modulus_Pa = 1e6\npoisson_ratio = 0.3\n[body.fem]\nedge_mm = 5\n[contact]\n"
         "backend = \"elastic\"\n" +
         fixed + kTool;
}
// Everything at x <= -50 mm, or at x >= 50 mm: 100 mm stay free.
const char* const kLeft = "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-100, -1, -10]\nto_mm = [-50, 11, 10]\n";
const char* const kRight = "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [50, -1, -10]\nto_mm = [100, 11, 10]\n";

std::string refusal(const std::string& text) {
  return test::refusal_by([&] {
    const SceneDesc scene = parse_scene(text, "s.toml");
    std::vector<std::string> warnings;
    const TetMesh mesh = make_tet_mesh(scene, warnings);
    check_supports(mesh, supports_of(scene, mesh), "s.toml: body");
  });
}

struct Pressed {
  explicit Pressed(const std::string& text) : scene(parse_scene(text, "s.toml")), mesh(make_tet_mesh(scene, warnings)) {
    supports = supports_of(scene, mesh);
  }
  std::vector<Vec3> moved_by(const std::vector<Vec3>& force_N) const {
    return LinearBody(mesh, {scene.material.youngs_modulus_Pa, scene.material.poisson_ratio}, supports, "bar")
        .solve_m(force_N);
  }
  std::vector<std::string> warnings;
  SceneDesc scene;
  TetMesh mesh;
  Supports supports;
};

// Newtons per metre of a bar pressed down across its section at x = 0.
double stiffness_in_the_middle(const std::string& fixed) {
  const Pressed bar_of(bar(fixed));
  std::vector<Vec3> force_N(bar_of.mesh.node_m.size());
  std::vector<std::size_t> middle;
  for (std::size_t n = 0; n < force_N.size(); ++n)
    if (std::abs(bar_of.mesh.node_m[n].x) < 1e-6) middle.push_back(n);
  for (const std::size_t n : middle) force_N[n].y = -1 / static_cast<double>(middle.size());
  const std::vector<Vec3> moved = bar_of.moved_by(force_N);
  double work = 0;
  for (const std::size_t n : middle) work += dot(force_N[n], moved[n]);
  return 1 / work;
}

// Timoshenko's beam: clamped at both ends 1 / (L^3 / 192 EI + L / 4 kGA), at one end with the force in its middle
// 1 / (a^3 / 3 EI + a / kGA), a = L / 2. Elements of half the height are 1 % stiff, the clamped sections another.
TEST(Supports, TwoBoxesHoldABarAtBothEnds) {
  const double E = 1e6, G = E / 2.6, side = 0.01, L = 0.1, I = std::pow(side, 4) / 12, kGA = G * side * side * 5 / 6;
  const double both = 1 / (std::pow(L, 3) / (192 * E * I) + L / (4 * kGA));
  const double one = 1 / (std::pow(L / 2, 3) / (3 * E * I) + L / 2 / kGA);
  EXPECT_NEAR(stiffness_in_the_middle(std::string(kLeft) + kRight) / both, 1, 0.03);
  EXPECT_NEAR(stiffness_in_the_middle(kLeft) / one, 1, 0.03);
}

// On a plate without friction, with two planes of symmetry, pressure p gives the strain p / E everywhere.
TEST(Supports, PlatesHoldOneComponent) {
  const Pressed column(
      "name = \"column\"\n[body]\nshape = \"box\"\nsize_mm = [20, 40, 30]\n[body.material]\nyoungs_modulus_Pa = 1e6\n"
      "poisson_ratio = 0.3\n[body.fem]\nedge_mm = 10\n[contact]\nbackend = \"elastic\"\n"
      "[[body.fixed]]\nbase_height_mm = 0\nholds = \"y\"\n"
      "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-11, -1, -16]\nto_mm = [-10, 41, 16]\nholds = \"x\"\n"
      "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-11, -1, -16]\nto_mm = [11, 41, -15]\nholds = \"z\"\n" +
      std::string(kTool));
  // Consistent with a uniform pressure whatever the mesh: the reactions of a uniform strain.
  const double strain = 1e-3, E = 1e6, nu = 0.3;
  std::vector<Vec3> uniform, load(column.mesh.node_m.size());
  for (const Vec3& x : column.mesh.node_m)
    uniform.push_back({nu * strain * (x.x + 0.01), -strain * x.y, nu * strain * (x.z + 0.015)});
  const LinearBody body(column.mesh, {E, nu}, column.supports, "column");
  const std::vector<Vec3> reaction = body.forces_N(uniform);
  double total = 0;
  for (std::size_t n = 0; n < load.size(); ++n)
    if (column.mesh.node_m[n].y > 0.04 - 1e-9) {
      load[n].y = reaction[n].y;
      total += load[n].y;
    }
  EXPECT_NEAR(total, -strain * E * 0.02 * 0.03, 1e-9);
  const std::vector<Vec3> moved = body.solve_m(load);
  for (std::size_t n = 0; n < load.size(); ++n) EXPECT_LT(norm(moved[n] - uniform[n]), 1e-11);
}

TEST(Supports, ABallHoldsWhatIsInIt) {
  const Pressed bar_of(bar("[body.fixed]\nregion = \"ball\"\ncentre_mm = [0, 0, 0]\nradius_mm = 12\n"));
  int held = 0;
  for (std::size_t n = 0; n < bar_of.mesh.node_m.size(); ++n) {
    EXPECT_EQ(bar_of.supports[n], norm(bar_of.mesh.node_m[n]) <= 0.012 + 1e-9 ? kHoldAll : 0);
    held += bar_of.supports[n] == kHoldAll ? 1 : 0;
  }
  EXPECT_GT(held, 20);
}

// A plate of 60 x 2 x 60 mm: the patch is of one face, the ball of both.
TEST(Supports, APatchIsOfOneSide) {
  const auto plate = [](const std::string& region) {
    return Pressed(
        "name = \"plate\"\n[body]\nshape = \"box\"\nsize_mm = [60, 2, 60]\n[body.material]\nyoungs_modulus_Pa = 1e6\n"
        "poisson_ratio = 0.3\n[body.fem]\nedge_mm = 5\n[contact]\nbackend = \"elastic\"\n[body.fixed]\nregion = \"" +
        region + "\"\ncentre_mm = [0, -4, 0]\nradius_mm = 8\n" + kTool);
  };
  const Pressed patch = plate("patch"), ball = plate("ball");
  int held = 0, of_the_ball = 0;
  for (std::size_t n = 0; n < patch.mesh.node_m.size(); ++n) {
    const Vec3 x = patch.mesh.node_m[n];
    // The middle is the foot of the point on the plate; the ball's own is 4 mm below.
    EXPECT_EQ(patch.supports[n] != 0, x.y < 1e-9 && norm(x) <= 0.008 + 1e-9) << n;
    held += patch.supports[n] != 0 ? 1 : 0;
    of_the_ball += ball.supports[n] != 0 && x.y > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(held, 20);
  EXPECT_GT(of_the_ball, 3);
}

// The vertices of the base, by their numbers, are the base; in a file as well.
TEST(Supports, ListedVerticesHoldTheTrianglesBetweenThem) {
  const std::string file = testing::TempDir() + "palpate_vertices_" + std::to_string(getpid()) + ".txt";
  const Pressed base(bar("[body.fixed]\nbase_height_mm = 0\n"));
  std::vector<std::string> warnings;
  const SurfaceMesh surface = make_body(base.scene, warnings);
  std::string numbers, lines;
  for (std::size_t v = 0; v < surface.vertex_m.size(); ++v) {
    if (surface.vertex_m[v].y > 1e-9) continue;
    numbers += (numbers.empty() ? "" : ", ") + std::to_string(v);
    lines += std::to_string(v) + "\n";
  }
  std::ofstream(file) << lines;
  const std::string entry = "[body.fixed]\nregion = \"vertices\"\n";
  EXPECT_EQ(Pressed(bar(entry + "vertices = [" + numbers + "]\n")).supports, base.supports);
  EXPECT_EQ(Pressed(bar(entry + "vertices_file = \"" + file + "\"\n")).supports, base.supports);
  std::ofstream(file) << "1 2\n3x\n";
  EXPECT_NE(refusal(bar(entry + "vertices_file = \"" + file + "\"\n")).find(":2: not a vertex's number"),
            std::string::npos);
  std::remove(file.c_str());
}

TEST(Supports, BadEntriesAreRefusedWithPlaceAndRemedy) {
  const auto names = [](const std::string& text, const char* what) {
    const std::string said = refusal(text);
    EXPECT_NE(said.find(what), std::string::npos) << said;
  };
  names(bar("[body.fixed]\nregion = \"ball\"\ncentre_mm = [0, 90, 0]\nradius_mm = 12\n"),
        "s.toml:12: body.fixed: holds no node of the body, which reaches from (-60, 0, -5) mm to (60, 10, 5) mm");
  names(bar(std::string(kLeft) + "[[body.fixed]]\nregion = \"ball\"\ncentre_mm = [0, 90, 0]\nradius_mm = 1\n"),
        "body.fixed[1]: holds no node");
  names(bar("[body.fixed]\nbase_height_mm = 11\n"), "holds every node of the body");
  names(bar("[body.fixed]\nbase_height_mm = 0\nholds = \"y\"\n"), "nothing keeps the body from moving as a whole");
  names(bar("[body.fixed]\nregion = \"ball\"\nradius_mm = 1\n"), "body.fixed: centre_mm: missing");
  names(bar("[body.fixed]\nregion = \"ball\"\ncentre_mm = [0, 0, 0]\nradius_mm = 9\nbase_height_mm = 1\n"),
        "body.fixed.base_height_mm: has no effect with region = \"ball\"");
  names(bar("[body.fixed]\nregion = \"box\"\nfrom_mm = [0, 0, 0]\nto_mm = [0, 1, 1]\n"),
        "must be greater than from_mm");
  names(bar("[body.fixed]\nregion = \"cube\"\n"), "'cube' is unknown; allowed one of base, box, ball, patch, vertices");
  const std::string listed = "[body.fixed]\nregion = \"vertices\"\n";
  names(bar(listed), "body.fixed.vertices: missing; give the numbers here");
  names(bar(listed + "vertices = [0, 1]\nvertices_file = \"v\"\n"), "body.fixed.vertices: given twice");
  names(bar(listed + "vertices = [0, 123456789]\n"), "vertex 123456789 is not of the body's surface");
  names(bar(listed + "vertices = [0]\n"), "no triangle of the surface has all its corners among the 1 listed");
  names(bar(listed + "vertices_file = \"no/such\"\n"), "no/such: cannot be opened");
  names(bar("[body.fixed]\nregion = \"patch\"\nradius_mm = 1\n"), "body.fixed: centre_mm: missing; a patch");
  names(bar("[body.fixed]\nregion = \"patch\"\ncentre_mm = [1, 99, 1]\nradius_mm = 0.1\n"), "holds no node");
  names(bar("[body.fixed]\nholds = \"normal\"\n"), "\"normal\" is of elastic beds; add stiffness_N_per_m3");
  names(
      "name = \"s\"\n[body]\nshape = \"sphere\"\n[body.fixed]\nregion = \"patch\"\ncentre_mm = [0, 0, 0]\n"
      "radius_mm = 9\n" +
          std::string(kTool),
      "\"patch\" is of finite elements; with tool points take a ball or a box");
  names("name = \"s\"\n[body]\nshape = \"sphere\"\n[body.fixed]\nstiffness_N_per_m3 = 1e6\n" + std::string(kTool),
        "stiffness_N_per_m3: has no effect unless contact.backend = \"elastic\"");
  names("name = \"s\"\n[body]\nshape = \"sphere\"\n[body.fixed]\nholds = \"y\"\n" + std::string(kTool),
        "body.fixed.holds: has no effect with tool points");
}

// Turned by 90 degrees about z and moved, x has become y; what is exact stays exact.
TEST(Placement, TurnsMeshAnchorsAndNormals) {
  const std::string own = "name = \"s\"\n[body]\nshape = \"ellipsoid\"\nhalf_axes_mm = [40, 30, 25]\n";
  const std::string moved = own + "position_mm = [100, 0, 5]\nrotation_deg = [0, 0, 90]\n";
  std::vector<std::string> warnings;
  const SceneDesc scene = parse_scene(moved + kTool, "s.toml");
  const SurfaceMesh mesh = make_body(scene, warnings);
  const SurfaceMesh at_rest = make_body(parse_scene(own + kTool, "s.toml"), warnings);
  ASSERT_EQ(mesh.vertex_m.size(), at_rest.vertex_m.size());
  for (std::size_t v = 0; v < mesh.vertex_m.size(); ++v) {
    const Vec3 p = at_rest.vertex_m[v];
    EXPECT_LT(norm(mesh.vertex_m[v] - Vec3{0.1 - p.y, p.x, 0.005 + p.z}), 1e-15);
  }
  double widest = 0;
  for (const AnchorPoint& anchor : exact_anchors(scene.body)) widest = std::max(widest, anchor.position_m.y);
  const double lowest_own = bounds_of(at_rest).lower_m.x;
  EXPECT_NEAR(widest, -lowest_own, 1e-9);  // the end of the long axis points up now
}

TEST(Placement, ExactNormalsTurnWithTheBody) {
  const std::string text =
      "name = \"s\"\n[body]\nshape = \"sphere\"\nradius_mm = 30\nposition_mm = [10, -20, 30]\n"
      "rotation_deg = [30, 40, -50]\n" +
      std::string(kTool);
  const SceneDesc scene = parse_scene(text, "s.toml");
  std::vector<std::string> warnings;
  const SurfaceMesh mesh = make_body(scene, warnings);
  const Vec3 centre = volume_centre_m(mesh);
  const std::vector<Triangle> triangle = linked_triangles(mesh);
  const std::vector<CornerNormals> normals = corner_normals(scene.body, mesh.vertex_m, triangle);
  for (std::size_t t = 0; t < triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 exact = unit_or(mesh.vertex_m[static_cast<std::size_t>(mesh.triangle[t][k])] - centre, {0, 1, 0});
      EXPECT_LT(norm(normals[t].normal[k] - exact), 1e-4);  // the mesh's centre of volume is the sphere's to that
    }
}

TEST(Placement, PressesRefuseABodyThatDoesNotStandWhereItIsMade) {
  const std::string text =
      "name = \"s\"\n[body]\nshape = \"cylinder\"\nrotation_deg = [90, 0, 0]\n[contact]\nlaw = \"tool\"\n"
      "[contact.series]\nc0_mm_per_N = \"auto\"\n" +
      std::string(kTool);
  try {
    compile_scene(parse_scene(text, "s.toml"));
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("body.rotation_deg"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate
