// Linear elasticity against analytic solutions: beams, thick rings, orders of convergence.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/fem/linear_body.h"
#include "config/fem/tet_procedural.h"
#include "tests/fem/face_load.h"

namespace palpate {
namespace {

TetMesh corners_only(const TetMesh& mesh) {
  TetMesh out;
  std::size_t corners = 0;
  for (const Tet& tet : mesh.tet) {
    Tet linear;
    for (std::size_t k = 0; k < 4; ++k) {
      linear.node[k] = tet.node[k];
      corners = std::max(corners, static_cast<std::size_t>(tet.node[k]) + 1);
    }
    out.tet.push_back(linear);
  }
  out.node_m.assign(mesh.node_m.begin(), mesh.node_m.begin() + static_cast<std::ptrdiff_t>(corners));
  return out;
}

// Mean deflection of the end face of a beam along y with a shear load of 1 N along x; m.
double tip_deflection_m(const TetMesh& mesh, double length_m, double area_m2, const FemMaterial& material) {
  const auto at_end = [&](Vec3 p) { return p.y > length_m * (1 - 1e-9); };
  const LinearBody body(mesh, material, hold_where(mesh, [](Vec3 p) { return p.y == 0; }), "beam");
  const std::vector<Vec3> load = face_load(mesh, at_end, [&](Vec3, Vec3) { return Vec3{1 / area_m2, 0, 0}; });
  const std::vector<Vec3> u = body.solve_m(load);
  double work = 0;
  for (std::size_t i = 0; i < u.size(); ++i) work += dot(load[i], u[i]);
  return work;  // by 1 N: the mean over the face
}

// 60 x 10 x 10 mm, E = 1000 MPa, nu = 0.3: 0.0868 mm with about 700 nodes, 0.0871 converged (a clamped root is 1.3 %
// stiffer than Timoshenko's 0.0883 to 0.0886).
TEST(Cantilever, QuadraticElementsFindTheReference) {
  const TetMesh mesh = make_box_tets({0.010, 0.060, 0.010}, {2, 14, 2});
  EXPECT_EQ(mesh.node_m.size(), 725u);
  const double tip = tip_deflection_m(mesh, 0.060, 1e-4, {1e9, 0.3});
  EXPECT_NEAR(tip, 0.0868e-3, 0.005 * 0.0868e-3);
}

// The same corners with linear elements: 12 to 22 % too stiff, as every text warns.
TEST(Cantilever, LinearElementsAreTooStiff) {
  const TetMesh mesh = corners_only(make_box_tets({0.010, 0.060, 0.010}, {4, 24, 4}));
  const double tip = tip_deflection_m(mesh, 0.060, 1e-4, {1e9, 0.3});
  EXPECT_LT(tip, 0.90 * 0.0871e-3);
  EXPECT_GT(tip, 0.75 * 0.0871e-3);
}

// nu = 0 has no clamping effect: P L^3/(3 E I) + 6 P L/(5 G A) of Timoshenko's beam is all there is.
TEST(Cantilever, SlenderBeamFollowsBeamTheory) {
  for (const double length : {0.10, 0.20}) {
    const double side = 0.005, young = 1e9;
    const TetMesh mesh = make_box_tets({side, length, side}, {2, static_cast<std::int32_t>(length / 0.005), 2});
    const double inertia = side * side * side * side / 12;
    const double bending = length * length * length / (3 * young * inertia);
    const double shear = 1.2 * length / (young / 2 * side * side);
    const double tip = tip_deflection_m(mesh, length, side * side, {young, 0});
    EXPECT_NEAR(tip / (bending + shear), 1.0, 2e-3) << length;
  }
}

// p_i = 0.1 MPa in a ring 20/30 mm, E = 3 MPa, nu = 0.45 (Lame 1852).
struct RingResult {
  double inner_m, outer_m;
};
RingResult press_ring(double poisson, bool plane_strain, std::array<std::int32_t, 3> cells, double width_m) {
  const double a = 0.020, b = 0.030;
  const TetMesh mesh = make_ring_tets(a, b, width_m, cells);
  check_tet_mesh(mesh, "ring");
  Supports supports(mesh.node_m.size(), 0);
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const Vec3 p = mesh.node_m[i];
    if (std::abs(p.x) < 1e-9) supports[i] |= 1;
    if (std::abs(p.y) < 1e-9) supports[i] |= 2;
    if (p.z < -0.5 * width_m + 1e-9 || (plane_strain && p.z > 0.5 * width_m - 1e-9)) supports[i] |= 4;
  }
  const LinearBody body(mesh, {3e6, poisson}, supports, "ring");
  const auto inside = [&](Vec3 p) { return std::hypot(p.x, p.y) < a + 1e-9; };
  const std::vector<Vec3> u = body.solve_m(face_load(mesh, inside, [](Vec3, Vec3 n) { return -1e5 * n; }));
  RingResult mean{};
  double inner = 0, outer = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Vec3 p = mesh.node_m[i];
    const double r = std::hypot(p.x, p.y), radial = (p.x * u[i].x + p.y * u[i].y) / r;
    if (r < a + 1e-9) mean.inner_m += radial, inner += 1;
    if (r > b - 1e-9) mean.outer_m += radial, outer += 1;
  }
  return {mean.inner_m / inner, mean.outer_m / outer};
}

TEST(ThickRing, FollowsLameInPlaneStressAndPlaneStrain) {
  const RingResult stress = press_ring(0.45, false, {32, 3, 1}, 0.002);
  EXPECT_NEAR(stress.inner_m, 2.033333e-3, 1e-3 * 2.033333e-3);
  EXPECT_NEAR(stress.outer_m, 1.6e-3, 1e-3 * 1.6e-3);
  const RingResult strain = press_ring(0.45, true, {32, 3, 1}, 0.004);
  EXPECT_NEAR(strain.inner_m, 1.817333e-3, 1e-3 * 1.817333e-3);
}

// (1 + nu)/E p a^2/(b^2 - a^2) ((1 - 2 nu) r + b^2/r): a locking element would hardly move.
TEST(ThickRing, NearlyIncompressibleRingDoesNotLock) {
  for (const double poisson : {0.495, 0.4999, 0.499999}) {
    const double a = 0.02, b = 0.03;
    const double exact = (1 + poisson) / 3e6 * 1e5 * a * a / (b * b - a * a) * ((1 - 2 * poisson) * a + b * b / a);
    const RingResult ring = press_ring(poisson, true, {32, 3, 1}, 0.004);
    EXPECT_NEAR(ring.inner_m / exact, 1.0, 5e-3) << poisson;
  }
}

// The gradient of a harmonic function solves Navier's equations without body force for any Poisson's ratio:
// phi = sin(a x) sin(b z) exp(c y), c^2 = a^2 + b^2.
struct SmoothField {
  double a = 30, b = 40, c = 50;  // 1/m; the box is 40 mm: one to two radians across
  Vec3 displacement(Vec3 p) const {
    const double e = std::exp(c * p.y);
    return 1e-6 * Vec3{a * std::cos(a * p.x) * std::sin(b * p.z) * e, c * std::sin(a * p.x) * std::sin(b * p.z) * e,
                       b * std::sin(a * p.x) * std::cos(b * p.z) * e};
  }
  Eigen::Matrix3d gradient(Vec3 p) const {
    const double e = 1e-6 * std::exp(c * p.y), sx = std::sin(a * p.x), cx = std::cos(a * p.x), sz = std::sin(b * p.z),
                 cz = std::cos(b * p.z);
    Eigen::Matrix3d g;
    g << -a * a * sx * sz * e, a * c * cx * sz * e, a * b * cx * cz * e, a * c * cx * sz * e, c * c * sx * sz * e,
        b * c * sx * cz * e, a * b * cx * cz * e, b * c * sx * cz * e, -b * b * sx * sz * e;
    return g;
  }
};

// Energy norm of the error, sqrt(1/2 integral e : D : e), of the solution with the exact field on the surface.
double energy_error(TetMesh mesh, const SmoothField& field, const FemMaterial& material) {
  // Off the symmetry planes, where the field would be special.
  for (Vec3& p : mesh.node_m) p += Vec3{0.007, 0, 0.011};
  Supports supports(mesh.node_m.size(), 0);
  std::vector<Vec3> held(mesh.node_m.size());
  for (const std::int32_t i : surface_of(mesh).node) {
    supports[static_cast<std::size_t>(i)] = kHoldAll;
    held[static_cast<std::size_t>(i)] = field.displacement(mesh.node_m[static_cast<std::size_t>(i)]);
  }
  const LinearBody body(mesh, material, supports, "box");
  const std::vector<Vec3> u = body.solve_m(std::vector<Vec3>(mesh.node_m.size()), held);
  const double shear = material.young_Pa / (2 * (1 + material.poisson));
  const double lame = 2 * shear * material.poisson / (1 - 2 * material.poisson);
  double energy = 0;
  for (const Tet& tet : mesh.tet)
    for (const TetPoint& q : tet_rule_14()) {
      const TetMapping m = map_tet(mesh, tet, q.lambda);
      const TetValues shape = tet_shape(tet, q.lambda);
      Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
      Vec3 p;
      for (std::size_t k = 0; k < 10; ++k) {
        if (tet.node[k] < 0) continue;
        const auto i = static_cast<std::size_t>(tet.node[k]);
        const auto row = static_cast<Eigen::Index>(k);
        p += shape(row) * mesh.node_m[i];
        gradient += Eigen::Vector3d(u[i].x, u[i].y, u[i].z) * m.gradient_1pm.row(row);
      }
      const Eigen::Matrix3d d = gradient - field.gradient(p);
      const Eigen::Matrix3d strain = 0.5 * (d + d.transpose());
      const double trace = strain.trace();
      energy += q.weight * m.determinant_m3 / 6 * (shear * strain.squaredNorm() + 0.5 * lame * trace * trace);
    }
  return std::sqrt(energy);
}

TEST(Convergence, LinearElementsAreFirstOrderAndQuadraticSecond) {
  const SmoothField field;
  const FemMaterial material{1e6, 0.3};
  for (const bool quadratic : {false, true}) {
    double last = 0, rate = 0;
    for (const std::int32_t n : {2, 4, 8}) {
      if (quadratic && n == 8) continue;
      TetMesh mesh = make_box_tets({0.04, 0.04, 0.04}, {n, n, n});
      if (!quadratic) mesh = corners_only(mesh);
      const double error = energy_error(mesh, field, material);
      if (last > 0) rate = std::log2(last / error);
      last = error;
    }
    // Asymptotic orders are 1 and 2; on these meshes the next term still shows.
    EXPECT_NEAR(rate, quadratic ? 2.0 : 1.0, 0.15);
  }
}

// Refining the order in part of a mesh cannot make a clamped, loaded body stiffer.
TEST(Refinement, MixedOrderLiesBetweenLinearAndQuadratic) {
  const TetMesh quadratic = make_box_tets({0.010, 0.060, 0.010}, {2, 12, 2});
  TetMesh mixed = corners_only(quadratic);
  add_middle_nodes(mixed, elements_near(
                              mixed, [](Vec3 p) { return p.y < 0.02; }, 2));
  std::size_t linear = 0, full = 0;
  for (const Tet& tet : mixed.tet) {
    linear += std::all_of(tet.node.begin() + 4, tet.node.end(), [](std::int32_t i) { return i < 0; });
    full += tet.is_quadratic();
  }
  EXPECT_GT(linear, 0u);
  EXPECT_GT(full, 0u);
  EXPECT_LT(linear + full, mixed.tet.size());  // the rest are transition elements
  check_tet_mesh(mixed, "mixed");
  const FemMaterial material{1e9, 0.3};
  const double t4 = tip_deflection_m(corners_only(quadratic), 0.060, 1e-4, material);
  const double both = tip_deflection_m(mixed, 0.060, 1e-4, material);
  const double t10 = tip_deflection_m(quadratic, 0.060, 1e-4, material);
  EXPECT_LT(t4, both);
  EXPECT_LT(both, t10);
}

}  // namespace
}  // namespace palpate
