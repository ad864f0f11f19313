// Mesh files: the library's process may do what it likes; what it sends is welded, checked, or refused with a
// ConfigError. The first byte names the format.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "config/body/mesh_io.h"
#include "config/body/self_intersection.h"
#include "config/scene/config_error.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  static const char* const kFormats[] = {".obj", ".stl", ".ply"};
  const std::string path =
      (std::filesystem::temp_directory_path() / ("palpate_fuzz_" + std::to_string(getpid()) + kFormats[data[0] % 3]))
          .string();
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return 0;
  std::fwrite(data + 1, 1, size - 1, file);
  std::fclose(file);
  try {
    MeshFile mesh = read_mesh(path, 1e-3, {1, std::uint64_t{1} << 30});
    orient_mesh(mesh.mesh);
    check_mesh(mesh.mesh, "fuzz");
    find_self_intersections(mesh.mesh, 1'000'000);
  } catch (const ConfigError&) {
  }
  std::filesystem::remove(path);
  return 0;
}
