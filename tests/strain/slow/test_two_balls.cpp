// The large-strain references of two balls on one body, which both feel: what tests/elastic/test_coupled_ticks.cpp is
// judged by. The arch takes 82 s of processor time (2026-11-25).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "config/bake/elastic_mesh.h"
#include "config/bake/image_rules.h"
#include "config/body/supports.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/large_strain_solver.h"
#include "tests/elastic/pinched_block.h"
#include "tests/elastic/pinched_bodies.h"
#include "tests/elastic/two_balls_on_an_arch.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

using Centres = std::array<Vec3, 2>;  // of the right and the left ball

struct TwoBalls {
  double radius_m, fine_m, fine_reach_m, touched_reach_m;  // elements under the balls, and how far around `place_m`
  Centres place_m, touching_m;                             // where they touch first, and their centres then
  std::vector<Centres> states_m;
  double half_length_m = 0;  // of capsules along z
};

// Forces on both balls at every state; the elements elsewhere are the scene's.
std::vector<PairForces> solve(const SceneDesc& scene, const TwoBalls& balls) {
  const ImageContents image = contents_of(BakedScene(scene).model());
  std::vector<std::string> warnings;
  const TetMesh base = make_elastic_mesh(scene, image, warnings);
  std::vector<Refinement> zones;
  for (const Vec3& place : balls.place_m)
    for (int along = -1; along <= (balls.half_length_m > 0 ? 1 : -1); ++along)
      zones.push_back({place + Vec3{0, 0, balls.half_length_m * along}, balls.fine_reach_m, balls.fine_m});
  const TetMesh fine = refine_elastic_mesh(scene, image, base, zones);
  const fem::StrainMesh<3> solid = elastic::solid_mesh(fine, "pair");
  std::vector<int> touched;
  for (int n = 0; n < solid.node_count(); ++n)
    for (const Refinement& zone : zones)
      if (norm(fine.node_m[static_cast<std::size_t>(n)] - zone.centre_m) < balls.touched_reach_m) {
        touched.push_back(n);
        break;
      }
  fem::RigidTool ball;
  ball.radius_m = balls.radius_m;
  if (balls.half_length_m > 0) {
    ball.shape = fem::RigidShape::kCylinder;
    ball.axis = {0, 0, 1};
    ball.half_length_m = balls.half_length_m;
  }
  fem::StrainOptions options;  // as the baker's check presses
  options.gap_tolerance = 5e-3;
  options.residual_tolerance = 1e-4;
  options.step_facets = 3;
  fem::LargeStrainSolver<3> solver(solid, elastic_material(scene, image.params, fine),
                                   elastic::fixed_components(supports_of(scene, fine)), touched, {ball, ball}, options);
  const auto origins = [](const Centres& centre_m) {
    std::vector<fem::Point<3>> at;
    for (const Vec3& p : centre_m) at.push_back({p.x, p.y, p.z});
    return at;
  };
  solver.place_tools(origins(balls.touching_m));
  std::vector<PairForces> forces;
  for (const Centres& state : balls.states_m) {
    const auto solved = solver.move_tools(origins(state));
    EXPECT_TRUE(solved.converged);
    const fem::Point<3>&a = solved.force_on_tool_N[0], &b = solved.force_on_tool_N[1];
    forces.push_back({{a[0], a[1], a[2]}, {b[0], b[1], b[2]}});
    std::printf("%d nodes: {{%.5f, %.5f, %.5f}, {%.5f, %.5f, %.5f}},\n", solid.node_count(), a[0], a[1], a[2], b[0],
                b[1], b[2]);
    std::fflush(stdout);  // a state takes minutes
  }
  return forces;
}

template <std::size_t N>
void expect_equal(const std::vector<PairForces>& solved, const std::array<PairForces, N>& reference) {
  ASSERT_EQ(solved.size(), N);
  for (std::size_t i = 0; i < N; ++i) {
    EXPECT_LT(norm(solved[i].right_N - reference[i].right_N), 1e-3 * norm(solved[i].right_N)) << i;
    EXPECT_LT(norm(solved[i].left_N - reference[i].left_N), 1e-3 * norm(solved[i].left_N)) << i;
  }
}

TEST(LongReport, TwoBallsOnAnArch) {
  constexpr double kOff = kPairHalf_m * kPairOuter_m / (kPairOuter_m + kPairBall_m);
  const double up = kPairTop_m - kPairOuter_m + std::sqrt(kPairOuter_m * kPairOuter_m - kOff * kOff);
  const auto centres = [](const PairState& state) { return Centres{pair_ball_m(state, 0), pair_ball_m(state, 1)}; };
  TwoBalls balls{kPairBall_m, 1.9e-3, 4.5e-3, 9e-3, {{{kOff, up, 0}, {-kOff, up, 0}}}, centres({0, 0}), {}};
  for (const PairState& state : kPairStates) balls.states_m.push_back(centres(state));
  expect_equal(solve(parse_scene(pair_scene(), "pair.toml"), balls), kPairReference);
}

class LongPinch : public testing::TestWithParam<PinchedBody> {};
TEST_P(LongPinch, IsTheReference) {
  const PinchedBody& body = GetParam();
  const auto centres = [&](const PinchState& state) { return Centres{body.ball_m(state, 1), body.ball_m(state, -1)}; };
  TwoBalls balls{kPinchBall_m, body.fine_m, 6e-3, 12e-3, {{body.place_m(1), body.place_m(-1)}}, centres({0, 0}), {}};
  for (const PinchState& state : kPinchStates) balls.states_m.push_back(centres(state));
  expect_equal(solve(parse_scene(body.scene(), "pinched.toml"), balls), body.reference);
}
INSTANTIATE_TEST_SUITE_P(LongReport, LongPinch, testing::ValuesIn(kPinchedBodies),
                         [](const auto& body) { return std::string(body.param.name); });

// The jaws of pinch_block.
TEST(LongReport, PinchedBlock) {
  const SceneDesc scene = parse_scene(pinched_block(), "pinched.toml");
  const auto centres = [](double closed_m) {
    const double off = kBlockHalf_m + kJawRadius_m - closed_m;
    return Centres{{{off, kJawHeight_m, 0}, {-off, kJawHeight_m, 0}}};
  };
  TwoBalls jaws{
      kJawRadius_m, 2e-3, 4e-3,      9e-3, {{{kBlockHalf_m, kJawHeight_m, 0}, {-kBlockHalf_m, kJawHeight_m, 0}}},
      centres(0),   {},   kJawHalf_m};
  for (const BlockState& state : kBlockStates) jaws.states_m.push_back(centres(state.closed_m));
  const std::vector<PairForces> forces = solve(scene, jaws);
  for (std::size_t i = 0; i < forces.size(); ++i) EXPECT_NEAR(forces[i].right_N.x, kBlockStates[i].force_N, 1e-3) << i;
}

}  // namespace
}  // namespace palpate::test
