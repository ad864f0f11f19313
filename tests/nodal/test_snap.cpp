// The clip of Duriez, Andriot & Kheddar (2003, section 5) snapped over a rigid tube. Reference: large strain in
// plane stress (tests/support/snap_reference.h). In three dimensions plane stress is nu = 0: with 0.35 and a width of
// five thicknesses the arms cannot bend anticlastically, which makes them 7 % stiffer.
#include <gtest/gtest.h>
#include <limits>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/scene/scene.h"
#include "tests/nodal/nodal_scene.h"
#include "tests/support/baked_scene.h"
#include "tests/support/snap_reference.h"

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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
  const TetMesh& mesh() const { return mesh_; }
  const CondensedBody& body() const { return body_; }
  std::size_t nodes() const { return mesh_.node_m.size(); }

  static constexpr int kTicksPerStep = 4;

 private:
  static NodalSceneOptions options(NodalCarry carry, double mu) {
    NodalSceneOptions o;
    o.young_Pa = 2e9;
    o.poisson = 0;
    o.carry = carry;
    o.mu = mu;
    o.coupling_N_per_m = 5000;  // as snap_in_paper
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
  for (const SnapSample& s : kSnapReference)
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
    BakedScene scene(load_scene(PALPATE_SOURCE_DIR "/config/scenes/snap_in_paper.toml"));
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

// Slowly past where the arms are widest open, 8.17 mm, in steps of 2.5 um: the force falls by 2.3 N/mm, 6 mN a step.
// Until 2026-11-23 whole rows of nodes stuck and slipped in turn there, since what the arms' bend followed of the last
// tick's friction counted as sliding: 0.15 N for a tick with mu = 0.2, 2.3 N in every other tick with 0.4.
TEST(Snap, SlidesWithoutSticking) {
  for (const double mu : {0.2, 0.4}) {
    BakedScene scene(load_scene(PALPATE_SOURCE_DIR "/config/scenes/snap_in_paper.toml"));
    scene.model().params.friction_mu_dynamic = mu;
    Bench bench(scene.model());
    double last = 0, largest = 0;
    for (int k = 0; k <= 3400; ++k) {
      const double force = bench.tick_at({{0, kFirstContact_m - 2.5e-6 * k, 0}, {}}, {}).contact_w.force_N.y;
      if (k > 2800) largest = std::max(largest, std::abs(force - last));
      last = force;
    }
    std::printf("mu = %.1f: steps of 2.5 um change the force by at most %.4f N\n", mu, largest);
    EXPECT_LT(largest, 0.05) << mu;  // measured 0.008 and 0.021 N
  }
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

// The tube has the clip's radius: seated, it meets all of the wall above the held foot at once, a stop. Over half a
// micrometre the force, -0.2 N before, rises by tens of newtons; but it is continuous, steps of a tenth change it by a
// tenth, and its slope is that of the wall pressed against its foot, E w R / t (phi + sin 2 phi / 2) with phi = 20
// degrees, and some more for what lies beside the foot. Through the coupling the hand feels no step at all.
TEST(Snap, TheSeatIsAStopAndNoStep) {
  constexpr double kPhi = 20 * 3.14159265358979323846 / 180;
  const double wall_N_per_m = 2e9 * 0.010 * 0.010 / 0.002 * (kPhi + 0.5 * std::sin(2 * kPhi));
  double slope_N_per_m = 0;
  for (const double step_m : {5e-6, 5e-7, 5e-8, 5e-9}) {
    Clip clip(1);
    clip.scene().move({0, kFirstContact_m, 0}, {0, 5e-6, 0}, 600);
    double last = clip.scene().output().contact_w.force_N.y, largest = 0;
    const int ticks = static_cast<int>(std::lround(5.5e-6 / step_m));
    for (int k = 1; k <= ticks; ++k) {
      const double force = clip.scene().tick_at({0, 5e-6 - step_m * k, 0}).contact_w.force_N.y;
      largest = std::max(largest, std::abs(force - last));
      last = force;
    }
    std::printf("seat: steps of %g um change the force by at most %.4f N\n", 1e6 * step_m, largest);
    EXPECT_LT(largest, 1.5 * wall_N_per_m * step_m);
    slope_N_per_m = largest / step_m;
  }
  EXPECT_GT(slope_N_per_m, wall_N_per_m);  // the last, where only the stop is in a step
  std::printf("slope of the stop %.1f N/um, of the wall on its foot %.1f N/um\n", 1e-6 * slope_N_per_m,
              1e-6 * wall_N_per_m);
}

TEST(Snap, TheHandFeelsTheSeatThroughTheCoupling) {
  Clip clip(1);
  const double step_m = 5e-6, coupling_N_per_m = 5000;
  clip.scene().move({0, kFirstContact_m, 0}, {0, 1e-3, 0}, 2600, Drive::kDevice);
  double last = clip.scene().output().contact_w.force_N.y, largest = 0;
  for (int k = 1; k <= 400; ++k) {  // past the seat by a millimetre
    const double force = clip.scene().tick_at({0, 1e-3 - step_m * k, 0}, Drive::kDevice).contact_w.force_N.y;
    largest = std::max(largest, std::abs(force - last));
    last = force;
  }
  std::printf("through the coupling: %.4f N a step of 5 um at most, %.2f N in the end\n", largest, last);
  EXPECT_LT(largest, 1.01 * coupling_N_per_m * step_m);
  EXPECT_NEAR(last, coupling_N_per_m * 1e-3, 0.01);
}

// Section 3.2 of the paper: where the body is not touched, middle nodes are not computed but put midway between the
// corners of their edge. What a tick would save and lose by that: displacements of the whole surface by the pushes of
// the moment, middle nodes of elements in contact kept. Forces cannot change, the table is of the quadratic body in
// both; and a tick computes no displacement but those of the problem's nodes (docs/models_contact_lcp.md, section 3).
TEST(Snap, ThePMethodOfThePaperSavesWorkThatATickDoesNotDo) {
  Clip clip(1);
  const CondensedBody& body = clip.body();
  const std::size_t n = body.node.size();
  std::vector<std::int32_t> vertex(clip.mesh().node_m.size(), -1);
  for (std::size_t i = 0; i < n; ++i) vertex[static_cast<std::size_t>(body.node[i])] = static_cast<std::int32_t>(i);
  double worst = 0, full = 0, kept = 0, tick = 0;
  for (int k = 0; k <= 140; ++k) {
    clip.scene().move(Clip::at(k - 1), Clip::at(k), 4);
    const ContactProblem& p = problem_of(clip.scene().scratch());
    std::vector<Vec3> u(n);
    std::vector<char> pushed(n);
    std::size_t pushes = 0;
    for (std::int32_t j = 0; j < p.count; ++j) {
      if (!(p.node[j].push.normal_N > 0)) continue;
      ++pushes;
      const auto v = static_cast<std::size_t>(p.node[j].vertex);
      pushed[v] = 1;
      const Vec3 f = p.node[j].force_w;
      for (std::size_t i = 0; i < n; ++i) {
        const auto entry = [&](std::size_t a) {
          const double* row = body.compliance_mpN.data() + (3 * i + a) * 3 * n + 3 * v;
          return row[0] * f.x + row[1] * f.y + row[2] * f.z;
        };
        u[i] += {entry(0), entry(1), entry(2)};
      }
    }
    if (pushes == 0) continue;
    std::vector<char> is_free(n);  // middle nodes of elements in contact
    for (const Tet& tet : clip.mesh().tet) {
      const bool touched = std::ranges::any_of(tet.node, [&](std::int32_t node) {
        const std::int32_t v = vertex[static_cast<std::size_t>(node)];
        return v >= 0 && pushed[static_cast<std::size_t>(v)] != 0;
      });
      for (std::size_t e = 4; touched && e < 10; ++e)
        if (const std::int32_t v = vertex[static_cast<std::size_t>(tet.node[e])]; v >= 0)
          is_free[static_cast<std::size_t>(v)] = 1;
    }
    double largest = 0, apart = 0;
    std::vector<char> midway(n);
    for (const Tet& tet : clip.mesh().tet)
      for (std::size_t e = 0; e < 6; ++e) {
        const auto at = [&](std::int32_t node) { return vertex[static_cast<std::size_t>(node)]; };
        const std::int32_t m = at(tet.node[4 + e]), a = at(tet.node[static_cast<std::size_t>(kTetEdge[e][0])]),
                           b = at(tet.node[static_cast<std::size_t>(kTetEdge[e][1])]);
        if (m < 0 || a < 0 || b < 0 || is_free[static_cast<std::size_t>(m)] != 0) continue;
        midway[static_cast<std::size_t>(m)] = 1;
        apart = std::max(apart, norm(u[static_cast<std::size_t>(m)] -
                                     0.5 * (u[static_cast<std::size_t>(a)] + u[static_cast<std::size_t>(b)])));
      }
    for (const Vec3& v : u) largest = std::max(largest, norm(v));
    worst = std::max(worst, apart / largest);
    const double left = static_cast<double>(n) - static_cast<double>(std::ranges::count(midway, 1));
    const double m = static_cast<double>(pushes);
    full = std::max(full, 9 * m * static_cast<double>(n));
    kept = std::max(kept, 9 * m * left + 3 * (static_cast<double>(n) - left));
    tick = std::max(tick, 9 * m * p.count);
  }
  std::printf(
      "P-method on %zu nodes: products %.0f instead of %.0f for the whole surface, a tick does %.0f; middle nodes off "
      "by %.2f %% of the largest displacement\n",
      n, kept, full, tick, 100 * worst);
  EXPECT_LT(kept, 0.5 * full);  // the paper's saving is real,
  EXPECT_LT(tick, 0.5 * kept);  // of work that is none of the tick's
  EXPECT_LT(worst, 0.05);
}

}  // namespace
}  // namespace palpate::test
