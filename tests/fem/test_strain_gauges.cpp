// Strain gauges, and whether single precision suffices.
#include "config/fem/strain_gauges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/fem/compliance_precision.h"
#include "config/fem/tet_procedural.h"

namespace palpate {
namespace {

struct Bar {
  TetMesh mesh = make_box_tets({0.010, 0.060, 0.010}, {2, 8, 2});
  Supports supports = hold_where(mesh, [](Vec3 p) { return p.y == 0; });
  LinearBody solver{mesh, {1e9, 0.3}, supports, "bar"};
  CondensedBody body = condense(solver, mesh, supports, "bar");
};

// Sum over the end face of the rows of the table: uniform pull F = 1 N gives e_yy = F/(E A) = 1e-5 away from the root.
TEST(StrainGauges, ReadTheStrainOfAPulledBar) {
  const Bar bar;
  const StrainGauges gauges = place_strain_gauges(bar.solver, bar.mesh, bar.body, 16);
  ASSERT_GT(gauges.tet.size(), 0u);
  ASSERT_LE(gauges.tet.size(), 16u);
  const std::size_t row = 6 * gauges.tet.size();
  ASSERT_EQ(gauges.strain_1pN.size(), 3 * bar.body.node.size() * row);
  std::vector<double> strain(row, 0.0);
  double area = 0;
  std::vector<double> share(bar.body.node.size(), 0.0);
  for (std::size_t t = 0; t < bar.body.surface.triangle.size(); ++t) {
    const Corners& c = bar.body.surface.triangle[t];
    bool at_end = true;
    for (const std::int32_t i : c) at_end = at_end && bar.body.surface.vertex_m[static_cast<std::size_t>(i)].y > 0.0599;
    if (!at_end) continue;
    const double a = 0.5 * norm(triangle_cross(bar.body.surface, t));
    area += a;
    for (const std::int32_t i : c) share[static_cast<std::size_t>(i)] += a / 3;
  }
  for (std::size_t i = 0; i < share.size(); ++i)
    for (std::size_t k = 0; k < row; ++k) strain[k] += share[i] / area * gauges.strain_1pN[(3 * i + 1) * row + k];
  for (std::size_t g = 0; g < gauges.tet.size(); ++g) {
    if (gauges.position_m[g].y < 0.015 || gauges.position_m[g].y > 0.045) continue;
    EXPECT_NEAR(strain[6 * g + 1], 1e-5, 1e-7) << g;  // 1 %: the ends still show
    EXPECT_NEAR(strain[6 * g], -0.3e-5, 1e-7) << g;
  }
  // The largest strain of a cantilever is at its root: some gauge must sit there, on the outer fibre.
  const auto at_root =
      std::count_if(gauges.position_m.begin(), gauges.position_m.end(), [](Vec3 p) { return p.y < 0.0075; });
  EXPECT_GT(at_root, 0);
  EXPECT_GT(gauges.mean_share, 0.8);
  EXPECT_LE(gauges.worst_share, gauges.mean_share);
}

TEST(StrainGauges, SizeOfAStrainDoesNotDependOnTheFrame) {
  const double pull[6] = {1, 0, 0, 0, 0, 0};
  const double turned[6] = {0.5, 0.5, 0, 0.5, 0, 0};  // the same pull along (1, 1, 0)/sqrt(2)
  EXPECT_DOUBLE_EQ(strain_size(pull), 1);
  EXPECT_DOUBLE_EQ(strain_size(turned), 1);
}

TEST(SinglePrecision, SufficesForTheClipAndTheBar) {
  const Bar bar;
  const TetMesh clip = make_clip_mesh(1);
  for (const CondensedBody& body : {bar.body, condense(clip, {2e9, 0.35}, clip_supports(clip), "clip")}) {
    const PrecisionReport report = single_precision_error(body);
    EXPECT_TRUE(single_precision_suffices(report)) << report.total_error;
    EXPECT_GT(report.total_error, 0);
  }
}

// A table whose interesting part is a small difference of large entries (a soft spring under a stiff block) loses it.
TEST(SinglePrecision, IsRefusedWhereRoundingDecides) {
  const Bar bar;
  CondensedBody soft = bar.body;
  for (double& c : soft.compliance_mpN) c *= 1e-6;
  const std::size_t size = 3 * soft.node.size();
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j)
      if (i % 3 == j % 3 && soft.held[i / 3] == 0 && soft.held[j / 3] == 0) soft.compliance_mpN[i * size + j] += 1e-3;
  EXPECT_FALSE(single_precision_suffices(single_precision_error(soft)));
}

}  // namespace
}  // namespace palpate
