// Superellipsoids: the ellipsoid among them, the volume of all of them, and squareness.
#include <gtest/gtest.h>

#include <cmath>

#include "config/body/body.h"
#include "config/body/procedural.h"

namespace palpate {
namespace {

SurfaceMesh made(double e1, double e2, int triangles) {
  SceneDesc scene;
  scene.body.shape = BodyShape::kSuperellipsoid;
  scene.body.half_axes_m = {0.040, 0.030, 0.025};
  scene.body.e1 = e1;
  scene.body.e2 = e2;
  scene.body.triangles = triangles;
  std::vector<std::string> warnings;
  return make_body(scene, warnings);
}

TEST(Superellipsoid, WithBothExponentsOneIsTheEllipsoid) {
  for (const Vec3& p : made(1, 1, 3000).vertex_m) {
    const Vec3 q{p.x / 0.040, p.y / 0.030 - 1, p.z / 0.025};
    EXPECT_NEAR(squared_norm(q), 1, 1e-12);
  }
}

// V = 2 abc e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2) (Jaklic, Leonardis and Solina 2000, eq. 2.60). The mesh is inscribed: a
// little less, by the cut of its facets; sharper shapes lose more.
TEST(Superellipsoid, VolumeIsTheBetaFunctions) {
  for (const auto& [e1, e2] : {std::pair{1.0, 1.0}, {0.4, 0.4}, {0.4, 1.0}, {1.0, 0.5}, {1.5, 1.2}}) {
    const double exact =
        2 * 0.040 * 0.030 * 0.025 * e1 * e2 * std::beta(0.5 * e1 + 1, e1) * std::beta(0.5 * e2, 0.5 * e2);
    const double volume = signed_volume_m3(made(e1, e2, 20000));
    EXPECT_LT(volume, exact * (1 + 1e-9)) << e1 << " " << e2;
    EXPECT_GT(volume, 0.99 * exact) << e1 << " " << e2;
  }
}

TEST(Superellipsoid, ReachesItsHalfAxesAndFillsTheBoxAsItSquares) {
  double last = 0;
  for (const double e : {1.6, 1.0, 0.6, 0.3}) {
    const SurfaceMesh mesh = made(e, e, 3000);
    const Bounds box = bounds_of(mesh);
    EXPECT_LE(box.upper_m.x, 0.040 + 1e-12);
    EXPECT_LE(box.upper_m.y, 0.060 + 1e-12);
    EXPECT_LE(box.upper_m.z, 0.025 + 1e-12);
    EXPECT_NEAR(box.lower_m.y, 0, 1e-12);
    EXPECT_GT(signed_volume_m3(mesh), last);
    last = signed_volume_m3(mesh);
  }
}

}  // namespace
}  // namespace palpate
