// What an image holds of a body's surface under its tips, for drawing: rt_core/contact/elastic/drawn_shapes.h.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "config/elastic/half_space_patch.h"
#include "rt_core/contact/contact.h"
#include "rt_core/contact/elastic/drawn_shapes.h"
#include "tests/elastic/elastic_tick_scene.h"

namespace palpate::test {
namespace {

// Inward: the mean of 1 / (pi E* r) over the patch, summed in rings about the place. Outward: as for any pressure
// (Timoshenko & Goodier 1970, section 139).
TEST(HalfSpacePatch, IsTheSumOfPointForces) {
  constexpr double kSigma = 2e-3, kModulus = 1e5, kNu = 0.3;
  for (const double r : {0.0, 1e-3, 3e-3, 9e-3, 40e-3}) {
    double inward = 0;
    constexpr int kRings = 1200, kAround = 120;
    const double step = (r + 8 * kSigma) / kRings;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kAround; ++j) {
        const double s = (i + 0.5) * step, angle = 2 * kPi * (j + 0.5) / kAround;
        const double square = r * r + s * s + 2 * r * s * std::cos(angle);
        inward += std::exp(-0.5 * square / (kSigma * kSigma)) * step / kAround;  // s cancels 1 / s
      }
    inward /= kSigma * kSigma * kPi * kModulus;
    const elastic::PatchAnswer answer = elastic::gaussian_patch_answer(r, kSigma, kModulus, kNu);
    EXPECT_NEAR(answer.inward_mpN / inward, 1, 2e-4) << r;
    const double pushed = 1 - std::exp(-0.5 * r * r / (kSigma * kSigma));
    EXPECT_NEAR(answer.outward_mpN * r, -(1 - 2 * kNu) / (1 - kNu) / (2 * kPi * kModulus) * pushed, 1e-12) << r;
  }
}

// What one place's press does at another along its normal, the other's does at the one (Betti); so do the soft modes,
// and half a space but for what it draws in, which is a tenth at nu = 0.45.
TEST(DrawnShapes, PlacesAnswerOneAnotherAlike) {
  const BakedScene scene(
      elastic_scene("shape = \"ellipsoid\"\nhalf_axes_mm = [30, 20, 24]\ntriangles = 2000\n", 4, 7, 8, 3));
  const Model& model = scene.model();
  ASSERT_GT(drawn_shapes::count(model), 20);
  const auto answer_m_per_N = [&](std::int32_t at, std::int32_t pressed) {
    std::vector<double> amplitude;
    const float* of = drawn_shapes::at(model, pressed);
    for (std::int32_t k = 0; k < drawn_shapes::count(model); ++k, of += elastic_layout::kDrawnFloats)
      amplitude.push_back(static_cast<double>(of[3]));
    return -dot(drawn_shapes::displacement_m(model, at, amplitude), model.vertex_normal[static_cast<std::size_t>(at)]);
  };
  double apart = 0, size = 0;
  const auto free = [&](std::int32_t v) { return model.vertex_m[static_cast<std::size_t>(v)].y > 0.012; };
  for (std::int32_t a = 0; a < static_cast<std::int32_t>(model.vertex_m.size()); a += 23)
    for (std::int32_t b = a + 1; b < static_cast<std::int32_t>(model.vertex_m.size()); b += 19) {
      if (!free(a) || !free(b)) continue;
      const double one = answer_m_per_N(a, b), other = answer_m_per_N(b, a);
      apart += (one - other) * (one - other);
      size += one * one + other * other;
    }
  RecordProperty("apart", std::to_string(std::sqrt(apart / size)));
  EXPECT_LT(std::sqrt(apart / size), 0.1);
}

// The loader's rules for them.
TEST(DrawnShapes, HostileCountsAreRefused) {
  const BakedScene scene(elastic_scene("shape = \"box\"\nsize_mm = [40, 40, 40]\ntriangles = 800\n", 1, 20, 8, 1));
  const ContactMethod& method = contact_method(Method::kElastic);
  const auto refused = [&](float count, std::int64_t floats_after) {
    Model model = scene.model();
    const std::int64_t blocks = elastic_layout::all_vertex_floats(model);
    std::vector<float> floats(static_cast<std::size_t>(blocks + 1 + floats_after), 1.0F);
    floats[static_cast<std::size_t>(blocks)] = count;
    model.sizes.n_elastic_vertex = static_cast<decltype(model.sizes.n_elastic_vertex)>(floats.size());
    model.elastic_vertex = floats;
    return std::string(method.check_data(model).error == ImageError::kNone ? "" : method.check_data(model).field);
  };
  const std::int64_t vertices = scene.model().sizes.n_vertex;
  EXPECT_EQ(refused(0, 0), "");
  EXPECT_EQ(refused(3, 15 * vertices), "");
  EXPECT_EQ(refused(3, 16 * vertices), "");  // moduli
  EXPECT_EQ(refused(elastic_layout::kMostDrawnShapes, 5 * vertices * elastic_layout::kMostDrawnShapes), "");
  for (const std::int64_t floats :
       {std::int64_t{0}, 15 * vertices - 1, 15 * vertices + 1, 17 * vertices, 20 * vertices})
    EXPECT_EQ(refused(3, floats), "n_elastic_vertex") << floats;
  for (const float count : {-1.0F, 2.5F, 129.0F, 3e38F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(refused(count, 15 * vertices), "n_elastic_vertex") << count;
  Model model = scene.model();
  model.sizes.n_elastic_vertex = elastic_layout::all_vertex_floats(model);  // none, not even how many
  EXPECT_STREQ(method.check_data(model).field, "n_elastic_vertex");
  model = scene.model();
  std::vector<float> floats(model.elastic_vertex.begin(), model.elastic_vertex.end());
  floats.back() = std::numeric_limits<float>::infinity();
  model.elastic_vertex = floats;
  EXPECT_STREQ(method.check_data(model).field, "elastic_vertex");
}

}  // namespace
}  // namespace palpate::test
