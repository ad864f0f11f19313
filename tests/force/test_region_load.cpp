// Sum of point forces of one region: worked example, weightings, centre of pressure, continuity, stiffness.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "rt_core/contact/friction.h"
#include "rt_core/contact/points/point_laws.h"

namespace palpate {
namespace {

const CubicLaw kLaw{40, 3e8, kHuge};
const Vec3 kUp{0, 0, 1};

struct Points {
  std::vector<Contact> contact;
  std::vector<std::int32_t> index;

  void add(Vec3 position, Vec3 normal, Real depth, Real weight) {
    Contact c;
    c.position_w = position;
    c.normal_w = normal;
    c.depth_m = depth;
    c.weight = weight;
    index.push_back(static_cast<std::int32_t>(contact.size()));
    contact.push_back(c);
  }
  RegionRows view() { return {contact.data(), index.data(), static_cast<std::int32_t>(index.size())}; }
};

RegionLoad load_of(const RegionRows& rows, Real shift_m, Vec3 pivot) {
  return region_load(PointLaws{kLaw, &rows, nullptr, 1}, 0, rows, shift_m, pivot);
}

// Depths 1 to 4 mm at the corners of a 2 mm square.
Points worked_points() {
  Points points;
  points.add({0, 0, 0}, kUp, 1e-3, 1);
  points.add({2e-3, 0, 0}, kUp, 2e-3, 1);
  points.add({2e-3, 2e-3, 0}, kUp, 3e-3, 1);
  points.add({0, 2e-3, 0}, kUp, 4e-3, 1);
  return points;
}

TEST(RegionLoad, WorkedExample) {
  Points points = worked_points();
  weigh_contacts(ContactWeight::kPaper, points.view());
  const RegionLoad load = load_of(points.view(), 0, {});
  const Real force[4] = {0.085, 0.62, 2.055, 4.84};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(points.contact[i].force_N, force[i], 1e-14);
  EXPECT_NEAR(load.force_N, 7.6, 1e-14);
  EXPECT_NEAR(load.resultant_w.z, 7.6, 1e-14);
  EXPECT_NEAR(law_depth_m(kLaw, 7.6), 2.9218233470e-3, 1e-13);
  const RegionCentre centre = region_centre(points.view(), kUp);
  EXPECT_NEAR(centre.position_w.x, 0.7039473684e-3, 1e-13);
  EXPECT_NEAR(centre.position_w.y, 1.8144736842e-3, 1e-13);
  EXPECT_NEAR(centre.position_w.z, 0, 1e-18);
  // The paper's equivalent point: the geometric centre, whatever the forces.
  RegionRows paper = points.view();
  paper.geometric = true;
  EXPECT_NEAR(region_centre(paper, kUp).position_w.x, 1e-3, 1e-18);
  EXPECT_NEAR(region_centre(paper, kUp).position_w.y, 1e-3, 1e-18);
  // The resultant at the centre of pressure has the torque of the points.
  EXPECT_LT(norm(cross(centre.position_w, load.resultant_w) - load.torque_w), 1e-16);
  // Pressed along a direction 30 degrees off the normal: parts, limits and sticking.
  const Vec3 along{std::sin(M_PI / 6), 0, -std::cos(M_PI / 6)};
  const Vec3 total = -load.force_N * along;
  EXPECT_NEAR(total.x, -3.8, 1e-13);
  EXPECT_NEAR(total.z, 6.581793069, 1e-9);
  FrictionParameters p;
  p.k_N = 0.8 * std::pow(5.0, 0.25);
  p.beta = 0.75;
  p.mu_dynamic = 0.5;
  EXPECT_NEAR(static_limit_N(p, total.z), 4.91575982676, 1e-10);
  EXPECT_NEAR(sliding_limit_N(p, total.z), 3.29089653, 5e-9);
}

TEST(RegionLoad, Weightings) {
  for (const ContactWeight law : {ContactWeight::kWinkler, ContactWeight::kArea, ContactWeight::kPaper}) {
    Points points;
    const Real weight[3] = {0.5, 1.0, 2.5};
    for (const Real w : weight) points.add({}, kUp, 2e-3, w);
    weigh_contacts(law, points.view());
    const Real force = load_of(points.view(), 0, {}).force_N;
    EXPECT_NEAR(force, law == ContactWeight::kWinkler ? 4 * 2.48 : 2.48, 1e-13);
    EXPECT_NEAR(points.contact[0].weight,
                law == ContactWeight::kWinkler ? 0.5 : (law == ContactWeight::kArea ? 0.125 : 1.0 / 3), 1e-16);
  }
  for (const ContactWeight law : {ContactWeight::kWinkler, ContactWeight::kArea, ContactWeight::kPaper}) {
    Points empty, zero;
    zero.add({}, kUp, 1e-3, 0);
    zero.add({}, kUp, 1e-3, -1);
    zero.add({}, kUp, 1e-3, std::nan(""));
    weigh_contacts(law, empty.view());
    weigh_contacts(law, zero.view());
    EXPECT_TRUE(std::isfinite(load_of(zero.view(), 0, {}).force_N));
  }
}

TEST(RegionLoad, WinklerForceIsContinuousWhenPointsEnterAndLeave) {
  // A sphere of sample points pressed in: points enter one after another.
  const auto force_at = [](Real travel) {
    Points points;
    for (int i = -6; i <= 6; ++i) {
      const Real x = 1e-3 * i, depth = travel - x * x / (2 * 0.01);
      if (depth > 0) points.add({x, 0, 0}, kUp, depth, 0.1);
    }
    weigh_contacts(ContactWeight::kWinkler, points.view());
    return std::pair{load_of(points.view(), 0, {}).force_N, points.contact.size()};
  };
  Real previous = 0, largest = 0;
  std::size_t count = 0, entries = 0;
  for (int i = 1; i <= 3000; ++i) {
    const auto [force, points] = force_at(1e-6 * i);
    entries += points != count;
    count = points;
    largest = std::max(largest, force - previous);
    EXPECT_GE(force, previous);
    previous = force;
  }
  EXPECT_EQ(entries, 7u);
  // No step exceeds travel times the greatest stiffness: 13 points, 0.1 (k1 + 3 k3 D^2) at 3 mm each.
  EXPECT_LT(largest, 1e-6 * 1.3 * law_tangent_N_per_m(kLaw, 3e-3));
}

TEST(RegionLoad, CentreLiesOnACurvedSurface) {
  // Points of a sphere of 30 mm: their mean lies below the surface by the sagitta, the centre does not.
  const Real radius = 0.03;
  Points points;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<Real> angle(-0.25, 0.25), depth(1e-3, 2e-3);
  Vec3 mean;
  for (int i = 0; i < 12; ++i) {
    const Vec3 n = unit_or({std::sin(angle(random)), std::sin(angle(random)), 1}, kUp);
    points.add(radius * n, n, depth(random), 1);
    mean += (1.0 / 12) * (radius * n);
  }
  load_of(points.view(), 0, {});
  const RegionCentre centre = region_centre(points.view(), kUp);
  EXPECT_GT(radius - norm(mean), 2e-4);
  EXPECT_LT(std::abs(norm(centre.position_w) - radius), 2e-5);  // third order in the patch's 15 degrees
  EXPECT_NEAR(norm(centre.normal_w), 1, 1e-15);
}

TEST(RegionLoad, StiffnessIsTheDerivativeOfTheWrench) {
  Points points;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<Real> u(-1, 1);
  for (int i = 0; i < 6; ++i) {
    points.add({0.01 * u(random), 0.01 * u(random), 0.01 * u(random)}, unit_or({u(random), u(random), 2}, kUp),
               2e-3 + 1e-3 * u(random), 0.3);
  }
  const Vec3 pivot{0.02, -0.01, 0.05};
  const RegionLoad load = load_of(points.view(), 1e-4, pivot);
  Real k[36];
  store(load.stiffness, k);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) EXPECT_EQ(k[6 * i + j], k[6 * j + i]);
  }
  for (int axis = 0; axis < 6; ++axis) {
    // Moving the tool by e changes each depth by -n.(e or e x r).
    const Real h = 1e-7;
    Vec3 e;
    (axis % 3 == 0 ? e.x : axis % 3 == 1 ? e.y : e.z) = h;
    Points moved = points;
    for (Contact& c : moved.contact) {
      c.depth_m -= dot(c.normal_w, axis < 3 ? e : cross(e, c.position_w - pivot));
    }
    const RegionLoad after = load_of(moved.view(), 1e-4, pivot);
    const Vec3 df = (1 / h) * (after.resultant_w - load.resultant_w), dt = (1 / h) * (after.torque_w - load.torque_w);
    const Real column[6] = {df.x, df.y, df.z, dt.x, dt.y, dt.z};
    for (int row = 0; row < 6; ++row) EXPECT_NEAR(column[row], -k[6 * row + axis], 1.0) << row << ' ' << axis;
  }
  EXPECT_NEAR(stiffness_along_N_per_m(load.stiffness, {0, 0, 1}), k[14], 1e-9);
}

TEST(RegionLoad, DegenerateGeometry) {
  Points opposed;  // a pinch inside one region: no resultant direction
  opposed.add({0, 0, 0.01}, {0, 0, 1}, 2e-3, 1);
  opposed.add({0, 0, -0.01}, {0, 0, -1}, 2e-3, 1);
  RegionLoad load = load_of(opposed.view(), 0, {});
  EXPECT_LT(norm(load.resultant_w), 1e-15);
  EXPECT_EQ(region_centre(opposed.view(), {1, 0, 0}).normal_w, (Vec3{1, 0, 0}));
  Points unloaded;
  unloaded.add({1, 0, 0}, kUp, 1e-3, 1);
  unloaded.add({3, 0, 0}, kUp, 1e-3, 1);
  load = load_of(unloaded.view(), 5e-3, {});
  EXPECT_EQ(load.force_N, 0);
  EXPECT_NEAR(region_centre(unloaded.view(), kUp).position_w.x, 2, 1e-15);
  Points none;
  EXPECT_EQ(region_centre(none.view(), kUp).normal_w, kUp);
}

}  // namespace
}  // namespace palpate
