// Elastic beds under a body: against beams and blocks on Winkler's foundation, in the factor, the presses and the tick.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "config/bake/elastic_mesh.h"
#include "config/bake/fem_body.h"
#include "config/body/supports.h"
#include "config/elastic/rest_body.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/large_strain_solver.h"
#include "config/scene/config_error.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

using elastic::RestBody;
using Vector3 = Eigen::Vector3d;

// A box of finite elements `edge_mm` long, E = 1 MPa, nu = 0.3.
std::string box(const std::string& size_mm, const std::string& edge_mm, const std::string& fixed) {
  return "name = \"box\"\n[body]\nshape = \"box\"\nsize_mm = " + size_mm +
         "\n[body.material]\nyoungs_modulus_Pa = 1e6\npoisson_ratio = 0.3\n[body.fem]\nedge_mm = " + edge_mm +
         "\n[contact]\nbackend = \"elastic\"\n" + fixed + "[[tool.piece]]\nshape = \"sphere\"\nradius_mm = 8\n";
}

struct OnBed {
  explicit OnBed(const std::string& text) : scene(parse_scene(text, "s.toml")), mesh(make_tet_mesh(scene, warnings)) {
    ModelParams params{};
    params.youngs_modulus_Pa = scene.material.youngs_modulus_Pa;
    params.poisson_ratio = scene.material.poisson_ratio;
    material = elastic_material(scene, params, mesh);
    solid = elastic::solid_mesh(mesh, "box");
    fixed = elastic::fixed_components(supports_of(scene, mesh));
  }
  RestBody<3> rest() const { return {solid, material, fixed}; }
  // A uniform pressure on facets that face along `normal`, 1 N in all.
  Eigen::VectorXd pressure_N(const RestBody<3>& body, const Vector3& normal) const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(body.size());
    double area = 0;
    for (const auto& point : body.surface().points()) {
      if (point.normal.dot(normal) < 0.99) continue;
      const auto& nodes = body.surface().facets()[static_cast<std::size_t>(point.facet)].nodes;
      for (std::size_t a = 0; a < nodes.size(); ++a)
        load.segment<3>(3 * nodes[a]) -= point.area_m2 * point.shape.value[a] * normal;
      area += point.area_m2;
    }
    return load / area;
  }
  std::vector<std::string> warnings;
  SceneDesc scene;
  TetMesh mesh;
  fem::StrainBody material;
  fem::StrainMesh<3> solid;
  std::vector<bool> fixed;
};

// 20 x 40 x 30 mm on a bed without friction, its flanks at two planes of symmetry: a uniform strain.
const char* const kColumn =
    "[[body.fixed]]\nbase_height_mm = 0\nholds = \"y\"\nstiffness_N_per_m3 = 5e7\n"
    "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-11, -1, -16]\nto_mm = [-10, 41, 16]\nholds = \"x\"\n"
    "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-11, -1, -16]\nto_mm = [11, 41, -15]\nholds = \"z\"\n";
constexpr double kYoung_Pa = 1e6, kArea_m2 = 0.02 * 0.03, kHeight_m = 0.04, kBed = 5e7;

TEST(ElasticBed, ABlockSinksAsItsPressureSays) {
  const OnBed column(box("[20, 40, 30]", "10", kColumn));
  const RestBody<3> body = column.rest();
  const Eigen::VectorXd u = body.solve(column.pressure_N(body, {0, 1, 0}));
  const double p = 1 / kArea_m2;
  for (std::size_t n = 0; n < column.mesh.node_m.size(); ++n)
    EXPECT_NEAR(u[static_cast<Eigen::Index>(3 * n + 1)] / (-p / kBed - p * column.mesh.node_m[n].y / kYoung_Pa), 1,
                1e-9);
}

// The same under a plate by the solver of the check presses: at 0.1 % of strain its large strain is 0.2 % of the force.
TEST(ElasticBed, ThePressesReferenceRestsOnItToo) {
  const OnBed column(box("[20, 40, 30]", "10", kColumn));
  std::vector<int> top;
  for (int n = 0; n < column.solid.node_count(); ++n)
    if (column.solid.nodes_m[static_cast<std::size_t>(n)][1] > kHeight_m - 1e-9) top.push_back(n);
  fem::RigidTool plate;
  plate.shape = fem::RigidShape::kPlane;
  plate.axis = {0, -1, 0};
  fem::LargeStrainSolver<3> solver(column.solid, column.material, column.fixed, top, {plate});
  solver.place_tools({{0, kHeight_m, 0}});
  const double sinks_m = 6e-5;
  const auto state = solver.move_tools({{0, kHeight_m - sinks_m, 0}});
  ASSERT_TRUE(state.converged);
  const double force_N = kArea_m2 * sinks_m / (1 / kBed + kHeight_m / kYoung_Pa);
  EXPECT_NEAR(state.force_on_tool_N[0][1] / force_N, 1, 4e-3);
  EXPECT_NEAR(state.support_reaction_N[1] / state.force_on_tool_N[0][1], 1, 1e-6);
}

// Hetenyi 1946, section 10: a free beam of length L with P in its middle sinks there by P m / 2k (cosh mL + cos mL + 2)
// / (sinh mL + sin mL), k = bed times width, m^4 = k / 4EI. Shear adds 1.5 % at this slenderness; two elements of half
// the height are 1 % stiff.
TEST(ElasticBed, ABeamOnItIsHetenyis) {
  constexpr double kStiffness = 1.3e5, kLength = 0.24, kSide = 0.01;
  const OnBed bar(box("[240, 10, 10]", "5", "[body.fixed]\nbase_height_mm = 0\nstiffness_N_per_m3 = 1.3e5\n"));
  const RestBody<3> body = bar.rest();
  Eigen::VectorXd load = Eigen::VectorXd::Zero(body.size());
  std::vector<std::size_t> middle;
  for (std::size_t n = 0; n < bar.mesh.node_m.size(); ++n)
    if (std::abs(bar.mesh.node_m[n].x) < 1e-6) middle.push_back(n);
  for (const std::size_t n : middle)
    load[static_cast<Eigen::Index>(3 * n + 1)] = -1 / static_cast<double>(middle.size());
  const double sinks = load.dot(body.solve(load)), k = kStiffness * kSide,
               m = std::pow(k / (4 * kYoung_Pa * std::pow(kSide, 4) / 12), 0.25), ml = m * kLength;
  const double beam = m / (2 * k) * (std::cosh(ml) + std::cos(ml) + 2) / (std::sinh(ml) + std::sin(ml));
  EXPECT_NEAR(sinks / beam, 1, 0.03);
}

// A bed all around, so soft that it holds the body and is not felt: pressed from both sides it gives p L / E.
TEST(ElasticBed, ASoftOneAllAroundLeavesABodyFree) {
  const OnBed block(box("[20, 40, 30]", "10",
                        "[body.fixed]\nregion = \"box\"\nfrom_mm = [-50, -50, -50]\nto_mm = [50, 50, 50]\n"
                        "stiffness_N_per_m3 = 1e3\n"));
  const RestBody<3> body = block.rest();
  const Eigen::VectorXd both = block.pressure_N(body, {0, 1, 0}) + block.pressure_N(body, {0, -1, 0});
  EXPECT_NEAR(both.dot(body.solve(both)) / (kHeight_m / (kYoung_Pa * kArea_m2)), 1, 1e-4);
}

// Beds along the surface's normal are plates without friction at any slope: a turned column between three of them is
// pressed as the standing one is.
TEST(ElasticBed, PlatesMaySlope) {
  const std::string beds =
      "[[body.fixed]]\nregion = \"box\"\nfrom_mm = [-99, -99, -99]\nto_mm = [99, 99, 99]\n"
      "stiffness_N_per_m3 = 5e7\nholds = \"normal\"\n";
  const auto sinks_m = [&](const std::string& turn, const Vector3& up) {
    std::string text = box("[20, 40, 30]", "10", beds);
    text.insert(text.find("[body.material]"), turn);
    const OnBed column(text);
    const RestBody<3> body = column.rest();
    const Eigen::VectorXd load = column.pressure_N(body, up);
    return load.dot(body.solve(load));
  };
  const double standing = sinks_m("", {0, 1, 0});
  EXPECT_LT(standing, 1 / (kBed * kArea_m2));  // the plate under the pressure, and more
  const double a = 3.14159265358979323846 / 6;
  EXPECT_NEAR(sinks_m("rotation_deg = [0, 0, 30]\n", {-std::sin(a), std::cos(a), 0}) / standing, 1, 1e-6);
}

// In the tick: a block on a bed is that block on a rigid base, in series with the bed's give F / kA. A sixteenth of the
// block's own stiffness leaves the bed's pressure even to a few per cent.
TEST(ElasticBed, InTheTickItIsInSeries) {
  const std::string clamped = elastic_scene("shape = \"box\"\nsize_mm = [40, 30, 40]\ntriangles = 800\n", 0, 10, 8, 4);
  std::string on_bed = clamped;
  const std::string rigid = "base_height_mm = " + number(0) + "\n";
  on_bed.insert(on_bed.find(rigid) + rigid.size(), "stiffness_N_per_m3 = 6e6\n");
  const Vec3 top{0, 0.038, 0};
  const double depth = 1.5e-3, force_N = press_N(BakedScene(clamped).model(), top, depth);
  const double give_m = force_N / (6e6 * 0.04 * 0.04);
  EXPECT_GT(give_m, 0.3 * depth);
  const double on_bed_N = press_N(BakedScene(on_bed).model(), top, depth + give_m);
  RecordProperty("ratio", std::to_string(on_bed_N / force_N));
  EXPECT_NEAR(on_bed_N / force_N, 1, 0.03);
}

TEST(ElasticBed, ABodyThatNothingHoldsIsRefusedWithARemedy) {
  using testing::AllOf;
  using testing::HasSubstr;
  const auto said = [](const std::string& fixed) {
    std::string text = box("[20, 40, 30]", "10", "");
    text.insert(text.find("size_mm"), fixed);
    try {
      parse_scene(text, "s.toml");
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  for (const std::string fixed : {"fixed = \"none\"\n", "fixed = []\n"})
    EXPECT_THAT(said(fixed),
                AllOf(HasSubstr("s.toml:4: body.fixed: a body that nothing holds"), HasSubstr("stiffness_N_per_m3")));
}

}  // namespace
}  // namespace palpate::test
