// The controller's own black box. While its host lives, the controller's main thread sleeps; when the host is gone, it
// writes what the telemetry ring still holds, and every further tick until the loop has ended, so that the seconds
// between the host's death and zero force are in a file: `palpate recover` joins it to the host's.
#pragma once

#include <functional>
#include <string>

#include "sim_host/rings/telemetry.h"

namespace palpate {

class CrashFile {
 public:
  // `control_fd`: the socket to the host, which closes it only by ending. `path`: of the recording to write; empty:
  // none.
  CrashFile(int control_fd, std::string path);
  ~CrashFile();
  CrashFile(const CrashFile&) = delete;
  CrashFile& operator=(const CrashFile&) = delete;

  // By the loop's thread when it has ended.
  void loop_ended() noexcept;
  // By the main thread: waits until the host has died (true) or the loop has ended (false). `hear` is called when the
  // host has said something on the socket.
  bool wait_for_death(const std::function<void()>& hear);
  // Writes what the ring holds of the newest scene, whose model it is; while the loop still runs, also every further
  // tick until it has ended. Errors go to stderr: there is nobody else left.
  void write(const TelemetryRegion& ring, const Model& model, bool loop_runs);

 private:
  // True once the loop has ended; waits up to `timeout_ms`.
  bool has_ended(int timeout_ms);

  int control_fd_, ended_fd_;
  std::string path_;
};

}  // namespace palpate
