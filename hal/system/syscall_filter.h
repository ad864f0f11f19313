// A seccomp allow-list for the real-time thread, installed after set-up: whatever the loop does not need is refused by
// the kernel, the offending call returns ENOSYS, and its number is kept for the loop to report as
// Fault::kForbiddenCall. It binds the calling thread only; graphics, recording and set-up threads are not affected.
#pragma once

#include <string>

namespace palpate {

// Installs the SIGSYS handler (process-wide) and the filter (this thread, for good). False, with the reason, when the
// kernel refuses (no seccomp).
bool install_syscall_filter(std::string& reason);

// Number of the first forbidden system call attempted by any filtered thread, or -1. Async-signal-safe, wait-free.
int forbidden_syscall() noexcept;
// Forgets it (after the operator's reset).
void clear_forbidden_syscall() noexcept;

}  // namespace palpate
