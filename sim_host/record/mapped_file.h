#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace palpate {

// A recording mapped read-only; it may be longer than memory. Throws RecordingError when it cannot be opened or is
// empty.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::span<const std::byte> bytes() const { return {data_, size_}; }
  // Maps what the file, whatever its name is by now, has grown to.
  void grow();
  // Open for reading: for locks.
  int fd() const { return fd_; }

 private:
  void map();

  std::string path_;
  int fd_ = -1;
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace palpate
