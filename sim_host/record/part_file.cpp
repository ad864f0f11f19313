#include "sim_host/record/part_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "hal/system/file_lock.h"
#include "sim_host/record/recording.h"

namespace palpate {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw RecordingError(path + ": " + what + ": " + std::strerror(errno));
}

// Whether there is anything of that name, a dangling link included.
bool exists(const std::string& path) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0;
}

// Why a .part file of that name is in the way.
std::string in_the_way(const std::string& part) {
  const int fd = open(part.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (fd < 0) return part + ": in the way (a link?); remove it or choose another name";
  const bool orphan = lock_exclusively(fd);
  const std::string holder = orphan ? "" : lock_holder(fd);
  close(fd);
  if (orphan) {
    return part + ": left by a run that was killed; keep it with `palpate recover " + part +
           "`, or delete it, or choose another name";
  }
  return part + ": " + holder + " is writing this recording; choose another name";
}

void sync_folder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const int fd = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

}  // namespace

PartFile::PartFile(std::string path, WhenItExists existing, const char* suffix)
    : path_(std::move(path)), existing_(existing), suffix_(suffix) {
  if (existing_ == WhenItExists::kRefuse && exists(path_)) {
    throw RecordingError(path_ + ": exists already and is not replaced; choose another name, or --overwrite");
  }
  // Renaming onto a device node puts a file in its place.
  std::error_code none;
  if (std::filesystem::exists(path_, none) && !std::filesystem::is_regular_file(path_, none)) {
    throw RecordingError(path_ + ": is no ordinary file and is not replaced; choose another name");
  }
  const std::string part = part_path();
  fd_ = open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (fd_ < 0 && errno == EEXIST) throw RecordingError(in_the_way(part));
  if (fd_ < 0) refuse(path_, "cannot create the recording");
  if (!lock_exclusively(fd_)) {
    close(fd_);
    refuse(part, "cannot lock the recording");
  }
}

PartFile::PartFile(PartFile&& other) noexcept
    : path_(std::move(other.path_)),
      existing_(other.existing_),
      suffix_(other.suffix_),
      fd_(std::exchange(other.fd_, -1)),
      written_(other.written_) {}

PartFile::~PartFile() {
  if (fd_ < 0) return;
  if (!written_) unlink(part_path().c_str());
  close(fd_);
}

void PartFile::write(const void* data, std::size_t bytes) {
  const auto* at = static_cast<const char*>(data);
  written_ = true;
  while (bytes > 0) {  // bound: bytes
    const ssize_t written = ::write(fd_, at, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse(part_path(), "cannot write");
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void PartFile::finish() {
  if (fsync(fd_) != 0) refuse(part_path(), "fsync");
  const unsigned flags = existing_ == WhenItExists::kRefuse ? RENAME_NOREPLACE : 0;
  bool renamed = renameat2(AT_FDCWD, part_path().c_str(), AT_FDCWD, path_.c_str(), flags) == 0;
  if (!renamed && errno == EINVAL) {  // a file system without RENAME_NOREPLACE: a link fails where a file is, too
    renamed = link(part_path().c_str(), path_.c_str()) == 0 && unlink(part_path().c_str()) == 0;
  }
  if (!renamed) refuse(part_path(), "complete, but cannot be renamed to " + path_);
  sync_folder(path_);
  close(std::exchange(fd_, -1));
}

void PartFile::discard() {
  unlink(part_path().c_str());
  close(std::exchange(fd_, -1));
}

void require_space(const std::string& path, double bytes) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  struct statvfs status {};
  if (statvfs(folder.empty() ? "." : folder.c_str(), &status) != 0) return;  // opening the file says what is wrong
  const double free_bytes = static_cast<double>(status.f_bavail) * static_cast<double>(status.f_frsize);
  if (free_bytes >= bytes) return;
  char text[160];
  std::snprintf(text, sizeof(text), ": the recording takes about %.0f MB and the disk has %.0f MB free", 1e-6 * bytes,
                1e-6 * free_bytes);
  throw RecordingError(path + text + "; clear it, record elsewhere, shorten --duration, or use --no-record");
}

std::string free_name(const std::string& wanted) {
  const auto taken = [](const std::string& name) { return exists(name) || exists(name + kPartSuffix); };
  const std::filesystem::path path(wanted);
  std::string name = wanted;
  for (int number = 2; taken(name); ++number) {  // bound: files in the folder
    name = (path.parent_path() / path.stem()).string() + "-" + std::to_string(number) + path.extension().string();
  }
  return name;
}

}  // namespace palpate
