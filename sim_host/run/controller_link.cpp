#include "sim_host/run/controller_link.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <csignal>
#include <stdexcept>

#include "sim_host/exit_codes.h"
#include "sim_host/run/scene_shelf.h"

namespace palpate {

namespace {

// Mapping and locking the controller's memory takes well under a second; a scene of a million triangles a little more.
constexpr int kStartTimeout_ms = 5000;

}  // namespace

ControllerLink::ControllerLink(const std::string& program, std::vector<std::string> arguments, int device_fd,
                               const std::vector<std::pair<int, int>>& others) {
  std::string error;
  mailbox_memory_ = SharedMemory::create("palpate-mailbox", sizeof(MailboxRegion), error);
  if (!mailbox_memory_) throw std::runtime_error(error);
  mailbox_writer_ = std::make_unique<MailboxWriter>(*static_cast<MailboxRegion*>(mailbox_memory_.data()));
  mailbox_writer_->set(0, false);

  arguments.insert(arguments.end(), {"--control-fd", std::to_string(kControlDescriptor)});
  std::vector<std::pair<int, int>> descriptors{{control_.end(1), kControlDescriptor}};
  if (device_fd >= 0) descriptors.emplace_back(device_fd, kDeviceDescriptor);
  descriptors.insert(descriptors.end(), others.begin(), others.end());
  process_ = Process::start(program, arguments, descriptors);
  control_.close_end(1);  // so that the controller's death shows as a closed connection

  int fd = -1;
  if (send_descriptor(control_.end(0), 'C', mailbox_memory_.fd(), error)) {
    fd = receive_descriptor(control_.end(0), 'T', kStartTimeout_ms, error);
  }
  if (fd < 0) {
    // It has said why on stderr; its exit code is the run's.
    const bool told = process_.wait(1000) && process_.exit_code() > kExitOk && process_.exit_code() < 128;
    throw ExitError(told ? process_.exit_code() : kExitDied, "the controller did not start: " + error);
  }
  telemetry_ = SharedMemory::open_peer(fd, sizeof(TelemetryRegion), error);
  if (!telemetry_) throw std::runtime_error("the controller's telemetry is refused: " + error);
  if (const char* wrong = check_telemetry(telemetry())) {
    throw std::runtime_error(fmt::format("the controller's telemetry is of another build ({})", wrong));
  }
}

std::string ControllerLink::announce_scene(const std::string& path) {
  constexpr int kLook_ms = 50, kLongest_ms = 10'000;
  const std::string text = kAnnounce + path;
  const int fd = control_.end(0);
  if (send(fd, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0) return "the controller does not listen";
  for (int waited_ms = 0; waited_ms < kLongest_ms; waited_ms += kLook_ms) {
    pollfd wait{fd, POLLIN, 0};
    char answer[2048];
    mailbox().beat();
    if (poll(&wait, 1, kLook_ms) <= 0) continue;
    const ssize_t got = recv(fd, answer, sizeof answer, MSG_DONTWAIT);
    if (got < 1) return "the controller has ended";
    return answer[0] == kReady ? "" : std::string(answer + 1, static_cast<std::size_t>(got - 1));
  }
  return "the controller did not answer";
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
