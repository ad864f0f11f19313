#include "sim_host/record/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "sim_host/record/recording.h"

namespace palpate {

MappedFile::MappedFile(const std::string& path) : path_(path) {
  fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd_ < 0) throw RecordingError(fmt::format("{}: cannot open: {}", path, std::strerror(errno)));
  try {
    map();
  } catch (const RecordingError&) {
    close(fd_);
    throw;
  }
}

MappedFile::~MappedFile() {
  munmap(const_cast<std::byte*>(data_), size_);
  close(fd_);
}

void MappedFile::map() {
  struct stat status {};
  const bool sized = fstat(fd_, &status) == 0 && status.st_size > 0;
  const auto size = static_cast<std::size_t>(sized ? status.st_size : 0);
  void* data = sized ? mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd_, 0) : MAP_FAILED;
  if (data == MAP_FAILED) throw RecordingError(fmt::format("{}: empty, or not a file that can be mapped", path_));
  if (data_ != nullptr) munmap(const_cast<std::byte*>(data_), size_);
  data_ = static_cast<const std::byte*>(data);
  size_ = size;
}

void MappedFile::grow() { map(); }

}  // namespace palpate
