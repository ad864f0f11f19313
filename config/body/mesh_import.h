// The mesh library, kept in a process of its own with a limit on time and memory: it is large, its input comes from
// anywhere, and some files keep it busy for ever (a PLY header without its end: assimp 5.2.5, 2026-11-22).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

struct ImportLimits {
  unsigned cpu_s = 60;  // a million triangles of OBJ take under 10 s
  std::uint64_t memory_bytes = std::uint64_t{6} << 30;
};

// One mesh of a file as it stands there: faces of any number of corners, in file units.
struct RawMesh {
  std::vector<std::array<float, 3>> vertex;
  std::vector<std::uint32_t> corners;  // of each face
  std::vector<std::uint32_t> index;    // of all faces, one after the other
};

// Throws ConfigError naming the file: when the library refuses it, crashes on it or does not finish within `limits`.
std::vector<RawMesh> import_meshes(const std::string& path, const ImportLimits& limits);

}  // namespace palpate
