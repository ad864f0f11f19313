#include "tests/strain/plane_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::fem {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kInner_m = 0.020, kOuter_m = 0.030, kFingerRadius_m = 0.008;
constexpr double kFingerAngle_rad[2] = {90 * kDegree, 20 * kDegree};

StrainBody ring_material(Kinematics kinematics, StrainLaw law) {
  StrainBody body;
  body.youngs_modulus_Pa = 3e6;
  body.poisson_ratio = 0.45;
  body.kinematics = kinematics;
  body.thickness_m = 0.01;
  body.law = law;
  return body;
}

Point<2> polar(double r, double angle) { return {r * std::cos(angle), r * std::sin(angle)}; }
double radius_of(const Point<2>& p) { return std::hypot(p[0], p[1]); }
double angle_of(const Point<2>& p) { return std::atan2(p[1], p[0]); }

LargeStrainSolver<2> ring_between_plates(int elements, Kinematics kinematics, StrainLaw law) {
  const StrainMesh<2> mesh = make_plane_mesh({{uniform_steps(kInner_m, kOuter_m, std::max(3, elements / 4)),
                                               uniform_steps(0, std::numbers::pi / 2, elements), polar}},
                                             1e-8);
  std::vector<bool> fixed;
  for (const Point<2>& p : mesh.nodes_m) {
    fixed.push_back(p[0] < 1e-9);
    fixed.push_back(p[1] < 1e-9);
  }
  RigidTool plate;
  plate.shape = RigidShape::kPlane;
  plate.axis = {0, -1, 0};
  const auto outer =
      nodes_where<2>(mesh, [](const Point<2>& p) { return radius_of(p) > kOuter_m - 1e-9 && p[1] > 0.01; });
  LargeStrainSolver<2> solver(mesh, ring_material(kinematics, law), fixed, outer, {plate});
  solver.place_tools({{0, kOuter_m}});
  return solver;
}

LargeStrainSolver<2> clip_on_tube(double element_m) {
  const ClipMesh clip = clip_mesh(element_m);
  LargeStrainSolver<2> solver(clip.mesh, clip_material(), clip.fixed, clip.contact_nodes, {ball(kClipTubeRadius_m)});
  solver.place_tools({{0, clip_first_contact_m()}});
  return solver;
}

double clip_tip_face_m() { return kClipTipCentreRadius_m * std::cos(kClipArmEnd_rad) - kClipTipRadius_m; }

LargeStrainSolver<2> clip_spread(double element_m) {
  const ClipMesh clip = clip_mesh(element_m);
  RigidTool face;
  face.shape = RigidShape::kPlane;
  face.axis = {1, 0, 0};
  LargeStrainSolver<2> solver(clip.mesh, clip_material(), clip.fixed, clip.contact_nodes, {face});
  solver.place_tools({{clip_tip_face_m(), 0}});
  return solver;
}

// Edges from `from` to `to`, fine at the ends that are fingers, none longer
// than 5 degrees.
std::vector<double> arc_steps(double from, bool finger_from, double to, bool finger_to, double step) {
  std::vector<double> ends[2];
  const bool finger[2] = {finger_from, finger_to};
  const double half = 0.5 * (to - from);
  for (int k = 0; k < 2; ++k) {
    const int fine = std::max(2, static_cast<int>(std::lround(6 * kDegree / step)));
    const std::vector<double> graded =
        finger[k] ? graded_steps(0, std::min(half, fine * step), half, fine, 1.3) : uniform_steps(0, half, 1);
    ends[k] = {0};
    for (std::size_t i = 1; i < graded.size(); ++i) {
      const int pieces = static_cast<int>(std::ceil((graded[i] - graded[i - 1]) / (5 * kDegree)));
      for (int p = 1; p <= pieces; ++p) ends[k].push_back(graded[i - 1] + (graded[i] - graded[i - 1]) * p / pieces);
    }
  }
  std::vector<double> edges;
  for (const double x : ends[0]) edges.push_back(from + x);
  for (auto x = ends[1].rbegin() + 1; x != ends[1].rend(); ++x) edges.push_back(to - *x);
  return edges;
}

// Over one turn, with edges at both ends of the clamp: its length decides how
// much the ring sways.
std::vector<double> turn_with_fingers(double step) {
  const double stops[] = {kFingerAngle_rad[1], kFingerAngle_rad[0], 245 * kDegree, 295 * kDegree, 380 * kDegree};
  const bool finger[] = {true, true, false, false, true};
  std::vector<double> edges = {stops[0]};
  for (int k = 0; k < 4; ++k) {
    const std::vector<double> arc = arc_steps(stops[k], finger[k], stops[k + 1], finger[k + 1], step);
    edges.insert(edges.end(), arc.begin() + 1, arc.end());
  }
  return edges;
}

StrainMesh<2> ring_under_fingers_mesh(double step_m) {
  std::vector<double> shells = graded_steps(kOuter_m, kOuter_m - 4 * step_m, kInner_m, 4, 1.4);
  std::reverse(shells.begin(), shells.end());
  return make_plane_mesh({{shells, turn_with_fingers(step_m / kOuter_m), polar}}, 1e-8);
}

LargeStrainSolver<2> ring_under_fingers(const StrainMesh<2>& mesh, StrainLaw law) {
  std::vector<bool> fixed;
  for (const Point<2>& p : mesh.nodes_m) {
    const bool held = radius_of(p) > kOuter_m - 1e-9 && std::abs(angle_of(p) + 90 * kDegree) < (25 + 1e-6) * kDegree;
    fixed.push_back(held);
    fixed.push_back(held);
  }
  std::vector<RigidTool> fingers;
  std::vector<Point<2>> origin;
  for (const double angle : kFingerAngle_rad) {
    fingers.push_back(ball(kFingerRadius_m));
    fingers.back().press = {-std::cos(angle), -std::sin(angle), 0};
    origin.push_back(polar(kOuter_m + kFingerRadius_m, angle));
  }
  const auto near_finger = nodes_where<2>(mesh, [](const Point<2>& p) {
    const double a = angle_of(p);
    return radius_of(p) > kOuter_m - 1e-9 &&
           (std::abs(a - kFingerAngle_rad[0]) < 16 * kDegree || std::abs(a - kFingerAngle_rad[1]) < 16 * kDegree);
  });
  LargeStrainSolver<2> solver(mesh, ring_material(Kinematics::kPlaneStrain, law), fixed, near_finger, fingers);
  solver.place_tools(origin);
  return solver;
}

LargeStrainSolver<3> hollow_cylinder(double step_m, int fine, StrainLaw law) {
  const double up = 90 * kDegree;
  std::vector<double> turns = graded_steps(up, up - fine * step_m / kOuter_m, 0, fine, 1.6);
  std::vector<double> shells = graded_steps(kOuter_m, kOuter_m - step_m, kInner_m, 1, 1.5);
  std::reverse(turns.begin(), turns.end());
  std::reverse(shells.begin(), shells.end());
  const StrainMesh<3> mesh =
      sweep(make_plane_mesh({{shells, turns, polar}}, 1e-8), graded_steps(0, fine * step_m, 0.03, fine, 1.6));
  std::vector<bool> fixed;
  for (const Point<3>& p : mesh.nodes_m)
    for (const double x : p) fixed.push_back(x < 1e-9);
  const auto near_finger = nodes_where<3>(mesh, [](const Point<3>& p) {
    return std::hypot(p[0], p[1]) > kOuter_m - 1e-9 && p[0] < 0.009 && p[1] > 0 && p[2] < 0.009;
  });
  const StrainBody body = ring_material(Kinematics::kSolid, law);
  LargeStrainSolver<3> solver(mesh, body, fixed, near_finger, {ball(kFingerRadius_m)});
  solver.place_tools({{0, kOuter_m + kFingerRadius_m, 0}});
  return solver;
}

}  // namespace

HollowCylinder::HollowCylinder(double contact_element_m, int fine_count, StrainLaw law)
    : solver(hollow_cylinder(contact_element_m, fine_count, law)) {}

double HollowCylinder::force_N(double depth_m) {
  const PressState<3> state = solver.move_tools({{0, kOuter_m + kFingerRadius_m - depth_m, 0}});
  EXPECT_TRUE(state.converged) << depth_m;
  return 4 * state.force_on_tool_N[0][1];
}

RingBetweenPlates::RingBetweenPlates(int quarter_elements, Kinematics kinematics, StrainLaw law)
    : solver(ring_between_plates(quarter_elements, kinematics, law)) {}

double RingBetweenPlates::force_N(double approach_m) {
  const PressState<2> state = solver.move_tools({{0, kOuter_m - 0.5 * approach_m}});
  EXPECT_TRUE(state.converged) << approach_m;
  return 2 * state.force_on_tool_N[0][1];
}

double clip_first_contact_m() {
  const Point<2> tip = polar(kClipTipCentreRadius_m, kClipArmEnd_rad);
  const double reach = kClipTubeRadius_m + kClipTipRadius_m;
  return tip[1] + std::sqrt(reach * reach - tip[0] * tip[0]);
}

StrainBody clip_material() {
  StrainBody body;
  body.youngs_modulus_Pa = 2e9;
  body.poisson_ratio = 0.35;
  body.kinematics = Kinematics::kPlaneStress;
  body.thickness_m = 0.01;
  return body;
}

ClipMesh clip_mesh(double element_m) {
  const double inner = kClipTubeRadius_m, outer = inner + 2 * kClipTipRadius_m, foot = -90 * kDegree,
               grip = -70 * kDegree;
  const int half = std::max(1, static_cast<int>(std::lround(kClipTipRadius_m / element_m)));
  const auto along = [&](double from, double to) {
    return uniform_steps(from, to,
                         std::max(2, static_cast<int>(std::lround((to - from) * kClipTipCentreRadius_m / element_m))));
  };
  const Point<2> tip = polar(kClipTipCentreRadius_m, kClipArmEnd_rad);
  const auto round_tip = [&](double r, double turn) {
    const Point<2> p = polar(r, kClipArmEnd_rad + turn);
    return Point<2>{tip[0] + p[0], tip[1] + p[1]};
  };
  // The tip slides on the tube: four times finer round it.
  const int turns = static_cast<int>(std::lround(std::numbers::pi * kClipTipRadius_m / (0.25 * element_m)));
  ClipMesh clip;
  clip.mesh = make_plane_mesh(
      {{uniform_steps(inner, outer, 2 * half), along(foot, grip), polar},
       {uniform_steps(inner, outer, 2 * half), along(grip, kClipArmEnd_rad), polar},
       {uniform_steps(0, kClipTipRadius_m, half), uniform_steps(0, std::numbers::pi, turns), round_tip}},
      1e-8);
  for (const Point<2>& p : clip.mesh.nodes_m) {
    const bool held = radius_of(p) > outer - 1e-9 && angle_of(p) < grip + 1e-9 && p[0] > -1e-9 && p[1] < 0;
    clip.fixed.push_back(held || p[0] < 1e-9);
    clip.fixed.push_back(held);
  }
  clip.contact_nodes = nodes_where<2>(clip.mesh, [&](const Point<2>& p) {
    const bool arm = radius_of(p) < inner + 1e-9;
    const double to_tip = std::hypot(p[0] - tip[0], p[1] - tip[1]);
    return (arm && p[1] > 0) || (std::abs(to_tip - kClipTipRadius_m) < 1e-9 && radius_of(p) < outer - 1e-9);
  });
  clip.tip_node =
      nodes_where<2>(clip.mesh, [&](const Point<2>& p) { return std::hypot(p[0] - tip[0], p[1] - tip[1]) < 1e-9; })[0];
  return clip;
}

ClipOnTube::ClipOnTube(double element_m) : solver(clip_on_tube(element_m)) {}

ClipOnTube::State ClipOnTube::insert(double insertion_m) {
  const PressState<2> state = solver.move_tools({{0, clip_first_contact_m() - insertion_m}});
  EXPECT_TRUE(state.converged) << insertion_m;
  return {2 * state.force_on_tool_N[0][1], 2 * state.energy_J};
}

ClipSpread::ClipSpread(double element_m) : solver(clip_spread(element_m)) {}

double ClipSpread::force_N(double travel_m) {
  const PressState<2> state = solver.move_tools({{clip_tip_face_m() + travel_m, 0}});
  EXPECT_TRUE(state.converged) << travel_m;
  return -state.force_on_tool_N[0][0];
}

RingUnderFingers::RingUnderFingers(double contact_element_m, StrainLaw law)
    : mesh(ring_under_fingers_mesh(contact_element_m)), solver(ring_under_fingers(mesh, law)) {}

double RingUnderFingers::compliance_at_second_m_per_N(double first_m) {
  const double reach = kOuter_m + kFingerRadius_m;
  const PressState<2> state =
      solver.move_tools({polar(reach - first_m, kFingerAngle_rad[0]), polar(reach + kOuter_m, kFingerAngle_rad[1])});
  const Point<2> at = polar(kOuter_m, kFingerAngle_rad[1]), in = polar(-1, kFingerAngle_rad[1]);
  const int node =
      nodes_where<2>(mesh, [&](const Point<2>& p) { return std::hypot(p[0] - at[0], p[1] - at[1]) < 1e-8; })[0];
  const std::size_t dof = 2 * static_cast<std::size_t>(node);
  return (in[0] * state.u_m[dof] + in[1] * state.u_m[dof + 1]) / state.force_on_tool_N[0][1];
}

RingUnderFingers::Forces RingUnderFingers::press(double first_m, double second_m) {
  const double reach = kOuter_m + kFingerRadius_m;
  const PressState<2> state =
      solver.move_tools({polar(reach - first_m, kFingerAngle_rad[0]), polar(reach - second_m, kFingerAngle_rad[1])});
  EXPECT_TRUE(state.converged) << first_m << " " << second_m;
  const auto radial = [&](int k) {
    const Point<2> out = polar(1, kFingerAngle_rad[k]), f = state.force_on_tool_N[static_cast<std::size_t>(k)];
    return out[0] * f[0] + out[1] * f[1];
  };
  return {radial(0), radial(1), state.energy_J};
}

ArmSeries bake_clip_arm(double element_m) {
  const ClipMesh clip = clip_mesh(element_m);
  const std::size_t tip = 2 * static_cast<std::size_t>(clip.tip_node);
  const auto push = [&](StrainLaw law, const Point<2>& force) {
    StrainBody body = clip_material();
    body.law = law;
    LargeStrainSolver<2> solver(clip.mesh, body, clip.fixed, {}, {});
    std::vector<double> load(clip.fixed.size());
    load[tip] = force[0];
    load[tip + 1] = force[1];
    const PressState<2> state = solver.load(load, {});
    EXPECT_TRUE(state.converged);
    return ArmState{force, {state.u_m[tip], state.u_m[tip + 1]}};
  };
  // Half the peak load downwards, all of it nearly level: the directions the
  // tube's normal sweeps.
  return fit_arm(
      push(StrainLaw::kLinear, {1, 0}), push(StrainLaw::kLinear, {0, 1}),
      {push(StrainLaw::kNeoHookean, polar(5, -40 * kDegree)), push(StrainLaw::kNeoHookean, polar(10, 10 * kDegree))});
}

namespace {

DepthOfForce single_finger(int finger, double element_m, StrainLaw law, double largest_mm, double step_mm) {
  RingUnderFingers ring(element_m, law);
  std::vector<LoadPoint> points;
  const double away = -5e-3;
  for (double d = 0.5 * step_mm; d < 1.35 * largest_mm; d += step_mm) {
    const auto f = finger == 0 ? ring.press(1e-3 * d, away) : ring.press(away, 1e-3 * d);
    points.push_back({1e-3 * d, finger == 0 ? f.first_N : f.second_N});
  }
  return depth_table(points);
}

bool same(const PairState& a, const PairState& b) { return a.first_m == b.first_m && a.second_m == b.second_m; }

FingerError error_of(const std::vector<PairState>& states, const std::vector<PairState>& fitted,
                     const DepthOfForce& first, const DepthOfForce& second, const PairCoupling& coupling) {
  double wrong = 0, whole = 0;
  for (const PairState& s : states) {
    if (std::any_of(fitted.begin(), fitted.end(), [&](const PairState& f) { return same(f, s); })) continue;
    const PairState p = solve_pair(first, second, coupling, s.first_m, s.second_m);
    wrong += std::pow(p.first_N - s.first_N, 2) + std::pow(p.second_N - s.second_N, 2);
    whole += std::pow(s.first_N, 2) + std::pow(s.second_N, 2);
  }
  return {std::sqrt(wrong / whole)};
}

}  // namespace

FingerStudy study_two_fingers(double element_m, const std::vector<double>& depths_mm, double table_step_mm) {
  FingerStudy study;
  const double top = 1e-3 * depths_mm.back(), least = 1e-3 * depths_mm.front();
  std::vector<double> depths = {0};
  for (const double d : depths_mm) depths.push_back(1e-3 * d);
  std::vector<PairState> fitted;
  for (const double second : depths) {
    RingUnderFingers ring(element_m, StrainLaw::kNeoHookean);
    if (second > 0) ring.press(0, second);
    for (const double first : depths) {
      if (!(first + second > 0)) continue;
      const auto f = ring.press(first, second);
      study.states.push_back({first, second, f.first_N, f.second_N});
      if ((first == top && second == least) || (first == least && second == top) || (first == top && second == top))
        fitted.push_back(study.states.back());
    }
  }
  const auto tables = [&](StrainLaw law, double range) {
    return std::array{single_finger(0, element_m, law, range * depths_mm.back(), table_step_mm),
                      single_finger(1, element_m, law, range * depths_mm.back(), table_step_mm)};
  };
  const auto small = tables(StrainLaw::kLinear, 1.5), large = tables(StrainLaw::kNeoHookean, 1);
  RingUnderFingers ring(element_m, StrainLaw::kLinear);
  const double c = ring.compliance_at_second_m_per_N(0.25 * top);
  study.coupling = fit_pair(c, large[0], large[1], fitted);
  PairCoupling straight = study.coupling;
  straight.h12_m_per_N2 = straight.h21_m_per_N2 = 0;
  study.linear = error_of(study.states, fitted, small[0], small[1], straight);
  study.uncoupled = error_of(study.states, fitted, large[0], large[1], {});
  study.first_order = error_of(study.states, fitted, large[0], large[1], straight);
  study.second_order = error_of(study.states, fitted, large[0], large[1], study.coupling);
  return study;
}

}  // namespace palpate::fem
