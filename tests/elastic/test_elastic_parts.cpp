// The parts of the elastic body: modes, soft energy, local law, what bad input says.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "config/elastic/fixed_random.h"
#include "config/elastic/local_law.h"
#include "config/elastic/solid_mesh.h"
#include "config/fem/tet_procedural.h"
#include "config/scene/config_error.h"
#include "tests/elastic/elastic_scenes.h"

namespace palpate::elastic {
namespace {

class ClipParts : public testing::Test {
 protected:
  static constexpr int kSoft = 3, kAll = 12;
  ElasticScene<2> scene_ = clip_scene(1e-3);
  RestBody<2> rest_{scene_.mesh, scene_.material, scene_.fixed};
  SurfaceModes modes_ = surface_modes(rest_, kAll);
};

TEST_F(ClipParts, ModesSolveTheirEquationAndAreOrthonormal) {
  for (int a = 0; a < kAll; ++a) {
    const Eigen::VectorXd weighted = rest_.surface().mass_times(modes_.phi_1pm.col(a));
    for (int b = 0; b <= a; ++b) EXPECT_NEAR(modes_.phi_1pm.col(b).dot(weighted), a == b, 1e-8) << a << b;
    // 1e-6: the Lanczos residual of 1e-9 in the surface's norm, seen in the displacements of all nodes.
    const Eigen::VectorXd back = modes_.lambda_Npm3[a] * rest_.solve(weighted);
    EXPECT_LT((back - modes_.phi_1pm.col(a)).norm(), 1e-6 * back.norm()) << a;
    if (a > 0) {
      EXPECT_GE(modes_.lambda_Npm3[a], modes_.lambda_Npm3[a - 1]);
    }
  }
}

TEST_F(ClipParts, RepeatedBakesAgreeInEveryBit) {
  const SurfaceModes again = surface_modes(RestBody<2>(scene_.mesh, scene_.material, scene_.fixed), kAll);
  EXPECT_TRUE((again.phi_1pm.array() == modes_.phi_1pm.array()).all());
  const SoftMaps first = soft_maps(rest_, modes_, kSoft, 5e-5), second = soft_maps(rest_, again, kSoft, 5e-5);
  EXPECT_TRUE((first.potential.quartic.array() == second.potential.quartic.array()).all());
}

// V holds the energy to the fourth order in q: the forces' first error is of the fourth, or of the fifth where the
// motion is symmetric. Half the motion must leave at most an eighth of it.
TEST_F(ClipParts, ForcesOfTheSoftEnergyAreThoseOfTheBody) {
  const SoftMaps maps = soft_maps(rest_, modes_, 2, 5e-5);
  EXPECT_EQ(maps.residuals, 2 * 3 + 4 * 8);  // three pairs, eight directions
  double error[2] = {};
  for (const int half : {0, 1}) {
    Eigen::VectorXd q(2);
    q << (half ? 5e-4 : 1e-3) / modes_.phi_1pm.col(0).cwiseAbs().maxCoeff(), 0;
    const Eigen::VectorXd force = rest_.internal_force(soft_displacement(modes_, maps, q));
    const SoftPotential::Value v = maps.potential.at(q);
    for (int a = 0; a < 2; ++a) {
      const Eigen::VectorXd along = modes_.phi_1pm.col(a) + maps.theta_1pm3[pair_place(a, 0, 2)] * q[0];
      error[half] = std::max(error[half], std::abs(along.dot(force) - v.slope[a]) / v.slope[0]);
    }
  }
  EXPECT_LT(error[0], 0.02);  // a tenth of the arm's radius at its tip
  EXPECT_LT(error[1], 0.125 * error[0]);
  for (const Eigen::VectorXd& theta : maps.theta_1pm3)
    for (int c = 0; c < 2; ++c)
      EXPECT_LT(std::abs(theta.dot(rest_.surface().mass_times(modes_.phi_1pm.col(c)))), 1e-5 * theta.norm());
}

TEST_F(ClipParts, PatchCarriesAUnitForce) {
  const int node = scene_.contact_nodes[scene_.contact_nodes.size() / 2];
  const Vector<2> normal = node_normal(rest_.surface(), node);
  const Eigen::VectorXd g = gaussian_patch<2>(rest_, rest_.surface().rest(node), normal, 1e-3);
  Vector<2> total = Vector<2>::Zero();
  for (Eigen::Index i = 0; i < g.size(); ++i) total[i % 2] += g[i];
  EXPECT_LT((total + normal).norm(), 1e-12);
}

TEST(SoftPotential, SlopesAreDifferencesAndTheEnergyIsBoundedBelow) {
  Eigen::VectorXd lambda(3);
  lambda << 1, 4, 9;
  SoftPotential v(lambda);
  FixedRandom random(7);
  for (double& c : v.cubic) c = random.symmetric();
  for (double& c : v.quartic) c = random.symmetric() - 1;  // turns down far out
  v.radius_rootJ = 1;
  for (const double scale : {0.2, 0.9, 3.0}) {  // inside, inside, outside the ball
    Eigen::VectorXd q(3);
    q << 0.5 * scale, -0.2 * scale, 0.1 * scale;
    const auto at = v.at(q);
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      Eigen::VectorXd ahead = q, behind = q;
      ahead[k] += h;
      behind[k] -= h;
      const auto a = v.at(ahead), b = v.at(behind);
      EXPECT_NEAR((a.energy_J - b.energy_J) / (2 * h), at.slope[k], 1e-7 * (1 + at.slope.norm()));
      for (int l = 0; l < 3; ++l)
        EXPECT_NEAR((a.slope[l] - b.slope[l]) / (2 * h), at.curvature(k, l), 1e-6 * (1 + at.curvature.norm()));
    }
  }
  Eigen::VectorXd far(3);
  far << 3e3, 2e3, 1e3;
  EXPECT_GT(v.at(far).energy_J, 0);  // the bare polynomial is -1e13 here
  EXPECT_LT(trusted_radius(v, 5, 0.2), 5);
}

TEST(LocalLaw, IsHertzForSmallContactsAndAgreesWithItself) {
  LocalLaw sphere{false, 1 / 0.006, 1 / 0.03, 3e6, 1};
  const double radius = 1 / (1 / 0.006 + 1 / 0.03), force = 1e-4;
  // The large-strain share 0.02 a/R of the travel is 1e-4 here.
  EXPECT_NEAR(sphere.at(force).travel_m / std::pow(0.75 * force / (3e6 * std::sqrt(radius)), 2.0 / 3), 1, 1e-3);
  for (const LocalLaw& law : {sphere, LocalLaw{false, 0, 1 / 0.03, 3e6, 1}, LocalLaw{true, 1 / 0.006, 0, 3e4, 0.06}})
    for (const double f : {0.1, 3.0, 40.0}) {
      const double h = 1e-4 * f;
      const auto ahead = law.at(f + h), behind = law.at(f - h), at = law.at(f);
      EXPECT_NEAR((ahead.travel_m - behind.travel_m) / (2 * h) / at.compliance_mpN, 1, 1e-6) << f;
      // Five Gauss points over the whole radius: 2.3e-5 of the slope at 40 N, where a is two thirds of R.
      EXPECT_NEAR((ahead.work_J - behind.work_J) / (2 * h) / at.travel_m, 1, 5e-5) << f;
    }
}

TEST(GaussianPatch, HalfSpaceValueIsTheMeanOfItsPointCompliance) {
  const double sigma = 2e-3, step = 1e-5, spread = std::sqrt(2.0) * sigma;  // of the distance of two of its points
  double mean = 0;
  for (double r = 0.5 * step; r < 12 * spread; r += step)
    mean += step * r / (spread * spread) * std::exp(-0.5 * r * r / (spread * spread)) / (std::numbers::pi * 3e6 * r);
  EXPECT_NEAR(gaussian_self_compliance_mpN(false, 3e6, sigma, 1) / mean, 1, 1e-4);
}

TEST(ElasticBody, BadInputSaysWhatToDo) {
  const ElasticScene<2> scene = clip_scene(1e-3);
  EXPECT_THROW(RestBody<2>(scene.mesh, scene.material, std::vector<bool>(scene.fixed.size())), ConfigError);
  fem::StrainBody bad = scene.material;
  bad.poisson_ratio = 0.5;
  EXPECT_THROW(RestBody<2>(scene.mesh, bad, scene.fixed), ConfigError);
  TetMesh tets = make_box_tets({0.01, 0.01, 0.01}, {1, 1, 1});
  EXPECT_EQ(solid_mesh(tets, "box").node_count(), 27);
  keep_middle_nodes(tets, std::vector<char>(tets.tet.size()));
  EXPECT_THROW(solid_mesh(tets, "box"), ConfigError);
  const RestBody<2> rest(scene.mesh, scene.material, scene.fixed);
  EXPECT_THROW(surface_modes(rest, 2 * scene.mesh.node_count()), ConfigError);
  std::vector<int> inside;
  for (int n = 0; n < scene.mesh.node_count() && inside.empty(); ++n)
    if (rest.surface().facets_at(n).empty()) inside.push_back(n);
  EXPECT_THROW(make_elastic_body(rest, inside, {1, 5}), ConfigError);
}

}  // namespace
}  // namespace palpate::elastic
