// Bodies of two materials: columns in series, inclusions under the surface, groups of a .msh file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "config/bake/elastic_check.h"
#include "config/bake/elastic_mesh.h"
#include "config/bake/fem_body.h"
#include "config/bake/image_rules.h"
#include "config/body/supports.h"
#include "config/elastic/rest_body.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/tet_io.h"
#include "config/scene/config_error.h"
#include "rt_core/contact/contact.h"
#include "rt_core/contact/elastic/elastic_layout.h"
#include "tests/elastic/elastic_tick_scene.h"
#include "tests/support/refusal.h"

namespace palpate::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string own_file(const char* name) {
  return testing::TempDir() + "palpate_materials_" + std::to_string(getpid()) + name;
}

// A column of 20 x 40 x 30 mm that keeps its width (nu = 0), on y = 0.
std::string column(const std::string& shape, const std::string& regions) {
  return "name = \"column\"\n[body]\n" + shape +
         "[body.material]\nyoungs_modulus_Pa = 1e6\npoisson_ratio = 0\n[body.fixed]\nbase_height_mm = 0\n[contact]\n"
         "backend = \"elastic\"\n" +
         regions + "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n";
}
const char* const kBox = "shape = \"box\"\nsize_mm = [20, 40, 30]\nfem.edge_mm = 10\n";
const char* const kUpperHalf =
    "[[body.material_region]]\nregion = \"box\"\nfrom_mm = [-20, 20, -20]\nto_mm = [20, 50, 20]\n"
    "youngs_modulus_Pa = 5e6\n";

// How far 1 N, spread evenly over the top, presses it down.
double sinks_m(const std::string& text) {
  const SceneDesc scene = parse_scene(text, "s.toml");
  std::vector<std::string> warnings;
  const TetMesh mesh = make_tet_mesh(scene, warnings);
  ModelParams params{};
  params.youngs_modulus_Pa = scene.material.youngs_modulus_Pa;
  params.poisson_ratio = scene.material.poisson_ratio;
  const elastic::RestBody<3> body(elastic::solid_mesh(mesh, "column"), elastic_material(scene, params, mesh),
                                  elastic::fixed_components(supports_of(scene, mesh)));
  Eigen::VectorXd load = Eigen::VectorXd::Zero(body.size());
  for (const auto& point : body.surface().points()) {
    if (point.normal[1] < 0.99) continue;
    const auto& nodes = body.surface().facets()[static_cast<std::size_t>(point.facet)].nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a) load[3 * nodes[a] + 1] -= point.area_m2 * point.shape.value[a];
  }
  load /= 0.02 * 0.03;
  return load.dot(body.solve(load));
}

std::string refusal(const std::string& text) {
  return refusal_by([&] { sinks_m(text); });
}

// Strains in series: p (L1 / E1 + L2 / E2).
constexpr double kInSeries_m = (0.02 / 1e6 + 0.02 / 5e6) / (0.02 * 0.03);

TEST(ElasticMaterials, AColumnOfTwoIsInSeries) {
  EXPECT_NEAR(sinks_m(column(kBox, "")) / (0.04 / 1e6 / (0.02 * 0.03)), 1, 1e-9);
  EXPECT_NEAR(sinks_m(column(kBox, kUpperHalf)) / kInSeries_m, 1, 1e-9);
  // A boundary within a row of elements: they have the mean of both by volume. Of a row of 10 mm of which a quarter is
  // stiff that gives 10 / 2 mm / MPa instead of 7.5 / 1 + 2.5 / 5, 9 % of the whole.
  const std::string between =
      "[[body.material_region]]\nregion = \"box\"\nfrom_mm = [-20, 17.5, -20]\nto_mm = [20, 50, "
      "20]\nyoungs_modulus_Pa = 5e6\n";
  const double exact = (0.0175 / 1e6 + 0.0225 / 5e6) / (0.02 * 0.03), found = sinks_m(column(kBox, between));
  EXPECT_GT(found / exact, 0.85);
  EXPECT_LT(found / exact, 1);
}

// The box's own elements, written for gmsh with the upper half as a physical group.
void write_msh(const std::string& path) {
  const SceneDesc scene = parse_scene(column(kBox, ""), "s.toml");
  std::vector<std::string> warnings;
  TetMesh mesh = make_tet_mesh(scene, warnings);
  keep_middle_nodes(mesh, std::vector<char>(mesh.tet.size(), 0));
  std::ofstream out(path);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 4 \"skin\"\n3 4 \"stiff half\"\n3 9 \"rest\"\n"
         "$EndPhysicalNames\n$Nodes\n"
      << mesh.node_m.size() << "\n";
  out.precision(17);
  for (std::size_t n = 0; n < mesh.node_m.size(); ++n)
    out << n + 1 << " " << 1e3 * mesh.node_m[n].x << " " << 1e3 * mesh.node_m[n].y << " " << 1e3 * mesh.node_m[n].z
        << "\n";
  out << "$EndNodes\n$Elements\n" << mesh.tet.size() << "\n";
  for (std::size_t t = 0; t < mesh.tet.size(); ++t) {
    double y = 0;
    for (std::size_t k = 0; k < 4; ++k) y += 0.25 * mesh.node_m[static_cast<std::size_t>(mesh.tet[t].node[k])].y;
    out << t + 1 << " 4 2 " << (y > 0.02 ? 4 : 9) << " 1";
    for (std::size_t k = 0; k < 4; ++k) out << " " << mesh.tet[t].node[k] + 1;
    out << "\n";
  }
  out << "$EndElements\n";
}

TEST(ElasticMaterials, GroupsOfAMeshFileAreMaterials) {
  const std::string file = own_file(".msh"), shape = "shape = \"tets\"\nmesh = \"" + file + "\"\n";
  write_msh(file);
  const auto group = [&](const std::string& name) {
    return column(shape,
                  "[[body.material_region]]\nregion = \"group\"\ngroup = \"" + name + "\"\nyoungs_modulus_Pa = 5e6\n");
  };
  EXPECT_NEAR(sinks_m(group("stiff half")) / kInSeries_m, 1, 1e-9);
  EXPECT_NEAR(sinks_m(group("4")) / kInSeries_m, 1, 1e-9);
  EXPECT_THAT(refusal(group("soft")), HasSubstr("body.material_region[0].group: \"soft\" is no group of the mesh, "
                                                "which has 4 (\"stiff half\"), 9 (\"rest\")"));
  std::remove(file.c_str());
}

// Format 4.1 says a volume's group beside its geometry.
TEST(ElasticMaterials, GroupsAreReadFromBothFormats) {
  const std::string file = own_file("4.msh");
  std::ofstream(file)
      << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"core\"\n$EndPhysicalNames\n"
         "$Entities\n1 0 1 2\n5 0 0 0 0\n3 0 0 0 1 1 1 1 8 0\n1 0 0 0 1 1 1 1 7 1 3\n"
         "2 0 0 0 1 1 1 0 1 -3\n$EndEntities\n$Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n"
         "0 0 1\n1 1 1\n$EndNodes\n$Elements\n2 2 1 2\n3 1 4 1\n1 1 2 3 4\n3 2 4 1\n2 2 3 4 5\n"
         "$EndElements\n";
  const TetMesh mesh = read_msh(file, 1e-3).mesh;
  EXPECT_EQ(mesh.group, (std::vector<std::int32_t>{7, 0}));
  EXPECT_EQ(mesh.group_name, (std::map<std::int32_t, std::string>{{7, "core"}}));
  std::remove(file.c_str());
}

TEST(ElasticMaterials, RegionsThatAreNothingAreRefused) {
  const auto region = [](const std::string& keys) {
    return column(kBox, "[[body.material_region]]\nregion = " + keys + "youngs_modulus_Pa = 5e6\n");
  };
  EXPECT_THAT(refusal(region("\"ball\"\ncentre_mm = [0, 90, 0]\nradius_mm = 5\n")),
              AllOf(HasSubstr("body.material_region[0]: has nothing of the body, which reaches from (-10, 0, -15) mm"),
                    HasSubstr("s.toml:13")));
  EXPECT_THAT(refusal(region("\"ball\"\nradius_mm = 5\n")), HasSubstr("centre_mm: missing; a ball needs it"));
  EXPECT_THAT(refusal(region("\"ball\"\ncentre_mm = [0, 9, 0]\nradius_mm = 5\ngroup = \"a\"\n")),
              HasSubstr("group: has no effect with region = \"ball\""));
  EXPECT_THAT(refusal(region("\"group\"\ngroup = \"a\"\n")), HasSubstr("the body has no groups"));
  EXPECT_THAT(refusal(region("\"box\"\nfrom_mm = [0, 0, 0]\nto_mm = [0, 1, 1]\n")), HasSubstr("exchange the corners"));
  EXPECT_THAT(
      refusal("name = \"s\"\n[body]\nshape = \"sphere\"\n[[body.material_region]]\nregion = \"ball\"\ncentre_mm = "
              "[0, 0, 0]\nradius_mm = 5\nyoungs_modulus_Pa = 1e4\n[[tool.piece]]\nshape = \"sphere\"\n"
              "radius_mm = 8\n"),
      HasSubstr("has no effect unless contact.backend = \"elastic\""));
}

// In the tick. A block of 60 x 30 x 60 mm, E = 3 MPa but where the region says otherwise.
std::string block(const std::string& region, const std::string& modulus = "3e6", double edge_mm = 10) {
  std::string text =
      elastic_scene("shape = \"box\"\nsize_mm = [60, 30, 60]\ntriangles = 800\n", 0, edge_mm, 8, 4) + region;
  const std::string own = "youngs_modulus_Pa = 3e6";
  return text.replace(text.find(own), own.size(), "youngs_modulus_Pa = " + modulus);
}
std::string stone(const std::string& modulus) {
  return "[[body.material_region]]\nregion = \"ball\"\ncentre_mm = [0, 15, 0]\nradius_mm = 8\nyoungs_modulus_Pa = " +
         modulus + "\n";
}
const Vec3 kTop{0, 0.038, 0};

TEST(ElasticMaterials, TenTimesBothIsTenTimesTheForce) {
  const double one = press_N(BakedScene(block(stone("15e6"))).model(), kTop, 2e-3),
               ten = press_N(BakedScene(block(stone("15e7"), "3e7")).model(), kTop, 2e-3);
  EXPECT_NEAR(ten / one, 10, 1e-3);
}

// The same body said in two ways: what the tips meet is the scene's own material, or a region's.
TEST(ElasticMaterials, ASurfaceOfAnotherMaterialIsFeltAsThat) {
  const std::string half = "[[body.material_region]]\nregion = \"box\"\nfrom_mm = [-40, ",
                    ends = ", 40]\nyoungs_modulus_Pa = ";
  const BakedScene below(block(half + "-1, -40]\nto_mm = [40, 20" + ends + "3e6\n", "9e6")),
      above(block(half + "20, -40]\nto_mm = [40, 31" + ends + "9e6\n"));
  const double alone = press_N(BakedScene(block("", "9e6")).model(), kTop, 2e-3);
  for (const double depth : {0.5e-3, 2e-3}) {
    const double one = press_N(below.model(), kTop, depth), other = press_N(above.model(), kTop, depth);
    EXPECT_NEAR(other / one, 1, 1e-5) << depth;
    EXPECT_LT(one, alone);
  }
}

// What the loader refuses of the moduli at the vertices.
TEST(ElasticMaterials, ImagesHaveSaneModuli) {
  const BakedScene baked(block(stone("15e6"), "3e6", 20));
  const ContactMethod& method = contact_method(Method::kElastic);
  ASSERT_EQ(method.check_data(baked.model()).error, ImageError::kNone);
  ASSERT_TRUE(elastic_layout::has_moduli(baked.model()));
  Model model = baked.model();
  model.sizes.n_elastic_vertex -= 1;
  EXPECT_STREQ(method.check_data(model).field, "n_elastic_vertex");
  for (const float bad : {0.0F, -1.0F, 1e9F}) {
    model = baked.model();
    std::vector<float> values(model.elastic_vertex.begin(), model.elastic_vertex.end());
    values.back() = bad;
    model.elastic_vertex = values;
    EXPECT_STREQ(method.check_data(model).field, "elastic_vertex") << bad;
  }
}

// Pressed on one material, slid to the other, lifted: the work comes back, as forces along the surface are slopes of
// the energy where the modulus changes too. Without that slope the two presses' works differ by what they store. 0.03 %
// are left (2026-11-23) by trapezoids of 0.02 mm.
TEST(ElasticMaterials, ALoopOverTheBoundaryReturnsItsWork) {
  const BakedScene baked(
      block("[[body.material_region]]\nregion = \"box\"\nfrom_mm = [0, -1, -40]\nto_mm = [40, 31, 40]\n"
            "youngs_modulus_Pa = 9e6\n"));
  Bench bench(baked.model());
  double work_J = 0, most_J = 0;
  Vec3 at{-0.012, 0.0385, 0.001}, force = bench.tick_at({at, {}}, {}).contact_w.force_N;
  for (const Vec3 to : {Vec3{-0.012, 0.0365, 0.001}, Vec3{0.012, 0.0365, 0.001}, Vec3{0.012, 0.0385, 0.001}}) {
    const Vec3 from = at;
    const int steps = static_cast<int>(norm(to - from) / 2e-5);
    for (int i = 1; i <= steps; ++i) {
      const Vec3 next = from + (static_cast<double>(i) / steps) * (to - from);
      const Vec3 now = bench.tick_at({next, {}}, {}).contact_w.force_N;
      work_J -= dot(0.5 * (force + now), next - at);
      most_J = std::max(most_J, work_J);
      at = next;
      force = now;
    }
  }
  RecordProperty("left", std::to_string(work_J / most_J));
  EXPECT_GT(most_J, 1e-3);
  EXPECT_LT(std::abs(work_J), 2e-3 * most_J);
}

// A stone 7 mm below the surface under a ball of 8 mm: 3.1 to 4.0 % too soft on elements of 5 mm (2026-11-25). What is
// taken off for elements that are too stiff, 1.6 % of a half space's give, is known to 0.7 (kNoise), which is 2 % here.
TEST(SlowElasticMaterials, AStoneBelowTheSurfaceIsFeltAsByFiniteElements) {
  const std::string text = block(stone("15e6"), "3e6", 5);
  const BakedScene baked(text);
  EXPECT_GT(press_N(baked.model(), kTop, 1e-3), 1.15 * press_N(BakedScene(block("", "3e6", 5)).model(), kTop, 1e-3));
  const SceneDesc scene = parse_scene(text, "test.toml");
  const ImageContents image = contents_of(baked.model());
  std::vector<std::string> warnings;
  const TetMesh mesh = make_elastic_mesh(scene, image, warnings);
  CheckPress press{{0, 0.03, 0}, {0, 1, 0}, 0.008, {0.5e-3, 1e-3, 2e-3}, false, {}};
  press_elements(scene, image, mesh, press);
  ASSERT_GE(press.reference_N.size(), 2u);
  const CheckedPress checked = press_baked(with_ball(scene, image, 0.008), press);
  RecordProperty("worst", std::to_string(checked.worst_error));
  EXPECT_LT(checked.worst_error, 0.045);
}

}  // namespace
}  // namespace palpate::test
