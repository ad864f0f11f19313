// The large-strain reference of a rod that lies on a block: what tests/elastic/test_line_contact.cpp is judged by.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "config/bake/elastic_mesh.h"
#include "config/bake/image_rules.h"
#include "config/body/supports.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/large_strain_solver.h"
#include "tests/elastic/rod_on_a_block.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

// Elements of 1.4 mm under it: the contact is 2 to 4 mm wide.
constexpr double kFine_m = 1.4e-3, kFineReach_m = 3.5e-3, kTouched_m = 7e-3;

TEST(LongReport, RodOnABlock) {
  const SceneDesc scene = parse_scene(rod_on_a_block(), "rod.toml");
  const ImageContents image = contents_of(BakedScene(scene).model());
  std::vector<std::string> warnings;
  std::vector<Refinement> zones;
  for (int i = -3; i <= 3; ++i)
    zones.push_back({{0, kRodBlockTop_m, (kRodHalf_m + 2e-3) * i / 3}, kFineReach_m, kFine_m});
  const TetMesh fine = refine_elastic_mesh(scene, image, make_elastic_mesh(scene, image, warnings), zones);
  std::vector<int> touched;
  for (std::size_t n = 0; n < fine.node_m.size(); ++n)
    for (const Refinement& zone : zones)
      if (norm(fine.node_m[n] - zone.centre_m) < kTouched_m) {
        touched.push_back(static_cast<int>(n));
        break;
      }
  for (const RodState& state : kRodStates) {
    fem::RigidTool rod;
    rod.shape = fem::RigidShape::kCylinder;
    rod.radius_m = kRodRadius_m;
    rod.half_length_m = kRodHalf_m;
    const Vec3 axis = rod_axis(state), middle = rod_middle_m(state);
    rod.axis = {axis.x, axis.y, axis.z};
    fem::StrainOptions options;  // as the baker's check presses
    options.gap_tolerance = 5e-3;
    options.residual_tolerance = 1e-4;
    options.step_facets = 3;
    const fem::StrainMesh<3> solid = elastic::solid_mesh(fine, "rod");
    fem::LargeStrainSolver<3> solver(solid, elastic_material(scene, image.params, fine),
                                     elastic::fixed_components(supports_of(scene, fine)), touched, {rod}, options);
    const double clear_m = kRodBlockTop_m + kRodRadius_m + kRodHalf_m * std::sin(state.lean_rad);
    solver.place_tools({{0, clear_m, 0}});
    const auto solved = solver.move_tools({{middle.x, middle.y, middle.z}});
    EXPECT_TRUE(solved.converged);
    const double force_N = solved.force_on_tool_N[0][1];
    std::printf("%d nodes: %.5f N\n", solid.node_count(), force_N);
    std::fflush(stdout);
    EXPECT_NEAR(force_N, state.force_N, 1e-3 * force_N);
  }
}

}  // namespace
}  // namespace palpate::test
