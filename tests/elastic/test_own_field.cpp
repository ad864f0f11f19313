// What a place gives by itself, where its compliance crosses zero.
#include "rt_core/contact/elastic/own_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

// A ball of 8 mm on the side of a small block, whose c falls from the top, where the body is soft, to below zero
// further down: across its zero, 2 mm deep, by 20 um a tick.
TEST(OwnField, ASlideOverWhereAPlaceBecomesALayerNeitherStepsNorLosesEnergy) {
  const BakedScene scene(
      parse_scene(elastic_scene("shape = \"box\"\nsize_mm = [24, 30, 24]\n", 0, 4, 8, 3), "block.toml"));
  Bench bench(scene.model());
  const double step = 2e-5;
  move_to(bench, {0.023, 0.023, 0}, {0.018, 0.023, 0});
  std::vector<Vec3> force{bench.output.contact_w.force_N};
  const double begun_J = bench.output.energy_J;
  double work_J = 0, aside_N = 0, off_N = 0;
  for (int i = 1; i <= 200; ++i) {
    const Output& out = bench.tick_at({{0.018, 0.023 + i * step, 0}, {}}, {});
    work_J += 0.5 * step * (force.back().y + out.contact_w.force_N.y);
    force.push_back(out.contact_w.force_N);
    aside_N = std::max(aside_N, std::abs(out.contact_w.force_N.y));
  }
  for (std::size_t i = 1; i + 1 < force.size(); ++i)
    off_N = std::max(off_N, norm(force[i] - 0.5 * (force[i - 1] + force[i + 1])));
  // With c1 let go at zero: 4 % of the force, and 1.4e-3 of the energy (2026-11-26). A slide may step by half a
  // percent.
  EXPECT_LT(off_N, 0.005 * norm(force.front()));
  EXPECT_LT(aside_N, 0.1 * norm(force.front()));
  EXPECT_NEAR(bench.output.energy_J + work_J, begun_J, 2e-4 * begun_J);
}

ElasticRow place(double c_m_per_N, double c1_m_per_N2) {
  ElasticRow row{};
  row.modulus = 1;
  row.c_m_per_N = c_m_per_N;
  row.c1_m_per_N2 = c1_m_per_N2;
  return row;
}
TipLaw ball_law() {
  TipLaw law{};
  law.coefficient = 4e5;  // a dent of 1 mm under 12.6 N
  law.depth_max_m = 4e-3;
  law.half_power = 3;
  law.force_max_N = law.coefficient * std::pow(law.depth_max_m, 1.5);
  return law;
}
// The integral of w over the force.
double complementary_J(double c, double c1, double force_N) {
  const FarField far = own_field(ball_law(), place(c, c1)).far;
  return force_N * far_shift_m(far, force_N) - far_energy_J(far, force_N);
}

TEST(OwnField, TellsHowItChangesWithItsNumbers) {
  const double dent = 1 / (1.5 * 4e5 * std::sqrt(4e-3));
  for (const double c : {2 * dent, 0.1 * dent, 1e-3 * dent, -0.03 * dent, -0.1 * dent, -0.19 * dent, -0.3 * dent})
    for (const double c1 : {0.002 * dent, 0.2 * dent, -0.002 * dent, -0.1 * dent})
      for (const double force_N : {0.5, 5.0, 60.0}) {
        const FarChange change = far_change(own_field(ball_law(), place(c, c1)), c, c1, force_N);
        const double of_c = 1e-5 * dent, of_c1 = 1e-5 * std::abs(c1);
        const double per_c =
            (complementary_J(c + of_c, c1, force_N) - complementary_J(c - of_c, c1, force_N)) / of_c / 2;
        const double per_c1 =
            (complementary_J(c, c1 + of_c1, force_N) - complementary_J(c, c1 - of_c1, force_N)) / of_c1 / 2;
        EXPECT_NEAR(change.per_c0_N2, per_c, 1e-4 * (std::abs(per_c) + force_N * force_N)) << c / dent << " " << c1;
        EXPECT_NEAR(change.per_c1_N3, per_c1, 1e-4 * std::abs(per_c1) + 1e-9) << c / dent << " " << c1;
      }
}

TEST(OwnField, IsTheSameFromBothSidesOfZero) {
  for (const double c1 : {3e-6, -3e-6}) {
    const FarField above = own_field(ball_law(), place(1e-18, c1)).far,
                   below = own_field(ball_law(), place(-1e-18, c1)).far;
    for (const double force_N : {1.0, 10.0, 100.0})
      EXPECT_NEAR(far_shift_m(above, force_N), far_shift_m(below, force_N), 1e-12) << force_N;
  }
}

}  // namespace
}  // namespace palpate::test
