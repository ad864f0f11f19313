// Critical points of curvature on the smooth part of a mesh: quadric fits, smoothing, topological persistence.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "config/body/anchors.h"
#include "config/index.h"

namespace palpate {

namespace {

constexpr double kJetRadius = 0.3;         // of the smallest half extent
constexpr std::int32_t kJetVertices = 96;  // visited per fit, spread evenly: bounds the cost on fine meshes
constexpr int kSmoothingSteps = 20;
constexpr double kPersistence = 0.1;  // of the field's range

// One-ring neighbours that are not on a feature, in compressed rows.
struct Rings {
  std::vector<std::int32_t> first, other;
  std::span<const std::int32_t> of(std::size_t i) const {
    return {other.data() + first[i], other.data() + first[i + 1]};
  }
};
Rings rings_of(const SurfaceMesh& mesh, const std::vector<char>& on_feature) {
  // On a closed, oriented mesh each triangle gives each of its corners exactly one new neighbour.
  Rings rings;
  rings.first.assign(mesh.vertex_m.size() + 1, 0);
  const auto each = [&](auto&& visit) {
    for (const Corners& c : mesh.triangle)
      for (std::size_t k = 0; k < 3; ++k)
        if (!on_feature[at(c[k])] && !on_feature[at(c[(k + 1) % 3])]) visit(at(c[k]), c[(k + 1) % 3]);
  };
  each([&](std::size_t i, std::int32_t) { ++rings.first[i + 1]; });
  std::partial_sum(rings.first.begin(), rings.first.end(), rings.first.begin());
  rings.other.resize(at(rings.first.back()));
  std::vector<std::int32_t> fill(rings.first.begin(), rings.first.end() - 1);
  each([&](std::size_t i, std::int32_t j) { rings.other[at(fill[i]++)] = j; });
  return rings;
}

// Smooth patch of each vertex: connected sets that do not cross a feature; -1 on features.
std::vector<std::int32_t> patches_of(const Rings& rings, const std::vector<char>& on_feature) {
  std::vector<std::int32_t> patch(on_feature.size(), -1);
  std::int32_t count = 0;
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < patch.size(); ++start) {
    if (on_feature[start] || patch[start] >= 0) continue;
    patch[start] = count;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      for (const std::int32_t j : rings.of(i))
        if (patch[at(j)] < 0) {
          patch[at(j)] = count;
          open.push_back(at(j));
        }
    }
    ++count;
  }
  return patch;
}

// Vertices sorted into cubic cells of the jet radius.
class Grid {
 public:
  Grid(const SurfaceMesh& mesh, double cell_m) : box_(bounds_of(mesh)), cell_m_(cell_m) {
    const Vec3 size = box_.size_m();
    nx_ = 1 + static_cast<std::int32_t>(size.x / cell_m);
    ny_ = 1 + static_cast<std::int32_t>(size.y / cell_m);
    nz_ = 1 + static_cast<std::int32_t>(size.z / cell_m);
    cells_.resize(at(nx_) * at(ny_) * at(nz_));
    for (std::size_t i = 0; i < mesh.vertex_m.size(); ++i)
      cells_[index(mesh.vertex_m[i], 0, 0, 0)].push_back(static_cast<std::int32_t>(i));
  }
  // Vertices of the 27 cells around p, every `stride`-th of each when there are many.
  template <class Visit>
  void around(Vec3 p, Visit visit) const {
    std::size_t total = 0;
    each_cell(p, [&](const std::vector<std::int32_t>& cell) { total += cell.size(); });
    // About a third of the vertices in the 27 cells lie within the radius.
    const std::size_t stride = std::max<std::size_t>(1, total / (3 * at(kJetVertices)));
    each_cell(p, [&](const std::vector<std::int32_t>& cell) {
      for (std::size_t k = 0; k < cell.size(); k += stride) visit(at(cell[k]));
    });
  }

 private:
  template <class Visit>
  void each_cell(Vec3 p, Visit visit) const {
    for (std::int32_t x = -1; x <= 1; ++x)
      for (std::int32_t y = -1; y <= 1; ++y)
        for (std::int32_t z = -1; z <= 1; ++z)
          if (const std::size_t i = index(p, x, y, z); i < cells_.size()) visit(cells_[i]);
  }
  std::size_t index(Vec3 p, std::int32_t dx, std::int32_t dy, std::int32_t dz) const {
    const auto step = [&](double v, double low, std::int32_t n, std::int32_t d) {
      return std::clamp(static_cast<std::int32_t>((v - low) / cell_m_), 0, n - 1) + d;
    };
    const std::int32_t x = step(p.x, box_.lower_m.x, nx_, dx), y = step(p.y, box_.lower_m.y, ny_, dy),
                       z = step(p.z, box_.lower_m.z, nz_, dz);
    if (x < 0 || y < 0 || z < 0 || x >= nx_ || y >= ny_ || z >= nz_) return cells_.size();
    return (at(x) * at(ny_) + at(y)) * at(nz_) + at(z);
  }
  Bounds box_;
  double cell_m_;
  std::int32_t nx_, ny_, nz_;
  std::vector<std::vector<std::int32_t>> cells_;
};

struct Curvature {
  double gaussian = 0, mean = 0;  // 1/m^2, 1/m
};

// Weighted least-squares quadric h(x, y) over the tangent plane at vertex i (a degree-2 jet, Cazals & Pouget 2005).
Curvature fit_curvature(const SurfaceMesh& mesh, const std::vector<Vec3>& normal,
                        const std::vector<std::int32_t>& patch, const Grid& grid, double radius_m, std::size_t i) {
  const Vec3 n = normal[i];
  const Vec3 u = unit_or(cross(axis_off(n), n), {});
  const Vec3 v = cross(n, u);
  Eigen::Matrix<double, 6, 6> left = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  int used = 0;
  grid.around(mesh.vertex_m[i], [&](std::size_t j) {
    const Vec3 d = mesh.vertex_m[j] - mesh.vertex_m[i];
    const double squared = squared_norm(d) / (radius_m * radius_m);
    if (squared > 1 || patch[j] != patch[i] || dot(normal[j], n) < 0.2) return;
    const double x = dot(d, u) / radius_m, y = dot(d, v) / radius_m, h = dot(d, n) / radius_m;
    Eigen::Matrix<double, 6, 1> row;
    row << 1, x, y, 0.5 * x * x, x * y, 0.5 * y * y;
    const double weight = std::exp(-4 * squared);
    left.noalias() += weight * row * row.transpose();
    right.noalias() += weight * h * row;
    ++used;
  });
  if (used < 8) return {};
  left.diagonal().array() += 1e-12 * left(0, 0);
  const Eigen::Matrix<double, 6, 1> c = left.ldlt().solve(right);
  const double hx = c(1), hy = c(2), xx = c(3), xy = c(4), yy = c(5), g = 1 + hx * hx + hy * hy;
  Curvature k;
  k.gaussian = (xx * yy - xy * xy) / (g * g) / (radius_m * radius_m);
  k.mean = -((1 + hy * hy) * xx - 2 * hx * hy * xy + (1 + hx * hx) * yy) / (2 * g * std::sqrt(g)) / radius_m;
  return k;
}

void smooth(const Rings& rings, std::vector<double>& f) {
  for (int step = 0; step < kSmoothingSteps; ++step) {
    std::vector<double> next = f;
    for (std::size_t i = 0; i < f.size(); ++i) {
      const auto ring = rings.of(i);
      if (ring.empty()) continue;
      double sum = 0;
      for (const std::int32_t j : ring) sum += f[at(j)];
      next[i] = 0.5 * f[i] + 0.5 * sum / static_cast<double>(ring.size());
    }
    f = std::move(next);
  }
}

struct Critical {
  std::size_t vertex;
  double persistence;
};

// 0-dimensional persistence of the superlevel sets of `sign * f` on one patch (Edelsbrunner, Letscher & Zomorodian
// 2002): a peak dies where its set meets that of a higher one. Reports peaks and those meeting points. Equal values
// are ordered by index, the other way round for the other sign, so that two equal saddles are both found.
void persistent_points(const Rings& rings, const std::vector<double>& f, double sign,
                       std::vector<std::int32_t> vertices, double least, std::vector<Critical>& found) {
  std::sort(vertices.begin(), vertices.end(), [&](std::int32_t a, std::int32_t b) {
    if (f[at(a)] != f[at(b)]) return sign * f[at(a)] > sign * f[at(b)];
    return sign > 0 ? a > b : a < b;
  });
  std::vector<std::int32_t> parent(f.size(), -1);  // -1: not yet in any set
  std::vector<std::int32_t> peak(f.size(), -1);    // of a set's root
  const auto root = [&](std::int32_t i) {
    while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
    return i;
  };
  std::vector<std::int32_t> place(f.size(), 0);  // in the sorted order
  for (std::size_t k = 0; k < vertices.size(); ++k) place[at(vertices[k])] = static_cast<std::int32_t>(k);
  for (const std::int32_t i : vertices) {
    parent[at(i)] = i;
    peak[at(i)] = i;
    for (const std::int32_t j : rings.of(at(i))) {
      if (parent[at(j)] < 0) continue;
      std::int32_t a = root(i), b = root(j);
      if (a == b) continue;
      if (place[at(peak[at(a)])] > place[at(peak[at(b)])]) std::swap(a, b);  // a has the higher peak
      const double persistence = std::abs(f[at(peak[at(b)])] - f[at(i)]);
      if (persistence > least) {
        found.push_back({at(peak[at(b)]), persistence});
        found.push_back({at(i), persistence});
      }
      parent[at(b)] = a;
    }
  }
  if (!vertices.empty()) {
    const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(),
                                                 [&](std::int32_t a, std::int32_t b) { return f[at(a)] < f[at(b)]; });
    found.push_back({at(vertices.front()), f[at(*high)] - f[at(*low)]});
  }
}

}  // namespace

std::vector<AnchorPoint> curvature_anchors(const SurfaceMesh& mesh, const std::vector<Vec3>& normal,
                                           const std::vector<char>& on_feature, const PrincipalExtents& extents) {
  const Rings rings = rings_of(mesh, on_feature);
  const std::vector<std::int32_t> patch = patches_of(rings, on_feature);
  const double radius_m = kJetRadius * extents.half_extent_m[2];
  const Grid grid(mesh, radius_m);
  std::vector<double> gaussian(mesh.vertex_m.size(), 0.0), mean(mesh.vertex_m.size(), 0.0);
  for (std::size_t i = 0; i < mesh.vertex_m.size(); ++i) {
    if (patch[i] < 0) continue;
    const Curvature k = fit_curvature(mesh, normal, patch, grid, radius_m, i);
    gaussian[i] = k.gaussian;
    mean[i] = k.mean;
  }
  smooth(rings, gaussian);
  smooth(rings, mean);

  std::vector<std::vector<std::int32_t>> members;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    if (patch[i] < 0) continue;
    if (at(patch[i]) >= members.size()) members.resize(at(patch[i]) + 1);
    members[at(patch[i])].push_back(static_cast<std::int32_t>(i));
  }
  std::vector<AnchorPoint> anchors;
  for (const std::vector<std::int32_t>& vertices : members) {
    // Ranges below a twentieth of the body's own curvature are a plane, cylinder, cone or sphere with mesh noise:
    // such a patch has no extremal points of its own.
    const double natural = 1.0 / extents.mean_m();
    const auto range = [&](const std::vector<double>& f) {
      double low = kHuge, high = -kHuge;
      for (const std::int32_t i : vertices) {
        low = std::min(low, f[at(i)]);
        high = std::max(high, f[at(i)]);
      }
      return high - low;
    };
    const bool by_gaussian = range(gaussian) > 0.1 * natural * natural;
    if (!by_gaussian && !(range(mean) > 0.2 * natural)) continue;
    const std::vector<double>& f = by_gaussian ? gaussian : mean;
    const double span = range(f);
    std::vector<Critical> found;
    persistent_points(rings, f, 1, vertices, kPersistence * span, found);
    persistent_points(rings, f, -1, vertices, kPersistence * span, found);
    for (const Critical& c : found)
      anchors.push_back({mesh.vertex_m[c.vertex], normal[c.vertex], c.persistence / span});
  }
  return anchors;
}

}  // namespace palpate
