// Where readers come to the controller's telemetry: a local socket with a path. Whoever connects and is the same user,
// or root, is given the descriptor of the sealed memory and sent away; it maps that read-only, and more than that the
// seals do not allow. The controller never reads a byte of theirs, keeps nothing of them, and serves the door on an
// ordinary thread of its own, which neither the loop nor its memory knows of: how many readers there are, and what
// becomes of them, it cannot tell.
//
// On the socket (SOCK_SEQPACKET), from the controller only, one message: the byte 'T' with the descriptor, or a text
// that begins with "refused".
#pragma once

#include <sys/types.h>

#include <string>
#include <thread>

#include "hal/system/shared_memory.h"
#include "sim_host/rings/telemetry.h"

namespace palpate {

class TelemetryDoor {
 public:
  TelemetryDoor() = default;  // none
  // Closes and removes the path.
  ~TelemetryDoor();
  TelemetryDoor(const TelemetryDoor&) = delete;
  TelemetryDoor& operator=(const TelemetryDoor&) = delete;
  // Listens on `path` for readers of `memory_fd`, which must live as long. A path left by a dead process is replaced.
  // False and `error` when it cannot.
  bool open(const std::string& path, int memory_fd, std::string& error);

 private:
  void serve() noexcept;

  int listener_ = -1, ended_fd_ = -1, memory_fd_ = -1;
  std::string path_;
  std::thread thread_;
};

// A reader's end.
struct AttachedTelemetry {
  SharedMemory memory;
  pid_t controller = 0;
  const TelemetryRegion& region() const { return *static_cast<const TelemetryRegion*>(memory.data()); }
};
// `where`: the path of a door, or the process id of a palpate-rt, whose descriptors the kernel shows to the same user.
// Throws std::runtime_error, with what to do, when there is none, it is somebody else's or of another build.
AttachedTelemetry attach_telemetry(const std::string& where);

}  // namespace palpate
