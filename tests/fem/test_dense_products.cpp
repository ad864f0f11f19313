// Eigen cuts large dense products into blocks by the processor's caches, and their sums with them.
#include <gtest/gtest.h>

#include <Eigen/Core>

namespace palpate {
namespace {

// Those of config/CMakeLists.txt, wherever this runs: asked for by one source alone, the processor's own would serve
// all.
TEST(DenseProducts, AreCutAlikeOnEveryProcessor) {
  EXPECT_EQ(Eigen::l1CacheSize(), 48 * 1024);
  EXPECT_EQ(Eigen::l2CacheSize(), 2 * 1024 * 1024);
  EXPECT_EQ(Eigen::l3CacheSize(), 32 * 1024 * 1024);
}

}  // namespace
}  // namespace palpate
