// The large-strain reference of two balls that lean on one arch: what tests/elastic/test_coupled_ticks.cpp is judged
// by. 82 s of processor time (2026-11-25).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "config/bake/elastic_mesh.h"
#include "config/bake/image_rules.h"
#include "config/body/supports.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/large_strain_solver.h"
#include "tests/elastic/two_balls_on_an_arch.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

// Forces on both balls at every state, with elements of `edge_m` under the balls and `body_m` elsewhere.
std::vector<PairForces> solve(double body_m, double edge_m) {
  SceneDesc scene = parse_scene(pair_scene(), "pair.toml");
  scene.fem.edge_m = body_m;
  const ImageContents image = contents_of(BakedScene(scene).model());
  std::vector<std::string> warnings;
  const TetMesh base = make_elastic_mesh(scene, image, warnings);
  constexpr double kOff = kPairHalf_m * kPairOuter_m / (kPairOuter_m + kPairBall_m);
  std::vector<Refinement> zones;
  for (const double side : {1.0, -1.0})
    zones.push_back({{side * kOff, kPairTop_m - kPairOuter_m + std::sqrt(kPairOuter_m * kPairOuter_m - kOff * kOff), 0},
                     4.5e-3,
                     edge_m});
  const TetMesh fine = refine_elastic_mesh(scene, image, base, zones);
  const fem::StrainMesh<3> solid = elastic::solid_mesh(fine, "pair");
  std::vector<int> touched;
  for (int n = 0; n < solid.node_count(); ++n)
    for (const Refinement& zone : zones)
      if (norm(fine.node_m[static_cast<std::size_t>(n)] - zone.centre_m) < 9e-3) {
        touched.push_back(n);
        break;
      }
  fem::RigidTool ball;
  ball.radius_m = kPairBall_m;
  fem::StrainOptions options;  // as the baker's check presses
  options.gap_tolerance = 5e-3;
  options.residual_tolerance = 1e-4;
  options.step_facets = 3;
  fem::LargeStrainSolver<3> solver(solid, elastic_material(scene, image.params, fine),
                                   elastic::fixed_components(supports_of(scene, fine)), touched, {ball, ball}, options);
  const auto origins = [](const PairState& state) {
    std::vector<fem::Point<3>> at;
    for (const int left : {0, 1}) {
      const Vec3 p = pair_ball_m(state, left);
      at.push_back({p.x, p.y, p.z});
    }
    return at;
  };
  solver.place_tools(origins({0, 0}));
  std::vector<PairForces> forces;
  for (const PairState& state : kPairStates) {
    const auto solved = solver.move_tools(origins(state));
    EXPECT_TRUE(solved.converged);
    const fem::Point<3>&a = solved.force_on_tool_N[0], &b = solved.force_on_tool_N[1];
    forces.push_back({{a[0], a[1], a[2]}, {b[0], b[1], b[2]}});
    std::printf("%d nodes: {{%.5f, %.5f, %.5f}, {%.5f, %.5f, %.5f}}\n", solid.node_count(), a[0], a[1], a[2], b[0],
                b[1], b[2]);
  }
  return forces;
}

TEST(LongReport, TwoBallsOnAnArch) {
  const std::vector<PairForces> forces = solve(6e-3, 1.9e-3);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    EXPECT_LT(norm(forces[i].right_N - kPairReference[i].right_N), 1e-3 * norm(forces[i].right_N)) << i;
    EXPECT_LT(norm(forces[i].left_N - kPairReference[i].left_N), 1e-3 * norm(forces[i].left_N)) << i;
  }
}

}  // namespace
}  // namespace palpate::test
