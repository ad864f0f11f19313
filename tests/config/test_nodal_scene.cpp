// Mistakes in scenes with finite elements: each is refused with file, line, key, what is allowed and what to do.
#include <gtest/gtest.h>

#include <fstream>

#include "config/bake/compile.h"
#include "config/scene/config_error.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

const char* const kBlock = R"(name = "block"
[body]
shape = "box"
size_mm = [20, 20, 20]
[contact]
backend = "nodal"
[body.material]
youngs_modulus_Pa = 2e5
poisson_ratio = 0.45
[[tool.piece]]
shape = "sphere"
radius_mm = 8
)";

std::string error_of(std::string text) {
  if (text.find("nodal") != std::string::npos && text.find("[friction]") == std::string::npos)
    text += "[friction]\nlaw = \"none\"\n";
  return test::refusal_by([&] { compile_scene(parse_scene(text, "s.toml")); });
}

struct Mistake {
  const char* name;
  const char* lines;  // after kBlock, whose last line is 12
  const char* where;
  const char* says;
};
const Mistake kMistakes[] = {
    {"solver", "[contact.nodal]\nsolver = \"lemke\"\n", "s.toml:14: contact.nodal.solver", "pivoting"},
    {"sweeps_without_effect", "[contact.nodal]\nsweeps = 5\n", "s.toml:14: contact.nodal.sweeps", "no effect"},
    {"sweeps", "[contact.nodal]\nsolver = \"gauss_seidel\"\nsweeps = 101\n", "s.toml:15: contact.nodal.sweeps",
     "1 to 100"},
    {"friction_sweeps", "[contact.nodal]\nfriction_sweeps = 0\n", "s.toml:14: contact.nodal.friction_sweeps",
     "1 to 20"},
    {"carry", "[contact.nodal]\ncarry = \"own\"\n", "s.toml:14: contact.nodal.carry", "far_field"},
    {"margin", "[contact.nodal]\nmargin_mm = 0\n", "s.toml:14: contact.nodal.margin_mm", "0.001 to 100 mm"},
    {"wall", "[contact.nodal]\nwall_N_per_m = 0\n", "s.toml:14: contact.nodal.wall_N_per_m", "1 to"},
    {"strain", "[contact.nodal]\nstrain_limit = nan\n", "s.toml:14: contact.nodal.strain_limit", "out of range"},
    {"proxy_speed", "[contact.nodal]\nproxy_speed_max_m_per_s = 1000\n",
     "s.toml:14: contact.nodal.proxy_speed_max_m_per_s", "0.001 to 100"},
    {"order", "[body.fem]\norder = \"cubic\"\n", "s.toml:14: body.fem.order", "quadratic"},
    {"zone_without_order", "[body.fem]\nzone_from_mm = [-5, 15, -5]\n", "s.toml:14: body.fem.zone_from_mm",
     "no effect"},
    {"layers_without_order", "[body.fem]\norder = \"linear\"\nzone_layers = 2\n", "s.toml:15: body.fem.zone_layers",
     "no effect"},
    {"no_zone", "[body.fem]\norder = \"mixed\"\n", "body.fem.zone_from_mm", "missing"},
    {"half_a_zone", "[body.fem]\norder = \"mixed\"\nzone_from_mm = [-5, 15, -5]\n", "body.fem.zone_to_mm", "missing"},
    {"zone_inside_out", "[body.fem]\norder = \"mixed\"\nzone_from_mm = [-5, 25, -5]\nzone_to_mm = [5, 15, 5]\n",
     "s.toml:16: body.fem.zone_to_mm", "exchange"},
    {"zone_nowhere", "[body.fem]\norder = \"mixed\"\nzone_from_mm = [-5, 25, -5]\nzone_to_mm = [5, 35, 5]\n",
     "s.toml:15: body.fem.zone_from_mm", "from (-10, 0, -10) mm to (10, 20, 10) mm"},
    {"zone_within_an_element",
     "[body.fem]\norder = \"mixed\"\nedge_mm = 5\nzone_from_mm = [1, 16, 1]\nzone_to_mm = [2, 17, 2]\n",
     "s.toml:16: body.fem.zone_from_mm", "larger than an element"},
    {"zone_not_a_number", "[body.fem]\norder = \"mixed\"\nzone_from_mm = [nan, 0, 0]\nzone_to_mm = [5, 5, 5]\n",
     "s.toml:15: body.fem.zone_from_mm", "out of range"},
    {"zone_layers",
     "[body.fem]\norder = \"mixed\"\nzone_from_mm = [-5, 15, -5]\nzone_to_mm = [5, 25, 5]\nzone_layers = 0\n",
     "s.toml:17: body.fem.zone_layers", "1 to 10"},
    {"edge", "[body.fem]\nedge_mm = 0.001\n", "s.toml:14: body.fem.edge_mm", "0.01 to 1000 mm"},
    {"level", "[body.fem]\nlevel = 2\n", "s.toml:14: body.fem.level", "no effect"},
    {"precision", "[body.fem]\nprecision = \"half\"\n", "s.toml:14: body.fem.precision", "single"},
    {"gauges", "[body.fem]\nstrain_gauges = 17\n", "s.toml:14: body.fem.strain_gauges", "0 to 16"},
    {"law", "[friction]\nlaw = \"return_map\"\n", "s.toml:14: friction.law", "coulomb"},
    {"mu_dynamic", "[friction]\nlaw = \"coulomb\"\nmu_dynamic = 0.3\n", "s.toml:15: friction.mu_dynamic", "no effect"},
    {"skeleton", "[skeleton]\nanchors_max = 9\n", "s.toml:13: skeleton", "remove the table"},
    {"flat_hull", "[[tool.piece]]\nshape = \"hull\"\nvertices_mm = [[0,0,0],[9,0,0],[0,9,0],[9,9,0]]\n",
     "tool.piece[1].vertices_mm", "box"},
    // The mesh and its solution.
    {"mixed_nearly_incompressible",
     "[body.fem]\norder = \"mixed\"\nzone_from_mm = [-5, 15, -5]\nzone_to_mm = [5, 25, 5]\n",
     "s.toml:14: body.fem.order", "0.49"},
    {"linear_nearly_incompressible", "[body.fem]\norder = \"linear\"\n", "body.shape", "0.49"},
    {"too_many_nodes", "[body.fem]\nedge_mm = 1\n", "body.shape", "Coarsen"},
};

TEST(NodalScene, EveryMistakeNamesPlaceRangeAndRemedy) {
  for (const Mistake& mistake : kMistakes) {
    std::string text = kBlock + std::string(mistake.lines);
    if (std::string(mistake.name).find("nearly_incompressible") != std::string::npos)
      text.replace(text.find("0.45"), 4, "0.495");
    const std::string error = error_of(text);
    EXPECT_NE(error.find(mistake.where), std::string::npos) << mistake.name << ": " << error;
    EXPECT_NE(error.find(mistake.says), std::string::npos) << mistake.name << ": " << error;
  }
}

// A zone under the middle of the top: fewer nodes than quadratic everywhere, more than linear; one that reaches over
// the whole body says that it is no zone.
TEST(NodalScene, MixedOrderIsQuadraticInItsZone) {
  const auto report_of = [](const std::string& order) {
    return compile_scene(
               parse_scene(kBlock + std::string("[friction]\nlaw = \"none\"\n[body.fem]\nedge_mm = 5\n") + order,
                           "s.toml"))
        .report;
  };
  const CompileReport linear = report_of("order = \"linear\"\n");
  const CompileReport mixed = report_of("order = \"mixed\"\nzone_from_mm = [-1, 19, -1]\nzone_to_mm = [1, 21, 1]\n");
  const CompileReport wider =
      report_of("order = \"mixed\"\nzone_from_mm = [-1, 19, -1]\nzone_to_mm = [1, 21, 1]\nzone_layers = 2\n");
  const CompileReport all = report_of("order = \"mixed\"\nzone_from_mm = [-11, -1, -11]\nzone_to_mm = [11, 21, 11]\n");
  const CompileReport quadratic = report_of("");
  EXPECT_EQ(linear.fem_nodes, 125);
  EXPECT_LT(linear.fem_nodes, mixed.fem_nodes);
  EXPECT_LT(mixed.fem_nodes, wider.fem_nodes);
  EXPECT_LT(wider.fem_nodes, quadratic.fem_nodes);
  EXPECT_EQ(quadratic.fem_nodes, 729);
  EXPECT_LT(mixed.compliance_bytes, quadratic.compliance_bytes);
  EXPECT_EQ(all.fem_nodes, quadratic.fem_nodes);
  EXPECT_TRUE(mixed.warnings.empty());
  ASSERT_EQ(all.warnings.size(), 1u);
  EXPECT_NE(all.warnings[0].find("s.toml:18: body.fem.zone_from_mm"), std::string::npos) << all.warnings[0];
}

TEST(NodalScene, PoissonsRatioOfOneHalfIsRefused) {
  std::string text = kBlock;
  text.replace(text.find("0.45"), 4, "0.5");
  const std::string error = error_of(text);
  EXPECT_NE(error.find("s.toml:9: body.material.poisson_ratio"), std::string::npos) << error;
  EXPECT_NE(error.find("0.4999"), std::string::npos) << error;
}

TEST(NodalScene, FiniteElementsNeedTheirBackEnd) {
  std::string text = kBlock;
  const std::string backend = "[contact]\nbackend = \"nodal\"\n";
  text.replace(text.find(backend), backend.size(), "[contact]\nlaw = \"hertz\"\n");
  EXPECT_NE(error_of(text + "[body.fem]\nedge_mm = 4\n").find("s.toml:13: body.fem"), std::string::npos);
  EXPECT_NE(error_of(text + "[contact.nodal]\nmargin_mm = 1\n").find("s.toml:13: contact.nodal"), std::string::npos);
  EXPECT_NE(error_of(text + "[friction]\nlaw = \"coulomb\"\n").find("s.toml:14: friction.law"), std::string::npos);
}

// A mesh of one flat tetrahedron, and a file that is none.
TEST(NodalScene, BadMeshFilesAreNamed) {
  const std::string file = testing::TempDir() + "/flat.msh";
  std::ofstream(file)
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n$EndNodes\n"
         "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n";
  std::string text = kBlock;
  text.replace(text.find("shape = \"box\"\nsize_mm = [20, 20, 20]\n"), 37,
               "shape = \"tets\"\nmesh = \"" + file + "\"\n");
  EXPECT_NE(error_of(text).find("body."), std::string::npos) << error_of(text);
  std::ofstream(file) << "no mesh\n";
  EXPECT_NE(error_of(text).find(file), std::string::npos) << error_of(text);
}

}  // namespace
}  // namespace palpate
