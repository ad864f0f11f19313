// A file's bytes as they were at one moment, in memory that nobody else can change: cp, truncate or an editor on the
// file afterwards do nothing to it. A file mapping follows its file instead, and a cut one ends its readers (SIGBUS):
// seen three times of three on a running controller (2026-11-21).
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace palpate {

// Movable; frees the memory in its destructor.
class PrivateFile {
 public:
  PrivateFile() = default;
  PrivateFile(PrivateFile&& other) noexcept;
  PrivateFile& operator=(PrivateFile&& other) noexcept;
  ~PrivateFile();

  // Copies `path` into anonymous memory, which is read-only from then on. On failure returns an empty object and says
  // why in `error`: not readable, not a regular file, empty, or shorter than it was when the copy began. Bytes that
  // change during the copy are for the reader's checksum to find.
  static PrivateFile read(const std::string& path, std::string& error);

  explicit operator bool() const { return data_ != nullptr; }
  // Aligned to a page.
  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(data_), size_}; }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace palpate
