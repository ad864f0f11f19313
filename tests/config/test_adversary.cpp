#include <gtest/gtest.h>

#include <memory>

#include "config/bake/adversary.h"

namespace palpate {
namespace {

// Every compiler's search draws alike: of two numbers in one expression either may be drawn first.
TEST(Adversary, DrawsTheDirectionBeforeTheLength) {
  const auto model = std::make_unique<Model>();
  Adversary whole(*model, 7), apart(*model, 7);
  for (int i = 0; i < 100; ++i) {
    const Vec3 way = apart.direction();
    const Vec3 expected = apart.uniform(0, 0.2) * 3.0 * way;
    const Vec3 drawn = whole.any_way(0.2, 3.0);
    EXPECT_EQ(drawn.x, expected.x) << i;
    EXPECT_EQ(drawn.y, expected.y) << i;
    EXPECT_EQ(drawn.z, expected.z) << i;
  }
}

}  // namespace
}  // namespace palpate
