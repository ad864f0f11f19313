#include <gtest/gtest.h>

#include "sim_host/view/displacement_angle.h"
#include "tests/deform/deform_scene.h"

namespace palpate {
namespace {

TEST(DisplacementAngle, WorkedExample) {
  const PatchCorner corner[3] = {{{1, 0, -3}, {0, 0, 1}, 0.6}, {{0, .5, -1}, {1, 0, 0}, 0.4}, {}};
  const Vec3 d = displacement_by_angle(corner, {.6, 0, .8});
  EXPECT_NEAR(norm(d), 2.344580192, 6e-10);
  EXPECT_NEAR(d.x, 0.406431, 6e-7);
  EXPECT_NEAR(d.y, 0.189547, 6e-7);
  EXPECT_NEAR(d.z, -2.301291, 6e-7);
  const double theta = std::acos(dot(d, {.6, 0, .8}) / norm(d)) * 180 / palpate::kPi;
  EXPECT_NEAR(theta, 132.939031, 6e-7);
}

// Against the definition in long double.
TEST(DisplacementAngle, AgreesWithDefinition) {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 200; ++trial) {
    PatchCorner corner[3];
    long double m = 0, theta = 0;
    Vec3 linear;
    const double w[3] = {0.2, 0.3, 0.5};
    for (int i = 0; i < 3; ++i) {
      corner[i] = {deform_test::random_vector(random, 1e-3), unit_or(deform_test::random_vector(random, 1), {1, 0, 0}),
                   w[i]};
      const long double length = deform_test::distance(corner[i].displacement, {});
      m += deform_test::wide(w[i]) * length;
      const double cosine_m = dot(corner[i].displacement, corner[i].normal);
      theta += deform_test::wide(w[i]) * std::acos(deform_test::wide(cosine_m) / length);
      linear += w[i] * corner[i].displacement;
    }
    const Vec3 n = unit_or(deform_test::random_vector(random, 1), {0, 0, 1});
    const Vec3 t = unit_or(tangential_part(linear, n), {});
    const Vec3 expected = static_cast<double>(m * std::cos(theta)) * n + static_cast<double>(m * std::sin(theta)) * t;
    EXPECT_LT(norm(displacement_by_angle(corner, n) - expected), 1e-12 * static_cast<double>(m));
  }
}

TEST(DisplacementAngle, EqualCornersOnAFlatPatchAreReproduced) {
  const Vec3 d{0.3e-3, 0.1e-3, -2e-3}, n{0, 0, 1};
  const PatchCorner corner[3] = {{d, n, 0.2}, {d, n, 0.3}, {d, n, 0.5}};
  EXPECT_LT(norm(displacement_by_angle(corner, n) - d), 1e-17);
}

TEST(DisplacementAngle, CornersThatDoNotMoveHaveNoAngle) {
  const Vec3 n{0, 0, 1}, d{1e-3, 0, -1e-3};
  const PatchCorner corner[3] = {{d, n, 0.25}, {{}, n, 0.5}, {{}, n, 0.25}};
  const Vec3 u = displacement_by_angle(corner, n);  // direction of the one that moves, a quarter of its size
  EXPECT_LT(norm(u - 0.25 * d), 1e-18);
  const PatchCorner still[3] = {{{}, n, 0.25}, {{}, n, 0.5}, {{}, n, 0.25}};
  EXPECT_EQ(displacement_by_angle(still, n), Vec3{});
}

TEST(DisplacementAngle, WithoutAzimuthItIsLinear) {
  const Vec3 n{0, 0, 1};
  const PatchCorner pushed[3] = {{{0, 0, -1e-3}, n, 0.5}, {{0, 0, -2e-3}, n, 0.5}, {}};
  EXPECT_EQ(displacement_by_angle(pushed, n), (Vec3{0, 0, -1.5e-3}));
  const PatchCorner opposed[3] = {{{1e-3, 0, 0}, n, 0.5}, {{-1e-3, 0, 0}, n, 0.5}, {}};
  EXPECT_EQ(displacement_by_angle(opposed, n), Vec3{});
}

TEST(DisplacementAngle, RotatesWithTheFrame) {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 50; ++trial) {
    const Quat q = deform_test::random_rotation(random);
    PatchCorner corner[3], turned[3];
    for (int i = 0; i < 3; ++i) {
      corner[i] = {deform_test::random_vector(random, 1), unit_or(deform_test::random_vector(random, 1), {1, 0, 0}),
                   1.0 / 3};
      turned[i] = {rotate(q, corner[i].displacement), rotate(q, corner[i].normal), 1.0 / 3};
    }
    const Vec3 n = unit_or(deform_test::random_vector(random, 1), {0, 0, 1});
    EXPECT_LT(norm(displacement_by_angle(turned, rotate(q, n)) - rotate(q, displacement_by_angle(corner, n))), 1e-13);
  }
}

}  // namespace
}  // namespace palpate
