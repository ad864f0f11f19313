// Child processes of `palpate run`: started with chosen descriptors, in their own process group (so that Ctrl-C in the
// terminal reaches only the host, which then stops them in order), and always reaped.
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

namespace palpate {

class Process {
 public:
  Process() = default;
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  // Kills (SIGKILL) and reaps a child that still runs.
  ~Process();

  // Starts `program` with `arguments`. Each pair (here, there) gives the child our descriptor `here` as `there` (>= 3).
  // Throws std::runtime_error when it cannot be started.
  static Process start(const std::string& program, const std::vector<std::string>& arguments,
                       const std::vector<std::pair<int, int>>& descriptors);
  // Waits up to `timeout_ms`; true once the child has ended.
  bool wait(int timeout_ms);
  bool running() { return !wait(0); }
  // Exit code, or 128 + signal number, once wait() returned true.
  int exit_code() const { return exit_code_; }
  void signal(int number) const;

 private:
  pid_t pid_ = -1;
  bool ended_ = true;
  int exit_code_ = 0;
};

}  // namespace palpate
