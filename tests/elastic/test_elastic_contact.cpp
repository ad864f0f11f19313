// The whole elastic body against large-strain references, and what any elastic body must keep.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "config/scene/config_error.h"
#include "tests/elastic/elastic_scenes.h"

namespace palpate::elastic {
namespace {

struct ReferenceRow {
  double travel_mm, force_N;
};

// Into the test's report (--gtest_output=xml): what docs/models_elastic.md quotes.
void record_share(const std::string& name, double share) {
  testing::Test::RecordProperty(name, std::to_string(100 * share) + " %");
}

StaticContact<2> clip_on_tube(const ElasticBody<2>& body) {
  StaticContact<2> contact(body, {fem::ball(fem::kClipTubeRadius_m)});
  contact.place_tools({{0, fem::clip_first_contact_m()}});
  return contact;
}
double insert(StaticContact<2>& contact, double insertion_m) {
  return 2 * contact.move_tools({{0, fem::clip_first_contact_m() - insertion_m}}).force_on_tool_N[0][1];
}

TEST(ElasticContact, ClipOnATubeKeepsWithinThreePerCentOfThePeak) {
  const BakedBody<2> clip(clip_scene(5e-4), {2, 30});
  StaticContact<2> contact = clip_on_tube(clip.body);
  // Large strain on the same mesh (docs/models_large_strain.md, F); linear finite elements miss by 7.7 %.
  double worst = 0;
  for (const ReferenceRow& row : {ReferenceRow{0.5, 2.618},
                                  {1, 4.360},
                                  {2, 6.156},
                                  {3, 6.501},
                                  {4, 5.914},
                                  {5, 4.675},
                                  {6, 2.887},
                                  {7, 0.802},
                                  {8, -1.457},
                                  {10, -5.744},
                                  {11.5, -7.336},
                                  {13, -5.508},
                                  {14, -0.944}})
    worst = std::max(worst, std::abs(insert(contact, 1e-3 * row.travel_mm) - row.force_N) / 7.336);
  record_share("of_the_peak", worst);
  EXPECT_LT(worst, 0.03);
}

TEST(ElasticContact, RingBetweenPlatesGoesOval) {
  const BakedBody<2> ring(plates_scene(96), {1, 30});
  fem::RigidTool upper, lower;
  upper.shape = lower.shape = fem::RigidShape::kPlane;
  upper.axis = {0, -1, 0};
  lower.axis = {0, 1, 0};
  StaticContact<2> contact(ring.body, {upper, lower});
  contact.place_tools({{0, 0.03}, {0, -0.03}});
  // Published forces (docs/models_large_strain.md, D); linear finite elements miss by 52 %.
  double worst = 0;
  for (const ReferenceRow& row : {ReferenceRow{1, 0.8208}, {4, 3.1874}, {8, 6.0475}, {12, 8.6689}, {16, 11.258}}) {
    const auto state = contact.move_tools({{0, 0.03 - 5e-4 * row.travel_mm}, {0, -0.03 + 5e-4 * row.travel_mm}});
    worst = std::max(worst, std::abs(state.force_on_tool_N[0][1] / row.force_N - 1));
    EXPECT_NEAR(state.force_on_tool_N[0][1], -state.force_on_tool_N[1][1], 0.01 * row.force_N);  // both plates alike
  }
  record_share("worst", worst);
  EXPECT_LT(worst, 0.03);
}

// The ring under one finger, in full and with half its wall: what the reference says about the wall, the body says too.
// One soft mode, which a finger on the axis does not move: the self terms alone carry the wall, and c1 its softening.
// With more modes the equilibrium sticks at kinks between facets (docs/models_elastic.md).
TEST(ElasticContact, HalvingTheWallChangesTheForceAsTheReferenceDoes) {
  double ratio[2], off[2];  // reduced and large strain; by wall
  for (const int thin : {0, 1}) {
    const ElasticScene<2> scene = fingers_scene(1e-3, thin ? 0.025 : 0.020);
    const fem::RigidTool finger = fem::ball(0.008);
    fem::LargeStrainSolver<2> solver(scene.mesh, scene.material, scene.fixed, scene.contact_nodes, {finger});
    solver.place_tools({finger_origin(0, 0)});
    const double full = solver.move_tools({finger_origin(0, 2e-3)}).force_on_tool_N[0][1];
    double force[2];  // by second order
    for (const bool second : {false, true}) {
      ElasticOptions options{1, 20};
      options.second_order = second;
      const BakedBody<2> ring(scene, options);
      StaticContact<2> contact(ring.body, {finger});
      contact.place_tools({finger_origin(0, 0)});
      force[second] = finger_force_N(0, contact.move_tools({finger_origin(0, 2e-3)}));
      record_share(std::string(thin ? "thin" : "full") + (second ? "_with_c1" : ""), force[second] / full - 1);
    }
    off[thin] = std::abs(force[1] / full - 1);
    EXPECT_LT(off[thin], std::abs(force[0] / full - 1));  // c1 is worth having
    ratio[0] = thin ? force[1] / ratio[0] : force[1];
    ratio[1] = thin ? full / ratio[1] : full;
  }
  EXPECT_LT(ratio[1], 0.4);  // a half wall bends about six times as easily
  EXPECT_NEAR(ratio[0] / ratio[1], 1, 0.02);
  EXPECT_LT(std::max(off[0], off[1]), 0.03);
}

TEST(ElasticContact, TenTimesTheModulusIsTenTimesTheForce) {
  double force[2];
  for (const int stiff : {0, 1}) {
    ElasticScene<2> scene = clip_scene(1e-3);
    scene.material.youngs_modulus_Pa *= stiff ? 10 : 1;
    const BakedBody<2> clip(scene, {2, 10});
    StaticContact<2> contact = clip_on_tube(clip.body);
    force[stiff] = insert(contact, 2e-3);
  }
  EXPECT_NEAR(force[1] / force[0], 10, 0.05);  // the facets' kinks leave the equilibrium 1e-3 of slack
}

TEST(ElasticContact, WorkOfTheToolIsTheStoredEnergy) {
  const BakedBody<2> clip(clip_scene(5e-4), {2, 20});
  StaticContact<2> contact = clip_on_tube(clip.body);
  double work = 0, before = 0, energy = 0;
  constexpr int kSteps = 60;
  const double step = 3e-3 / kSteps;
  for (int i = 1; i <= kSteps; ++i) {
    const auto state = contact.move_tools({{0, fem::clip_first_contact_m() - step * i}});
    const double force = state.force_on_tool_N[0][1];
    work += 0.5 * step * (before + force);
    before = force;
    energy = state.energy_J;
  }
  record_share("work_off", work / energy - 1);
  EXPECT_NEAR(work / energy, 1, 0.01);  // the trapezoids of 60 steps, and the facets' kinks
}

TEST(ElasticContact, StoredEnergyIsPositiveInTheTrustedBall) {
  const BakedBody<2> clip(clip_scene(1e-3), {3, 10});
  const SoftPotential& v = clip.body.maps.potential;
  ASSERT_GT(v.radius_rootJ, 0);
  for (int k = 0; k < 360; ++k) {
    Eigen::VectorXd q(3);
    q << std::cos(k), std::sin(k) * std::cos(2.3 * k), std::sin(k) * std::sin(2.3 * k);
    for (int a = 0; a < 3; ++a) q[a] /= std::sqrt(v.lambda()[a]);
    for (const double share : {0.3, 0.6, 0.95}) EXPECT_GT(v.at(share * v.radius_rootJ * q).energy_J, 0);
  }
}

TEST(ElasticContact, OtherToolsAreRefused) {
  const BakedBody<2> clip(clip_scene(1e-3), {1, 5});
  EXPECT_THROW(StaticContact<2>(clip.body, {fem::punch(1e-3, 1e-4)}), ConfigError);
}

// Two fingers on the clamped ring: 24 states, the ring sways under them.
TEST(SlowElastic, TwoFingersOnARing) {
  const BakedBody<2> ring(fingers_scene(1e-3), {3, 30});
  struct Row {
    double first_mm, second_mm, first_N, second_N;
  };
  // Large strain on the same mesh (docs/models_large_strain.md, G2).
  const Row rows[] = {
      {0.75, 0.75, 1.192, 0.524}, {1.5, 0.75, 2.280, 0.541}, {2.25, 0.75, 3.324, 0.539}, {3, 0.75, 4.328, 0.506},
      {0.75, 1.5, 1.197, 0.949},  {1.5, 1.5, 2.255, 0.912},  {2.25, 1.5, 3.278, 0.864},  {3, 1.5, 4.244, 0.737},
      {0.75, 2.25, 1.156, 1.410}, {1.5, 2.25, 2.179, 1.319}, {2.25, 2.25, 3.162, 1.182}, {3, 2.25, 4.143, 1.097},
      {0.75, 3, 1.057, 1.864},    {1.5, 3, 2.065, 1.740},    {2.25, 3, 3.016, 1.548},    {3, 3, 3.967, 1.388}};
  double wrong = 0, whole = 0;
  std::unique_ptr<StaticContact<2>> contact;
  for (const Row& row : rows) {
    if (row.first_mm == 0.75) {
      contact = std::make_unique<StaticContact<2>>(ring.body, std::vector{fem::ball(0.008), fem::ball(0.008)});
      contact->place_tools({finger_origin(0, 0), finger_origin(1, 0)});
      contact->move_tools({finger_origin(0, 0), finger_origin(1, 1e-3 * row.second_mm)});
    }
    const auto state =
        contact->move_tools({finger_origin(0, 1e-3 * row.first_mm), finger_origin(1, 1e-3 * row.second_mm)});
    wrong += std::pow(finger_force_N(0, state) - row.first_N, 2) + std::pow(finger_force_N(1, state) - row.second_N, 2);
    whole += row.first_N * row.first_N + row.second_N * row.second_N;
  }
  // Linear finite elements: 24 %.
  record_share("rms", std::sqrt(wrong / whole));
  EXPECT_LT(std::sqrt(wrong / whole), 0.06);
}

TEST(SlowElastic, SphereOnABlock) {
  const BakedBody<3> block(block_scene(), {1, 20});
  StaticContact<3> contact(block.body, {fem::ball(6.35e-3)});
  contact.place_tools({{0, 0, 6.35e-3}});
  // Published large-strain forces (docs/models_large_strain.md, A).
  double worst = 0;
  for (const ReferenceRow& row : {ReferenceRow{0.25, 1.4558}, {0.5, 4.1091}, {1, 11.573}, {2, 32.303}, {3, 58.363}}) {
    const auto state = contact.move_tools({{0, 0, 6.35e-3 - 1e-3 * row.travel_mm}});
    worst = std::max(worst, std::abs(state.force_on_tool_N[0][2] / row.force_N - 1));
  }
  record_share("worst", worst);
  EXPECT_LT(worst, 0.025);
}

// A tongue that bends by a quarter of its length while the ball slides along it.
TEST(SlowElastic, BallBendsATongue) {
  const ElasticScene<3> scene = tongue_scene();
  const double height = kTongueThickness_m + 0.005;
  const BakedBody<3> tongue(scene, {2, 20});
  StaticContact<3> contact(tongue.body, {fem::ball(0.005)});
  fem::LargeStrainSolver<3> solver(scene.mesh, scene.material, scene.fixed, scene.contact_nodes, {fem::ball(0.005)});
  contact.place_tools({{kTonguePlace_m, height, 0}});
  solver.place_tools({{kTonguePlace_m, height, 0}});
  double worst = 0;
  for (const double depth_m : {2e-3, 4e-3, 6e-3, 8e-3, 10e-3}) {
    const double reduced = contact.move_tools({{kTonguePlace_m, height - depth_m, 0}}).force_on_tool_N[0][1],
                 full = solver.move_tools({{kTonguePlace_m, height - depth_m, 0}}).force_on_tool_N[0][1];
    worst = std::max(worst, std::abs(reduced / full - 1));
    record_share("at_" + std::to_string(static_cast<int>(1e3 * depth_m + 0.5)) + "_mm", reduced / full - 1);
  }
  EXPECT_LT(worst, 0.05);
}

}  // namespace
}  // namespace palpate::elastic
