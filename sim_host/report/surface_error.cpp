#include "sim_host/report/surface_error.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "rt_core/contact/contact.h"
#include "rt_core/surface/closest_point.h"
#include "sim_host/report/csv_table.h"
#include "sim_host/view/deformed_surface.h"
#include "sim_host/view/elastic_surface.h"

namespace palpate {

namespace {

constexpr std::array<const char*, 7> kColumns = {"x_mm", "y_mm", "z_mm", "ux_mm", "uy_mm", "uz_mm", "area_mm2"};

// The drawn displacement at any place of the rest surface: as pictures refine it, straight between the vertices but for
// the dents, which are the tips' own.
class DrawnSurface {
 public:
  DrawnSurface(const Model& model, const State& state) : model_(model) {
    if (method_of(model) == Method::kElastic) {
      ElasticShape shape = elastic_shape(model, state);
      displacement_m_ = mode_displacement_m(model, shape);
      dents_ = std::move(shape.dent);
    } else {
      displacement_m_ = deformed_surface(model, state).displacement_m;
    }
  }
  Vec3 displacement_m(Vec3 rest_m) const {
    const SurfacePoint nearest = closest_surface_point(model_, rest_m, kHuge, -1);
    if (!nearest.found) return {};
    const Triangle& triangle = model_.triangle[static_cast<std::size_t>(nearest.triangle)];
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = model_.vertex_m[static_cast<std::size_t>(triangle.vertex[k])];
    const Vec3 face = cross(corner[1] - corner[0], corner[2] - corner[0]);
    Vec3 moved, normal;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangle.vertex[k]);
      const Vec3 a = corner[(k + 1) % 3], b = corner[(k + 2) % 3];
      const double share = dot(cross(a - nearest.closest_w, b - nearest.closest_w), face) / squared_norm(face);
      moved += share * displacement_m_[v];
      normal += share * model_.vertex_normal[v];
    }
    for (const TipDent& dent : dents_) moved += dent.at(rest_m, unit_or(normal, face));
    return moved;
  }

 private:
  const Model& model_;
  std::vector<Vec3> displacement_m_;
  std::vector<TipDent> dents_;
};

// The rigid motion across a normal that fits what a surface is off best, by area; four numbers.
class Lean {
 public:
  explicit Lean(Vec3 normal) : one_(unit_or(tangential_part(axis_off(normal), normal), {1, 0, 0})), normal_(normal) {}
  void add(Vec3 at_m, Vec3 off, double area) {
    const Columns column = columns(at_m);
    const Eigen::Vector3d e(off.x, off.y, off.z);
    square_ += area * column.transpose() * column;
    right_ += area * column.transpose() * e;
    left_ += area * e.squaredNorm();
  }
  // Sum of what is left of the squares.
  double left() const { return std::max(left_ - right_.dot(square_.ldlt().solve(right_)), 0.0); }

 private:
  using Columns = Eigen::Matrix<double, 3, 4>;
  Columns columns(Vec3 at_m) const {
    constexpr double kUnit_m = 0.01;  // so that shifts and tilts are of one size
    Columns out;
    const Vec3 two = cross(normal_, one_),
               way[4] = {one_, two, cross(one_, (1 / kUnit_m) * at_m), cross(two, (1 / kUnit_m) * at_m)};
    for (int k = 0; k < 4; ++k) out.col(k) << way[k].x, way[k].y, way[k].z;
    return out;
  }
  Vec3 one_, normal_;
  Eigen::Matrix4d square_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right_ = Eigen::Vector4d::Zero();
  double left_ = 0;
};

}  // namespace

SurfaceError surface_error(const Model& model, const State& state, const ReferenceSurface& reference, Vec3 normal) {
  const DrawnSurface drawn(model, state);
  Lean lean(normal);
  SurfaceError error;
  double off = 0, moves = 0, area = 0;
  for (const elastic::MovedPlace& place : reference.place) {
    const Vec3 by = (1 / reference.depth_m) * (drawn.displacement_m(place.rest_m) - place.displacement_m);
    const double distance = norm(by);
    if (distance > error.largest) {
      error.largest = distance;
      error.at_largest_m = place.rest_m;
    }
    const double way = norm(place.displacement_m) / reference.depth_m;
    if (!(way > kMovedShare)) continue;
    lean.add(place.rest_m, by, place.area_m2);
    off += place.area_m2 * distance * distance;
    moves += place.area_m2 * way * way;
    area += place.area_m2;
  }
  if (!(area > 0)) return error;
  error.rms = std::sqrt(off / area);
  error.upright_rms = std::sqrt(lean.left() / area);
  error.still_rms = std::sqrt(moves / area);
  return error;
}

ReferenceSurface read_reference_surface(const std::string& path) {
  const CsvTable table = read_csv_table(path);
  ReferenceSurface surface;
  surface.depth_m = 1e-3 * std::stod("0" + table.note("depth_mm"));
  if (!(surface.depth_m > 0)) throw std::runtime_error(path + ": # depth_mm must be above 0");
  std::array<const std::vector<double>*, kColumns.size()> column{};
  for (std::size_t c = 0; c < kColumns.size(); ++c) column[c] = &table.column(kColumns[c]);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto at = [&](std::size_t c) { return 1e-3 * (*column[c])[i]; };
    surface.place.push_back({{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, 1e-3 * at(6)});
  }
  return surface;
}

void write_reference_surface(const std::string& path, const ReferenceSurface& surface) {
  std::ofstream out(path);
  out << fmt::format("# depth_mm = {:.9g}\n", 1e3 * surface.depth_m);
  for (std::size_t c = 0; c < kColumns.size(); ++c) out << (c > 0 ? "," : "") << kColumns[c];
  out << "\n";
  for (const elastic::MovedPlace& place : surface.place) {
    const Vec3 x = 1e3 * place.rest_m, u = 1e3 * place.displacement_m;
    out << fmt::format("{:.6g},{:.6g},{:.6g},{:.4f},{:.4f},{:.4f},{:.4g}\n", x.x, x.y, x.z, u.x, u.y, u.z,
                       1e6 * place.area_m2);
  }
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

std::string reference_surface_path(const std::string& reference_path) {
  constexpr char kEnding[] = ".reference.csv";
  const std::size_t end = reference_path.rfind(kEnding);
  return (end == std::string::npos ? reference_path : reference_path.substr(0, end)) + ".surface.csv";
}

}  // namespace palpate
