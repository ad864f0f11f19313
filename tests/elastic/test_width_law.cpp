// What a place adds to a tip's law where its give changes with the width of the contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "config/elastic/width_law.h"
#include "config/response/layer_loss.h"
#include "rt_core/contact/tips/travel.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

constexpr double kModulus = 2.5e4, kThickness_m = 0.01;

// A bonded layer's give under a patch, by its kernel.
double layer_give_mpN(const ElasticLayer& layer, double modulus_Pa, double sigma_m) {
  constexpr int kSteps = 2000;
  constexpr double kStep = 20.0 / kSteps;
  const double s = sigma_m / layer.thickness_m;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double w = kStep * (i + 0.5);
    sum += kStep * layer_loss(layer, w) * std::exp(-s * s * w * w);
  }
  return -sum / (std::numbers::pi * modulus_Pa * layer.thickness_m);
}
elastic::WidthLaw layer_width(const ElasticLayer& layer, double modulus_Pa) {
  const double sigma[2] = {0.375 * layer.thickness_m, 0.525 * layer.thickness_m};
  const double give[2] = {layer_give_mpN(layer, modulus_Pa, sigma[0]), layer_give_mpN(layer, modulus_Pa, sigma[1])};
  return {give, sigma, modulus_Pa, layer.poisson_ratio, 0};
}

TEST(WidthLaw, TwoPatchesTellALayer) {
  for (const double nu : {0.0, 0.3, 0.45, 0.49}) {
    const ElasticLayer layer{kThickness_m, nu, LayerBase::kBonded};
    const elastic::WidthLaw width = layer_width(layer, kModulus);
    EXPECT_NEAR(width.thickness_m() / kThickness_m, 1, 1e-3) << nu;
    const double narrow = -LayerContact(layer, 0.01).kernel_at_zero_per_m() / (std::numbers::pi * kModulus);
    EXPECT_NEAR(width.give_mpN(0) / narrow, 1, 1e-3) << nu;
    // Wide, a layer gives next to nothing, and less than nothing never.
    for (const double sigma : {0.004, 0.01, 0.02}) {
      const double half_space = 1 / (2 * std::sqrt(std::numbers::pi) * sigma * kModulus);
      EXPECT_GT(half_space + width.give_mpN(sigma), 0) << nu << ' ' << sigma;
      EXPECT_LT(width.give_mpN(sigma), 0) << nu << ' ' << sigma;
    }
  }
}

// A plate with free faces under a patch, from wave numbers of half a thickness on.
double plate_give_mpN(double thickness_m, double sigma_m) {
  constexpr double kStep = 1e-3;
  double sum = 0;
  for (double w = 0.5 + 0.5 * kStep; w < 15; w += kStep) {
    const double give = (std::sinh(w) * std::cosh(w) + w) / (std::sinh(w) * std::sinh(w) - w * w);
    sum += kStep * (give - 1) * std::exp(-std::pow(w * sigma_m / thickness_m, 2));
  }
  return sum / (std::numbers::pi * kModulus * thickness_m);
}

TEST(WidthLaw, TwoPatchesTellAWall) {
  const double sigma[2] = {4e-3, 5.6e-3};
  const double give[2] = {plate_give_mpN(0.01, sigma[0]), plate_give_mpN(0.01, sigma[1])};
  const elastic::WidthLaw width(give, sigma, kModulus, 0.4, 0);
  EXPECT_NEAR(width.thickness_m() / 0.01, 1, 1e-3);
  for (const double at : {0.0, 1e-3, 2e-3, 4e-3, 5.6e-3})
    EXPECT_NEAR(width.give_mpN(at) / plate_give_mpN(0.01, at), 1, 1e-3) << at;
}

TEST(WidthLaw, APlaceThatGivesMoreTheWiderIsAParabola) {
  const double give[2] = {3e-5, 3.2e-5}, sigma[2] = {3e-3, 4e-3};
  const elastic::WidthLaw width(give, sigma, kModulus, 0.4, 0);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(width.give_mpN(sigma[i]), give[i], 1e-18);
  EXPECT_NEAR(width.give_mpN(0), 3e-5 - 2e-6 * 9 / 7, 1e-18);
}

// A ball of nu = 0 held to 45 % of its height, by quadratic elements: what its top gives of 1 / (E* radius) under
// patches of 0.149 and 0.208 radii, and on finer meshes under narrower ones (2026-11-28). Without the logarithm the law
// says -0.187 and -0.193 of those.
TEST(WidthLaw, ACompressibleBallGivesMoreTheNarrower) {
  const double unit = 1 / (kModulus * 0.03), sigma[2] = {0.149 * 0.03, 0.208 * 0.03};
  const double give[2] = {-0.2006 * unit, -0.2288 * unit};
  const elastic::WidthLaw width(give, sigma, kModulus, 0, 1 / 0.03);
  EXPECT_NEAR(width.give_mpN(sigma[0]) / give[0], 1, 0.03);  // what is taken for noise of elements: less_noise_mpN
  EXPECT_NEAR(width.give_mpN(sigma[1]) / give[1], 1, 0.01);
  EXPECT_NEAR(width.give_mpN(0.0754 * 0.03) / unit, -0.1146, 0.015);
  EXPECT_NEAR(width.give_mpN(0.1056 * 0.03) / unit, -0.1645, 0.015);
}

// What the tick makes of a flat place of that give: its closed form.
double tick_N(const elastic::BallLaw& ball, const elastic::PlaceFit& fit, double c_mpN, double depth_m) {
  const LayerContact half_space({0, 0.45, LayerBase::kBonded}, ball.radius_m);
  const double m = 4.0 / 3 * ball.modulus_Pa * std::sqrt(ball.radius_m);
  const double z = std::max(-(c_mpN + fit.more_give_mpN), 0.0) * m * std::sqrt(depth_m);
  return ball.modulus_Pa * half_space.at_depth({TipProfile::kSphere, ball.radius_m, 0}, depth_m).force_m2 +
         m * std::pow(depth_m, 1.5) * z * (1.5 + 2.625 * z) +
         fit.beta_1pmN * ball.radius_m * m * m * std::pow(depth_m, 3);
}

// press_axisymmetric, neo-Hookean, E = 0.1 MPa, a ball of 10 mm on a layer of 14 mm and 49 mm radius, 13 elements under
// the ball (2026-11-25). With 2 % more travel a / R whatever nu the deepest of nu = 0 was 27 % too soft.
TEST(WidthLaw, ABallOnACompressibleLayer) {
  const struct {
    double nu, force_N[4];  // at 0.7, 1.4, 2.8, 4.2 mm
  } rows[] = {{0, {0.310087, 0.978168, 3.305460, 7.034916}},
              {0.3, {0.333392, 1.038206, 3.407458, 7.034652}},
              {0.45, {0.382004, 1.189938, 3.867849, 7.852352}}};
  for (const auto& row : rows) {
    const double modulus = 1e5 / (1 - row.nu * row.nu);
    const elastic::WidthLaw width = layer_width({0.014, row.nu, LayerBase::kBonded}, modulus);
    const elastic::BallLaw ball{0.01, modulus, false, row.nu, 0, {}};
    const double c = width.give_mpN(0);
    const elastic::PlaceFit fit = elastic::fit_place(ball, width, c, 4.2e-3);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(tick_N(ball, fit, c, 0.7e-3 * (1 << i) - (i == 3 ? 1.4e-3 : 0)) / row.force_N[i], 1, 0.03)
          << row.nu << ' ' << i;
  }
}

// The same over the exact linear layer, on a block of 60 mm; on a ball of 25 mm, over linear elements (2026-11-25).
TEST(WidthLaw, LargeStrainOnABlockAndOnABall) {
  const struct { double depth_mm, block, ball; } rows[] = {{2, 1.043, 0.980}, {4, 1.0691, 0.9776}};
  const elastic::BallLaw flat{0.01, 1e5, false, 0.3, 0, {}}, curved{0.01, 1e5, false, 0.49, 40, {40, 40}};
  const double narrow = -LayerContact({0.06, 0.3, LayerBase::kBonded}, 0.01).kernel_at_zero_per_m() / 3.1416e5;
  for (const auto& row : rows) {
    EXPECT_NEAR(elastic::large_strain_factor(flat, narrow, 1e-3 * row.depth_mm), row.block, 0.02) << row.depth_mm;
    EXPECT_NEAR(elastic::large_strain_factor(curved, 0, 1e-3 * row.depth_mm), row.ball, 0.02) << row.depth_mm;
  }
}

// Over linear elements, a ball on a ball by how much larger it is, at a tenth and a half of its radius: x's coefficient
// fades where the body bends away (2026-11-28; without that 8 % too stiff at nu 0.2, 10 at 0, 12 on a body twice as
// large as the ball, where 4.5 are left).
TEST(WidthLaw, LargeStrainOnACompressibleBall) {
  const struct {
    double nu, kR, tenth, half;
  } rows[] = {{0, 0.265, 1.0520, 1.1443},    {0.1, 0.265, 1.0383, 1.1133}, {0.2, 0.265, 1.0263, 1.0829},
              {0.35, 0.265, 1.0087, 1.0327}, {0, 0.2, 1.0583, 1.1562},     {0.2, 0.5, 1.0127, 1.0524}};
  for (const auto& row : rows) {
    const double k = row.kR / 0.01;
    const elastic::BallLaw ball{0.01, 1e5, false, row.nu, k, {k, k}};
    EXPECT_NEAR(elastic::large_strain_factor(ball, 0, 1e-3), row.tenth, 0.02) << row.nu << ' ' << row.kR;
    EXPECT_NEAR(elastic::large_strain_factor(ball, 0, 5e-3), row.half, row.kR > 0.3 ? 0.05 : 0.03)
        << row.nu << ' ' << row.kR;
  }
}

// Hertz' ellipse by elliptic integrals (Johnson 1985, 4.2): relative curvatures 1, 1.58, 2, 3 and 5 to one another, and
// the circle's that has its force at the same dent, of their mean (worked out on 2026-11-28).
TEST(WidthLaw, ASphereThatIsDentedAsAnEllipse) {
  const struct {
    double ratio, of_mean;
  } rows[] = {{1, 1}, {1.58, 0.965970}, {2, 0.924244}, {3, 0.824218}, {5, 0.671500}};
  for (const auto& row : rows) {
    // On a cylinder: 1 / R one way, 1 / R + k the other.
    const double radius = 0.01, k = (row.ratio - 1) / radius;
    const double relative = 1 / radius + elastic::equal_sphere_1pm({k, 0}, radius);
    EXPECT_NEAR(relative / (1 / radius + 0.5 * k), row.of_mean, 2.6e-3) << row.ratio;
  }
}

// Two spheres one on the other: as small as can be Hertz' relative radius, and the exact sphere's law on a plane.
TEST(WidthLaw, ABallOnACurvedBody) {
  const elastic::BallLaw ball{0.01, kModulus, false, 0.4, 50}, flat{0.01, kModulus, false, 0.4, 0};
  const elastic::BallLaw::Point small = ball.at(1e-4);
  EXPECT_NEAR(small.force_N / (4.0 / 3 * kModulus * std::sqrt(0.01 / 1.5) * std::pow(small.dent_m, 1.5)), 1, 1e-3);
  const LayerContact half_space({0, 0.4, LayerBase::kBonded}, 0.01);
  const double depth = flat.at(5e-3).dent_m;
  EXPECT_NEAR(flat.at(5e-3).force_N / kModulus, half_space.at_depth({TipProfile::kSphere, 0.01, 0}, depth).force_m2,
              1e-9);
}

// A flat place told by any two patches, from a tenth of a half space's give to thirty times it, under any ball, any of
// the give in the soft modes: the force rises with depth, and on a wall is at most what half the dent (2^1.5), large
// strain (1.35) and a term in D^3 fitted to a law in D^1.5 (1.3) make of the half space's: 4.9 found. Without an end to
// what the width takes off the dent the law of a block's edge asked for 1e5 N (2026-11-25).
TEST(WidthLaw, AnyPlaceIsBoundedAndRises) {
  std::uint32_t seed = 20261125;
  const auto random = [&] { return (seed = 1664525 * seed + 1013904223) / 4294967296.0; };
  for (int i = 0; i < 400; ++i) {
    const double nus[] = {0, 0.3, 0.45, 0.4999}, radii_m[] = {1e-3, 6e-3, 0.06}, edges_m[] = {1e-3, 3e-3, 8e-3};
    const double nu = nus[i % 4], radius = radii_m[i / 4 % 3],
                 sigma[2] = {edges_m[i / 12 % 3], 1.4 * edges_m[i / 12 % 3]};
    const double half_space = 1 / (2 * std::sqrt(std::numbers::pi) * sigma[0] * kModulus);
    const double first = half_space * (random() < 0.5 ? -0.9 * random() : 30 * std::pow(random(), 3));
    const double give[2] = {first, first < 0 ? first * (0.4 + 0.7 * random()) : first * (0.6 + 0.5 * random())};
    const elastic::WidthLaw width(give, sigma, kModulus, nu, 0);
    const elastic::BallLaw ball{radius, kModulus, false, nu, 0, {}};
    const double deepest = radius * (0.05 + 0.55 * random()), narrow = width.give_mpN(0);
    const double c = narrow > 0 ? narrow * (1.02 - random()) : narrow * (1 + 0.5 * random());
    const elastic::PlaceFit fit = elastic::fit_place(ball, width, c, deepest);
    const elastic::BallLaw plain{radius, kModulus, false, 0.5, 0, {}};
    double before = 0;
    for (int k = 1; k <= 40; ++k) {
      const double depth = deepest * k / 40, force = tick_N(ball, fit, c, depth);
      ASSERT_GT(force, before) << i << ' ' << k << " nu " << nu << " R " << radius << " c " << c << " R0 " << narrow;
      // What the fit adds to c is in series with the dent, beside c.
      const double whole = depth + (std::max(c + fit.more_give_mpN, 0.0) - c) * force;
      if (c > 0) {
        ASSERT_LT(force, 5.1 * tick_N(plain, {}, 0, whole)) << i << ' ' << k << " nu " << nu << " R " << radius;
      }
      before = force;
    }
  }
}

// Curvature that only rounding has is none.
TEST(WidthLaw, NearlyFlatIsFlat) {
  const double give[2] = {3e-5, 2.9e-5}, sigma[2] = {3e-3, 4.2e-3};
  const elastic::WidthLaw width(give, sigma, kModulus, 0.4, 0);
  const elastic::PlaceFit flat = elastic::fit_place({0.006, kModulus, false, 0.4, 0}, width, 1e-5, 4e-3);
  for (const double curvature : {1e-14, -1e-9, 1e-6}) {
    const elastic::PlaceFit fit = elastic::fit_place({0.006, kModulus, false, 0.4, curvature}, width, 1e-5, 4e-3);
    EXPECT_NEAR(fit.beta_1pmN / flat.beta_1pmN, 1, 1e-4) << curvature;
    EXPECT_NEAR(fit.more_give_mpN / flat.more_give_mpN, 1, 1e-4) << curvature;
  }
}

TEST(PlaceTerms, ForceIsTheSlopeOfTheEnergyAndItsTangentOfTheForce) {
  const PlaceTerms terms{3e3, 2e4, -4e5, 6e7};
  constexpr double kRange = 3e-3, kStep = 1e-8;
  for (const double e : {1e-5, 4e-4, 2.9e-3, 3.5e-3, 9e-3}) {
    const LawPoint at = place_at(terms, kRange, e);
    const double slope = (place_energy_J(terms, kRange, e + kStep) - place_energy_J(terms, kRange, e - kStep)) / 2;
    EXPECT_NEAR(slope / kStep / at.force_N, 1, 1e-5) << e;
    const double rise = place_at(terms, kRange, e + kStep).force_N - place_at(terms, kRange, e - kStep).force_N;
    EXPECT_NEAR(rise / (2 * kStep) / at.tangent_N_per_m, 1, 1e-5) << e;
  }
  EXPECT_EQ(place_at(terms, kRange, -1e-3).force_N, 0);
  EXPECT_EQ(place_energy_J(terms, kRange, 0), 0);
}

// The case `layer` of tests/accuracy, whose reference is axisymmetric Q9 of 24 elements under the ball (2026-11-22).
// One clamped number for c had it 24 % too soft at 4 mm.
TEST(ElasticTick, BallOnAThinLayer) {
  SceneDesc scene = parse_scene(
      elastic_scene("shape = \"cylinder\"\nradius_mm = 40\nheight_mm = 10\ntriangles = 4000\n", 0, 5, 6.35, 4),
      "layer.toml");
  scene.material.youngs_modulus_Pa = 2e4;
  scene.contact.max_depth_m = 4.2e-3;
  const BakedScene baked(scene);
  const struct {
    double depth_mm, force_N;
  } rows[] = {{0.4, 0.02533522}, {1.2, 0.151284}, {2.4, 0.48864}, {4, 1.170875}};
  for (const auto& row : rows)
    EXPECT_NEAR(press_N(baked.model(), {0, 0.01635, 0}, 1e-3 * row.depth_mm) / row.force_N, 1, 0.03) << row.depth_mm;
}

// Where the give falls along the surface, what a loop of slides and presses takes it gives back.
TEST(ElasticTick, ALoopOverTheRimOfASupportReturnsItsWork) {
  const BakedScene scene(elastic_scene(
      "shape = \"cylinder\"\nradius_mm = 30\nheight_mm = 12\naxis = \"y\"\ntriangles = 3000\n", 0, 6, 8, 2));
  Bench bench(scene.model());
  const Vec3 corner[] = {{0.004, 0.021, 0}, {0.004, 0.0185, 0}, {0.016, 0.0185, 0.003}, {0.016, 0.021, 0.003}};
  double work = 0, largest = 0;
  Vec3 at = corner[0];
  bench.tick_at({at, {}}, {});
  for (int i = 1; i <= 4; ++i) {
    const Vec3 from = at, to = corner[i % 4];
    const int steps = static_cast<int>(norm(to - from) / 2e-5) + 1;
    Vec3 before = bench.output.contact_w.force_N;
    for (int k = 1; k <= steps; ++k) {
      const Vec3 next = from + (static_cast<double>(k) / steps) * (to - from);
      bench.tick_at({next, {}}, {});
      const Vec3 force = bench.output.contact_w.force_N;
      work += 0.5 * dot(force + before, next - at);
      at = next;
      before = force;
    }
    largest = std::max(largest, std::abs(work));
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT(std::abs(work), 2e-3 * largest);
}

}  // namespace
}  // namespace palpate::test
