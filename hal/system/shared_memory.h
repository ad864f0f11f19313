// Sealed shared memory between two processes that need not trust each other. The owner creates it, maps it writable,
// then seals it: from then on nobody, the owner included, can shrink it, grow it, punch holes in it or map it writable
// again. Without these seals a peer can truncate the object (the other side dies of SIGBUS) or punch a hole (page
// faults and zeros inside the real-time loop): both were reproduced. Objects of shm_open cannot be sealed.
#pragma once

#include <cstddef>
#include <string>

namespace palpate {

// Owns a file descriptor and a mapping of it. Movable; closes and unmaps in its destructor.
class SharedMemory {
 public:
  SharedMemory() = default;
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  // Creates `bytes` of zeroed memory, mapped read-write here, populated, locked in RAM where permitted, and sealed
  // with F_SEAL_SHRINK | GROW | FUTURE_WRITE | SEAL. On failure returns an empty object and says why in `error`.
  static SharedMemory create(const char* name, std::size_t bytes, std::string& error);
  // Takes over the peer's descriptor `fd` (closed on failure too): refused unless it is a memfd with all four seals and
  // exactly `bytes` long. Mapped read-only, populated, locked in RAM where permitted.
  static SharedMemory open_peer(int fd, std::size_t bytes, std::string& error);

  explicit operator bool() const { return data_ != nullptr; }
  void* data() const { return data_; }
  std::size_t size() const { return size_; }
  int fd() const { return fd_; }
  // False when mlock was refused (RLIMIT_MEMLOCK): pages may then be swapped out, a set-up verdict.
  bool locked() const { return locked_; }

 private:
  int fd_ = -1;
  void* data_ = nullptr;
  std::size_t size_ = 0;
  bool locked_ = false;
};

// Passes `fd` over a Unix socket (SCM_RIGHTS) with the one-byte label `tag`. False and `error` on failure.
bool send_descriptor(int socket, char tag, int fd, std::string& error);
// Waits up to `timeout_ms` for a descriptor labelled `tag`; returns it (close-on-exec) or -1 and `error`. Any
// descriptor that comes with another label, or surplus ones, are closed.
int receive_descriptor(int socket, char tag, int timeout_ms, std::string& error);

}  // namespace palpate
