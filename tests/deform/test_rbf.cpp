#include <gtest/gtest.h>

#include <limits>

#include "sim_host/view/rbf_surface.h"
#include "tests/deform/deform_scene.h"

namespace palpate {
namespace {

using deform_test::Dense;
using deform_test::Row;
using deform_test::Scene;
using deform_test::wide;

// d(x) with nodes `node` (displacements `value`) by dense elimination of the interpolation system in long double: the
// oracle for the baked inverse and for the moving contact point, which is simply one more node here.
Vec3 dense_interpolation(const std::vector<Vec3>& node, const std::vector<Vec3>& value, int tail, Vec3 x) {
  const std::size_t n = node.size(), size = n + (tail == 1 ? 4 : 1);
  Dense m(size, Row(size, 0));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) m[i][j] = deform_test::distance(node[i], node[j]);
    const long double p[4] = {1, wide(node[i].x), wide(node[i].y), wide(node[i].z)};
    for (std::size_t k = 0; k < size - n; ++k) m[i][n + k] = m[n + k][i] = p[k];
  }
  const long double p[4] = {1, wide(x.x), wide(x.y), wide(x.z)};
  Vec3 result;
  double* out[3] = {&result.x, &result.y, &result.z};
  for (int axis = 0; axis < 3; ++axis) {
    Row b(size, 0);
    for (std::size_t i = 0; i < n; ++i) b[i] = wide(deform_test::component(value[i], axis));
    const Row c = deform_test::solve_dense(m, b);
    long double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += c[i] * deform_test::distance(x, node[i]);
    for (std::size_t k = 0; k < size - n; ++k) sum += c[n + k] * p[k];
    *out[axis] = static_cast<double>(sum);
  }
  return result;
}

// Weight of each anchor at x, tested through the public functions.
struct Weights {
  RbfVector w{};
  Weights(const Model& model, Vec3 x) { rbf_weights(model, x, w); }
};

class Rbf : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    scene_.model.params.rbf_tail = static_cast<RbfTail>(GetParam());
    deform_test::make_ellipsoid(scene_);
    ASSERT_TRUE(rbf_available(scene_.model));
  }
  std::size_t anchors() const { return scene_.anchors.size(); }
  std::vector<Vec3> positions() const {
    std::vector<Vec3> p;
    for (const Anchor& a : scene_.anchors) p.push_back(a.position_m);
    return p;
  }
  Scene scene_;
};

INSTANTIATE_TEST_SUITE_P(Tails, Rbf, ::testing::Values(0, 1));

TEST_P(Rbf, InverseTimesMatrixIsTheIdentity) {
  const auto n = static_cast<std::size_t>(scene_.model.sizes.n_rbf);
  const std::vector<Vec3> p = positions();
  for (std::size_t i = 0; i < p.size(); ++i) {
    RbfVector g{}, q{};
    rbf_terms(scene_.model, p[i], g);  // a row of M
    rbf_multiply(scene_.model, g, q);
    for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(q[j], i == j ? 1 : 0, 1e-13);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_EQ(scene_.inverse[i * n + j], scene_.inverse[j * n + i]);
  }
}

TEST_P(Rbf, WeightsArePartitionOfUnityAndInterpolate) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Weights weights(scene_.model, deform_test::random_vector(random, 0.05));
    double sum = 0;
    for (std::size_t i = 0; i < anchors(); ++i) sum += weights.w[i];
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  for (std::size_t i = 0; i < anchors(); ++i) {
    const Weights weights(scene_.model, scene_.anchors[i].position_m);
    for (std::size_t j = 0; j < anchors(); ++j) EXPECT_NEAR(weights.w[j], i == j ? 1 : 0, 1e-13);
  }
}

TEST_P(Rbf, ReproducesRigidTranslationAndWithLinearTailLinearFields) {
  std::mt19937_64 random(2);
  const auto field = [&](Vec3 x) {
    const Vec3 constant{1e-3, -2e-3, 3e-3};
    if (GetParam() == 0) return constant;
    return constant + Vec3{0.1 * x.x - 0.2 * x.y, 0.3 * x.z + 0.05 * x.x, -0.4 * x.y};
  };
  Vec3 d[kMaxAnchors];
  for (std::size_t i = 0; i < anchors(); ++i) d[i] = field(scene_.anchors[i].position_m);
  Vec3 c[kMaxRbf];
  rbf_coefficients(scene_.model, d, c);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 x = deform_test::random_vector(random, 0.08);
    RbfVector g{};
    rbf_terms(scene_.model, x, g);
    EXPECT_LT(norm(rbf_value(scene_.model, g, c) - field(x)), 1e-14);
  }
}

// Worked example, and the bordered inverse against a dense solve with the contact point as a seventh node.
TEST_P(Rbf, MovingContactPointEqualsOneMoreNode) {
  std::vector<Vec3> d{{2e-3, 0, -4e-3}, {-2e-3, 0, -4e-3}, {0, 2e-3, -5e-3}, {0, -2e-3, -5e-3}, {0, 0, -35e-3}, {}};
  const Vec3 p{20e-3, 15e-3, 17.6776695e-3}, dent{1e-3, 2e-3, -20e-3};
  RbfContact contact;
  make_rbf_contact(scene_.model, p, contact);
  Vec3 c[kMaxRbf];
  rbf_coefficients(scene_.model, d.data(), c);
  RbfVector at_contact{};
  rbf_terms(scene_.model, p, at_contact);
  const Vec3 rest_of_dent = dent - rbf_value(scene_.model, at_contact, c);
  const auto evaluate = [&](Vec3 x) {
    RbfVector g{};
    rbf_terms(scene_.model, x, g);
    return rbf_value(scene_.model, g, c) + rbf_contact_weight(scene_.model, contact, g, x) * rest_of_dent;
  };

  const Vec3 x{10e-3, -20e-3, 15e-3};
  RbfVector g{};
  rbf_terms(scene_.model, x, g);
  const double psi = rbf_contact_weight(scene_.model, contact, g, x);
  const Vec3 u = evaluate(x);
  if (GetParam() == 0) {
    const double weights[6] = {.186223, -.024408, -.043604, .498650, .404878, -.021739};
    const Weights actual(scene_.model, x);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(actual.w[i], weights[i], 6e-7);
    EXPECT_NEAR(psi, .07532006, 6e-9);
    EXPECT_LT(norm(u - Vec3{0.433115e-3, -0.988354e-3, -17.259745e-3}), 1e-9);
  } else {
    EXPECT_NEAR(psi, .09148657, 6e-9);
    EXPECT_LT(norm(u - Vec3{0.5e-3, -1.241847e-3, -19.947213e-3}), 1e-9);
  }

  std::vector<Vec3> nodes = positions();
  nodes.push_back(p);
  d.push_back(dent);
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 y = deform_test::random_vector(random, 0.05);
    EXPECT_LT(norm(evaluate(y) - dense_interpolation(nodes, d, GetParam(), y)), 1e-13);
  }
  EXPECT_LT(norm(evaluate(p) - dent), 1e-15);
  for (std::size_t i = 0; i < anchors(); ++i) EXPECT_LT(norm(evaluate(nodes[i]) - d[i]), 1e-14);
}

TEST_P(Rbf, ContactAtAnAnchorIsRecognised) {
  for (std::size_t i = 0; i < anchors(); ++i) {
    RbfContact contact;
    make_rbf_contact(scene_.model, scene_.anchors[i].position_m, contact);
    EXPECT_EQ(contact.at_anchor, static_cast<int>(i));
    EXPECT_EQ(contact.inverse_s, 0);
    RbfVector g{};
    rbf_terms(scene_.model, {0.01, 0.01, 0.01}, g);
    EXPECT_EQ(rbf_contact_weight(scene_.model, contact, g, {0.01, 0.01, 0.01}), 0);
    make_rbf_contact(scene_.model, scene_.anchors[i].position_m + Vec3{0, 1e-5, 0}, contact);
    EXPECT_EQ(contact.at_anchor, -1);  // a hundredth of a millimetre away it is an ordinary point again
    EXPECT_TRUE(is_finite(contact.inverse_s) && contact.inverse_s < 0);
  }
}

// Results must not depend on where the world's origin or axes are.
TEST_P(Rbf, InvariantUnderRigidMotion) {
  std::mt19937_64 random(9);
  const Vec3 x{10e-3, -20e-3, 15e-3};
  const Weights rest(scene_.model, x);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose pose{deform_test::random_vector(random, 1.0), deform_test::random_rotation(random)};
    Scene moved;
    moved.model.params.rbf_tail = static_cast<RbfTail>(GetParam());
    moved.anchors = scene_.anchors;
    for (Anchor& a : moved.anchors) a.position_m = transform(pose, a.position_m);
    ASSERT_TRUE(moved.bind());
    const Weights weights(moved.model, transform(pose, x));
    // 1e-11: coordinates 1 m from the origin are rounded at 1e-16 m of bodies of 0.04 m; the linear tail squares that
    // ratio.
    for (std::size_t i = 0; i < anchors(); ++i) EXPECT_NEAR(weights.w[i], rest.w[i], 1e-11);
  }
}

TEST(RbfSystem, RefusesWhatCannotBeInverted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> inverse(static_cast<std::size_t>(kMaxRbf * kMaxRbf));
  std::vector<Vec3> ring;  // coplanar, away from the origin
  for (int i = 0; i < 8; ++i) {
    const double angle = palpate::kPi * i / 4;
    ring.push_back({0.3 + 0.04 * std::cos(angle), 0.2 + 0.03 * std::sin(angle), 0.1 + 0.02 * std::cos(angle)});
  }
  EXPECT_TRUE(invert_rbf_system(ring, RbfTail::kConstant, inverse));
  EXPECT_FALSE(invert_rbf_system(ring, RbfTail::kLinear, inverse));
  ring.push_back({0.3, 0.2, 0.15});  // one out of the plane is enough
  EXPECT_TRUE(invert_rbf_system(ring, RbfTail::kLinear, inverse));
  ring.push_back(ring[2]);  // the same anchor twice
  EXPECT_FALSE(invert_rbf_system(ring, RbfTail::kConstant, inverse));
  ring.back() = {nan, 0, 0};
  EXPECT_FALSE(invert_rbf_system(ring, RbfTail::kConstant, inverse));
  EXPECT_FALSE(invert_rbf_system({}, RbfTail::kConstant, inverse));
  const std::vector<Vec3> one{{0.1, 0.2, 0.3}};
  EXPECT_TRUE(invert_rbf_system(one, RbfTail::kConstant, inverse));
  EXPECT_FALSE(invert_rbf_system(one, RbfTail::kLinear, inverse));
  std::vector<double> small(3);
  EXPECT_FALSE(invert_rbf_system(one, RbfTail::kConstant, small));
  std::vector<Vec3> many(static_cast<std::size_t>(kMaxAnchors) + 1);
  EXPECT_FALSE(invert_rbf_system(many, RbfTail::kConstant, inverse));
}

TEST(RbfSystem, FullCapacityIsAccurate) {
  std::mt19937_64 random(31);
  Scene scene;
  scene.model.params.rbf_tail = RbfTail::kLinear;
  for (int i = 0; i < kMaxAnchors; ++i) {
    scene.anchors.push_back(deform_test::make_anchor(deform_test::random_vector(random, 0.05), 3e-3));
  }
  ASSERT_TRUE(scene.bind());
  for (std::size_t i = 0; i < scene.anchors.size(); ++i) {
    const Weights weights(scene.model, scene.anchors[i].position_m);
    for (std::size_t j = 0; j < scene.anchors.size(); ++j) EXPECT_NEAR(weights.w[j], i == j ? 1 : 0, 1e-11);
  }
}

TEST(RbfSystem, AnImageWithoutInterpolationIsNotUsed) {
  Scene scene;
  EXPECT_FALSE(rbf_available(scene.model));
  scene.anchors.push_back(deform_test::make_anchor({0, 0, 0.01}, 1e-3));
  ASSERT_TRUE(scene.bind());
  EXPECT_TRUE(rbf_available(scene.model));
  scene.model.params.rbf_tail = RbfTail::kLinear;  // the size no longer fits
  EXPECT_FALSE(rbf_available(scene.model));
}

}  // namespace
}  // namespace palpate
