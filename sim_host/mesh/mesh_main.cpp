// palpate-mesh, started as `palpate mesh`: repairs and remeshes a body's surface. A program of its own: CGAL takes a
// minute to compile, and what runs scenes does not need it.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "config/body/mesh_io.h"
#include "config/scene/schema.h"
#include "sim_host/exit_codes.h"
#include "sim_host/json_output.h"
#include "sim_host/mesh/convex_parts.h"
#include "sim_host/mesh/mesh_picture.h"
#include "sim_host/mesh/surface_repair.h"

namespace palpate {
namespace {

struct MeshOptions {
  std::string input, output, picture;
  double scale = 1e-3, edge_mm = 0, hole_mm = 0, sharp_deg = 60;
  bool keep_largest = false, no_remesh = false, check = false, convex = false, json = false;
};

void print_state(const char* when, const SurfaceState& s) {
  const Vec3 size = 1e3 * s.bounds.size_m();
  fmt::print("{:<8}{} triangles, {} vertices, {:.4g} x {:.4g} x {:.4g} mm, {:.5g} cm2, {:.5g} cm3\n", when, s.triangles,
             s.vertices, size.x, size.y, size.z, 1e4 * s.area_m2, 1e6 * s.volume_m3);
  fmt::print("{:<8}{}; {} open edges, {} shared by more than two triangles, {}{} pairs of triangles that cross\n", "",
             s.parts == 1 ? "one part" : fmt::format("{} parts", s.parts), s.open_edges, s.shared_edges, s.crossings,
             s.crossings >= 1000 ? " or more" : "");
}

Json state_json(const SurfaceState& s) {
  const Vec3 size = s.bounds.size_m();
  return {{"triangles", s.triangles},   {"vertices", s.vertices},         {"size_m", {size.x, size.y, size.z}},
          {"surface_m2", s.area_m2},    {"volume_m3", s.volume_m3},       {"parts", s.parts},
          {"open_edges", s.open_edges}, {"shared_edges", s.shared_edges}, {"crossing_pairs", s.crossings}};
}

bool is_sound(const SurfaceState& s) {
  return s.parts == 1 && s.open_edges == 0 && s.shared_edges == 0 && s.crossings == 0 && s.volume_m3 > 0;
}

// Nothing over what stands there: the input, or somebody's work.
void check_files(const MeshOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(options.input, error)) throw std::runtime_error(options.input + ": no such file");
  if (options.check) return;
  if (std::filesystem::exists(options.output, error))
    throw std::runtime_error(options.output + ": exists; name another file with -o, or remove it");
}

std::string default_output(const std::string& input, bool convex) {
  return std::filesystem::path(input).filename().replace_extension("").string() +
         (convex ? "_parts.txt" : "_repaired.obj");
}

// A line x y z in metres a corner, an empty line after each part: what config/tool/tool_mesh.cpp reads.
int write_parts(const MeshOptions& options, Json& json) {
  const std::vector<std::vector<Vec3>> parts =
      convex_parts(read_mesh(options.input, options.scale).mesh, options.input);
  std::ofstream out(options.output);
  for (const std::vector<Vec3>& part : parts) {
    for (const Vec3& p : part) out << fmt::format("{:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    out << "\n";
  }
  if (!out.flush()) throw std::runtime_error(options.output + ": cannot be written; check the folder and its space");
  json["output"] = options.output;
  json["convex_parts"] = parts.size();
  fmt::print("wrote   {}: {} convex parts\n", options.output, parts.size());
  return kExitOk;
}

int run(MeshOptions options, Json& json) {
  if (options.output.empty()) options.output = default_output(options.input, options.convex);
  check_files(options);
  json["input"] = options.input;
  if (options.convex) return write_parts(options, json);
  const MeshFile file = read_mesh(options.input, options.scale);
  if (file.welded_vertices > 0) fmt::print("read    joined {} vertices that coincide\n", file.welded_vertices);
  if (file.collapsed_triangles > 0)
    fmt::print("read    left out {} triangles whose corners coincide\n", file.collapsed_triangles);
  const SurfaceState before = survey(file.mesh);
  json["before"] = state_json(before);
  json["sound"] = is_sound(before);
  print_state("before", before);
  if (options.check) {
    fmt::print("{}\n", is_sound(before) ? "sound: it can be a body as it is" : "not sound: run without --check");
    return is_sound(before) ? kExitOk : kExitFailed;
  }
  RepairOptions repair;
  repair.largest_hole_m = 1e-3 * options.hole_mm;
  repair.edge_m = 1e-3 * options.edge_mm;
  repair.sharp_deg = options.sharp_deg;
  repair.keep_largest = options.keep_largest;
  repair.remesh = !options.no_remesh;
  const bool person = isatty(STDERR_FILENO) != 0;
  const RepairedSurface result = repair_surface(file.mesh, repair, options.input, [person](const char* step) {
    if (person) fmt::print(stderr, "        {} ...\n", step);
  });
  int number = 0;
  json["repairs"] = Json::array();
  for (const Repair& r : result.repair) {
    json["repairs"].push_back({{"what", r.what}, {"where_m", {r.where_m.x, r.where_m.y, r.where_m.z}}});
    fmt::print("mended  {}. {}{}\n", ++number, r.what, r.where_m == Vec3{} ? "" : " at " + position_text(r.where_m));
  }
  if (result.repair.empty()) fmt::print("mended  nothing\n");
  const SurfaceState after = survey(result.mesh);
  json["after"] = state_json(after);
  json["moved_m"] = repair.remesh ? Json(result.moved_m) : Json(nullptr);
  json["output"] = options.output;
  print_state("after", after);
  if (repair.remesh)
    fmt::print("{:<8}{:.3g} mm at most between the repaired and the remeshed surface\n", "", 1e3 * result.moved_m);
  write_obj(options.output, result.mesh);
  if (!options.picture.empty()) save_mesh_picture(options.picture, file.mesh, result);
  fmt::print("wrote   {} (millimetres: body.scale = 0.001){}\n", options.output,
             options.picture.empty() ? "" : ", " + options.picture);
  return kExitOk;
}

void add_options(CLI::App& app, MeshOptions& options) {
  app.add_option("FILE", options.input, "surface: .stl, .obj or .ply")->required();
  app.add_option("-o,--output", options.output, "OBJ to write; default: FILE's name with _repaired.obj, here");
  app.add_option("--scale", options.scale, "metres per unit of the file")
      ->check(CLI::Range(1e-9, 1e6))
      ->capture_default_str();
  app.add_option("--edge-mm", options.edge_mm, "length of the new triangles' edges; default: extent / 40")
      ->check(CLI::Range(0.001, 1000.0));
  app.add_option("--hole-mm", options.hole_mm, "close holes up to this size across; default: extent / 5")
      ->check(CLI::Range(0.001, 10000.0));
  app.add_option("--sharp-deg", options.sharp_deg, "edges sharper than this stay")
      ->check(CLI::Range(1.0, 180.0))
      ->capture_default_str();
  app.add_flag("--keep-largest", options.keep_largest, "leave out every part but the largest");
  app.add_flag("--no-remesh", options.no_remesh, "repair only; keep the file's triangles");
  app.add_option("--picture", options.picture, "PNG of before and after, places of repairs marked");
  app.add_flag("--convex", options.convex,
               "cut it into convex parts, for a tool, and write their corners in metres: FILE's name with _parts.txt");
  app.add_flag("--check", options.check, "only say what the surface is like; exit code 1 if it is not sound");
  add_json_flag(app, options.json);
  app.footer(
      "Examples:\n"
      "  palpate mesh organ.stl                          repaired and remeshed, to organ_repaired.obj\n"
      "  palpate mesh organ.stl --check                  what is wrong with it\n"
      "  palpate mesh scan.ply --scale 1 --edge-mm 3 --hole-mm 20 --picture scan.png -o scan.obj\n"
      "Then: body.shape = \"mesh\", body.mesh = \"organ_repaired.obj\" in a scene.");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  CLI::App app{"Make a body's surface of a scan or a model: closed, oriented, one piece, of even triangles.",
               "palpate mesh"};
  palpate::MeshOptions options;
  palpate::add_options(app, options);
  try {
    app.parse(argc, argv);
    return palpate::run_with_json(options.json, "mesh", [&](palpate::Json& json) { return run(options, json); });
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? palpate::kExitOk : palpate::kExitUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return palpate::kExitUsage;
  }
}
