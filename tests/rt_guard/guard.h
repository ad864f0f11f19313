// Detectors for what must never happen in a tick: heap use, locks, file and time calls (by standing in for the C
// library's functions), page faults (by the kernel's own count), and any system call at all (by a seccomp filter in a
// child process).
#pragma once

#include <functional>

namespace palpate::test {

// Calls made on this thread between arm() and disarm().
struct CallCount {
  long heap = 0;    // malloc, calloc, realloc, free, posix_memalign, aligned_alloc, and so operator new and delete
  long lock = 0;    // mutexes, read-write locks, condition variables, thread creation
  long system = 0;  // files, mapping, sleeping, clocks
  const char* first = "";  // name of the first of them
  long total() const { return heap + lock + system; }
};
void arm();
CallCount disarm();

// Page faults of this thread so far, minor and major.
long page_faults();

// Runs `work` in a child process in which every system call but exit_group is trapped. Returns -1 when none was tried,
// otherwise the number of the first one; -2 when the child could not be set up or died of something else.
int first_system_call(const std::function<void()>& work);

}  // namespace palpate::test
