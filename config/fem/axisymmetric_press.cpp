#include "config/fem/axisymmetric_press.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "config/scene/config_error.h"

namespace palpate::fem {

namespace {

constexpr double kHalfTurn = std::numbers::pi;

void check_positive(const char* name, double value) {
  if (!(value > 0)) throw ConfigError(std::string("press: ") + name + " must be above 0, got " + std::to_string(value));
}

void check_input(const PressBody& body, const RigidTool& tool, const std::vector<double>& depths_m) {
  check_positive("body.outer_radius_m", body.outer_radius_m);
  check_positive("body.height_m", body.height_m);
  if (tool.shape == RigidShape::kBall || tool.shape == RigidShape::kPunch)
    check_positive("tool.radius_m", tool.radius_m);
  if (tool.shape == RigidShape::kPunch && !(tool.fillet_m > 0 && tool.fillet_m < tool.radius_m))
    throw ConfigError(
        "press: a punch needs an edge fillet above 0 and below its radius: a sharp edge has no finite stress");
  if (tool.shape == RigidShape::kCone && !(tool.half_apex_rad > 0.05 && tool.half_apex_rad < 1.55 && tool.fillet_m > 0))
    throw ConfigError("press: a cone needs a half apex angle in (0.05, 1.55) rad and a tip fillet above 0");
  double last = 0;
  for (const double d : depths_m) {
    if (!(d > last)) throw ConfigError("press: depths must rise from above 0");
    last = d;
  }
}

std::vector<double> reversed(std::vector<double> edges) {
  std::reverse(edges.begin(), edges.end());
  return edges;
}

StrainMesh<2> block_mesh(const PressBody& body, const PressMeshing& m) {
  const auto steps = [&](double length) {
    const double fine = std::min(m.fine_extent_m, length);
    const int count = std::max(2, static_cast<int>(std::lround(m.fine_count * fine / m.fine_extent_m)));
    return graded_steps(0, fine, length, count, m.growth);
  };
  std::vector<double> heights = reversed(steps(body.height_m));
  for (double& h : heights) h = -h;
  const GridPatch patch = {steps(body.outer_radius_m), heights, [](double s, double t) { return Point<2>{s, t}; }};
  return make_plane_mesh({patch}, 1e-7 * body.height_m);
}

// What is held does not move: the body ends at its support's plane. Rays from a point on the axis, the ellipse's centre
// unless that is held or nearly so: the elements there collapse to triangles. An element edge meets the support's rim.
StrainMesh<2> ellipsoid_mesh(const PressBody& body, const PressMeshing& m) {
  const double a = body.outer_radius_m, c = body.height_m, base = body.fixed_below_m;
  const double origin = base < -0.1 * c ? 0 : 0.5 * (c + base);
  std::vector<double> shells = graded_steps(1, 1 - m.fine_extent_m / (c - origin), 0, m.fine_count, m.growth);
  std::vector<double> turns = graded_steps(0, m.fine_extent_m / a, kHalfTurn, m.fine_count, m.growth);
  // 10 degrees is the coarsest that follows the ellipse.
  std::vector<double> angles = {turns[0]};
  for (std::size_t i = 1; i < turns.size(); ++i) {
    const int pieces = static_cast<int>(std::ceil((turns[i] - turns[i - 1]) / (kHalfTurn / 18)));
    for (int k = 1; k <= pieces; ++k) angles.push_back(turns[i - 1] + (turns[i] - turns[i - 1]) * k / pieces);
  }
  const double rim = kHalfTurn / 2 - std::asin(base / c);
  *std::min_element(angles.begin() + 1, angles.end() - 1,
                    [&](double x, double y) { return std::abs(x - rim) < std::abs(y - rim); }) = rim;
  for (double& angle : angles) angle = kHalfTurn / 2 - angle;
  const GridPatch patch = {reversed(shells), reversed(angles), [&](double s, double t) {
                             const double turn = kHalfTurn / 2 - t;
                             Point<2> edge{a * std::cos(t), c * std::sin(t)};
                             if (turn > rim) edge = {a * std::sin(rim) * (kHalfTurn - turn) / (kHalfTurn - rim), base};
                             return Point<2>{s * edge[0], -c + origin + s * (edge[1] - origin)};
                           }};
  return make_plane_mesh({patch}, 1e-7 * c);
}

bool on_surface(const PressBody& body, const Point<2>& p) {
  if (body.kind == PressBody::Kind::kBlock) return p[1] > -1e-9 * body.height_m;
  const double x = p[0] / body.outer_radius_m, y = (p[1] + body.height_m) / body.height_m;
  return x * x + y * y > 1 - 1e-3;
}

struct PressSetup {
  StrainMesh<2> mesh;
  std::vector<bool> fixed;
  std::vector<int> contact_nodes;
};

PressSetup set_up(const PressBody& body, const PressMeshing& meshing) {
  const bool block = body.kind == PressBody::Kind::kBlock;
  PressSetup s;
  s.mesh = block ? block_mesh(body, meshing) : ellipsoid_mesh(body, meshing);
  // The outermost shell's inner nodes must not count as surface: their distance from it is half the fine step or more.
  for (const Point<2>& p : s.mesh.nodes_m) {
    const bool held =
        block ? p[1] < -(1 - 1e-9) * body.height_m : p[1] + body.height_m < body.fixed_below_m + 1e-6 * body.height_m;
    const bool axis = p[0] < 1e-9 * body.outer_radius_m;
    s.fixed.push_back(axis || (held && !body.slip_base));
    s.fixed.push_back(held);
  }
  const double reach = 4 * meshing.fine_extent_m;
  s.contact_nodes =
      nodes_where<2>(s.mesh, [&](const Point<2>& p) { return on_surface(body, p) && p[0] < reach && p[1] > -reach; });
  return s;
}

}  // namespace

PressMeshing default_meshing(const PressBody& body, const RigidTool& tool, double depth_m, int fine_count) {
  PressMeshing m;
  m.fine_count = fine_count;
  double contact = tool.radius_m;
  if (tool.shape == RigidShape::kBall) {
    const double curvature =
        body.kind == PressBody::Kind::kEllipsoid ? body.height_m / (body.outer_radius_m * body.outer_radius_m) : 0;
    contact = std::sqrt(depth_m / (1 / tool.radius_m + curvature));
  } else if (tool.shape == RigidShape::kCone) {
    contact = depth_m * std::tan(tool.half_apex_rad) + tool.fillet_m;
  }
  m.fine_extent_m = std::min(1.25 * contact, 0.5 * std::min(body.outer_radius_m, body.height_m));
  return m;
}

PressCurve press_as_far_as_possible(const PressBody& body, const RigidTool& tool, StrainLaw law,
                                    const std::vector<double>& depths_m, const PressMeshing& meshing) {
  check_input(body, tool, depths_m);
  PressSetup s = set_up(body, meshing);
  StrainBody material;
  material.youngs_modulus_Pa = body.youngs_modulus_Pa;
  material.poisson_ratio = body.poisson_ratio;
  material.law = law;
  LargeStrainSolver<2> solver(s.mesh, material, s.fixed, s.contact_nodes, {tool});
  const double tip = tool.shape == RigidShape::kBall ? tool.radius_m : 0.0;
  solver.place_tools({{0, tip}});
  PressCurve curve;
  curve.mesh = s.mesh;
  for (const double depth : depths_m) {
    PressState<2> state = solver.move_tools({{0, tip - depth}});
    if (!state.converged) break;
    curve.points.push_back({depth, state.force_on_tool_N[0][1], state.energy_J, state.contact_radius_m,
                            state.newton_steps, std::move(state.u_m)});
  }
  return curve;
}

PressCurve press_axisymmetric(const PressBody& body, const RigidTool& tool, StrainLaw law,
                              const std::vector<double>& depths_m, const PressMeshing& meshing) {
  PressCurve curve = press_as_far_as_possible(body, tool, law, depths_m, meshing);
  if (const std::size_t done = curve.points.size(); done < depths_m.size())
    throw ConfigError("press: no equilibrium at depth " + std::to_string(1e3 * depths_m[done]) +
                      " mm (the last was at " + std::to_string(done == 0 ? 0.0 : 1e3 * depths_m[done - 1]) +
                      " mm): press less deep or refine the mesh");
  return curve;
}

}  // namespace palpate::fem
