#include <gtest/gtest.h>

#include <algorithm>

#include "tests/collide/meshes.h"

namespace palpate::test {
namespace {

// Every child's box and every triangle under it, checked recursively.
struct Walk {
  const Body& body;
  std::vector<int> seen;
  int depth = 0;

  void node(int index, int level) {
    depth = std::max(depth, level);
    const BvhNode& n = body.model.bvh[static_cast<std::size_t>(index)];
    for (int k = 0; k < 4; ++k) {
      const std::size_t before = seen.size();
      if (n.child[k] >= 0) {
        ASSERT_GT(n.child[k], index) << "children come after their parent";
        ASSERT_EQ(n.count[k], 0);
        node(n.child[k], level + 1);
      } else {
        ASSERT_LE(n.count[k], 4);
        for (int i = 0; i < n.count[k]; ++i) seen.push_back(~n.child[k] + i);
      }
      for (std::size_t i = before; i < seen.size(); ++i) contained(n, k, seen[i]);
    }
  }
  void contained(const BvhNode& n, int k, int triangle) {
    for (const int v : body.model.triangle[static_cast<std::size_t>(triangle)].vertex) {
      const Vec3 p = body.model.vertex_m[static_cast<std::size_t>(v)];
      const double c[3] = {p.x, p.y, p.z};
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_LE(double(n.lower_m[axis][k]), c[axis]);
        ASSERT_GE(double(n.upper_m[axis][k]), c[axis]);
      }
    }
  }
};

class BvhTest : public testing::TestWithParam<int> {
 protected:
  static Mesh mesh(int which) {
    switch (which) {
      case 0:
        return box({0.03, 0.02, 0.01});
      case 1:
        return ellipsoid({0.05, 0.035, 0.03}, 12, {0.3, -0.2, 0.1});
      case 2:
        return torus(0.04, 0.012, 40, 20);
      default: {  // 500 copies of one triangle: no plane separates them
        Mesh m;
        m.vertex = {{0, 0, 0}, {1e-2, 0, 0}, {0, 1e-2, 0}};
        m.triangle.assign(500, {{0, 1, 2}, {-1, -1, -1}});
        return m;
      }
    }
  }
};

TEST_P(BvhTest, CoversEveryTriangleOnceInsideItsBoxes) {
  const Body body = make_body(mesh(GetParam()));
  Walk walk{body, {}, 0};
  walk.node(0, 1);
  EXPECT_EQ(walk.depth, body.bvh.depth);
  EXPECT_LT(body.bvh.stack_high_water, kMaxTraversalStack);
  ASSERT_EQ(walk.seen.size(), body.mesh.triangle.size());
  std::sort(walk.seen.begin(), walk.seen.end());
  for (std::size_t i = 0; i < walk.seen.size(); ++i) EXPECT_EQ(walk.seen[i], static_cast<int>(i));
}

TEST_P(BvhTest, RenumbersTrianglesAndAdjacencyConsistently) {
  const Body body = make_body(mesh(GetParam()));
  for (std::size_t t = 0; t < body.bvh.triangle.size(); ++t) {
    const Triangle& now = body.bvh.triangle[t];
    const Triangle& old = body.mesh.triangle[static_cast<std::size_t>(body.bvh.old_index[t])];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(now.vertex[k], old.vertex[k]);
      if (old.adjacent[k] < 0) {
        EXPECT_EQ(now.adjacent[k], -1);
      } else {
        EXPECT_EQ(body.bvh.old_index[static_cast<std::size_t>(now.adjacent[k])], old.adjacent[k]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, BvhTest, testing::Range(0, 4));

TEST(Bvh, DepthStaysWithinTheStackForAMeshThatDefeatsTheHeuristic) {
  // Triangles at geometrically shrinking distances: area splits peel off one at a time until medians take over.
  Mesh mesh;
  double x = 1;
  for (int i = 0; i < 3000; ++i, x *= 0.99) {
    const int v = static_cast<int>(mesh.vertex.size());
    mesh.vertex.insert(mesh.vertex.end(), {{x, 0, 0}, {x, 1e-6, 0}, {x, 0, 1e-6}});
    mesh.triangle.push_back({{v, v + 1, v + 2}, {-1, -1, -1}});
  }
  const BvhBuild bvh = build_bvh(mesh.vertex, mesh.triangle);
  EXPECT_LE(bvh.depth, kBvhSahLevels + 7);  // log4(3000) + 1 = 6.8
  EXPECT_LT(bvh.stack_high_water, kMaxTraversalStack);
}

TEST(Bvh, ConesHoldTheNormalsOfTheWholeNeighbourhood) {
  const Body body = make_body(torus(0.04, 0.012, 40, 20));
  std::vector<std::vector<Vec3>> fan(body.model.vertex_m.size());
  for (const Triangle& t : body.model.triangle) {
    const auto at = [&](int k) { return body.model.vertex_m[static_cast<std::size_t>(t.vertex[k])]; };
    const Vec3 normal = unit_or(cross(at(1) - at(0), at(2) - at(0)), {});
    for (const int v : t.vertex) fan[static_cast<std::size_t>(v)].push_back(normal);
  }
  int cones = 0;
  for (const BvhNode& n : body.model.bvh) {
    for (int k = 0; k < 4; ++k) {
      const auto component = [&](int i) { return static_cast<Real>(n.cone_axis[i][k]); };
      const Vec3 axis{component(0), component(1), component(2)};
      if (n.child[k] >= 0 || squared_norm(axis) == 0) continue;
      ++cones;
      EXPECT_NEAR(norm(axis), 1, 1e-6);
      for (int i = 0; i < n.count[k]; ++i)
        for (const int v : body.model.triangle[static_cast<std::size_t>(~n.child[k] + i)].vertex)
          for (const Vec3 normal : fan[static_cast<std::size_t>(v)])
            EXPECT_LE(norm(cross(normal, axis)), double(n.cone_tangent[k]) * dot(normal, axis));
    }
  }
  EXPECT_GT(cones, 100);  // the test looked at something
}

}  // namespace
}  // namespace palpate::test
