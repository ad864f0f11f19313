// The figures of Cui & Xiao 2008 by the laws as they are printed, and on the sphere of their Table III.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "config/hand/hand_model.h"
#include "rt_core/math.h"
#include "sim_host/press/grasp_stability.h"
#include "tests/articulate/grasp_scenes.h"

namespace palpate::test {
namespace {

// Where the fingers press, weighted by how hard.
Vec3 middle_of_contacts(const PlayedGrasp& played) {
  Vec3 sum;
  double weight = 0;
  for (const GraspContact& finger : played.grasp().finger) {
    sum += finger.normal_N * finger.position_w;
    weight += finger.normal_N;
  }
  return (1 / weight) * sum;
}

const double kCylinder_m = 0.12;

// Anchors of one rim, nearest to the contacts first.
std::vector<std::size_t> rim(const PlayedGrasp& played, double height_m) {
  const Model& model = played.scene.model();
  const Vec3 middle = middle_of_contacts(played);
  std::vector<std::size_t> anchors;
  for (std::size_t a = 0; a < model.anchor.size(); ++a)
    if (std::abs(model.anchor[a].position_m.y - height_m) < 1e-9) anchors.push_back(a);
  std::ranges::sort(anchors, {}, [&](std::size_t a) { return norm(model.anchor[a].position_m - middle); });
  return anchors;
}

double mean_stress(const PlayedGrasp& played, const std::vector<std::size_t>& anchors) {
  double sum = 0;
  for (const std::size_t a : anchors) sum += played.run.held_stress_Pa[a];
  return sum / static_cast<double>(anchors.size());
}

// Fig. 7 by the printed equations. "For each grasp, the anchor points closer to the contact regions are under greater
// stresses": between the rims and within each of them. "A big drop between anchor point 4 and anchor point 5", the
// rims, "is less steep for the five-finger power grasp". Within a rim distance is that from the middle of the contacts.
// Anchors that are as far from it to 2 % are told apart by direction: a beam takes its share of each region's force by
// 1/l along and by 1/l^3 across, so that 2 % of l are at most 6 % of stress, as much as a turn of the beam against the
// push makes. Measured 2026-11-25: of 36 pairs seven are so near, and four of these are the other way round, by 0.8
// to 6.7 %; the stress of all others falls.
void expect_stress_to_fall(const PlayedGrasp& played, const std::vector<std::size_t>& rim, const std::string& label) {
  const Model& model = played.scene.model();
  const Vec3 middle = middle_of_contacts(played);
  const auto distance = [&](std::size_t a) { return norm(model.anchor[a].position_m - middle); };
  const std::vector<double>& stress = played.run.held_stress_Pa;
  for (std::size_t i = 0; i < rim.size(); ++i)
    for (std::size_t k = i + 1; k < rim.size(); ++k) {
      const bool apart = distance(rim[k]) > 1.02 * distance(rim[i]);
      EXPECT_GT(stress[rim[i]], (apart ? 1 : 0.92) * stress[rim[k]])
          << label << ": anchors " << rim[i] + 1 << " and " << rim[k] + 1;
      if (!apart)
        std::printf("%s: anchors %zu and %zu, %.2f and %.2f mm: %.1f and %.1f kPa\n", label.c_str(), rim[i] + 1,
                    rim[k] + 1, 1e3 * distance(rim[i]), 1e3 * distance(rim[k]), 1e-3 * stress[rim[i]],
                    1e-3 * stress[rim[k]]);
    }
}

TEST(PaperGrasps, StressFallsWithinEachRimAndBetweenThem) {
  double drop_before = kHuge;
  std::vector<double> stress_before(8, 0.0);
  for (const char* name : {"grasp_cylinder_2", "grasp_cylinder_3", "grasp_cylinder_5"}) {
    const PlayedGrasp played(name, {"laws/cui_xiao_2008.toml"});
    const std::vector<double>& stress = played.run.held_stress_Pa;
    const std::vector<std::size_t> near = rim(played, kCylinder_m), far = rim(played, 0);
    ASSERT_EQ(near.size(), 4u);
    ASSERT_EQ(far.size(), 4u);
    expect_stress_to_fall(played, near, std::string(name) + ", near rim");
    expect_stress_to_fall(played, far, std::string(name) + ", far rim");
    const double drop = mean_stress(played, near) / mean_stress(played, far);
    EXPECT_GT(drop, 1.2) << name;
    EXPECT_LT(drop, drop_before) << name;
    drop_before = drop;
    for (std::size_t a = 0; a < stress.size(); ++a) {
      EXPECT_GT(stress[a], stress_before[a]) << name << ": more fingers, more stress, at anchor " << a + 1;
      stress_before[a] = stress[a];
    }
    EXPECT_TRUE(played.run.back_at_rest);
  }
}

// Fig. 8, likewise.
TEST(PaperGrasps, StressesStartAtZeroAndGrowToTheHold) {
  const PlayedGrasp played("grasp_cylinder_5", {"laws/cui_xiao_2008.toml"});
  EXPECT_EQ(played.run.regions, kHandParts);
  for (std::size_t part = 1; part <= kHandParts; ++part) EXPECT_GT(played.run.part_force_N[part], 0.1) << part;
  for (std::size_t a = 0; a < played.run.stress_Pa.size(); ++a) {
    EXPECT_EQ(played.run.stress_Pa[a].front(), 0);
    EXPECT_EQ(played.run.stress_Pa[a].back(), 0);
    // The hold is where it is largest; fingers that break loose while closing may pass it by little.
    EXPECT_GT(played.run.held_stress_Pa[a], 0.9 * std::ranges::max(played.run.stress_Pa[a])) << a;
  }
}

// Fig. 9 and Table III: three grasps of one sphere of 3480 triangles and 1742 vertices, with all fifteen parts in the
// power grasp. Each holds the body's weight, and no part of a finger that takes part only grazes it: 0.05 N is a share
// of 0.4 of an even one of the weight (2 N over 15 parts).
TEST(PaperGrasps, TheSphereOfTableThreeIsHeldByFifteenRegions) {
  double before = 0;
  std::int32_t fingers = 2;
  for (const char* name : {"grasp_sphere_2", "grasp_sphere_3", "grasp_sphere_5"}) {
    const PlayedGrasp played(name, {"bodies/sphere_rings.toml"});
    EXPECT_EQ(played.scene.model().triangle.size(), 3480u);
    EXPECT_EQ(played.scene.model().vertex_m.size(), 1742u);
    EXPECT_EQ(played.scene.model().anchor.size(), 6u);
    EXPECT_EQ(played.run.regions, 3 * fingers) << name;
    const double stress = std::accumulate(played.run.held_stress_Pa.begin(), played.run.held_stress_Pa.end(), 0.0);
    EXPECT_GT(stress, before) << name;
    before = stress;
    EXPECT_TRUE(played.run.back_at_rest);
    const GraspStability stability = judge(played.grasp());
    double least_N = kHuge;
    for (const double force_N : played.run.part_force_N)
      if (force_N > 0) least_N = std::min(least_N, force_N);
    EXPECT_TRUE(stability.holds) << name << " needs " << stability.friction_needed << " of the friction";
    EXPECT_GT(least_N, 0.05) << name;
    std::printf("%s: %d regions, least part %.4f N, friction needed %.3f\n", name, played.run.regions, least_N,
                stability.friction_needed);
    fingers += fingers == 2 ? 1 : 2;
  }
}

// Fig. 10 of the circular-beam paper (2009): different grasps of the cylinder with a hole. An overlay, since hand, pose
// and way in are those of the solid cylinder's grasps. The hole leaves 0.70 of the
// weight.
TEST(PaperGrasps, TheHollowCylinderIsHeldByTwoThreeAndFiveFingers) {
  double before_Pa = 0;
  for (const auto& [name, regions] :
       {std::pair{"grasp_cylinder_2", 6}, {"grasp_cylinder_3", 9}, {"grasp_cylinder_5", 15}}) {
    const PlayedGrasp hollow(name, {"bodies/hollow_cylinder.toml"});
    const Model& model = hollow.scene.model();
    EXPECT_EQ(model.params.skeleton_law, SkeletonLaw::kCircular);
    EXPECT_EQ(model.triangle.size(), 3024u);
    // The wall is 10 of 22 mm.
    EXPECT_NEAR(model.params.body_mass_kg / scene_named(name).model().params.body_mass_kg, 1 - 144.0 / 484, 0.01);
    EXPECT_EQ(hollow.run.regions, regions) << name;
    for (std::size_t part = 1; part <= kHandParts; ++part)
      EXPECT_EQ(hollow.run.part_force_N[part] > 0.3, played(name).part_force_N[part] > 0) << name << " " << part;
    EXPECT_TRUE(judge(hollow.grasp()).holds) << name;
    EXPECT_TRUE(hollow.run.back_at_rest) << name;
    const double stress_Pa = std::accumulate(hollow.run.held_stress_Pa.begin(), hollow.run.held_stress_Pa.end(), 0.0);
    EXPECT_GT(stress_Pa, before_Pa) << name;
    before_Pa = stress_Pa;
  }
}

// Fig. 6: fingers wrap the cylinder, root and tip of each more than 70 degrees apart about its axis, and the thumb
// comes from the other side: what its parts push together is opposed to what those of every finger do.
TEST(PaperGrasps, FingersWrapTheCylinderAndTheThumbOpposes) {
  const GraspRun& run = played("grasp_cylinder_5");
  const Model& model = scene_named("grasp_cylinder_5").model();
  Vec3 push[kHandParts + 1];  // of each part on the body
  for (std::size_t i = 0; i < model.tool_point.size(); ++i) {
    const std::int32_t slot = run.held->point.data()[i].region;
    if (slot >= 0)
      push[model.piece[static_cast<std::size_t>(model.tool_point[i].piece)].part] = -run.held->region[slot].normal_w;
  }
  const auto together = [&](std::int32_t tip) {
    Vec3 sum;
    for (std::int32_t part = tip; part < tip + 3; ++part)
      sum += run.part_force_N[static_cast<std::size_t>(part)] * push[part];
    return unit_or(sum, {});
  };
  constexpr std::int32_t kThumb = 13;
  for (const std::int32_t finger : {1, 4, 7, 10}) {
    const char* const name = hand_parts()[static_cast<std::size_t>(finger - 1)].name;
    EXPECT_LT(dot(push[finger], push[finger + 2]), std::cos(70 * kPi / 180)) << name;
    EXPECT_LT(dot(together(finger), together(kThumb)), -0.25) << name;
  }
}

}  // namespace
}  // namespace palpate::test
