#include "config/body/mesh_io.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <unordered_map>

#include "config/index.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

std::string lower_extension(const std::string& path) {
  std::string text = std::filesystem::path(path).extension().string();
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

void check_file(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".obj" && extension != ".stl" && extension != ".ply")
    throw ConfigError(path + ": unknown mesh format '" + extension + "'; allowed .obj, .stl, .ply");
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw ConfigError(path + ": no such mesh file; body.mesh is relative to the scene file");
  if (!std::filesystem::is_regular_file(path, error)) throw ConfigError(path + ": is not a regular file");
  if (std::filesystem::file_size(path, error) == 0) throw ConfigError(path + ": the mesh file is empty");
}

// Splits a polygon into the fan about one of its corners whose triangles all face the polygon's way; false when there
// is none (a strongly concave polygon). assimp's own triangulation is not used: Debian's build aborts the process on
// files cut in the middle of a face (assertion in TriangulateProcess, assimp 5.2.5).
bool add_fan(const std::vector<std::int32_t>& polygon, SurfaceMesh& mesh) {
  const std::size_t n = polygon.size();
  const auto point = [&](std::size_t k) { return mesh.vertex_m[at(polygon[k % n])]; };
  Vec3 normal;  // Newell's: twice the area vector
  for (std::size_t k = 1; k + 1 < n; ++k) normal += cross(point(k) - point(0), point(k + 1) - point(0));
  for (std::size_t start = 0; start < n; ++start) {
    bool convex = true;
    for (std::size_t k = 1; k + 1 < n && convex; ++k)
      convex = n == 3 || dot(cross(point(start + k) - point(start), point(start + k + 1) - point(start)), normal) > 0;
    if (!convex) continue;
    for (std::size_t k = 1; k + 1 < n; ++k)
      mesh.triangle.push_back({polygon[start], polygon[(start + k) % n], polygon[(start + k + 1) % n]});
    return true;
  }
  return false;
}

// Appends every face. OBJ, STL and PLY have no node transforms, so meshes are in file space.
void append(const RawMesh& part, double scale, const std::string& path, SurfaceMesh& mesh) {
  const auto base = static_cast<std::int32_t>(mesh.vertex_m.size());
  for (const auto& p : part.vertex) {
    mesh.vertex_m.push_back(
        {scale * static_cast<double>(p[0]), scale * static_cast<double>(p[1]), scale * static_cast<double>(p[2])});
  }
  std::size_t first = 0;
  for (std::size_t f = 0; f < part.corners.size(); first += part.corners[f], ++f) {
    std::vector<std::int32_t> polygon;
    for (std::size_t k = 0; k < part.corners[f]; ++k) {
      const std::uint32_t vertex = part.index[first + k];
      if (vertex >= part.vertex.size())
        throw ConfigError(path + ": face " + std::to_string(f) + " refers to vertex " + std::to_string(vertex) +
                          " of " + std::to_string(part.vertex.size()));
      polygon.push_back(base + static_cast<std::int32_t>(vertex));
    }
    if (polygon.size() < 3) continue;  // points and lines carry no surface
    if (!add_fan(polygon, mesh))
      throw ConfigError(path + ": face " + std::to_string(f) +
                        " is a concave polygon; split faces into triangles in the modelling program");
  }
}

struct Cell {
  std::int64_t x, y, z;
  bool operator==(const Cell&) const = default;
};
struct CellHash {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t h = 0x9E3779B97F4A7C15ull;
    for (const std::int64_t v : {c.x, c.y, c.z}) h = (h ^ static_cast<std::uint64_t>(v)) * 0xD6E8FEB86659FD93ull;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

// Representative of each vertex: the first one within `distance`. Cells are four distances wide, so that most balls
// touch one cell; every cell a ball touches is searched.
std::vector<std::int32_t> weld_map(const std::vector<Vec3>& vertex, double distance) {
  std::unordered_map<Cell, std::vector<std::int32_t>, CellHash> grid;
  std::vector<std::int32_t> map(vertex.size());
  const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / (4.0 * distance))); };
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const Vec3 p = vertex[i];
    std::int32_t found = -1;
    if (is_finite(p)) {
      for (std::int64_t x = cell(p.x - distance); x <= cell(p.x + distance); ++x)
        for (std::int64_t y = cell(p.y - distance); y <= cell(p.y + distance); ++y)
          for (std::int64_t z = cell(p.z - distance); z <= cell(p.z + distance); ++z)
            if (const auto entry = grid.find({x, y, z}); entry != grid.end())
              for (const std::int32_t j : entry->second)
                if (norm(vertex[at(j)] - p) <= distance && (found < 0 || j < found)) found = j;
      if (found < 0) grid[{cell(p.x), cell(p.y), cell(p.z)}].push_back(static_cast<std::int32_t>(i));
    }
    map[i] = found < 0 ? static_cast<std::int32_t>(i) : found;
  }
  return map;
}

double finite_extent(const std::vector<Vec3>& vertex) {
  SurfaceMesh finite;
  for (const Vec3& p : vertex)
    if (is_finite(p)) finite.vertex_m.push_back(p);
  return bounds_of(finite).largest_m();
}

void weld(MeshFile& file) {
  const double extent = finite_extent(file.mesh.vertex_m);
  if (!(extent > 0)) return;
  const std::vector<std::int32_t> map = weld_map(file.mesh.vertex_m, 1e-7 * extent);
  std::vector<Corners> kept;
  kept.reserve(file.mesh.triangle.size());
  for (const Corners& c : file.mesh.triangle) {
    const Corners m{map[at(c[0])], map[at(c[1])], map[at(c[2])]};
    if (m[0] == m[1] || m[1] == m[2] || m[2] == m[0])
      ++file.collapsed_triangles;
    else
      kept.push_back(m);
  }
  for (std::size_t i = 0; i < map.size(); ++i) file.welded_vertices += at(map[i]) != i ? 1 : 0;
  file.mesh.triangle = std::move(kept);
}

// Renumbers vertices in order of first use, dropping the rest.
void drop_unused(SurfaceMesh& mesh) {
  std::vector<std::int32_t> number(mesh.vertex_m.size(), -1);
  std::vector<Vec3> kept;
  for (Corners& c : mesh.triangle)
    for (std::int32_t& i : c) {
      if (number[at(i)] < 0) {
        number[at(i)] = static_cast<std::int32_t>(kept.size());
        kept.push_back(mesh.vertex_m[at(i)]);
      }
      i = number[at(i)];
    }
  mesh.vertex_m = std::move(kept);
}

}  // namespace

MeshFile read_mesh(const std::string& path, double scale, const ImportLimits& limits) {
  check_file(path);
  MeshFile file;
  for (const RawMesh& part : import_meshes(path, limits)) append(part, scale, path, file.mesh);
  if (file.mesh.triangle.empty()) throw ConfigError(path + ": the mesh file holds no triangles (truncated?)");
  weld(file);
  drop_unused(file.mesh);
  return file;
}

void write_obj(const std::string& path, const SurfaceMesh& mesh) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (out == nullptr) throw ConfigError(path + ": cannot be written: " + std::strerror(errno));
  std::fprintf(out, "# palpate mesh, millimetres\n");
  for (const Vec3& p : mesh.vertex_m) std::fprintf(out, "v %.9g %.9g %.9g\n", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
  for (const Corners& t : mesh.triangle) std::fprintf(out, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  const bool failed = std::ferror(out) != 0;
  if (std::fclose(out) != 0 || failed)
    throw ConfigError(path + ": cannot be written: " + std::strerror(errno) + "; is the disk full?");
}

}  // namespace palpate
