// The host's end of a running controller: starts palpate-rt, exchanges the two sealed memories with it over a Unix
// socket, and ends it in order.
//
// Set-up protocol on the socket (SOCK_SEQPACKET), each step one descriptor with a label:
//   host -> controller  'C'  the command mailbox      (the controller checks size and seals, maps it read-only)
//   controller -> host  'T'  the telemetry region     (the host does the same)
// Afterwards the host may send 'S' and the path of an image to go over to, and gets one answer, '+' or '-' and why not;
// nothing else travels there. The host keeps its end open as long as it lives, so that the controller
// knows of its death at once.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/system/shared_memory.h"
#include "sim_host/rings/mailbox.h"
#include "sim_host/rings/telemetry.h"
#include "sim_host/run/process.h"
#include "sim_host/run/socket_pair.h"

namespace palpate {

class ControllerLink {
 public:
  // Starts `program` with `arguments` and `--control-fd`. `device_fd` >= 0 is handed over as `kDeviceDescriptor`, and
  // of `others` each first as its second. Throws std::runtime_error when the controller does not come up within 5 s;
  // its own error text is on stderr then.
  ControllerLink(const std::string& program, std::vector<std::string> arguments, int device_fd,
                 const std::vector<std::pair<int, int>>& others = {});

  const TelemetryRegion& telemetry() const { return *static_cast<const TelemetryRegion*>(telemetry_.data()); }
  MailboxWriter& mailbox() { return *mailbox_writer_; }
  // What the writer writes to, for tests of what a broken host may do to a controller.
  MailboxRegion& mailbox_region() { return *static_cast<MailboxRegion*>(mailbox_memory_.data()); }
  // Has the controller read and check another scene's image: "" when it is ready to go over to it (MailboxWriter::
  // set_scene with the next number), otherwise why not. Waits up to 10 s, and shows meanwhile that the host lives.
  std::string announce_scene(const std::string& path);
  Process& process() { return process_; }
  // Asks for zero force and the end of the loop, waits, then insists: SIGTERM after 3 s, SIGKILL after 1 s more.
  // Returns the controller's exit code.
  int finish();

  static constexpr int kControlDescriptor = 3;
  static constexpr int kDeviceDescriptor = 4;
  static constexpr int kDeviceTurnDescriptor = 5;
  static constexpr int kHostTurnDescriptor = 6;
  static constexpr int kSecondDescriptor = 7;
  static constexpr int kSecondTurnDescriptor = 8;

 private:
  SocketPair control_;
  SharedMemory mailbox_memory_, telemetry_;
  std::unique_ptr<MailboxWriter> mailbox_writer_;
  Process process_;
};

}  // namespace palpate
