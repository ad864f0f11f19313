#include "config/body/procedural.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "config/index.h"
#include "rt_core/math.h"

namespace palpate {

namespace {

// Points of the f-fold subdivision of the icosahedron's faces, shared along edges, on the unit sphere.
class GeodesicSphere {
 public:
  explicit GeodesicSphere(std::int32_t frequency) : f_(frequency) {
    const double g = 0.5 * (1.0 + square_root(5.0));
    for (const double s : {-1.0, 1.0})
      for (const double t : {-g, g}) {
        corner({0, s, t});
        corner({s, t, 0});
        corner({t, 0, s});
      }
    // A face is three corners at mutual distance 2 (before normalising).
    for (std::int32_t a = 0; a < 12; ++a)
      for (std::int32_t b = a + 1; b < 12; ++b)
        for (std::int32_t c = b + 1; c < 12; ++c)
          if (joined(a, b) && joined(b, c) && joined(c, a)) {
            const bool outward = dot(raw_[at(a)], cross(raw_[at(b)], raw_[at(c)])) > 0;
            outward ? face(a, b, c) : face(a, c, b);
          }
  }
  SurfaceMesh mesh;

 private:
  void corner(Vec3 p) {
    raw_.push_back(p);
    mesh.vertex_m.push_back(unit_or(p, {}));
  }
  bool joined(std::int32_t a, std::int32_t b) const { return squared_norm(raw_[at(a)] - raw_[at(b)]) < 4.5; }
  // Vertex at step k of f along the edge from corner a to corner b.
  std::int32_t on_edge(std::int32_t a, std::int32_t b, std::int32_t k) {
    if (k == 0) return a;
    if (k == f_) return b;
    if (a > b) return on_edge(b, a, f_ - k);
    auto [entry, fresh] = edge_.try_emplace({a, b}, static_cast<std::int32_t>(mesh.vertex_m.size()));
    if (fresh)
      for (std::int32_t i = 1; i < f_; ++i) add(raw_[at(a)], raw_[at(b)], raw_[at(b)], i, 0);
    return entry->second + k - 1;
  }
  void add(Vec3 a, Vec3 b, Vec3 c, std::int32_t i, std::int32_t j) {
    const double u = static_cast<double>(i) / f_, v = static_cast<double>(j) / f_;
    mesh.vertex_m.push_back(unit_or(a + u * (b - a) + v * (c - a), {}));
  }
  void face(std::int32_t a, std::int32_t b, std::int32_t c) {
    std::vector<std::vector<std::int32_t>> row(at(f_) + 1);
    for (std::int32_t j = 0; j <= f_; ++j)
      for (std::int32_t i = 0; i <= f_ - j; ++i) row[at(j)].push_back(grid_vertex(a, b, c, i, j));
    for (std::int32_t j = 0; j < f_; ++j)
      for (std::int32_t i = 0; i < f_ - j; ++i) {
        const auto &low = row[at(j)], &high = row[at(j) + 1];
        mesh.triangle.push_back({low[at(i)], low[at(i) + 1], high[at(i)]});
        if (i + 1 < f_ - j) mesh.triangle.push_back({low[at(i) + 1], high[at(i) + 1], high[at(i)]});
      }
  }
  std::int32_t grid_vertex(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t i, std::int32_t j) {
    if (j == 0) return on_edge(a, b, i);
    if (i == 0) return on_edge(a, c, j);
    if (i + j == f_) return on_edge(b, c, j);
    add(raw_[at(a)], raw_[at(b)], raw_[at(c)], i, j);
    return static_cast<std::int32_t>(mesh.vertex_m.size()) - 1;
  }

  std::int32_t f_;
  std::vector<Vec3> raw_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> edge_;
};

SurfaceMesh geodesic_sphere(std::int32_t triangles) {
  const double f = std::round(std::sqrt(static_cast<double>(triangles) / 20.0));
  return GeodesicSphere(std::max(2, static_cast<std::int32_t>(f))).mesh;
}

// Moves the mesh so that its lowest point is at y = 0.
void stand(SurfaceMesh& mesh) {
  const double lowest = bounds_of(mesh).lower_m.y;
  for (Vec3& p : mesh.vertex_m) p.y -= lowest;
}

// The closed surface swept by `ring`, whose ends lie on the y axis, around it.
SurfaceMesh swept(const std::vector<ProfilePoint>& ring, std::int32_t around) {
  SurfaceMesh mesh;
  const auto rings = static_cast<std::int32_t>(ring.size());
  for (std::int32_t r = 0; r < rings; ++r) {
    const bool pole = r == 0 || r == rings - 1;
    for (std::int32_t k = 0; k < (pole ? 1 : around); ++k) {
      const double angle = 2 * kPi * k / around;
      const double radius = pole ? 0.0 : ring[at(r)].radius_m;
      mesh.vertex_m.push_back({radius * math::cos(angle), ring[at(r)].height_m, -radius * math::sin(angle)});
    }
  }
  const auto index = [&](std::int32_t r, std::int32_t k) {
    return r == 0 ? 0 : 1 + (r - 1) * around + (r == rings - 1 ? 0 : k % around);
  };
  // Two triangles per cell; next to a pole one of them would be degenerate.
  for (std::int32_t r = 0; r + 1 < rings; ++r)
    for (std::int32_t k = 0; k < around; ++k) {
      if (r > 0) mesh.triangle.push_back({index(r, k), index(r, k + 1), index(r + 1, k)});
      if (r + 2 < rings) mesh.triangle.push_back({index(r, k + 1), index(r + 1, k + 1), index(r + 1, k)});
    }
  return mesh;
}

SurfaceMesh ring_sphere(std::int32_t triangles) {
  const double nearest = std::round(0.5 * (1 + std::sqrt(1.0 + triangles)));
  const std::int32_t bands = std::max(2, static_cast<std::int32_t>(nearest));
  std::vector<ProfilePoint> meridian{{0, -1}};
  for (std::int32_t k = 1; k < bands; ++k) {
    const double angle = kPi * k / bands;
    meridian.push_back({math::sin(angle), -math::cos(angle)});
  }
  meridian.push_back({0, 1});
  return swept(meridian, 2 * bands);
}

}  // namespace

SurfaceMesh make_ellipsoid(Vec3 half_axes_m, std::int32_t triangles, SpherePattern pattern) {
  SurfaceMesh mesh = pattern == SpherePattern::kRings ? ring_sphere(triangles) : geodesic_sphere(triangles);
  for (Vec3& p : mesh.vertex_m) p = {half_axes_m.x * p.x, half_axes_m.y * (p.y + 1.0), half_axes_m.z * p.z};
  return mesh;
}

SurfaceMesh make_box(Vec3 size_m, std::int32_t triangles) {
  const double size[3] = {size_m.x, size_m.y, size_m.z};
  const double area = 2 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
  const double step = square_root(2 * area / triangles);
  std::array<std::int32_t, 3> n{};
  for (std::size_t a = 0; a < 3; ++a) n[a] = std::max(1, static_cast<std::int32_t>(std::round(size[a] / step)));
  SurfaceMesh mesh;
  std::map<std::array<std::int32_t, 3>, std::int32_t> number;  // grid position -> vertex: faces share their edges
  const auto vertex = [&](std::array<std::int32_t, 3> g) {
    const auto [entry, fresh] = number.try_emplace(g, static_cast<std::int32_t>(mesh.vertex_m.size()));
    if (fresh)
      mesh.vertex_m.push_back({size[0] * (static_cast<double>(g[0]) / n[0] - 0.5), size[1] * g[1] / n[1],
                               size[2] * (static_cast<double>(g[2]) / n[2] - 0.5)});
    return entry->second;
  };
  for (std::size_t a = 0; a < 3; ++a)
    for (const bool high : {false, true}) {
      const std::size_t u = (a + 1) % 3, v = (a + 2) % 3;  // u x v points along +a
      for (std::int32_t i = 0; i < n[u]; ++i)
        for (std::int32_t j = 0; j < n[v]; ++j) {
          std::array<std::int32_t, 4> q{};
          for (std::size_t k = 0; k < 4; ++k) {
            std::array<std::int32_t, 3> g{};
            g[a] = high ? n[a] : 0;
            g[u] = i + (k == 1 || k == 2 ? 1 : 0);
            g[v] = j + (k >= 2 ? 1 : 0);
            q[k] = vertex(g);
          }
          if (!high) std::swap(q[1], q[3]);
          mesh.triangle.push_back({q[0], q[1], q[2]});
          mesh.triangle.push_back({q[0], q[2], q[3]});
        }
    }
  return mesh;
}

SurfaceMesh make_revolution(const std::vector<ProfilePoint>& profile, std::int32_t triangles) {
  double widest = 0, length = 0;
  const std::vector<ProfilePoint> closed = refine_profile(profile, 1e9);
  for (std::size_t i = 0; i < closed.size(); ++i) {
    widest = std::max(widest, closed[i].radius_m);
    if (i > 0)
      length += std::hypot(closed[i].radius_m - closed[i - 1].radius_m, closed[i].height_m - closed[i - 1].height_m);
  }
  // Square cells of side s: 2 (2 pi R / s) (L / s) triangles.
  const double step = square_root(4 * kPi * widest * length / triangles);
  const std::vector<ProfilePoint> ring = refine_profile(profile, step);
  const std::int32_t around = std::max(8, 4 * static_cast<std::int32_t>(std::round(kPi * widest / (2 * step))));
  return swept(ring, around);
}

SurfaceMesh make_cylinder(double radius_m, double height_m, std::int32_t triangles) {
  return make_revolution({{radius_m, 0}, {radius_m, height_m}}, triangles);
}

SurfaceMesh make_heart(double size_m, std::int32_t triangles) {
  // Along a ray of unit direction u the surface is at distance t with (a t^2 - 1)^3 = c t^5, i.e. with t = s^3,
  // a s^6 - k s^5 - 1 = 0, k = cbrt(c): one positive root, so the solid is star-shaped and the map from the sphere is
  // watertight. kRounding lifts cbrt's argument off zero, which rounds the point and the notch.
  constexpr double kRounding = 0.004;
  SurfaceMesh mesh = geodesic_sphere(triangles);
  double widest = 0;
  for (Vec3& p : mesh.vertex_m) {
    const double x = p.x, y = p.z, z = p.y;  // Taubin's axes: x width, y depth, z up
    const double a = x * x + 2.25 * y * y + z * z;
    const double k = z * math::cbrt(x * x + (9.0 / 80.0) * y * y + kRounding);
    double s = 1.5;  // above the root, where the polynomial is convex: Newton descends monotonically
    for (int i = 0; i < 40; ++i) {
      const double s5 = s * s * s * s * s;
      s -= (a * s5 * s - k * s5 - 1.0) / (6.0 * a * s5 - 5.0 * k * s5 / s);
    }
    p = (s * s * s) * p;
    widest = std::max(widest, std::abs(p.x));
  }
  for (Vec3& p : mesh.vertex_m) p = (0.5 * size_m / widest) * p;
  stand(mesh);
  return mesh;
}

}  // namespace palpate
