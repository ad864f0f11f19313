#include "config/fem/tet_procedural.h"

#include <algorithm>
#include <cmath>

#include "config/index.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

void add_quad(PlaneMesh& plane, std::array<std::int32_t, 4> q, bool rising) {
  if (rising) {
    plane.triangle.push_back({q[0], q[1], q[2]});
    plane.triangle.push_back({q[0], q[2], q[3]});
  } else {
    plane.triangle.push_back({q[0], q[1], q[3]});
    plane.triangle.push_back({q[1], q[2], q[3]});
  }
}

double radius_of(Vec3 p) { return std::sqrt(p.x * p.x + p.y * p.y); }
bool is_near(double a, double b) { return std::abs(a - b) < 1e-9 * std::abs(b); }

// Moves the middles of edges whose two ends lie at one of the radii around (x, y) onto that circle.
Vec3 onto_circle(Vec3 middle_m, Vec3 end_a, Vec3 end_b, Vec3 centre_m, double radius_m) {
  const auto off = [&](Vec3 p) { return Vec3{p.x - centre_m.x, p.y - centre_m.y, 0}; };
  if (!is_near(norm(off(end_a)), radius_m) || !is_near(norm(off(end_b)), radius_m)) return middle_m;
  const Vec3 out = unit_or(off(middle_m), {});
  return {centre_m.x + radius_m * out.x, centre_m.y + radius_m * out.y, middle_m.z};
}

// The half of the clip with x >= 0. Angle from -y.
struct ClipHalf {
  const ClipShape& shape;
  std::vector<double> angle_rad;
  std::int32_t across, sectors;
  PlaneMesh plane;

  double middle_m() const { return shape.inner_m + 0.5 * shape.thickness_m; }
  std::int32_t node(std::size_t along, std::int32_t layer) const {
    return static_cast<std::int32_t>(along) * (across + 1) + layer;
  }
  void build() {
    for (const double a : angle_rad)
      for (std::int32_t j = 0; j <= across; ++j) {
        const double r = shape.inner_m + shape.thickness_m * j / across;
        plane.node_m.push_back({r * std::sin(a), -r * std::cos(a), 0});
      }
    for (std::int32_t j = 0; j <= across; ++j) plane.node_m[at(j)].x = 0;
    for (std::size_t i = 0; i + 1 < angle_rad.size(); ++i)
      for (std::int32_t j = 0; j < across; ++j)
        add_quad(plane, {node(i, j), node(i, j + 1), node(i + 1, j + 1), node(i + 1, j)}, (j < across / 2));
    build_tip();
  }
  // Rings of sectors around the middle of the arm's end.
  void build_tip() {
    const double a = angle_rad.back(), tip = 0.5 * shape.thickness_m;
    const Vec3 out{std::sin(a), -std::cos(a), 0}, on{std::cos(a), std::sin(a), 0}, centre = middle_m() * out;
    const std::size_t end = angle_rad.size() - 1;
    const std::int32_t rings = across / 2;
    std::vector<std::vector<std::int32_t>> ring(at(rings) + 1);
    for (std::int32_t k = 1; k <= rings; ++k)
      for (std::int32_t s = 0; s <= sectors; ++s) {
        if (s == 0 || s == sectors) {
          ring[at(k)].push_back(node(end, s == 0 ? rings - k : rings + k));
          continue;
        }
        const double psi = kPi * (static_cast<double>(s) / sectors - 0.5), rho = tip * k / rings;
        ring[at(k)].push_back(static_cast<std::int32_t>(plane.node_m.size()));
        plane.node_m.push_back(centre + rho * (std::cos(psi) * on + std::sin(psi) * out));
      }
    for (std::size_t s = 0; s < at(sectors); ++s) {
      plane.triangle.push_back({node(end, rings), ring[1][s + 1], ring[1][s]});
      for (std::size_t k = 1; k < at(rings); ++k)
        add_quad(plane, {ring[k][s], ring[k][s + 1], ring[k + 1][s + 1], ring[k + 1][s]}, 2 * at(sectors) > 4 * s);
    }
  }
};

// Appends the mirror image in x = 0; nodes on the plane are shared, and pairs keep their relative numbers, so that the
// extruded mesh is symmetric too.
void mirror_x(PlaneMesh& plane) {
  std::vector<std::int32_t> image(plane.node_m.size());
  const std::size_t nodes = plane.node_m.size(), triangles = plane.triangle.size();
  for (std::size_t i = 0; i < nodes; ++i) {
    const Vec3 p = plane.node_m[i];
    image[i] = static_cast<std::int32_t>(p.x == 0 ? i : plane.node_m.size());
    if (p.x != 0) plane.node_m.push_back({-p.x, p.y, p.z});
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    const Corners c = plane.triangle[t];
    plane.triangle.push_back({image[at(c[0])], image[at(c[2])], image[at(c[1])]});
  }
}

// Appends the mirror image of a mesh of corners in the plane where `axis` is zero; nodes on the plane are shared.
void mirror(TetMesh& mesh, double Vec3::*axis) {
  const std::size_t nodes = mesh.node_m.size(), tets = mesh.tet.size();
  std::vector<std::int32_t> image(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    Vec3 p = mesh.node_m[i];
    image[i] = static_cast<std::int32_t>(p.*axis == 0 ? i : mesh.node_m.size());
    if (p.*axis == 0) continue;
    p.*axis = -(p.*axis);
    mesh.node_m.push_back(p);
  }
  for (std::size_t t = 0; t < tets; ++t) {
    Tet tet = mesh.tet[t];
    for (std::size_t k = 0; k < 4; ++k) tet.node[k] = image[at(tet.node[k])];
    std::swap(tet.node[1], tet.node[2]);
    mesh.tet.push_back(tet);
  }
}

// Corners of boxes of six tetrahedra between the given planes; the diagonals of the faces across z lean towards x = 0.
TetMesh box_corners(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) {
  PlaneMesh plane;
  for (const double v : y)
    for (const double u : x) plane.node_m.push_back({u, v, 0});
  const auto columns = static_cast<std::int32_t>(x.size());
  const auto node = [&](std::size_t i, std::size_t j) {
    return static_cast<std::int32_t>(j) * columns + static_cast<std::int32_t>(i);
  };
  for (std::size_t j = 0; j + 1 < y.size(); ++j)
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
      add_quad(plane, {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}, x[i] < -1e-9 * x.back());
  return extrude(plane, z);
}

struct ClipLevel {
  std::int32_t foot, arm, across, sectors, along;
};
ClipLevel clip_level(std::int32_t level) {
  switch (level) {
    case 1:
      return {2, 9, 2, 3, 1};
    case 2:
      return {3, 13, 2, 4, 2};
    case 3:
      return {4, 18, 4, 6, 2};
    default:
      throw ConfigError("the clip's mesh level is " + std::to_string(level) + "; allowed 1 (coarse) to " +
                        std::to_string(kMostClipLevel));
  }
}

}  // namespace

std::vector<double> equal_steps(double from_m, double to_m, std::int32_t steps) {
  std::vector<double> out;
  for (std::int32_t k = 0; k <= steps; ++k) out.push_back(from_m + (to_m - from_m) * k / steps);
  return out;
}

TetMesh extrude(const PlaneMesh& plane, const std::vector<double>& height_m) {
  TetMesh mesh;
  const auto layer = static_cast<std::int32_t>(plane.node_m.size());
  for (const double z : height_m)
    for (const Vec3 p : plane.node_m) mesh.node_m.push_back({p.x, p.y, z});
  for (std::int32_t k = 0; k + 1 < static_cast<std::int32_t>(height_m.size()); ++k)
    for (Corners c : plane.triangle) {
      std::sort(c.begin(), c.end());
      const std::int32_t below = k * layer, above = below + layer;
      for (std::size_t cut = 0; cut < 3; ++cut) {
        // Corners 0..cut below, cut..2 above.
        Tet tet;
        std::size_t n = 0;
        for (std::size_t i = 0; i <= cut; ++i) tet.node[n++] = below + c[i];
        for (std::size_t i = cut; i < 3; ++i) tet.node[n++] = above + c[i];
        if (corner_volume_m3(mesh, tet) < 0) std::swap(tet.node[1], tet.node[2]);
        mesh.tet.push_back(tet);
      }
    }
  return mesh;
}

TetMesh make_box_tets(Vec3 size_m, std::array<std::int32_t, 3> cells) {
  TetMesh mesh = box_corners(equal_steps(-0.5 * size_m.x, 0.5 * size_m.x, cells[0]), equal_steps(0, size_m.y, cells[1]),
                             equal_steps(-0.5 * size_m.z, 0.5 * size_m.z, cells[2]));
  add_middle_nodes(mesh);
  return mesh;
}

TetMesh make_mirrored_box_tets(Vec3 size_m, std::array<std::int32_t, 3> cells) {
  const auto half_if_even = [](double side_m, std::int32_t count) {
    return count % 2 == 0 ? equal_steps(0, 0.5 * side_m, count / 2) : equal_steps(-0.5 * side_m, 0.5 * side_m, count);
  };
  TetMesh mesh = box_corners(half_if_even(size_m.x, cells[0]), equal_steps(0, size_m.y, cells[1]),
                             half_if_even(size_m.z, cells[2]));
  if (cells[0] % 2 == 0) mirror(mesh, &Vec3::x);
  if (cells[2] % 2 == 0) mirror(mesh, &Vec3::z);
  add_middle_nodes(mesh);
  return mesh;
}

TetMesh make_ring_tets(double inner_m, double outer_m, double width_m, std::array<std::int32_t, 3> cells) {
  PlaneMesh plane;
  for (std::int32_t i = 0; i < cells[0]; ++i)
    for (const double r : equal_steps(inner_m, outer_m, cells[1])) {
      const double a = 2 * kPi * i / cells[0];
      plane.node_m.push_back({r * std::cos(a), r * std::sin(a), 0});
    }
  const auto node = [&](std::int32_t i, std::int32_t j) { return (i % cells[0]) * (cells[1] + 1) + j; };
  for (std::int32_t i = 0; i < cells[0]; ++i)
    for (std::int32_t j = 0; j < cells[1]; ++j)
      add_quad(plane, {node(i, j), node(i, j + 1), node(i + 1, j + 1), node(i + 1, j)}, true);
  TetMesh mesh = extrude(plane, equal_steps(-0.5 * width_m, 0.5 * width_m, cells[2]));
  add_middle_nodes(mesh, {}, [&](Vec3 middle_m, std::int32_t a, std::int32_t b) {
    const Vec3 pa = mesh.node_m[at(a)], pb = mesh.node_m[at(b)];
    return onto_circle(onto_circle(middle_m, pa, pb, {}, inner_m), pa, pb, {}, outer_m);
  });
  return mesh;
}

namespace {

TetMesh clip_of(const ClipLevel& n, const ClipShape& shape) {
  std::vector<double> angle = equal_steps(0, shape.half_foot_rad, n.foot);
  const double end = kPi - shape.half_opening_rad;
  const std::vector<double> arm = equal_steps(shape.half_foot_rad, end, n.arm);
  angle.insert(angle.end(), arm.begin() + 1, arm.end());
  ClipHalf half{shape, angle, n.across, n.sectors, {}};
  half.build();
  mirror_x(half.plane);
  TetMesh mesh = extrude(half.plane, equal_steps(-0.5 * shape.width_m, 0.5 * shape.width_m, n.along));
  const double outer = shape.inner_m + shape.thickness_m;
  const Vec3 tip{half.middle_m() * std::sin(end), -half.middle_m() * std::cos(end), 0};
  add_middle_nodes(mesh, {}, [&](Vec3 m, std::int32_t a, std::int32_t b) {
    const Vec3 pa = mesh.node_m[at(a)], pb = mesh.node_m[at(b)];
    m = onto_circle(m, pa, pb, {}, shape.inner_m);
    m = onto_circle(m, pa, pb, {}, outer);
    m = onto_circle(m, pa, pb, tip, 0.5 * shape.thickness_m);
    return onto_circle(m, pa, pb, {-tip.x, tip.y, 0}, 0.5 * shape.thickness_m);
  });
  return mesh;
}

}  // namespace

TetMesh make_clip_mesh(std::int32_t level, const ClipShape& shape) { return clip_of(clip_level(level), shape); }
TetMesh make_clip_outline(const ClipShape& shape) { return clip_of({4, 28, 2, 18, 2}, shape); }

Supports clip_supports(const TetMesh& mesh, const ClipShape& shape) {
  const double outer = shape.inner_m + shape.thickness_m;
  return hold_where(mesh, [&](Vec3 p) {
    return is_near(radius_of(p), outer) && -p.y >= std::cos(shape.half_foot_rad * (1 + 1e-9)) * outer * (1 - 1e-12);
  });
}

}  // namespace palpate
