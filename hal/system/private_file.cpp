#include "hal/system/private_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace palpate {

namespace {

// Whether `size` bytes could be read.
bool read_all(int fd, std::byte* to, std::size_t size) {
  while (size > 0) {  // bound: size
    const ssize_t got = ::read(fd, to, size);
    if (got < 0 && errno == EINTR) continue;
    if (got == 0) errno = 0;
    if (got <= 0) return false;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

PrivateFile::PrivateFile(PrivateFile&& other) noexcept { *this = std::move(other); }

PrivateFile& PrivateFile::operator=(PrivateFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

PrivateFile::~PrivateFile() {
  if (data_ != nullptr) munmap(data_, size_);
}

PrivateFile PrivateFile::read(const std::string& path, std::string& error) {
  PrivateFile file;
  // Not blocking: a named pipe nobody writes to is refused below, not waited for.
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (fd < 0 || fstat(fd, &status) != 0) {
    error = path + ": cannot read: " + std::strerror(errno);
  } else if (!S_ISREG(status.st_mode) || status.st_size <= 0) {
    error = path + ": empty, or not a regular file";
  } else {
    file.size_ = static_cast<std::size_t>(status.st_size);
    void* data = mmap(nullptr, file.size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    file.data_ = data == MAP_FAILED ? nullptr : data;
    if (file.data_ == nullptr) {
      error = path + ": no memory for " + std::to_string(file.size_) + " bytes";
    } else if (!read_all(fd, static_cast<std::byte*>(data), file.size_)) {
      error = path + ": cannot read: " + (errno != 0 ? std::strerror(errno) : "it became shorter meanwhile");
    } else if (mprotect(data, file.size_, PROT_READ) != 0) {
      error = path + ": cannot protect its copy: " + std::strerror(errno);
    }
  }
  if (fd >= 0) close(fd);
  return error.empty() ? std::move(file) : PrivateFile{};
}

}  // namespace palpate
