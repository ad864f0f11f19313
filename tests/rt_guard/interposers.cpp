// Stands in for the C library's functions in the whole program: counts while this thread is armed, then does the real
// thing. The heap functions go to glibc's internal names, because dlsym itself may allocate; the others are looked up.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstddef>

#include "tests/rt_guard/guard.h"

namespace {

thread_local bool armed = false;
thread_local palpate::test::CallCount count;

void note(long palpate::test::CallCount::*kind, const char* name) {
  if (!armed) return;
  if (count.total() == 0) count.first = name;
  count.*kind += 1;
}
void heap(const char* name) { note(&palpate::test::CallCount::heap, name); }

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

namespace palpate::test {

void arm() {
  count = {};
  armed = true;
}
CallCount disarm() {
  armed = false;
  return count;
}

}  // namespace palpate::test

extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) { return heap("malloc"), __libc_malloc(size); }
void* calloc(std::size_t n, std::size_t size) { return heap("calloc"), __libc_calloc(n, size); }
void* realloc(void* p, std::size_t size) { return heap("realloc"), __libc_realloc(p, size); }
void free(void* p) { heap("free"), __libc_free(p); }
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return heap("aligned_alloc"), __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) { return heap("memalign"), __libc_memalign(alignment, size); }
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  heap("posix_memalign");
  *p = __libc_memalign(alignment, size);
  return *p != nullptr ? 0 : ENOMEM;
}

// A function of the C library with fixed parameters: counted, then called.
#define PALPATE_GUARDED(kind, result, name, parameters, arguments, ...) \
  result name parameters __VA_ARGS__ {                                  \
    static const auto next = real<result(*) parameters>(#name);         \
    note(&palpate::test::CallCount::kind, #name);                       \
    return next arguments;                                              \
  }
PALPATE_GUARDED(lock, int, pthread_mutex_lock, (pthread_mutex_t * m), (m), noexcept)
PALPATE_GUARDED(lock, int, pthread_mutex_trylock, (pthread_mutex_t * m), (m), noexcept)
PALPATE_GUARDED(lock, int, pthread_rwlock_rdlock, (pthread_rwlock_t * l), (l), noexcept)
PALPATE_GUARDED(lock, int, pthread_rwlock_wrlock, (pthread_rwlock_t * l), (l), noexcept)
PALPATE_GUARDED(lock, int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
PALPATE_GUARDED(lock, int, pthread_create, (pthread_t * t, const pthread_attr_t* a, void* (*f)(void*), void* x),
                (t, a, f, x), noexcept)
PALPATE_GUARDED(system, ssize_t, read, (int fd, void* p, std::size_t n), (fd, p, n))
PALPATE_GUARDED(system, ssize_t, write, (int fd, const void* p, std::size_t n), (fd, p, n))
PALPATE_GUARDED(system, int, close, (int fd), (fd))
PALPATE_GUARDED(system, void*, mmap, (void* p, std::size_t n, int prot, int flags, int fd, off_t o),
                (p, n, prot, flags, fd, o), noexcept)
PALPATE_GUARDED(system, int, munmap, (void* p, std::size_t n), (p, n), noexcept)
PALPATE_GUARDED(system, int, nanosleep, (const timespec* t, timespec* r), (t, r))
PALPATE_GUARDED(system, int, usleep, (useconds_t us), (us))
PALPATE_GUARDED(system, int, clock_gettime, (clockid_t c, timespec* t), (c, t), noexcept)
#undef PALPATE_GUARDED

int open(const char* path, int flags, ...) {
  static const auto next = real<int (*)(const char*, int, mode_t)>("open");
  note(&palpate::test::CallCount::system, "open");
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return next(path, flags, mode);
}

}  // extern "C"
