#include "sim_host/report/read_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate {

namespace {

// Names of the depth, the best first.
constexpr const char* kDepths[] = {"depth_mm", "penetration_mm"};

const char* depth_column(const CsvTable& table) {
  for (const char* name : kDepths)
    if (table.has(name)) return name;
  return nullptr;
}

std::vector<double> abscissae(const CsvTable& table, Abscissa over) {
  if (over == Abscissa::kTime) return table.column("time_s");
  std::vector<double> x(table.rows());
  if (over == Abscissa::kDepth) {
    const char* name = depth_column(table);
    const std::vector<double>& depth = table.column(name == nullptr ? kDepths[0] : name);
    std::ranges::transform(depth, x.begin(), [](double mm) { return 1e-3 * mm; });
  } else {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  }
  return x;
}

std::vector<Vec3> forces(const CsvTable& table) {
  std::vector<Vec3> force(table.rows());
  if (table.has("fx_N")) {
    const std::vector<double>&x = table.column("fx_N"), &y = table.column("fy_N"), &z = table.column("fz_N");
    for (std::size_t i = 0; i < force.size(); ++i) force[i] = {x[i], y[i], z[i]};
    return force;
  }
  const std::vector<double>& size = table.column(table.has("f_N") ? "f_N" : "force_N");
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = {size[i], 0, 0};
  return force;
}

}  // namespace

Abscissa common_abscissa(const CsvTable& a, const CsvTable& b, Abscissa wanted) {
  const auto has = [](const CsvTable& table, Abscissa over) {
    return over == Abscissa::kDepth ? depth_column(table) != nullptr : table.has("time_s");
  };
  for (const Abscissa over : {Abscissa::kDepth, Abscissa::kTime}) {
    if (wanted != Abscissa::kAny && wanted != over) continue;
    if (has(a, over) && has(b, over)) return over;
    if (wanted == over)
      throw std::runtime_error((has(a, over) ? b.file : a.file) + ": no column " +
                               (over == Abscissa::kDepth ? "depth_mm or penetration_mm" : "time_s"));
  }
  return Abscissa::kRow;
}

ForcePath path_of(const CsvTable& table, Abscissa over, bool vectors) {
  const std::vector<double> x = abscissae(table, over);
  const std::vector<Vec3> force = forces(table);
  ForcePath path;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(norm(force[i]))) continue;
    // The first press of a recording: what comes back or stands still is left out.
    if (!path.x.empty() && !(x[i] > path.x.back())) continue;
    path.x.push_back(x[i]);
    path.force_N.push_back(vectors ? force[i] : Vec3{norm(force[i]), 0, 0});
  }
  return path;
}

}  // namespace palpate
