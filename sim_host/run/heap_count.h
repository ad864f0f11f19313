// Counts what each thread of the controller asks of the heap: malloc and its family stand here in place of the C
// library's, in palpate-rt alone, count, and pass the call on. Over the loop's run nothing may be added.
#pragma once

namespace palpate {

// Calls of this thread so far: malloc, calloc, realloc, free, aligned ones, and so operator new and delete. -1: not
// counted, in builds where a sanitizer stands there itself.
long heap_calls() noexcept;

}  // namespace palpate
