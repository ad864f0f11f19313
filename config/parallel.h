// Independent pieces of a bake on several processors.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace palpate {

// 0 jobs: as many as there are processors.
inline std::size_t pieces_at_once(unsigned jobs) {
  return jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
}

// Calls work(i) for i < count on up to `jobs` threads. Pieces must not share what they write: then their results do not
// depend on `jobs`. Throws what the first piece, by its number, has thrown.
template <class Work>
void for_each_piece(std::size_t count, unsigned jobs, const Work& work) {
  std::vector<std::exception_ptr> thrown(count);
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        thrown[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> helper;
    for (std::size_t k = 1; k < std::min(pieces_at_once(jobs), count); ++k) helper.emplace_back(run);
    run();
  }
  for (const std::exception_ptr& error : thrown)
    if (error != nullptr) std::rethrow_exception(error);
}

}  // namespace palpate
