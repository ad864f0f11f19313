#include "sim_host/run/controller_link.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace palpate {

namespace {

// Mapping and locking the controller's memory takes well under a second; a scene of a million triangles a little more.
constexpr int kStartTimeout_ms = 5000;

struct Sockets {
  Sockets() {
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, end) != 0) {
      throw std::runtime_error(fmt::format("socketpair: {}", std::strerror(errno)));
    }
  }
  ~Sockets() {
    for (const int fd : end) close(fd);
  }
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;
  void close_peer() {
    close(end[1]);
    end[1] = -1;
  }
  int end[2] = {-1, -1};
};

}  // namespace

ControllerLink::ControllerLink(const std::string& program, std::vector<std::string> arguments, int device_fd) {
  std::string error;
  mailbox_memory_ = SharedMemory::create("palpate-mailbox", sizeof(MailboxRegion), error);
  if (!mailbox_memory_) throw std::runtime_error(error);
  mailbox_writer_ = std::make_unique<MailboxWriter>(*static_cast<MailboxRegion*>(mailbox_memory_.data()));
  mailbox_writer_->set(0, false);

  Sockets sockets;
  arguments.insert(arguments.end(), {"--control-fd", std::to_string(kControlDescriptor)});
  std::vector<std::pair<int, int>> descriptors{{sockets.end[1], kControlDescriptor}};
  if (device_fd >= 0) descriptors.emplace_back(device_fd, kDeviceDescriptor);
  process_ = Process::start(program, arguments, descriptors);
  sockets.close_peer();  // so that the controller's death shows as a closed connection

  int fd = -1;
  if (send_descriptor(sockets.end[0], 'C', mailbox_memory_.fd(), error)) {
    fd = receive_descriptor(sockets.end[0], 'T', kStartTimeout_ms, error);
  }
  if (fd < 0) throw std::runtime_error("the controller did not start: " + error);
  telemetry_ = SharedMemory::open_peer(fd, sizeof(TelemetryRegion), error);
  if (!telemetry_) throw std::runtime_error("the controller's telemetry is refused: " + error);
  if (const char* wrong = check_telemetry(telemetry())) {
    throw std::runtime_error(fmt::format("the controller's telemetry is of another build ({})", wrong));
  }
}

int ControllerLink::finish() {
  mailbox().set(Command::kStop, true);
  if (!process_.wait(3000)) {
    process_.signal(SIGTERM);
    if (!process_.wait(1000)) {
      process_.signal(SIGKILL);
      process_.wait(-1);
    }
  }
  return process_.exit_code();
}

}  // namespace palpate
