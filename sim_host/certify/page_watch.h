// How much of some memory one call touches, in pages: copies of it lie on pages of their own that may not be read, and
// the first touch of each is a fault that opens it. One watch at a time, on the calling thread.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace palpate {

// A block of whole pages, whose content may be written while it is open.
class WatchedBlock {
 public:
  explicit WatchedBlock(std::size_t bytes);
  ~WatchedBlock();
  WatchedBlock(const WatchedBlock&) = delete;
  WatchedBlock& operator=(const WatchedBlock&) = delete;
  std::byte* data() const { return data_; }
  std::size_t bytes() const { return bytes_; }

 private:
  std::byte* data_;
  std::size_t bytes_;
};

// Bytes in the pages of each block that `call` touches. It must not throw.
std::vector<std::size_t> bytes_touched(std::span<const WatchedBlock* const> blocks, const std::function<void()>& call);

}  // namespace palpate
