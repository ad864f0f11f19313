#include "sim_host/run/heap_count.h"

#include <cerrno>
#include <cstddef>

#ifdef PALPATE_SANITIZED

namespace palpate {
long heap_calls() noexcept { return -1; }
}  // namespace palpate

#else

namespace {
// Plain storage in the program's own block: the first use by a thread asks for no memory either.
__attribute__((tls_model("initial-exec"))) thread_local long calls = 0;
}  // namespace

namespace palpate {
long heap_calls() noexcept { return calls; }
}  // namespace palpate

extern "C" {

// glibc's own names of these functions. Looking them up with dlsym would allocate.
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) { return ++calls, __libc_malloc(size); }
void* calloc(std::size_t n, std::size_t size) { return ++calls, __libc_calloc(n, size); }
void* realloc(void* p, std::size_t size) { return ++calls, __libc_realloc(p, size); }
void free(void* p) { ++calls, __libc_free(p); }
void* memalign(std::size_t alignment, std::size_t size) { return ++calls, __libc_memalign(alignment, size); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return ++calls, __libc_memalign(alignment, size); }
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  ++calls;
  *p = __libc_memalign(alignment, size);
  return *p != nullptr ? 0 : ENOMEM;
}

}  // extern "C"

#endif
