#include "sim_host/run/host_load.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace palpate {

namespace {

// Beyond the caches of a desktop processor, four of which still fit beside everything else.
constexpr std::size_t kCopyBytes = 32u << 20;
constexpr std::size_t kStep = 64u << 10;
constexpr std::size_t kFileBytes = 4u << 20;

void copy_memory(const std::atomic<bool>& stop) {
  std::vector<char> from(kCopyBytes, 'a'), to(kCopyBytes);
  while (!stop.load(std::memory_order_relaxed)) {
    for (std::size_t at = 0; at < kCopyBytes && !stop.load(std::memory_order_relaxed); at += kStep) {
      std::memcpy(to.data() + at, from.data() + at, kStep);
      (void)getppid();  // into the kernel and back
    }
    from.swap(to);
  }
}

void write_file(const std::atomic<bool>& stop, const std::string& path) {
  const std::vector<char> data(kFileBytes, 'b');
  while (!stop.load(std::memory_order_relaxed)) {
    if (std::FILE* file = std::fopen(path.c_str(), "wb")) {
      std::fwrite(data.data(), 1, data.size(), file);
      std::fclose(file);
    }
    std::remove(path.c_str());
    usleep(10'000);
  }
}

}  // namespace

HostLoad::HostLoad(const std::string& folder) {
  const unsigned cpus = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < cpus; ++i) threads_.emplace_back([this] { copy_memory(stop_); });
  threads_.emplace_back(
      [this, path = folder + "/palpate-load-" + std::to_string(getpid())] { write_file(stop_, path); });
}

HostLoad::~HostLoad() {
  stop_.store(true);
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace palpate
