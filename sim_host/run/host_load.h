// Load made by this host while a certification runs: what a busy desktop does to caches, memory and kernel. One thread
// per CPU copies memory beyond the caches and makes system calls, one writes and deletes a file. Ordinary priority.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace palpate {

class HostLoad {
 public:
  // Starts at once; `folder` is where the file is written. Ends in the destructor.
  explicit HostLoad(const std::string& folder);
  ~HostLoad();
  HostLoad(const HostLoad&) = delete;
  HostLoad& operator=(const HostLoad&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

}  // namespace palpate
