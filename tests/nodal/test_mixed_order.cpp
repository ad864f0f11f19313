// Quadratic elements where the tool presses, linear ones elsewhere: what the contact feels is the zone's own order.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "config/scene/scene.h"
#include "tests/support/baked_scene.h"

namespace palpate::test {
namespace {

// A ball of 10 mm pressed 2.5 mm into the middle of a soft block's top, force at every 10 um.
std::vector<double> press(const char* order) {
  const BakedScene scene(std::string(R"(name = "block"
[body]
shape = "box"
size_mm = [40, 20, 40]
[body.material]
youngs_modulus_Pa = 1e5
poisson_ratio = 0.45
[body.fixed]
base_height_mm = 0
[contact]
backend = "nodal"
[contact.nodal]
strain_limit = 10
[friction]
law = "none"
[[tool.piece]]
shape = "sphere"
radius_mm = 10
[body.fem]
edge_mm = 5
strain_gauges = 0
)") + order);
  Bench bench(scene.model());
  std::vector<double> force;
  for (int k = 0; k <= 250; ++k) {
    force.push_back(bench.tick_at({{0, 0.030 - 1e-5 * k, 0}, {}}, {}).contact_w.force_N.y);
    EXPECT_LT(bench.output.residual_m, 1e-12);
  }
  return force;
}

// Mean of the ratio of forces from 1 mm on: what is left of the contact's jumps from node to node cancels.
double ratio(const std::vector<double>& force, const std::vector<double>& reference) {
  double sum = 0;
  for (std::size_t k = 100; k < force.size(); ++k) sum += force[k] / reference[k];
  return sum / static_cast<double>(force.size() - 100);
}

TEST(MixedOrder, TheContactFeelsItsZone) {
  const std::string zone = "zone_from_mm = [-5.1, 19, -5.1]\nzone_to_mm = [5.1, 21, 5.1]\norder = \"mixed\"\n";
  const std::vector<double> quadratic = press("order = \"quadratic\"\n");
  const double linear = ratio(press("order = \"linear\"\n"), quadratic);
  const double one = ratio(press((zone + "zone_layers = 1\n").c_str()), quadratic);
  const double two = ratio(press((zone + "zone_layers = 2\n").c_str()), quadratic);
  std::printf("force over that of quadratic elements: linear %.3f, one layer %.3f, two layers %.3f\n", linear, one,
              two);
  // Two layers leave a third of the linear mesh's error (docs/models_fem.md, section 3).
  EXPECT_GT(one, two);
  EXPECT_GT(two, 1);
  EXPECT_LT(two - 1, 0.4 * (linear - 1));
}

}  // namespace
}  // namespace palpate::test
