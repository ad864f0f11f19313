#include "config/body/mesh_import.h"

#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <span>

#include "config/scene/config_error.h"

namespace palpate {

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;  // a sanitizer's shadow is larger than any limit
#elif defined(__has_feature)
constexpr bool kLimitsMemory = !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool kLimitsMemory = true;
#endif

// What the child sends: 'M' and per mesh the numbers of vertices, faces and indices, then these; or 'E' and a text.
template <class T>
void put(std::string& out, const T* values, std::size_t count) {
  out.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

void put_mesh(std::string& out, const aiMesh& mesh) {
  std::uint64_t indices = 0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) indices += mesh.mFaces[f].mNumIndices;
  const std::uint64_t count[3] = {mesh.mNumVertices, mesh.mNumFaces, indices};
  put(out, count, 3);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const float p[3] = {mesh.mVertices[i].x, mesh.mVertices[i].y, mesh.mVertices[i].z};
    put(out, p, 3);
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) put(out, &mesh.mFaces[f].mNumIndices, 1);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) put(out, mesh.mFaces[f].mIndices, mesh.mFaces[f].mNumIndices);
}

std::string import_here(const std::string& path) {
  Assimp::Importer importer;
  // No post-processing: splitting, welding and checks are ours, so that faults are reported and not silently repaired.
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr) return std::string("E") + importer.GetErrorString();
  std::string out = "M";
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) put_mesh(out, *scene->mMeshes[i]);
  return out;
}

void write_all(int fd, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {  // bound: the text
    const ssize_t written = write(fd, text.data() + at, text.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    at += static_cast<std::size_t>(written);
  }
}

[[noreturn]] void be_child(int fd, const std::string& path, const ImportLimits& limits) {
  const auto limit = [](auto resource, rlim_t value) {
    const rlimit both{value, value};
    setrlimit(resource, &both);
  };
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_s);
  if (kLimitsMemory) limit(RLIMIT_AS, limits.memory_bytes);
  std::signal(SIGXCPU, SIG_DFL);
  const int null = open("/dev/null", O_WRONLY);
  dup2(null, STDERR_FILENO);  // what the library says while it fails is of no use to anybody
  try {
    write_all(fd, import_here(path));
  } catch (const std::exception& error) {
    write_all(fd, std::string("E") + error.what());
  }
  _exit(0);
}

// All the child sends until it ends.
std::string read_all(int fd) {
  std::string all;
  char block[1 << 16];
  for (;;) {  // bound: the child's life, which has a limit
    const ssize_t got = read(fd, block, sizeof(block));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return all;
    all.append(block, static_cast<std::size_t>(got));
  }
}

std::string import_in_child(const std::string& path, const ImportLimits& limits) {
  int fd[2];
  if (pipe2(fd, O_CLOEXEC) != 0) throw ConfigError(path + ": cannot read the mesh: " + std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) be_child(fd[1], path, limits);
  close(fd[1]);
  if (child < 0) {
    close(fd[0]);
    throw ConfigError(path + ": cannot read the mesh: " + std::strerror(errno));
  }
  std::string sent = read_all(fd[0]);
  close(fd[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool killed = WIFSIGNALED(status);
  if (killed && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    throw ConfigError(path + ": the mesh library did not finish within " + std::to_string(limits.cpu_s) +
                      " s of processor time; the file is damaged or truncated: export it again, or in another format");
  }
  if (killed) throw ConfigError(path + ": the mesh library crashed on it: damaged or truncated; export it again");
  return sent;
}

// Takes arrays from the front of what the child sent, never past its end.
class Bytes {
 public:
  explicit Bytes(std::span<const char> bytes) : bytes_(bytes) {}
  bool empty() const { return bytes_.empty(); }
  template <class T>
  bool take(std::vector<T>& values, std::uint64_t count) {
    if (count > bytes_.size() / sizeof(T)) return false;
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data(), count * sizeof(T));
    bytes_ = bytes_.subspan(count * sizeof(T));
    return true;
  }

 private:
  std::span<const char> bytes_;
};

}  // namespace

std::vector<RawMesh> import_meshes(const std::string& path, const ImportLimits& limits) {
  const std::string sent = import_in_child(path, limits);
  if (sent.empty() || sent[0] != 'M') {
    throw ConfigError(path + ": cannot read the mesh (truncated or damaged?): " + (sent.empty() ? "" : sent.substr(1)));
  }
  std::vector<RawMesh> meshes;
  for (Bytes bytes({sent.data() + 1, sent.size() - 1}); !bytes.empty();) {  // bound: the bytes
    std::vector<std::uint64_t> count;
    RawMesh mesh;
    const bool whole = bytes.take(count, 3) && bytes.take(mesh.vertex, count[0]) &&
                       bytes.take(mesh.corners, count[1]) && bytes.take(mesh.index, count[2]);
    std::uint64_t corners = 0;
    for (const std::uint32_t n : mesh.corners) corners += n;
    if (!whole || corners != mesh.index.size()) throw ConfigError(path + ": the mesh library's answer is cut off");
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace palpate
