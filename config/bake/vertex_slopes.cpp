#include "config/bake/vertex_slopes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "config/bake/creases.h"
#include "rt_core/vec.h"

namespace palpate {

namespace {

// Of two unit vectors the difference where edges of a round rim meet at less than 60 degrees; else a corner.
constexpr double kStraight = 1.73;

// Normal equations of a gradient in the plane of two axes.
struct Fit {
  Vec3 axis[2];
  double xx = 0, xy = 0, yy = 0, xv = 0, yv = 0;
};

void add(Fit& fit, Vec3 away_m, double difference) {
  const double x = dot(away_m, fit.axis[0]), y = dot(away_m, fit.axis[1]);
  // Weighted by the distance to -2: each neighbour states a slope, near ones no less than far ones.
  const double weight = 1 / squared_norm(away_m);
  fit.xx += weight * x * x;
  fit.xy += weight * x * y;
  fit.yy += weight * y * y;
  fit.xv += weight * x * difference;
  fit.yv += weight * y * difference;
}

Vec3 gradient_of(const Fit& fit) {
  const double determinant = fit.xx * fit.yy - fit.xy * fit.xy, size = fit.xx + fit.yy;
  if (!(determinant > 1e-6 * size * size)) return {};
  return ((fit.yy * fit.xv - fit.xy * fit.yv) / determinant) * fit.axis[0] +
         ((fit.xx * fit.yv - fit.xy * fit.xv) / determinant) * fit.axis[1];
}

// Of the normal equations' trace: what keeps a bend small where no edge tells of it, as across two that cross at right
// angles.
constexpr double kLittle = 1e-3;

// Normal equations of a symmetric tensor, its entries off the diagonal times the root of two.
class BendFit {
 public:
  // `twice`: second derivative along the edge times its length squared.
  void add(Vec3 edge_m, double twice) {
    constexpr double kRoot = 1.4142135623730951;
    const double length = norm(edge_m);
    const Vec3 u = (1 / length) * edge_m;
    Tensor row;
    row << u.x * u.x, kRoot * u.x * u.y, kRoot * u.x * u.z, u.y * u.y, kRoot * u.y * u.z, u.z * u.z;
    system_ += row * row.transpose();
    load_ += (twice / (length * length)) * row;
  }
  Bend bend() const {
    constexpr double kHalf = 0.70710678118654752;
    const double trace = system_.trace();
    if (!(trace > 0)) return {};
    const Tensor out = (system_ + kLittle * trace * Matrix::Identity()).llt().solve(load_);
    return {out[0], kHalf * out[1], kHalf * out[2], out[3], kHalf * out[4], out[5]};
  }

 private:
  using Tensor = Eigen::Matrix<double, 6, 1>;
  using Matrix = Eigen::Matrix<double, 6, 6>;
  Matrix system_ = Matrix::Zero();
  Tensor load_ = Tensor::Zero();
};

}  // namespace

std::vector<Vec3> vertex_slopes(std::span<const Vec3> vertex_m, std::span<const Vec3> normal,
                                std::span<const Triangle> triangles, std::span<const double> value) {
  std::vector<Fit> fit(vertex_m.size());
  for (std::size_t v = 0; v < fit.size(); ++v) {
    const Vec3 n = normal[v];
    fit[v].axis[0] = unit_or(tangential_part(axis_off(n), n), axis_off(n));
    fit[v].axis[1] = cross(n, fit[v].axis[0]);
  }
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {  // every inner edge twice, from both its ends
      const auto a = static_cast<std::size_t>(t.vertex[k]), b = static_cast<std::size_t>(t.vertex[(k + 1) % 3]);
      if (!(squared_norm(vertex_m[b] - vertex_m[a]) > 0)) continue;
      add(fit[a], vertex_m[b] - vertex_m[a], value[b] - value[a]);
      add(fit[b], vertex_m[a] - vertex_m[b], value[a] - value[b]);
    }
  std::vector<Vec3> slope(fit.size());
  for (std::size_t v = 0; v < fit.size(); ++v) slope[v] = gradient_of(fit[v]);
  return slope;
}

void stop_at_sharp_edges(std::span<const Vec3> vertex_m, std::span<const CornerNormals> normal,
                         std::span<const Triangle> triangles, std::span<Vec3> slope) {
  struct Ends {
    int count = 0;
    Vec3 along;
  };
  std::vector<Ends> sharp(vertex_m.size());
  const auto ends_at = [&](std::int32_t v, std::int32_t other) {
    Ends& ends = sharp[static_cast<std::size_t>(v)];
    const Vec3 along = vertex_m[static_cast<std::size_t>(other)] - vertex_m[static_cast<std::size_t>(v)];
    ends.along += (ends.count == 0 ? 1.0 : -1.0) * unit_or(along, {});
    ends.count += 1;
  };
  for (const Crease& crease : creases(normal, triangles)) {
    ends_at(crease.vertex[0], crease.vertex[1]);
    ends_at(crease.vertex[1], crease.vertex[0]);
  }
  for (std::size_t v = 0; v < sharp.size(); ++v) {
    if (sharp[v].count == 0) continue;
    // Two ends of one line, or a corner.
    const bool is_line = sharp[v].count == 2 && norm(sharp[v].along) > kStraight;
    const Vec3 along = unit_or(sharp[v].along, {});
    slope[v] = is_line ? dot(slope[v], along) * along : Vec3{};
  }
}

std::vector<Bend> vertex_bends(std::span<const Vec3> vertex_m, std::span<const Triangle> triangles,
                               std::span<const double> value, std::span<const Vec3> slope) {
  std::vector<BendFit> fit(vertex_m.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {  // every inner edge twice
      const auto a = static_cast<std::size_t>(t.vertex[k]), b = static_cast<std::size_t>(t.vertex[(k + 1) % 3]);
      const Vec3 edge = vertex_m[b] - vertex_m[a];
      if (!(squared_norm(edge) > 0)) continue;
      const double difference = 6 * (value[b] - value[a]), at_a = dot(slope[a], edge), at_b = dot(slope[b], edge);
      fit[a].add(edge, difference - 4 * at_a - 2 * at_b);
      fit[b].add(edge, -difference + 2 * at_a + 4 * at_b);
    }
  std::vector<Bend> bend;
  for (const BendFit& of : fit) bend.push_back(of.bend());
  return bend;
}

std::vector<Bend> vertex_curvatures(std::span<const Vec3> vertex_m, std::span<const CornerNormals> normal,
                                    std::span<const Triangle> triangles) {
  std::vector<BendFit> fit(vertex_m.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {  // every inner edge twice
      const std::size_t next = (k + 1) % 3;
      const auto a = static_cast<std::size_t>(triangles[i].vertex[k]),
                 b = static_cast<std::size_t>(triangles[i].vertex[next]);
      const Vec3 edge = vertex_m[b] - vertex_m[a];
      if (!(squared_norm(edge) > 0)) continue;
      const Vec3 at_a = normal[i].normal[k], at_b = normal[i].normal[next];
      const double turn = dot(at_b - at_a, edge);
      fit[a].add(norm(edge) * unit_or(tangential_part(edge, at_a), edge), turn);
      fit[b].add(norm(edge) * unit_or(tangential_part(edge, at_b), edge), turn);
    }
  std::vector<Bend> form;
  for (const BendFit& of : fit) form.push_back(of.bend());
  return form;
}

std::array<double, 2> principal_curvatures(const Bend& form) {
  const auto& [xx, xy, xz, yy, yz, zz] = form;
  const double mean = 0.5 * (xx + yy + zz), product = xx * yy + xx * zz + yy * zz - xy * xy - xz * xz - yz * yz;
  const double apart = std::sqrt(std::max(mean * mean - product, 0.0));
  return {mean + apart, mean - apart};
}

}  // namespace palpate
