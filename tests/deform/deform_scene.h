// A small body with anchors, owning the arrays a Model views; and an independent dense solver for oracles.
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "config/bake/rbf_system.h"
#include "rt_core/state.h"

namespace palpate::deform_test {

using Row = std::vector<long double>;
using Dense = std::vector<Row>;

// Gaussian elimination with partial pivoting in long double (64-bit mantissa): the oracle for every small solve here.
inline Row solve_dense(Dense a, Row b) {
  const std::size_t n = b.size();
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c; i < n; ++i) {
      if (std::fabs(a[i][c]) > std::fabs(a[pivot][c])) pivot = i;
    }
    std::swap(a[c], a[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t i = c + 1; i < n; ++i) {
      const long double f = a[i][c] / a[c][c];
      for (std::size_t j = c; j < n; ++j) a[i][j] -= f * a[c][j];
      b[i] -= f * b[c];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = i + 1; j < n; ++j) b[i] -= a[i][j] * b[j];
    b[i] /= a[i][i];
  }
  return b;
}

inline long double wide(double x) { return static_cast<long double>(x); }

inline long double distance(Vec3 a, Vec3 b) {
  const long double x = wide(a.x) - wide(b.x), y = wide(a.y) - wide(b.y), z = wide(a.z) - wide(b.z);
  return std::sqrt(x * x + y * y + z * z);
}

inline double component(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

inline Vec3 random_vector(std::mt19937_64& random, double scale) {
  std::uniform_real_distribution<double> uniform(-scale, scale);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

inline Quat random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return normalised({w, x, y, z});
}

// Circular section of radius r, release length of a rigid circular foot.
inline Anchor make_anchor(Vec3 position_m, double radius_m, double nu = 0.47, bool fixed = false) {
  Anchor anchor{};
  anchor.position_m = position_m;
  anchor.normal = unit_or(position_m, {0, 0, 1});
  anchor.section_area_m2 = kPi * radius_m * radius_m;
  anchor.section_inertia_m4 = kPi * radius_m * radius_m * radius_m * radius_m / 4;
  anchor.section_radius_m = radius_m;
  anchor.release_length_m = kPi * radius_m * (1 - nu * nu) / 2;
  anchor.fixed = fixed ? 1 : 0;
  return anchor;
}

struct Scene {
  Model model;
  std::vector<Anchor> anchors;
  std::vector<double> inverse;
  std::vector<Vec3> vertices, normals;
  std::vector<PatchWeight> patches;
  std::vector<ToolPoint> tool_points;

  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // Points the model at the arrays; returns whether the interpolation could be inverted.
  bool bind() {
    std::vector<Vec3> positions;
    for (const Anchor& a : anchors) positions.push_back(a.position_m);
    const auto n = static_cast<std::int64_t>(anchors.size()) + rbf_tail_size(model.params.rbf_tail);
    inverse.assign(static_cast<std::size_t>(n * n), 0.0);
    const bool invertible = invert_rbf_system(positions, model.params.rbf_tail, inverse);
    model.anchor = anchors;
    model.vertex_m = vertices;
    model.vertex_normal = normals;
    model.patch = patches;
    model.tool_point = tool_points;
    model.sizes.n_anchor = static_cast<std::int64_t>(anchors.size());
    model.sizes.n_rbf = invertible ? n : 0;
    model.sizes.n_rbf2 = invertible ? n * n : 0;
    if (invertible) model.rbf_inverse = inverse;
    return invertible;
  }
};

// Ellipsoid 40 x 30 x 25 mm, anchors at the ends of its axes, the bottom one fixed; rubber.
inline void make_ellipsoid(Scene& scene, double radius_m = 6e-3) {
  scene.model.params.youngs_modulus_Pa = 3e6;
  scene.model.params.poisson_ratio = 0.47;
  scene.model.params.skeleton_law = SkeletonLaw::kStiffness;
  scene.model.params.neighbourhood_law = NeighbourhoodLaw::kLogC1;
  scene.model.params.neighbourhood_radius_m = 10e-3;
  scene.model.params.surface_size_m = 80e-3;
  const Vec3 ends[6] = {{40e-3, 0, 0}, {-40e-3, 0, 0}, {0, 30e-3, 0}, {0, -30e-3, 0}, {0, 0, 25e-3}, {0, 0, -25e-3}};
  scene.anchors.clear();
  for (const Vec3& p : ends) scene.anchors.push_back(make_anchor(p, radius_m, 0.47, p.z < 0));
  scene.bind();
}

inline Vec3 ellipsoid_point(double theta, double phi) {
  return {40e-3 * std::sin(theta) * std::cos(phi), 30e-3 * std::sin(theta) * std::sin(phi), 25e-3 * std::cos(theta)};
}

// A region in contact at `centre` with force of size `force_N` on the tool along `normal`.
inline Region make_region(std::uint32_t id, std::uint32_t born_tick, Vec3 centre, Vec3 normal, double force_N) {
  Region region;
  region.id = id;
  region.born_tick = born_tick;
  region.point_count = 1;
  region.centre_w = centre;
  region.normal_w = normal;
  region.normal_force_N = force_N;
  region.depth_equivalent_m = 2e-3;
  region.area_m2 = kPi * 9e-6;  // radius 3 mm
  return region;
}

}  // namespace palpate::deform_test
