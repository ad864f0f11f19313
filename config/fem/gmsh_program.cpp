// Runs the program gmsh on a discrete surface.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "config/fem/tet_io.h"
#include "config/scene/config_error.h"

extern char** environ;

namespace palpate {

namespace {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "palpate-gmsh-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw ConfigError(name + ": cannot make a temporary folder: " + std::strerror(errno) + "; set TMPDIR");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

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
void write_script(double edge_m, const std::string& path) {
  char sizes[96];
  std::snprintf(sizes, sizeof sizes, "Mesh.MeshSizeMin = 0;\nMesh.MeshSizeMax = %.17g;\n", edge_m);
  std::ofstream(path) << "General.NumThreads = 1;\nMesh.RandomSeed = 1;\nMesh.Algorithm3D = 1;\nMesh.Optimize = 1;\n"
                      << sizes << "Merge \"surface.msh\";\nSurface Loop(1) = {1};\nVolume(1) = {1};\n";
}

// Runs gmsh with both outputs in `log`; its exit status, 127 when it is missing.
int run_gmsh(const TemporaryFolder& folder, const std::string& log) {
  std::string script = folder.file("body.geo"), result = folder.file("body.msh");
  std::string arguments[] = {"gmsh", script, "-3", "-nt", "1", "-v", "2", "-format", "msh22", "-o", result};
  std::vector<char*> argv;
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gmsh", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return 127;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return 1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

std::string last_lines(const std::string& path) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return text.size() > 600 ? text.substr(text.size() - 600) : text;
}

}  // namespace

TetMesh tetrahedralise(const SurfaceMesh& surface, double edge_m, const std::string& label) {
  check_mesh(surface, label);
  if (!(edge_m > 0)) throw ConfigError(label + ": the length of the tetrahedra's edges must be positive");
  const TemporaryFolder folder;
  write_surface(surface, folder.file("surface.msh"));
  write_script(edge_m, folder.file("body.geo"));
  const std::string log = folder.file("gmsh.log");
  const int status = run_gmsh(folder, log);
  if (status == 127)
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
