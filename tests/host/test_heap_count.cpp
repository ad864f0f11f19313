// The controller's count of its own heap calls must see every way to the heap, and only this thread's.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "sim_host/run/heap_count.h"

namespace palpate {
namespace {

#ifdef PALPATE_SANITIZED

TEST(HeapCount, SaysThatItDoesNotCountUnderASanitizer) { EXPECT_EQ(heap_calls(), -1); }

#else

template <class Work>
long calls_of(Work&& work) {
  const long before = heap_calls();
  work();
  return heap_calls() - before;
}

TEST(HeapCount, SeesEveryWayToTheHeap) {
  void* volatile p = nullptr;  // volatile: a pair of malloc and free must not be optimised away
  EXPECT_EQ(calls_of([&] { p = std::malloc(10); }), 1);
  EXPECT_EQ(calls_of([&] { p = std::realloc(p, 100); }), 1);
  EXPECT_EQ(calls_of([&] { std::free(p); }), 1);
  EXPECT_EQ(calls_of([&] { p = std::calloc(3, 7); }), 1);
  std::free(p);
  EXPECT_EQ(calls_of([&] { p = std::aligned_alloc(64, 128); }), 1);
  std::free(p);
  void* aligned = nullptr;
  EXPECT_EQ(calls_of([&] { ASSERT_EQ(posix_memalign(&aligned, 64, 100), 0); }), 1);
  std::free(aligned);
  EXPECT_EQ(calls_of([&] { p = ::operator new(24); }), 1);
  EXPECT_EQ(calls_of([&] { ::operator delete(p); }), 1);
}

TEST(HeapCount, SeesCallsFromWithinTheCppLibrary) {
  std::string text;
  EXPECT_GE(calls_of([&] { text.append(1000, 'x'); }), 1);  // in libstdc++.so
}

TEST(HeapCount, CountsNothingWhereNothingIsAskedFor) {
  double sum = 0;
  EXPECT_EQ(calls_of([&] {
              for (int i = 0; i < 1000; ++i) sum += i;
            }),
            0);
  EXPECT_EQ(sum, 499500);
}

TEST(HeapCount, CountsEachThreadByItself) {
  long of_thread = 0;
  const long here = calls_of([&] {
    std::thread([&] {
      of_thread = calls_of([] {
        for (std::size_t i = 0; i < 500; ++i) {
          void* volatile p = std::malloc(100 + i);
          std::free(p);
        }
      });
    }).join();
  });
  EXPECT_EQ(of_thread, 1000);
  EXPECT_LT(here, 100);  // what starting a thread needs
}

#endif

}  // namespace
}  // namespace palpate
