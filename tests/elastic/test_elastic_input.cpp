// What an elastic scene or image may not say, and the energy that the tick computes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "config/scene/config_error.h"
#include "rt_core/contact/contact.h"
#include "rt_core/contact/elastic/soft_energy.h"
#include "tests/elastic/elastic_tick_scene.h"
#include "tests/support/refusal.h"

namespace palpate::test {
namespace {

std::string error_of(const std::string& scene) {
  return refusal_by([&] { parse_scene(scene, "test.toml"); });
}

TEST(ElasticScene, SaysWhatHasNoPlace) {
  const std::string good = elastic_scene(arch(10), 35, 8, 8, 4);
  EXPECT_EQ(error_of(good), "accepted");
  const auto with = [&](const std::string& after, const std::string& what) {
    std::string text = good;
    return text.insert(text.find(after) + after.size(), what);
  };
  using testing::HasSubstr;
  EXPECT_THAT(error_of(with("backend = \"elastic\"\n", "law = \"duffing\"\n")),
              HasSubstr("contact.law: has no effect"));
  EXPECT_THAT(error_of(good + "[skeleton]\nlaw = \"none\"\n"), HasSubstr("skeleton: has no effect"));
  EXPECT_THAT(error_of(good + "[coupling]\nlaw = \"none\"\n"), HasSubstr("coupling: has no effect"));
  EXPECT_THAT(error_of(with("[body.fem]\n", "order = \"linear\"\n")), HasSubstr("body.fem.order: has no effect"));
  EXPECT_THAT(error_of(with("[body.elastic]\n", "linear_modes = 65\n")), HasSubstr("0 to 64"));
  EXPECT_THAT(error_of(elastic_scene(arch(10), 35, 8, 8, 4, "coulomb")),
              HasSubstr("allowed none, mindlin, presliding"));
  std::string points = good;
  points.replace(points.find("elastic\"\nmax"), 7, "response");
  EXPECT_THAT(error_of(points), HasSubstr("unless contact.backend"));
}

// A small elastic model: only what check_data and the energy look at.
struct SmallElastic {
  SmallElastic() {
    model.params.backend = Backend::kElastic;
    model.params.response_law = ResponseLaw::kTip;
    model.params.elastic_soft = 2;
    model.params.elastic_radius_rootJ = 0.5;
    // W4_ab = quartic . y2 must come from a symmetric tensor: columns hold twice the entry for pairs a < b.
    const double t[5] = {0.2, 0.05, -0.1, 0.02, -0.5};  // aaaa, aaab, aabb, abbb, bbbb
    quartic = {t[0], t[1], t[2], 2 * t[1], 2 * t[2], 2 * t[3], t[2], t[3], t[4]};
    const double c[4] = {0.3, -0.2, 0.1, -0.4};  // aaa, aab, abb, bbb
    cubic = {c[0], c[1], c[2], c[1], c[2], c[3]};
    model.elastic_cubic = cubic;
    model.elastic_quartic = quartic;
  }
  SoftEnergy at(double a, double b) const {
    const double p[2] = {a, b};
    double y[elastic_layout::kMaxTerms];
    soft_products(2, p, y);
    SoftEnergy out;
    soft_energy(model, p, y, out);
    return out;
  }
  std::vector<double> cubic, quartic;
  Model model;
};

TEST(SoftEnergyOfTheTick, SlopesAreDifferencesInsideAndOutsideTheBall) {
  const SmallElastic body;
  for (const double scale : {0.4, 0.9, 5.0}) {
    const double a = 0.4 * scale, b = -0.3 * scale, h = 1e-6;
    const SoftEnergy at = body.at(a, b);
    EXPECT_EQ(at.is_outside, scale > 1);
    const double d[2] = {(body.at(a + h, b).energy_J - body.at(a - h, b).energy_J) / (2 * h),
                         (body.at(a, b + h).energy_J - body.at(a, b - h).energy_J) / (2 * h)};
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(at.slope[k], d[k], 1e-6 * (1 + std::abs(d[k]))) << scale;
      EXPECT_NEAR(at.curvature[2 * k], (body.at(a + h, b).slope[k] - body.at(a - h, b).slope[k]) / (2 * h), 1e-6);
      EXPECT_NEAR(at.curvature[2 * k + 1], (body.at(a, b + h).slope[k] - body.at(a, b - h).slope[k]) / (2 * h), 1e-6);
    }
  }
  EXPECT_GT(body.at(300, -200).energy_J, 0);  // the bare quartic is far below zero there
}

// Every rule of the loader, broken one at a time in a baked image.
TEST(ElasticImage, HostileValuesAreRefused) {
  BakedScene scene(elastic_scene("shape = \"box\"\nsize_mm = [40, 40, 40]\ntriangles = 800\n", 1, 20, 8, 1));
  const ContactMethod& method = contact_method(Method::kElastic);
  ASSERT_EQ(method.check_data(scene.model()).error, ImageError::kNone);
  const auto refused = [&](auto change) {
    Model model = scene.model();
    change(model);
    return std::string(method.check_data(model).error == ImageError::kNone ? "" : method.check_data(model).field);
  };
  EXPECT_EQ(refused([](Model& m) { m.params.response_law = ResponseLaw::kPoints; }), "response_law");
  EXPECT_EQ(refused([](Model& m) { m.params.elastic_soft = 0; }), "elastic_soft");
  EXPECT_EQ(refused([](Model& m) { m.params.elastic_radius_rootJ = 0; }), "elastic_radius_rootJ");
  EXPECT_EQ(refused([](Model& m) { m.params.elastic_linear += 1; }), "n_elastic_vertex");
  EXPECT_EQ(refused([](Model& m) { m.sizes.n_elastic_vertex -= 1; }), "n_elastic_vertex");
  EXPECT_EQ(refused([](Model& m) { m.sizes.n_elastic_cubic += 1; }), "n_elastic_cubic");
  EXPECT_EQ(refused([](Model& m) { m.sizes.n_elastic_quartic = 0; }), "n_elastic_quartic");
  EXPECT_EQ(refused([](Model& m) { m.tip_law = {}; }), "n_tip_law");
  EXPECT_EQ(refused([](Model& m) { m.corner_normal = {}; }), "n_corner");
  std::vector<float> vertex(scene.model().elastic_vertex.begin(), scene.model().elastic_vertex.end());
  vertex[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refused([&](Model& m) { m.elastic_vertex = vertex; }), "elastic_vertex");
  const std::vector<double> wild(1, 1e300);
  EXPECT_EQ(refused([&](Model& m) { m.elastic_cubic = wild; }), "elastic_cubic");
  EXPECT_EQ(refused([&](Model& m) { m.elastic_quartic = wild; }), "elastic_quartic");
}

}  // namespace
}  // namespace palpate::test
