// The reference scenes on two meshes each, the hollow cylinder in space, the
// coupling of two fingers. It prints the tables of
// docs/models_large_strain.md; suite LongReport takes more than a minute.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "config/fem/series_fit.h"
#include "tests/strain/plane_scenes.h"
#include "tests/strain/run_time_law.h"

namespace palpate::fem {
namespace {

void add(const char* pattern, ...) __attribute__((format(printf, 1, 2)));
void add(const char* pattern, ...) {
  char line[400];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(line, sizeof line, pattern, values);
  va_end(values);
  std::fputs(line, stdout);
}

struct Row {
  double depth_mm, force_N;  // published large-strain reference
};

// Both meshes, both laws; the finer large-strain force within `share` of the
// published one.
void compare(const char* title, const PressBody& body, const RigidTool& tool, const std::vector<Row>& rows,
             const PressMeshing& coarse, const PressMeshing& fine, double share) {
  std::vector<double> depths;
  for (const Row& row : rows) depths.push_back(1e-3 * row.depth_mm);
  const PressCurve a = press_axisymmetric(body, tool, StrainLaw::kNeoHookean, depths, coarse);
  const PressCurve b = press_axisymmetric(body, tool, StrainLaw::kNeoHookean, depths, fine);
  const PressCurve c = press_axisymmetric(body, tool, StrainLaw::kLinear, depths, fine);
  add("\n### %s\n| depth, mm | large strain, %d elements, N | %d elements, N | "
      "published, N | linear, N | energy, mJ |\n",
      title, coarse.fine_count, fine.fine_count);
  add("|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    add("| %.2f | %.4f | %.4f | %.4f | %.4f | %.4f |\n", rows[i].depth_mm, a.points[i].force_N, b.points[i].force_N,
        rows[i].force_N, c.points[i].force_N, 1e3 * b.points[i].energy_J);
    EXPECT_NEAR(b.points[i].force_N / rows[i].force_N, 1, share) << title << rows[i].depth_mm;
  }
}

void series_errors(const char* title, const DepthOfForce& local, const SeriesCoefficients& c,
                   const std::vector<Row>& rows) {
  double largest = 0;
  for (const Row& row : rows)
    largest = std::max(largest, std::abs(series_force_N(local, c, 1e-3 * row.depth_mm) / row.force_N - 1));
  add("| %s | %.4g | %.4g | %.2f %% |\n", title, 1e3 * c.c0_m_per_N, 1e3 * c.c1_m_per_N2, 100 * largest);
  EXPECT_LT(largest, 0.02) << title;
}

DepthOfForce hertz(double modulus_Pa, double radius_m) {
  return [=](double f) { return std::pow(f / (4.0 / 3 * modulus_Pa * std::sqrt(radius_m)), 2.0 / 3); };
}

const std::vector<Row> kBlock = {{0.25, 1.4558}, {0.5, 4.1091}, {1, 11.573}, {2, 32.303}, {3, 58.363}};
const std::vector<Row> kEllipsoid = {{1, 14.208}, {2, 39.671}, {4, 109.78}, {6, 197.67}, {8, 298.42}};

TEST(Report, SphereOnBlock) {
  // 12 elements over 6 mm find no equilibrium at 0.25 mm: fewer than three are in contact then.
  compare("A: sphere of 6.35 mm on a rubber block", rubber_block(), ball(6.35e-3), kBlock, {6e-3, 15, 1.25},
          {6e-3, 24, 1.25}, 0.01);
}

TEST(Report, PunchOnLayers) {
  compare("B: punch of 1.6 mm on a layer of 3.2 mm", layer(3.2e-3), punch(1.6e-3, 0.2e-3),
          {{0.2, 1.2961}, {0.48, 3.2643}, {0.96, 6.4938}}, {2e-3, 10, 1.25}, {2e-3, 14, 1.25}, 0.012);
  compare("B: punch of 1.6 mm on a layer of 10 mm", layer(10e-3), punch(1.6e-3, 0.2e-3),
          {{0.2, 0.8640}, {0.48, 2.1304}, {0.96, 4.2651}}, {2e-3, 10, 1.25}, {2e-3, 14, 1.25}, 0.012);
}

TEST(Report, SphereOnEllipsoid) {
  compare("C1: sphere of 10 mm on an ellipsoid", ellipsoid(), ball(0.01), kEllipsoid,
          default_meshing(ellipsoid(), ball(0.01), 8e-3, 8), default_meshing(ellipsoid(), ball(0.01), 8e-3, 12), 0.01);
}

TEST(Report, RingBetweenPlates) {
  const double rows[][3] = {
      {1, 0.8208, 1.0290}, {4, 3.1874, 3.9951}, {8, 6.0475, 7.5769}, {12, 8.6689, 10.852}, {16, 11.258, 14.091}};
  RingBetweenPlates coarse(24, Kinematics::kPlaneStress, StrainLaw::kNeoHookean),
      fine(40, Kinematics::kPlaneStress, StrainLaw::kNeoHookean);
  RingBetweenPlates strain(40, Kinematics::kPlaneStrain, StrainLaw::kNeoHookean),
      linear(40, Kinematics::kPlaneStress, StrainLaw::kLinear);
  add("\n### D: thick ring between plates\n| approach, mm | plane stress, 24 "
      "elements, N | 40 elements, N | published, N | linear, N | plane strain, "
      "N | published, N |\n|---|---|---|---|---|---|---|\n");
  for (const auto& row : rows) {
    const double d = 1e-3 * row[0], a = coarse.force_N(d), b = fine.force_N(d), c = linear.force_N(d),
                 e = strain.force_N(d);
    add("| %.0f | %.4f | %.4f | %.4f | %.4f | %.4f | %.4f |\n", row[0], a, b, row[1], c, e, row[2]);
    EXPECT_NEAR(b / row[1], 1, row[0] > 1 ? 0.003 : 0.01) << row[0];
    EXPECT_NEAR(e / row[2], 1, row[0] > 1 ? 0.003 : 0.01) << row[0];
  }
}

TEST(Report, SnapClip) {
  const double rows[][2] = {{0.5, 2.589},   {1, 4.361},   {2, 6.170},   {3, 6.534},  {4, 5.965},
                            {5, 4.630},     {6, 2.899},   {7, 0.795},   {8, -1.467}, {10, -5.719},
                            {11.5, -7.351}, {12, -7.232}, {13, -5.505}, {14, -0.944}};
  ClipOnTube coarse(1e-3), fine(0.5e-3);
  const ArmSeries arm = bake_clip_arm(0.5e-3);
  const Point<2> rest = {kClipTipCentreRadius_m * std::cos(kClipArmEnd_rad),
                         kClipTipCentreRadius_m * std::sin(kClipArmEnd_rad)};
  add("\n### F: snap clip on a tube, plane stress\n| insertion, mm | 1 mm "
      "elements, N | 0.5 mm elements, N | published, N | arm series, N | "
      "energy, mJ |\n|---|---|---|---|---|---|\n");
  for (const auto& row : rows) {
    const ClipOnTube::State a = coarse.insert(1e-3 * row[0]), b = fine.insert(1e-3 * row[0]);
    const Point<2> force = arm_force_from_disc_N(arm, rest, {0, clip_first_contact_m() - 1e-3 * row[0]},
                                                 kClipTubeRadius_m + kClipTipRadius_m);
    add("| %.1f | %.3f | %.3f | %.3f | %.3f | %.2f |\n", row[0], a.force_N, b.force_N, row[1], -2 * force[1],
        1e3 * b.energy_J);
    EXPECT_NEAR(b.force_N, row[1], 0.08) << row[0];  // the tip touches from one contact point to the next: 0.05 N
                                                     // more
    EXPECT_NEAR(-2 * force[1], row[1], 0.02 * 7.35) << row[0];
  }
}

constexpr int kCylinderDepths = 8;  // 1 to 8 mm

std::vector<LoadPoint> press_cylinder(double element_m, int fine_count, StrainLaw law) {
  HollowCylinder cylinder(element_m, fine_count, law);
  std::vector<LoadPoint> path;
  for (int i = 1; i <= kCylinderDepths; ++i) path.push_back({1e-3 * i, cylinder.force_N(1e-3 * i)});
  return path;
}

// The law of the tick, c0 from the linear and c1 from the large-strain press to 5 mm, over the whole path.
void expect_law_of_cylinder(const std::vector<LoadPoint>& large, const LoadPoint& linear) {
  const double modulus = 3e6 / (1 - 0.45 * 0.45), radius = 1 / std::sqrt((1 / 0.008 + 1 / 0.03) / 0.008);
  const SeriesCoefficients c = fit_series(hertz(modulus, radius), linear, large[4], 60);
  const RunTimeLaw law(TipProfile::kParabola, radius, modulus, 4e-3, c);
  double largest = 0;
  for (const LoadPoint& p : large) largest = std::max(largest, std::abs(law.force_N(p.depth_m) / p.force_N - 1));
  add("\nc0 = %.4g mm/N, c1 = %.4g mm/N^2, both from 5 mm: largest error of the tick's law %.2f %%.\n",
      1e3 * c.c0_m_per_N, 1e3 * c.c1_m_per_N2, 100 * largest);
  EXPECT_LT(largest, 0.02);
}

TEST(Report, HollowCylinderInSpace) {
  const auto large = press_cylinder(2.2e-3, 3, StrainLaw::kNeoHookean),
             linear = press_cylinder(2.2e-3, 3, StrainLaw::kLinear);
  add("\n### E: hollow cylinder between two spherical fingers, in space\n| depth per finger, mm | large strain, 168 "
      "elements, N | linear, N |\n|---|---|---|\n");
  for (std::size_t i = 0; i < large.size(); ++i)
    add("| %.0f | %.3f | %.3f |\n", 1e3 * large[i].depth_m, large[i].force_N, linear[i].force_N);
  expect_law_of_cylinder(large, linear[4]);
}

TEST(LongReport, HollowCylinderInSpaceOnTwoMeshes) {
  const auto coarse = press_cylinder(2.2e-3, 3, StrainLaw::kNeoHookean),
             fine = press_cylinder(1.6e-3, 4, StrainLaw::kNeoHookean);
  add("\n| depth per finger, mm | large strain, 168 elements, N | 320 elements, N |\n|---|---|---|\n");
  for (std::size_t i = 0; i < fine.size(); ++i) {
    add("| %.0f | %.3f | %.3f |\n", 1e3 * fine[i].depth_m, coarse[i].force_N, fine[i].force_N);
    EXPECT_NEAR(coarse[i].force_N / fine[i].force_N, 1, 0.03) << i;
  }
  HollowCylinder linear(1.6e-3, 4, StrainLaw::kLinear);
  expect_law_of_cylinder(fine, {5e-3, linear.force_N(5e-3)});
}

// An ellipsoid with half axes x, y (pressed), z, fixed below a height, under a sphere of 10 mm; a quarter in space. The
// cube [0, 1] x [-1, 1] x [0, 1] is carried to the ball by x sqrt(1 - y^2/2 - z^2/2 + y^2 z^2/3) and its like.
struct PressedEllipsoid {
  PressedEllipsoid(const Point<3>& half_m, double fixed_below_m, double element_m, int fine_count)
      : top_m(half_m[1]), solver(make_solver(half_m, fixed_below_m, make_mesh(half_m, element_m, fine_count))) {}
  static StrainMesh<3> make_mesh(const Point<3>& half_m, double element_m, int fine) {
    // At the middle of the cube's face the map shrinks lengths by sqrt(1/2).
    const double x = element_m / (half_m[0] * std::sqrt(0.5)), z = element_m / (half_m[2] * std::sqrt(0.5));
    std::vector<double> heights = graded_steps(1, 1 - 2 * element_m / half_m[1], -1, 2, 1.6);
    std::reverse(heights.begin(), heights.end());
    const auto cube = [](double s, double t) { return Point<2>{s, t}; };
    StrainMesh<3> mesh = sweep(make_plane_mesh({{graded_steps(0, fine * x, 1, fine, 1.6), heights, cube}}, 1e-9),
                               graded_steps(0, fine * z, 1, fine, 1.6));
    for (Point<3>& p : mesh.nodes_m) {
      const Point<3> q = p;
      for (std::size_t i = 0; i < 3; ++i) {
        const double a = q[(i + 1) % 3] * q[(i + 1) % 3], b = q[(i + 2) % 3] * q[(i + 2) % 3];
        p[i] = half_m[i] * q[i] * std::sqrt(1 - a / 2 - b / 2 + a * b / 3);
      }
    }
    return mesh;
  }
  static LargeStrainSolver<3> make_solver(const Point<3>& half_m, double fixed_below_m, const StrainMesh<3>& mesh) {
    const auto on_surface = [&](const Point<3>& p) {
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += p[i] * p[i] / (half_m[i] * half_m[i]);
      return sum > 1 - 1e-6;
    };
    std::vector<bool> fixed;
    for (const Point<3>& p : mesh.nodes_m) {
      const bool held = on_surface(p) && p[1] < fixed_below_m + 1e-5;
      for (const std::size_t i : {0u, 1u, 2u}) fixed.push_back(held || (i != 1 && p[i] < 1e-9));
    }
    const auto top = nodes_where<3>(
        mesh, [&](const Point<3>& p) { return on_surface(p) && p[1] > 0 && std::hypot(p[0], p[2]) < 0.014; });
    StrainBody body;
    body.youngs_modulus_Pa = 3e6;
    body.poisson_ratio = 0.45;
    body.kinematics = Kinematics::kSolid;
    LargeStrainSolver<3> solver(mesh, body, fixed, top, {ball(0.01)});
    solver.place_tools({{0, half_m[1] + 0.01, 0}});
    return solver;
  }
  double force_N(double depth_m) {
    const PressState<3> state = solver.move_tools({{0, top_m + 0.01 - depth_m, 0}});
    EXPECT_TRUE(state.converged) << depth_m;
    return 4 * state.force_on_tool_N[0][1];
  }
  double top_m;
  LargeStrainSolver<3> solver;
};

// The body of revolution is C1 again: what the mesh in space is worth.
TEST(LongReport, EllipsoidsInSpace) {
  PressedEllipsoid round({0.04, 0.03, 0.04}, -0.024, 2.5e-3, 4), coarse({0.04, 0.025, 0.03}, -0.02, 3e-3, 3),
      fine({0.04, 0.025, 0.03}, -0.02, 2.5e-3, 4);
  add("\n### Ellipsoids in space\n| depth, mm | C1, N | published, N | 40 x 25 x 30 mm, 3 mm elements, N | 2.5 mm, N "
      "|\n|---|---|---|---|---|\n");
  for (const Row& row : kEllipsoid) {
    const double d = 1e-3 * row.depth_mm, a = round.force_N(d), b = coarse.force_N(d), c = fine.force_N(d);
    add("| %.0f | %.3f | %.3f | %.3f | %.3f |\n", row.depth_mm, a, row.force_N, b, c);
    EXPECT_NEAR(a / row.force_N, 1, 0.01) << row.depth_mm;
    EXPECT_NEAR(b / c, 1, 0.02) << row.depth_mm;
  }
}

// F-like: the clip's thin arms, spread at their tips by a face as far as the tube opens them.
TEST(Report, SpreadClip) {
  const double modulus = 2e9 / (1 - 0.35 * 0.35), range = 0.2e-3;
  const RunTimeLaw local(TipProfile::kSphere, kClipTipRadius_m, modulus, range);
  add("\n### Clip spread at its tips\n| travel, mm | 1 mm elements, N | 0.5 mm elements, N | law of the tick, N "
      "|\n|---|---|---|---|\n");
  ClipSpread coarse(1e-3), fine(0.5e-3);
  std::vector<LoadPoint> path;
  std::vector<double> rough;
  for (const double d : {0.26, 0.4, 0.65, 1.0, 1.3, 1.6, 1.95, 2.3, 2.6}) {
    path.push_back({1e-3 * d, fine.force_N(1e-3 * d)});
    rough.push_back(coarse.force_N(1e-3 * d));
  }
  const SeriesCoefficients c = fit_series(local.local_depth(), {path[2], path[4], path[6], path[8]}, path[8].force_N);
  const RunTimeLaw law(TipProfile::kSphere, kClipTipRadius_m, modulus, range, c);
  for (std::size_t i = 0; i < path.size(); ++i) {
    add("| %.2f | %.4f | %.4f | %.4f |\n", 1e3 * path[i].depth_m, rough[i], path[i].force_N,
        law.force_N(path[i].depth_m));
    EXPECT_NEAR(rough[i] / path[i].force_N, 1, 0.015) << path[i].depth_m;
    EXPECT_NEAR(law.force_N(path[i].depth_m) / path[i].force_N, 1, 0.02) << path[i].depth_m;
  }
}

TEST(Report, SeriesLaw) {
  add("\n### Series law against the published large-strain forces\n| scene | "
      "c0, mm/N | c1, mm/N^2 | largest error over the path |\n|---|---|---|---|\n");
  const DepthOfForce block = hertz(3.45e6, 6.35e-3),
                     body = hertz(3e6 / (1 - 0.45 * 0.45), 1 / (1 / 0.01 + 0.03 / (0.04 * 0.04)));
  series_errors(
      "A", block,
      bake_series(rubber_block(), ball(6.35e-3), block, 3e-3, default_meshing(rubber_block(), ball(6.35e-3), 3e-3, 12))
          .coefficients,
      kBlock);
  series_errors(
      "C1", body,
      bake_series(ellipsoid(), ball(0.01), body, 8e-3, default_meshing(ellipsoid(), ball(0.01), 8e-3, 10)).coefficients,
      kEllipsoid);
  const DepthOfForce none = [](double) { return 0.0; };
  RingBetweenPlates linear(24, Kinematics::kPlaneStress, StrainLaw::kLinear),
      large(24, Kinematics::kPlaneStress, StrainLaw::kNeoHookean);
  const SeriesCoefficients ring = fit_series(none, {2e-3, linear.force_N(2e-3)}, {8e-3, large.force_N(8e-3)}, 12);
  series_errors("D, plane stress, no local law", none, ring, {{4, 3.1874}, {8, 6.0475}, {12, 8.6689}, {16, 11.258}});
}

// Two discs 16 mm apart on a plane-strain block of 80 x 30 mm, large strain.
struct DiscsOnBlock {
  static constexpr double kRadius_m = 6e-3, kHalf_m = 8e-3;
  DiscsOnBlock() : mesh(make_mesh()), solver(make_solver(mesh)) {}
  static StrainMesh<2> make_mesh() {
    std::vector<double> across;
    const auto half = graded_steps(0, kHalf_m + 4e-3, 0.04, 12, 1.3), down = graded_steps(0, 5e-3, 0.03, 5, 1.3);
    for (std::size_t i = half.size(); i-- > 1;) across.push_back(-half[i]);
    across.insert(across.end(), half.begin(), half.end());
    std::vector<double> heights;
    for (std::size_t i = down.size(); i-- > 0;) heights.push_back(-down[i]);
    return make_plane_mesh({{across, heights, [](double s, double t) { return Point<2>{s, t}; }}}, 1e-9);
  }
  static LargeStrainSolver<2> make_solver(const StrainMesh<2>& mesh) {
    std::vector<bool> fixed;
    for (const Point<2>& p : mesh.nodes_m) fixed.insert(fixed.end(), 2, p[1] < -0.03 + 1e-9);
    const auto top = nodes_where<2>(mesh, [](const Point<2>& p) { return p[1] > -1e-9 && std::abs(p[0]) < 0.014; });
    StrainBody body;
    body.youngs_modulus_Pa = 1e5;
    body.poisson_ratio = 0.45;
    body.kinematics = Kinematics::kPlaneStrain;
    body.thickness_m = 0.01;
    LargeStrainSolver<2> solver(mesh, body, fixed, top, {ball(kRadius_m), ball(kRadius_m)});
    solver.place_tools({{-kHalf_m, kRadius_m}, {kHalf_m, kRadius_m}});
    return solver;
  }
  PressState<2> press(double first_m, double second_m) {
    const PressState<2> s = solver.move_tools({{-kHalf_m, kRadius_m - first_m}, {kHalf_m, kRadius_m - second_m}});
    EXPECT_TRUE(s.converged) << first_m << " " << second_m;
    return s;
  }
  StrainMesh<2> mesh;
  LargeStrainSolver<2> solver;
};

// What "auto" in contact.pair does: c and h from presses of one disc, held against states of both.
TEST(Report, PairFromPressesOfOne) {
  constexpr double kAway_m = -0.02;
  DiscsOnBlock one;
  std::vector<LoadPoint> table, touch;
  for (int i = 1; i <= 18; ++i) {
    const double d = 0.25e-3 * i;
    const PressState<2> s = one.press(d, kAway_m);
    table.push_back({d, s.force_on_tool_N[0][1]});
    if (i % 4 == 0)
      touch.push_back({touch_depth_m(top_line(one.mesh, s.u_m), ball(DiscsOnBlock::kRadius_m), DiscsOnBlock::kHalf_m),
                       table.back().force_N});
  }
  const TouchFit fit = fit_touch(touch);
  const DepthOfForce depth = depth_table(table);
  double wrong[2] = {}, whole = 0;
  for (const double second : {1e-3, 3e-3}) {
    DiscsOnBlock both;
    both.press(kAway_m, second);
    for (const double first : {1e-3, 2e-3, 4e-3}) {
      const PressState<2> s = both.press(first, second);
      const double f = s.force_on_tool_N[0][1], g = s.force_on_tool_N[1][1];
      const PairCoupling law[2] = {{}, {fit.c_m_per_N, fit.h_m_per_N2, fit.h_m_per_N2}};
      for (int k = 0; k < 2; ++k) {
        const PairState p = solve_pair(depth, depth, law[k], first, second);
        wrong[k] += std::pow(p.first_N - f, 2) + std::pow(p.second_N - g, 2);
      }
      whole += f * f + g * g;
    }
  }
  add("\nTwo discs on a block: c = %.4f mm/N, h = %.5f mm/N^2 from presses of one; root mean square of the errors with "
      "both %.2f %%, uncoupled %.2f %%.\n",
      1e3 * fit.c_m_per_N, 1e3 * fit.h_m_per_N2, 100 * std::sqrt(wrong[1] / whole), 100 * std::sqrt(wrong[0] / whole));
  EXPECT_LT(std::sqrt(wrong[1] / whole), 0.02);
  EXPECT_LT(wrong[1], 0.25 * wrong[0]);
}

// Two meshes: 1 and 0.7 mm under the fingers. A grid to 3 mm: beyond 4 mm the ring sways sideways under the upper
// finger (a limit point), where no law of two forces holds.
TEST(Report, TwoFingersOnARing) {
  const FingerStudy s = study_two_fingers(1e-3, {0.75, 1.5, 2.25, 3}, 0.5),
                    fine = study_two_fingers(0.7e-3, {0.75, 1.5, 2.25, 3}, 0.5);
  add("\n### G2: two fingers on a ring\n| first, mm | second, mm | first, 1 mm elements, N | 0.7 mm, N | second, 1 mm "
      "elements, N | 0.7 mm, N |\n|---|---|---|---|---|---|\n");
  double apart = 0, whole = 0;
  for (std::size_t i = 0; i < s.states.size(); ++i) {
    const PairState &p = s.states[i], &q = fine.states[i];
    add("| %.2f | %.2f | %.3f | %.3f | %.3f | %.3f |\n", 1e3 * p.first_m, 1e3 * p.second_m, p.first_N, q.first_N,
        p.second_N, q.second_N);
    apart += std::pow(p.first_N - q.first_N, 2) + std::pow(p.second_N - q.second_N, 2);
    whole += std::pow(q.first_N, 2) + std::pow(q.second_N, 2);
  }
  add("\nRoot mean square of the forces' differences between the meshes: %.2f %% of that of the forces.\n",
      100 * std::sqrt(apart / whole));
  EXPECT_LT(std::sqrt(apart / whole), 0.01);
  for (const FingerStudy* study : {&s, &fine}) {
    add("\nc = %.4f mm/N, h12 = %.4f, h21 = %.4f mm/N^2. Error of the other 21: linear law %.1f %%, uncoupled tables "
        "%.1f %%, tables with c %.1f %%, second order %.1f %%.\n",
        1e3 * study->coupling.c_m_per_N, 1e3 * study->coupling.h12_m_per_N2, 1e3 * study->coupling.h21_m_per_N2,
        100 * study->linear.held_out_rms, 100 * study->uncoupled.held_out_rms, 100 * study->first_order.held_out_rms,
        100 * study->second_order.held_out_rms);
    EXPECT_EQ(study->states.size(), 24u);
    EXPECT_LT(study->second_order.held_out_rms, 0.06);
    EXPECT_LT(study->second_order.held_out_rms, study->uncoupled.held_out_rms);
  }
}

}  // namespace
}  // namespace palpate::fem
