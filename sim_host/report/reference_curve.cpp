#include "sim_host/report/reference_curve.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "sim_host/build_id.h"
#include "sim_host/report/csv_table.h"

namespace palpate {

namespace {

constexpr char kHeader[] = "depth_mm,fx_N,fy_N,fz_N,coarse_N";

Vec3 vector_of(const CsvTable& table, const std::string& key) {
  std::istringstream text(table.note(key));
  Vec3 v;
  if (!(text >> v.x >> v.y >> v.z)) throw std::runtime_error(table.file + ": # " + key + " = X Y Z is missing");
  return v;
}

}  // namespace

double ReferenceCurve::uncertainty() const {
  double most = 0;
  for (std::size_t i = 0; i < coarse_N.size(); ++i)
    if (std::isfinite(coarse_N[i])) most = std::max(most, std::abs(coarse_N[i] / normal_N(i) - 1));
  return most;
}

ReferenceCurve read_reference(const std::string& path) {
  const CsvTable table = read_csv_table(path);
  ReferenceCurve curve;
  curve.press.place_m = 1e-3 * vector_of(table, "place_mm");
  const Vec3 normal = vector_of(table, "normal");
  if (!(norm(normal) > 0)) throw std::runtime_error(path + ": # normal = 0 0 0: give the outward direction");
  curve.press.normal = (1 / norm(normal)) * normal;
  curve.press.radius_m = 1e-3 * std::stod("0" + table.note("radius_mm"));
  if (!(curve.press.radius_m > 0)) throw std::runtime_error(path + ": # radius_mm must be above 0");
  curve.solver = table.note("solver");
  curve.mesh = table.note("mesh");
  curve.made = table.note("made");
  const std::vector<double>&depth = table.column("depth_mm"), &x = table.column("fx_N"), &y = table.column("fy_N"),
        &z = table.column("fz_N");
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!(depth[i] > (i > 0 ? depth[i - 1] : 0)))
      throw std::runtime_error(fmt::format("{}: depth_mm must rise from above 0, and row {} does not", path, i + 1));
    curve.depth_m.push_back(1e-3 * depth[i]);
    curve.force_N.push_back({x[i], y[i], z[i]});
  }
  if (curve.depth_m.size() < 3) throw std::runtime_error(path + ": a reference needs three depths or more");
  if (table.has("coarse_N")) curve.coarse_N = table.column("coarse_N");
  curve.press.depth_m = curve.depth_m.back();
  if (const std::string moved = reference_surface_path(path); std::filesystem::exists(moved))
    curve.surface = read_reference_surface(moved);
  return curve;
}

void write_reference(const std::string& path, const ReferenceCurve& curve) {
  std::ofstream out(path);
  const PressPlace& press = curve.press;
  const auto triple = [](Vec3 v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z); };
  out << "# place_mm = " << triple(1e3 * press.place_m) << "\n# normal = " << triple(press.normal)
      << fmt::format("\n# radius_mm = {:.9g}\n", 1e3 * press.radius_m) << "# solver = " << curve.solver
      << "\n# mesh = " << curve.mesh << "\n# made = " << curve.made << "\n"
      << kHeader << "\n";
  for (std::size_t i = 0; i < curve.depth_m.size(); ++i)
    out << fmt::format(
        "{:.9g},{:.7g},{:.7g},{:.7g},{}\n", 1e3 * curve.depth_m[i], curve.force_N[i].x, curve.force_N[i].y,
        curve.force_N[i].z,
        i < curve.coarse_N.size() && std::isfinite(curve.coarse_N[i]) ? fmt::format("{:.7g}", curve.coarse_N[i]) : "");
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
  if (!curve.surface.place.empty()) write_reference_surface(reference_surface_path(path), curve.surface);
}

std::string reference_path(const std::string& scene_path) {
  const std::size_t dot = scene_path.rfind(".toml");
  return scene_path.substr(0, dot) + ".reference.csv";
}

}  // namespace palpate
