// A file that appears under its name only when it is complete. Until then it is NAME.part: created new, never through a
// symbolic link, and locked, so that a second writer is refused and a reader can tell a file that is being written from
// one whose writer died.
#pragma once

#include <cstddef>
#include <string>

namespace palpate {

inline constexpr char kPartSuffix[] = ".part";

enum class WhenItExists {
  kRefuse,   // the name must be free when writing starts and when it ends
  kReplace,  // the old file stays until the new one is complete
};

// Every function throws RecordingError, naming the file, when the file system refuses.
class PartFile {
 public:
  PartFile(std::string path, WhenItExists existing, const char* suffix = kPartSuffix);
  PartFile(PartFile&& other) noexcept;
  // Leaves NAME.part behind unless nothing was written, or finish() or discard() came before.
  ~PartFile();

  const std::string& path() const { return path_; }
  std::string part_path() const { return path_ + suffix_; }
  void write(const void* data, std::size_t bytes);
  // On the disk, under its name.
  void finish();
  void discard();

 private:
  std::string path_;
  WhenItExists existing_;
  const char* suffix_;
  int fd_ = -1;
  bool written_ = false;
};

// Throws RecordingError when the file system that `path` is to lie on has less than `bytes` free.
void require_space(const std::string& path, double bytes);

// `wanted` if neither it nor its .part exists; otherwise the first of NAME-2.EXT, NAME-3.EXT ... that is free.
std::string free_name(const std::string& wanted);

}  // namespace palpate
