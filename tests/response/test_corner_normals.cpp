// Corner normals of surfaces whose shape is not known, against those of the shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "config/body/procedural.h"
#include "config/response/corner_normals.h"

namespace palpate {
namespace {

// An even sphere's vertices moved by up to `share` of an edge, on the sphere of radius 1.
SurfaceMesh uneven_sphere(double share) {
  SurfaceMesh mesh = make_ellipsoid({1, 1, 1}, 3000);
  for (Vec3& p : mesh.vertex_m) p.y -= 1;  // stands on its pole
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr double kEdge = 0.1;
  for (Vec3& p : mesh.vertex_m) p = unit_or(p + share * kEdge * Vec3{unit(random), unit(random), unit(random)}, p);
  return mesh;
}

// As of a mesh from a file.
std::vector<CornerNormals> normals_of(const SurfaceMesh& mesh) {
  BodyDesc body;
  body.shape = BodyShape::kMesh;
  const std::vector<Triangle> triangle = linked_triangles(mesh);
  return corner_normals(body, mesh.vertex_m, triangle);
}

double largest_error(const SurfaceMesh& mesh, const std::vector<Vec3>& exact) {
  const std::vector<CornerNormals> normals = normals_of(mesh);
  double largest = 0;
  for (std::size_t t = 0; t < normals.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      largest = std::max(largest, norm(normals[t].normal[k] - exact[static_cast<std::size_t>(mesh.triangle[t][k])]));
  return largest;
}

// Whatever the triangles (Max 1999). By angles up to 2, 16 and 25 mrad off (2026-11-26).
TEST(CornerNormals, OfASphereAreExact) {
  for (const double share : {0.0, 0.15, 0.25}) {
    const SurfaceMesh mesh = uneven_sphere(share);
    EXPECT_LT(largest_error(mesh, mesh.vertex_m), 1e-9) << share;
  }
}

// 6.5 and 15.7 mrad; weighted by angles 19.4 and 32.1 (2026-11-26).
TEST(CornerNormals, OfAnEllipsoidAreNear) {
  const Vec3 half{1, 0.6, 0.8};
  for (const auto& [share, most] : {std::pair{0.15, 0.01}, std::pair{0.25, 0.02}}) {
    SurfaceMesh mesh = uneven_sphere(share);
    std::vector<Vec3> exact;
    for (Vec3& p : mesh.vertex_m) {
      exact.push_back(unit_or({p.x / half.x, p.y / half.y, p.z / half.z}, {}));
      p = {half.x * p.x, half.y * p.y, half.z * p.z};
    }
    const double error = largest_error(mesh, exact);
    std::printf("  moved by %.2f of an edge: %.1f mrad\n", share, 1e3 * error);
    EXPECT_LT(error, most) << share;
  }
}

}  // namespace
}  // namespace palpate
