// Runs the program gmsh on a discrete surface.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "config/fem/tet_io.h"
#include "config/scene/child_program.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

void write_surface(const SurfaceMesh& surface, const std::string& path) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (out == nullptr) throw ConfigError(path + ": cannot be written: " + std::strerror(errno));
  std::fprintf(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%zu\n", surface.vertex_m.size());
  for (std::size_t i = 0; i < surface.vertex_m.size(); ++i) {
    const Vec3 p = surface.vertex_m[i];
    std::fprintf(out, "%zu %.17g %.17g %.17g\n", i + 1, p.x, p.y, p.z);
  }
  std::fprintf(out, "$EndNodes\n$Elements\n%zu\n", surface.triangle.size());
  for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
    const Corners& c = surface.triangle[t];
    std::fprintf(out, "%zu 2 2 0 1 %d %d %d\n", t + 1, c[0] + 1, c[1] + 1, c[2] + 1);
  }
  std::fprintf(out, "$EndElements\n");
  if (std::fclose(out) != 0) throw ConfigError(path + ": cannot be written: " + std::strerror(errno));
}

// Algorithm3D 1 is Delaunay: the only one of gmsh 4.8 that is robust for any surface and deterministic on one thread.
void write_script(double edge_m, std::span<const Vec3> inner_m, const std::string& path) {
  char text[160];
  std::snprintf(text, sizeof text, "Mesh.MeshSizeMin = 0;\nMesh.MeshSizeMax = %.17g;\n", edge_m);
  std::ofstream out(path);
  out << "General.NumThreads = 1;\nMesh.RandomSeed = 1;\nMesh.Algorithm3D = 1;\nMesh.Optimize = 1;\n"
      << text << "Merge \"surface.msh\";\nSurface Loop(1) = {1};\nVolume(1) = {1};\n";
  for (std::size_t i = 0; i < inner_m.size(); ++i) {
    const Vec3 p = inner_m[i];
    std::snprintf(text, sizeof text, "Point(%zu) = {%.17g, %.17g, %.17g, %.17g};\n", i + 1, p.x, p.y, p.z, edge_m);
    out << text << "Point{" << i + 1 << "} In Volume{1};\n";
  }
}

}  // namespace

TetMesh tetrahedralise(const SurfaceMesh& surface, double edge_m, const std::string& label,
                       std::span<const Vec3> inner_m) {
  check_mesh(surface, label);
  if (!(edge_m > 0)) throw ConfigError(label + ": the length of the tetrahedra's edges must be positive");
  const TemporaryFolder folder("palpate-gmsh");
  write_surface(surface, folder.file("surface.msh"));
  write_script(edge_m, inner_m, folder.file("body.geo"));
  const std::string log = folder.file("gmsh.log");
  const int status = run_program(
      {"gmsh", folder.file("body.geo"), "-3", "-nt", "1", "-v", "2", "-format", "msh22", "-o", folder.file("body.msh")},
      log);
  if (status == kProgramMissing)
    throw ConfigError(label +
                      ": the program gmsh, which makes the tetrahedra, was not found; install the package gmsh");
  if (status != 0 || !std::filesystem::exists(folder.file("body.msh")))
    throw ConfigError(
        label + ": gmsh could not fill the surface with tetrahedra; does it cut itself? It said: " + last_lines(log));
  try {
    return read_msh(folder.file("body.msh"), 1.0).mesh;
  } catch (const ConfigError&) {
    throw ConfigError(label + ": gmsh made no tetrahedra; does the surface cut itself? It said: " + last_lines(log));
  }
}

}  // namespace palpate
