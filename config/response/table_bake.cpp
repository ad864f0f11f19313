#include "config/response/table_bake.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/response/press_table.h"
#include "config/scene/config_error.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Value and slope of the Hermite cubic through (x, y, m) at `at`; beyond the ends by the end's tangent.
struct CubicPoint {
  double value, slope;
};
CubicPoint hermite(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& m,
                   double at) {
  const std::size_t n = x.size();
  if (at >= x[n - 1]) return {y[n - 1] + m[n - 1] * (at - x[n - 1]), m[n - 1]};
  std::size_t i = 0;
  while (i + 2 < n && at >= x[i + 1]) ++i;
  if (at == x[i]) return {y[i], m[i]};
  const double h = x[i + 1] - x[i], u = (at - x[i]) / h, rise = y[i + 1] - y[i];
  const double p = h * m[i], q = h * m[i + 1], c2 = 3 * rise - 2 * p - q, c3 = p + q - 2 * rise;
  return {y[i] + u * (p + u * (c2 + u * c3)), (p + u * (2 * c2 + 3 * u * c3)) / h};
}

// Mean of the curves by inverse squared distance (Shepard 1968): forces stay monotone.
std::vector<ResponseKnot> blend(const std::vector<ForceCurve>& curves, const CurveTable& table, std::size_t first_row,
                                Vec3 at) {
  std::vector<ResponseKnot> row(table.knot.size(), ResponseKnot{});
  double sum = 0;
  for (std::size_t c = 0; c < curves.size(); ++c) sum += 1 / squared_norm(at - curves[c].position_m);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const double weight = 1 / squared_norm(at - curves[c].position_m) / sum;
    for (std::size_t k = 0; k < row.size(); ++k) {
      row[k].force_N += weight * table.row[first_row + c][k].force_N;
      row[k].slope += weight * table.row[first_row + c][k].slope;
      row[k].energy_J += weight * table.row[first_row + c][k].energy_J;
    }
  }
  return row;
}

// Vertex nearest to each placed curve: it takes the curve itself.
std::vector<std::size_t> nearest_vertices(const SceneDesc& scene, const std::vector<ForceCurve>& curves,
                                          const std::vector<Vec3>& vertex, std::vector<std::string>& warnings) {
  std::vector<std::size_t> nearest;
  for (const ForceCurve& curve : curves) {
    std::size_t best = 0;
    for (std::size_t v = 1; v < vertex.size(); ++v)
      if (squared_norm(vertex[v] - curve.position_m) < squared_norm(vertex[best] - curve.position_m)) best = v;
    const double away = norm(vertex[best] - curve.position_m);
    if (away > 0.005)
      warnings.push_back(scene.table.file + ": a press is " + number_text(std::round(1e4 * away) / 10) +
                         " mm from the nearest vertex of the surface; check its position and unit (mm)");
    if (std::find(nearest.begin(), nearest.end(), best) != nearest.end())
      throw ConfigError(scene.source.where("contact.table.file") + ": two presses of " + scene.table.file +
                        " are nearest to the same vertex; use more triangles or average them");
    nearest.push_back(best);
  }
  return nearest;
}

}  // namespace

std::vector<double> pchip_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> h(n - 1), rise(n - 1), m(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = x[i + 1] - x[i];
    rise[i] = (y[i + 1] - y[i]) / h[i];
  }
  if (n == 2) return {rise[0], rise[0]};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double w1 = 2 * h[i] + h[i - 1], w2 = h[i] + 2 * h[i - 1];
    m[i] = rise[i - 1] * rise[i] > 0 ? (w1 + w2) / (w1 / rise[i - 1] + w2 / rise[i]) : 0.0;
  }
  const auto end = [](double h0, double h1, double d0, double d1) {
    const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if (!(slope * d0 > 0)) return 0.0;
    return d0 * d1 < 0 && std::abs(slope) > 3 * std::abs(d0) ? 3 * d0 : slope;
  };
  m[0] = end(h[0], h[1], rise[0], rise[1]);
  m[n - 1] = end(h[n - 2], h[n - 3], rise[n - 2], rise[n - 3]);
  return m;
}

void integrate_curve(const std::vector<double>& knot, bool root, std::vector<ResponseKnot>& row) {
  row[0].energy_J = 0;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) {
    const double h = knot[i + 1] - knot[i], a = row[i].force_N, b = row[i + 1].force_N;
    const double p = h * row[i].slope, q = h * row[i + 1].slope;
    const double plain = h * (0.5 * (a + b) + (p - q) / 12);
    // int f u du over the interval, u from 0 to 1.
    const double moment = (3 * a + 7 * b) / 20 + p / 30 - q / 20;
    row[i + 1].energy_J = row[i].energy_J + (root ? 2 * (knot[i] * plain + h * h * moment) : plain);
  }
}

CurveTable tabulate(const std::vector<ForceCurve>& presses, bool root) {
  std::vector<ForceCurve> curves = presses;
  if (root)
    for (ForceCurve& curve : curves)
      for (double& depth : curve.depth_m) depth = square_root(depth);
  CurveTable table;
  for (const ForceCurve& curve : curves)
    table.knot.insert(table.knot.end(), curve.depth_m.begin(), curve.depth_m.end());
  std::sort(table.knot.begin(), table.knot.end());
  table.knot.erase(std::unique(table.knot.begin(), table.knot.end()), table.knot.end());
  if (table.knot.size() > static_cast<std::size_t>(kMaxResponseKnots))
    throw ConfigError("the presses have " + std::to_string(table.knot.size()) + " different depths; allowed up to " +
                      std::to_string(kMaxResponseKnots) + ": sample them at the same depths, or at fewer");
  for (const ForceCurve& curve : curves) {
    std::vector<double> slope = pchip_slopes(curve.depth_m, curve.force_N);
    if (root) slope[0] = 0;
    std::vector<ResponseKnot> row;
    for (const double x : table.knot) {
      const CubicPoint point = hermite(curve.depth_m, curve.force_N, slope, x);
      row.push_back({point.value, point.slope, 0});
    }
    integrate_curve(table.knot, root, row);
    table.row.push_back(std::move(row));
  }
  return table;
}

namespace {

// Presses made with one tip: rows first_row and on of the table.
struct CurveSet {
  std::string file;
  std::vector<ForceCurve> curves;
  std::size_t first_row = 0;
};

// Set 0 is contact.table.file; every file that a piece names is one more.
std::vector<CurveSet> read_sets(const SceneDesc& scene, ImageContents& image) {
  std::vector<CurveSet> sets;
  const auto add = [&](const std::string& name, const std::string& key) {
    for (std::size_t i = 0; i < sets.size(); ++i)
      if (sets[i].file == name) return static_cast<std::int32_t>(i);
    const std::filesystem::path file(name);
    try {
      sets.push_back(
          {name, read_curves(file.is_absolute() ? name : scene.source.directory + name, scene.table.smooth), 0});
    } catch (const ConfigError& error) {
      throw ConfigError(scene.source.where(key) + ": " + error.what());
    }
    return static_cast<std::int32_t>(sets.size() - 1);
  };
  add(scene.table.file, "contact.table.file");
  for (std::size_t i = 0; i < scene.piece.size(); ++i)
    if (!scene.piece[i].table_file.empty())
      image.piece[i].curve_set = add(scene.piece[i].table_file, "tool.piece[" + std::to_string(i) + "].table_file");
  return sets;
}

// The curve of every vertex under the tips of one set: the press made there, or a mean of all.
void place_curves(const SceneDesc& scene, const CurveSet& set, const CurveTable& table, ImageContents& image,
                  std::vector<std::string>& warnings) {
  const std::size_t at = image.vertex_response.size(), vertices = image.vertex_m.size();
  image.vertex_response.resize(at + vertices, static_cast<std::int32_t>(set.first_row));
  if (set.curves.size() == 1) return;
  const std::vector<std::size_t> nearest = nearest_vertices(scene, set.curves, image.vertex_m, warnings);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto own = std::find(nearest.begin(), nearest.end(), v);
    if (own != nearest.end()) {
      image.vertex_response[at + v] =
          static_cast<std::int32_t>(set.first_row) + static_cast<std::int32_t>(own - nearest.begin());
      continue;
    }
    image.vertex_response[at + v] = static_cast<std::int32_t>(image.response.size() / table.knot.size());
    const std::vector<ResponseKnot> row = blend(set.curves, table, set.first_row, image.vertex_m[v]);
    image.response.insert(image.response.end(), row.begin(), row.end());
  }
}

void bake_file(const SceneDesc& scene, ImageContents& image, std::vector<std::string>& warnings) {
  std::vector<CurveSet> sets = read_sets(scene, image);
  std::vector<ForceCurve> curves;
  for (CurveSet& set : sets) {
    set.first_row = curves.size();
    curves.insert(curves.end(), set.curves.begin(), set.curves.end());
  }
  CurveTable table;
  try {
    table = tabulate(curves);
  } catch (const ConfigError& error) {
    throw ConfigError(scene.source.where("contact.table.file") + ": " + error.what());
  }
  image.knot = table.knot;
  for (const std::vector<ResponseKnot>& row : table.row)
    image.response.insert(image.response.end(), row.begin(), row.end());
  for (const CurveSet& set : sets) {
    place_curves(scene, set, table, image, warnings);
    for (const ForceCurve& curve : set.curves)
      if (curve.depth_m.back() < scene.contact.max_depth_m * (1 - 1e-12))
        warnings.push_back(set.file + ": a press ends at " + number_text(1e3 * curve.depth_m.back()) +
                           " mm, before contact.max_depth_mm; deeper the force continues by its tangent");
  }
}

void bake_presses(const SceneDesc& scene, ImageContents& image, ResponseReport& report) {
  PressTable pressed = press_table(scene, image.vertex_m);
  image.params.response_root = 1;
  image.knot = pressed.table.knot;
  for (const std::vector<ResponseKnot>& row : pressed.table.row)
    image.response.insert(image.response.end(), row.begin(), row.end());
  image.vertex_response = pressed.places.of_vertex;
  for (std::string& line : describe(pressed)) report.tip.push_back(std::move(line));
}

}  // namespace

void bake_table(const SceneDesc& scene, ImageContents& image, ResponseReport& report,
                std::vector<std::string>& warnings) {
  if (scene.table.source == TableSource::kFem)
    bake_presses(scene, image, report);
  else
    bake_file(scene, image, warnings);
  report.knots = static_cast<std::int64_t>(image.knot.size());
  report.curves = static_cast<std::int64_t>(image.response.size() / image.knot.size());
  const double bytes =
      static_cast<double>(sizeof(ResponseKnot) * image.response.size() + sizeof(double) * image.knot.size() +
                          sizeof(std::int32_t) * image.vertex_response.size());
  report.bytes_per_vertex = bytes / static_cast<double>(image.vertex_m.size());
}

}  // namespace palpate
