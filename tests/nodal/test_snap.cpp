// The clip of Duriez, Andriot & Kheddar (2003, section 5) snapped over a rigid tube. Reference: a large-strain
// finite-element solution in plane stress (E = 2000 MPa, nu = 0.35, element size 0.7 mm, uncertain by 1.5 %). In three
// dimensions plane stress is nu = 0: with 0.35 and a width of five thicknesses the arms cannot bend anticlastically,
// which makes them 7 % stiffer.
#include <gtest/gtest.h>
#include <limits>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/scene/scene.h"
#include "tests/nodal/nodal_scene.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

constexpr double kFirstContact_m = 0.01414133;

struct Sample {
  double insertion_mm, force_N;
};
constexpr Sample kReference[] = {{0.5, 2.589},   {1, 4.361},   {2, 6.170},   {3, 6.534},  {4, 5.965},
                                 {5, 4.630},     {6, 2.899},   {7, 0.795},   {8, -1.467}, {10, -5.719},
                                 {11.5, -7.351}, {12, -7.232}, {13, -5.505}, {14, -0.944}};
constexpr double kPeak_N = 6.534;

class Clip {
 public:
  explicit Clip(std::int32_t level, NodalCarry carry = NodalCarry::kTurned, double mu = 0)
      : mesh_(make_clip_mesh(level)),
        body_(condense(mesh_, {2e9, 0}, clip_supports(mesh_), "clip")),
        scene_(body_, {cylinder_piece(0.010, 0.040, 0.001)}, options(carry, mu)) {}

  // Force against insertion, on the way in, every tenth of a millimetre up to 14 mm.
  std::vector<double> insert() {
    scene_.restart();
    std::vector<double> force;
    for (int k = 0; k <= 140; ++k) {
      scene_.move(at(k - 1), at(k), kTicksPerStep);
      force.push_back(scene_.output().contact_w.force_N.y);
    }
    return force;
  }
  static Vec3 at(int tenths) { return {0, kFirstContact_m - 1e-4 * tenths, 0}; }
  NodalScene& scene() { return scene_; }
  std::size_t nodes() const { return mesh_.node_m.size(); }

  static constexpr int kTicksPerStep = 4;

 private:
  static NodalSceneOptions options(NodalCarry carry, double mu) {
    NodalSceneOptions o;
    o.young_Pa = 2e9;
    o.poisson = 0;
    o.carry = carry;
    o.mu = mu;
    return o;
  }
  TetMesh mesh_;
  CondensedBody body_;
  NodalScene scene_;
};

double zero_crossing_mm(const std::vector<double>& force) {
  for (std::size_t k = 30; k < force.size(); ++k)
    if (force[k] < 0) return 0.1 * (static_cast<double>(k) - force[k] / (force[k] - force[k - 1]));
  return kNan;
}

double worst_error(const std::vector<double>& force) {
  double worst = 0;
  for (const Sample& s : kReference)
    worst = std::max(worst, std::abs(force[static_cast<std::size_t>(std::lround(10 * s.insertion_mm))] - s.force_N));
  return worst / kPeak_N;
}

// Without the finite rotation of the arms linear elasticity is 8 % off; with it the meshes decide: 4.6, 4.2 and 3.0 %
// (2026-11-21).
TEST(Snap, FollowsTheReferenceOnThreeMeshes) {
  for (std::int32_t level = 1; level <= 3; ++level) {
    Clip clip(level);
    const std::vector<double> force = clip.insert();
    const auto highest = std::max_element(force.begin(), force.end());
    const auto lowest = std::min_element(force.begin(), force.end());
    std::printf(
        "level %d, %zu nodes: peak %.3f N at %.1f mm, zero at %.2f mm, lowest %.3f N at %.1f mm, worst error "
        "%.1f %% of the peak\n",
        level, clip.nodes(), *highest, 0.1 * static_cast<double>(highest - force.begin()), zero_crossing_mm(force),
        *lowest, 0.1 * static_cast<double>(lowest - force.begin()), 100 * worst_error(force));
    EXPECT_LT(worst_error(force), 0.06) << "level " << level;
    EXPECT_NEAR(*highest, kPeak_N, 0.06 * kPeak_N);
    EXPECT_NEAR(*lowest, -7.351, 0.06 * kPeak_N);
    EXPECT_NEAR(0.1 * static_cast<double>(highest - force.begin()), 3.0, 0.5);
    EXPECT_NEAR(0.1 * static_cast<double>(lowest - force.begin()), 11.5, 0.5);
    EXPECT_NEAR(zero_crossing_mm(force), 7.35, 0.15);
  }
}

// The scene as it is shipped, but for its friction, which the reference does not have; and without finite rotation.
TEST(Snap, TheShippedSceneFollowsTheReference) {
  for (const bool shipped : {false, true}) {
    BakedScene scene(load_scene(PALPATE_SOURCE_DIR "/config/scenes/snap_in.toml"));
    scene.model().params.friction_law = FrictionLaw::kNone;
    if (!shipped) scene.model().params.nodal_carry = NodalCarry::kFarField;
    Bench bench(scene.model());
    std::vector<double> force;
    for (int k = 0; k <= 560; ++k) {
      bench.tick_at({{0, kFirstContact_m - 2.5e-5 * k, 0}, {}}, {});
      if (k % 4 == 0) force.push_back(bench.output.contact_w.force_N.y);
    }
    EXPECT_LT(worst_error(force), shipped ? 0.06 : 0.10);
    EXPECT_EQ(bench.output.fault, 0u);
  }
}

// Why normals follow the far field: at rest they make the peak a third too high.
TEST(Snap, NormalsAtRestAreWrongForAClip) {
  Clip clip(1, NodalCarry::kRest);
  const std::vector<double> force = clip.insert();
  EXPECT_GT(*std::max_element(force.begin(), force.end()), 1.25 * kPeak_N);
}

TEST(Snap, InsertionAndReleaseRepeatToTheBit) {
  Clip clip(1, NodalCarry::kTurned, 0.2);
  std::uint64_t hash[2] = {};
  for (std::uint64_t& h : hash) {
    clip.scene().restart();
    for (int k = 0; k <= 140; ++k) clip.scene().move(Clip::at(k - 1), Clip::at(k), 2);
    for (int k = 140; k > 0; --k) clip.scene().move(Clip::at(k), Clip::at(k - 1), 2);
    h = hash_state(clip.scene().state());
  }
  EXPECT_EQ(hash[0], hash[1]);
}

// Without friction the way out meets the forces of the way in: no loop energy.
TEST(Snap, FrictionlessInsertionReturnsItsWork) {
  Clip clip(1);
  double work_J = 0, barrier_J = 0, last = 0;
  const auto go = [&](int from, int to) {
    clip.scene().move(Clip::at(from), Clip::at(to), Clip::kTicksPerStep);
    const double force = clip.scene().output().contact_w.force_N.y;
    work_J += 0.5 * (force + last) * 1e-4 * (to - from);
    barrier_J = std::max(barrier_J, work_J);
    last = force;
  };
  for (int k = 0; k < 140; ++k) go(k, k + 1);
  for (int k = 140; k > 0; --k) go(k, k - 1);
  EXPECT_NEAR(barrier_J, 0.0317, 0.1 * 0.0317);   // the reference's barrier
  EXPECT_LT(std::abs(work_J), 0.03 * barrier_J);  // measured 2026-11-21: see docs/models_contact_lcp.md
  std::printf("barrier %.2f mJ, loop %.3f mJ\n", 1e3 * barrier_J, 1e3 * work_J);
}

// With friction the way in costs more and the way out returns less.
TEST(Snap, FrictionAddsToTheInsertionForce) {
  Clip smooth(1), rough(1, NodalCarry::kTurned, 0.2);
  const std::vector<double> without = smooth.insert(), with = rough.insert();
  EXPECT_GT(*std::max_element(with.begin(), with.end()), 1.2 * *std::max_element(without.begin(), without.end()));
  EXPECT_LT(rough.scene().output().residual_m, 1e-6);
  double work = 0;
  for (std::size_t k = 1; k < with.size(); ++k) work += 0.5e-4 * (with[k] + with[k - 1]);
  EXPECT_GT(work, 0);
}

}  // namespace
}  // namespace palpate::test
