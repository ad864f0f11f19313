// Skeleton of baked beams: sharing of the force, interpolation over the triangle, the paper's ratios, bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "config/beams/circular_beam.h"
#include "rt_core/skeleton/beam_table.h"
#include "rt_core/status.h"
#include "sim_host/view/anchors.h"
#include "tests/deform/deform_scene.h"

namespace palpate {
namespace {

using deform_test::random_vector;
using palpate::kPi;

const BeamMaterial kRubber{3e6, 0.47};

// Tables of `vertices` x `anchors` that a Model views.
struct Table {
  Model model;
  std::vector<Anchor> anchor;
  std::vector<BeamStiffness> stiffness;
  std::vector<BeamRatio> ratio;
  std::vector<BeamResponse> response;

  explicit Table(std::size_t vertices, std::size_t anchors, SkeletonLaw law = SkeletonLaw::kCircular) {
    model.params.skeleton_law = law;
    model.sizes.n_vertex = static_cast<std::int64_t>(vertices);
    model.sizes.n_anchor = static_cast<std::int64_t>(anchors);
    for (std::size_t a = 0; a < anchors; ++a)
      anchor.push_back(deform_test::make_anchor({0.04, 0.01 * static_cast<double>(a), 0}, 5e-3));
    stiffness.assign(vertices * anchors, BeamStiffness{});
    ratio.assign(vertices * anchors, BeamRatio{});
    response.assign(vertices * anchors, BeamResponse{});
    model.anchor = anchor;
    model.beam_stiffness = stiffness;
    model.beam_ratio = ratio;
    model.beam_response = response;
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
};

SurfaceSpot at_vertex(std::int32_t vertex) { return {{vertex, 0, 0}, {1, 0, 0}, true}; }

// World stiffness of an arc whose tip frame is (radial, tangential, radial x tangential).
BeamStiffness arc_stiffness(const ArcSection& section, double angle, Vec3 r, Vec3 t) {
  const ArcCompliance c = arc_tip_compliance(section, kRubber, angle, section.outer_m);
  const double det = c.rr_m_per_N * c.tt_m_per_N - c.rt_m_per_N * c.rt_m_per_N;
  const double rr = c.tt_m_per_N / det, tt = c.rr_m_per_N / det, rt = -c.rt_m_per_N / det, zz = 1 / c.zz_m_per_N;
  const Vec3 z = cross(r, t);
  const auto entry = [&](double ri, double rj, double ti, double tj, double zi, double zj) {
    return rr * ri * rj + tt * ti * tj + rt * (ri * tj + ti * rj) + zz * zi * zj;
  };
  return {{entry(r.x, r.x, t.x, t.x, z.x, z.x), entry(r.x, r.y, t.x, t.y, z.x, z.y),
           entry(r.x, r.z, t.x, t.z, z.x, z.z), entry(r.y, r.y, t.y, t.y, z.y, z.y),
           entry(r.y, r.z, t.y, t.z, z.y, z.z), entry(r.z, r.z, t.z, t.z, z.z, z.z)}};
}

BeamStiffness random_stiffness(std::mt19937_64& random) {
  const Vec3 a = random_vector(random, 1), b = random_vector(random, 1), c = random_vector(random, 1);
  const auto entry = [&](int i, int j) {
    const auto at = [](Vec3 v, int k) { return deform_test::component(v, k); };
    return 900 * at(a, i) * at(a, j) + 300 * at(b, i) * at(b, j) + 50 * at(c, i) * at(c, j) + (i == j ? 5.0 : 0.0);
  };
  return {{entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)}};
}

TEST(BeamTable, TwoArcsOfTheWorkedExample) {
  // Arcs of +-60 degrees (a = 30, b = 40, t = 10 mm) from a common top, pressed with 2 N.
  Table table(1, 2);
  const ArcSection section{30e-3, 40e-3, 10e-3};
  table.stiffness[0] = arc_stiffness(section, kPi / 3, {0, 1, 0}, {-1, 0, 0});
  table.stiffness[1] = arc_stiffness(section, kPi / 3, {0, 1, 0}, {1, 0, 0});
  BeamTableSkeleton s;
  ASSERT_TRUE(solve_beam_table(table.model, at_vertex(0), {0, -2, 0}, s));
  EXPECT_NEAR(table.stiffness[0].k_N_per_m[0] + table.stiffness[1].k_N_per_m[0], 7625.156108, 1e-6);
  EXPECT_NEAR(table.stiffness[0].k_N_per_m[3] + table.stiffness[1].k_N_per_m[3], 3478.277285, 1e-6);
  EXPECT_NEAR(s.displacement_w.y, -2 / 3478.277285, 1e-12);
  EXPECT_NEAR(std::abs(s.force_w[0].x), 1.4011864, 6e-8);
  EXPECT_NEAR(s.force_w[0].x + s.force_w[1].x, 0, 1e-12);
  EXPECT_NEAR(s.force_w[0].y, -1, 1e-12);
  EXPECT_NEAR(s.force_w[1].y, -1, 1e-12);
}

TEST(BeamTable, ForcesAddUpAndEnergiesAgree) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    Table table(3, 7);
    for (BeamStiffness& k : table.stiffness) k = random_stiffness(random);
    const SurfaceSpot spot{{0, 1, 2}, {0.2, 0.3, 0.5}, true};
    const Vec3 force = random_vector(random, 10);
    BeamTableSkeleton s;
    ASSERT_TRUE(solve_beam_table(table.model, spot, force, s));
    Vec3 sum;
    double energy = 0;
    for (std::int32_t i = 0; i < s.count; ++i) {
      sum += s.force_w[i];
      energy += 0.5 * dot(s.force_w[i], s.displacement_w);
    }
    EXPECT_NEAR(norm(sum - force), 0, 1e-11 * norm(force));
    EXPECT_NEAR(energy, 0.5 * dot(force, s.displacement_w), 1e-12 * std::abs(energy));
    EXPECT_GT(energy, 0);
  }
}

TEST(BeamTable, ContinuousAcrossATrianglesEdge) {
  // The same edge point seen from the two triangles that share it.
  std::mt19937_64 random(12);
  Table table(4, 5);
  for (BeamStiffness& k : table.stiffness) k = random_stiffness(random);
  for (BeamResponse& r : table.response) r.axial_Pa_per_N = random_vector(random, 1e4);
  const SurfaceSpot one{{0, 1, 2}, {0.25, 0.75, 0}, true}, other{{3, 0, 1}, {0, 0.25, 0.75}, true};
  BeamTableSkeleton s, t;
  ASSERT_TRUE(solve_beam_table(table.model, one, {1, -3, 2}, s));
  ASSERT_TRUE(solve_beam_table(table.model, other, {1, -3, 2}, t));
  for (std::int32_t a = 0; a < 5; ++a) {
    EXPECT_NEAR(norm(s.force_w[a] - t.force_w[a]), 0, 1e-13);
    EXPECT_NEAR(beam_table_anchor(table.model, s, a).stress.axial_Pa,
                beam_table_anchor(table.model, t, a).stress.axial_Pa, 1e-8);
  }
}

TEST(BeamTable, AnchorsAnswerByTheirRows) {
  Table table(1, 2);
  std::mt19937_64 random(13);
  for (BeamStiffness& k : table.stiffness) k = random_stiffness(random);
  table.response[0].release_m_per_N[1] = {0, 2e-4, 0};
  table.response[0].inner_Pa_per_N = {0, 3000, 0};
  table.response[0].outer_Pa_per_N = {0, -1000, 0};
  table.response[0].side_Pa_per_N = {500, 0, 0};
  table.response[0].axial_Pa_per_N = {0, 1000, 0};
  table.response[0].shear_in_Pa_per_N = {30, 0, 0};
  table.response[0].shear_out_Pa_per_N = {0, 0, 40};
  table.response[1] = table.response[0];
  table.anchor[1].fixed = 1;
  const Vec3 force{1, -3, 2};
  BeamTableSkeleton s;
  ASSERT_TRUE(solve_beam_table(table.model, at_vertex(0), force, s));
  for (std::int32_t a = 0; a < 2; ++a) {
    const Vec3 f = s.force_w[a];
    const BeamTableAnchor r = beam_table_anchor(table.model, s, a);
    EXPECT_DOUBLE_EQ(r.stress.axial_Pa, 1000 * f.y);
    EXPECT_NEAR(std::abs(r.stress.axial_Pa) + r.stress.bending_Pa, 3000 * std::abs(f.y) + 500 * std::abs(f.x), 1e-9);
    EXPECT_NEAR(r.stress.shear_Pa, std::hypot(30 * f.x, 40 * f.z), 1e-9);
    EXPECT_DOUBLE_EQ(r.displacement_w.y, a == 0 ? 2e-4 * f.y : 0.0);
  }
}

TEST(BeamTable, PaperRatiosReproduceAForceInTheirPlane) {
  Table table(1, 3, SkeletonLaw::kCircularPaper);
  std::mt19937_64 random(14);
  for (BeamRatio& r : table.ratio) {
    const Vec3 a = unit_or(random_vector(random, 1), {1, 0, 0});
    const Vec3 b = unit_or(tangential_part(random_vector(random, 1), a), {0, 1, 0});
    r = {a, 400 * a, b, 900 * b};
  }
  const Vec3 force{0.5, -2, 1};
  BeamTableSkeleton s;
  ASSERT_TRUE(solve_beam_table(table.model, at_vertex(0), force, s));
  const Vec3 d = unit_or(force, {});
  Vec3 u, v, sum;
  for (const BeamRatio& r : table.ratio) {
    u += dot(r.f1_gain_N_per_m, d) * r.f1_axis;
    v += dot(r.f2_gain_N_per_m, d) * r.f2_axis;
  }
  for (std::int32_t i = 0; i < 3; ++i) sum += s.force_w[i];
  // Three equations, two scales: what is left over is normal to both columns.
  EXPECT_NEAR(dot(sum - force, u), 0, 1e-9 * norm(u) * norm(force));
  EXPECT_NEAR(dot(sum - force, v), 0, 1e-9 * norm(v) * norm(force));
}

TEST(BeamTable, RefusesWhatCannotBeSolved) {
  Table table(2, 3);
  std::mt19937_64 random(15);
  for (std::size_t i = 0; i < 3; ++i) table.stiffness[i] = random_stiffness(random);  // vertex 1 has no beams at all
  BeamTableSkeleton s;
  EXPECT_FALSE(solve_beam_table(table.model, at_vertex(1), {0, -1, 0}, s));
  EXPECT_TRUE(s.degenerate);
  for (std::int32_t a = 0; a < 3; ++a) EXPECT_EQ(s.force_w[a], Vec3{});
  EXPECT_FALSE(solve_beam_table(table.model, at_vertex(0), {std::nan(""), 0, 0}, s));
  EXPECT_FALSE(solve_beam_table(table.model, {}, {0, -1, 0}, s));  // not on the surface
  ASSERT_TRUE(solve_beam_table(table.model, at_vertex(0), {0, 0, 0}, s));
  EXPECT_EQ(s.force_w[0], Vec3{});
}

TEST(BeamTable, HoldsAsManyAnchorsAsAllowed) {
  Table table(1, kMaxAnchors);
  std::mt19937_64 random(16);
  for (BeamStiffness& k : table.stiffness) k = random_stiffness(random);
  BeamTableSkeleton s;
  ASSERT_TRUE(solve_beam_table(table.model, at_vertex(0), {1, 2, 3}, s));
  EXPECT_EQ(s.count, kMaxAnchors);
  Vec3 sum;
  for (const Vec3& f : s.force_w) sum += f;
  EXPECT_NEAR(norm(sum - Vec3{1, 2, 3}), 0, 1e-11);
}

}  // namespace
}  // namespace palpate
