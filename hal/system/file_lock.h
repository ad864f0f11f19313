// Exclusive locks on open files (flock): held by one process at a time, released by the kernel when it ends, however it
// ends.
#pragma once

#include <string>

namespace palpate {

// Takes the lock on `fd` without waiting. False when somebody else holds it, or the file system has no locks.
bool lock_exclusively(int fd);
// Who holds the lock on `fd`, in words ("process 4711 (palpate-rt)"), as far as the kernel tells.
std::string lock_holder(int fd);

}  // namespace palpate
