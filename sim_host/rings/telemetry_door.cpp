#include "sim_host/rings/telemetry_door.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "hal/system/local_socket.h"

namespace palpate {

namespace {

constexpr int kAnswer_ms = 2000;
constexpr int kWaiting = 16;  // readers that may queue; more are sent away by the kernel
// Whoever floods the door gets 1000 turns a second of an ordinary thread, no more.
constexpr int kPause_us = 1000;

// Without the heap: whatever happens here, the controller's memory stays as it is.
void answer(int reader, int memory_fd) noexcept {
  ucred peer{};
  if (get_peer(reader, peer) && is_trusted_peer(peer.uid, geteuid())) {
    std::string error;  // short texts only, and none when it works
    send_descriptor(reader, 'T', memory_fd, error);
    return;
  }
  char text[160];
  const int length = std::snprintf(text, sizeof text,
                                   "refused: you are user %u, and this telemetry is for user %u and root: attach as "
                                   "the user that runs the controller",
                                   peer.uid, geteuid());
  [[maybe_unused]] const ssize_t sent =  // a reader that has gone needs no answer
      send(reader, text, static_cast<std::size_t>(length), MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace

bool TelemetryDoor::open(const std::string& path, int memory_fd, std::string& error) {
  LocalAddress address;
  if (path.find('/') == std::string::npos) return error = "'" + path + "' is no path: write ./" + path, false;
  if (!make_local_address(path, address, error)) return error = "'" + path + "': a path here " + error, false;
  remove_stale_socket(address);
  listener_ = open_local_socket();
  ended_fd_ = eventfd(0, EFD_CLOEXEC);
  const bool bound = listener_ >= 0 && bind(listener_, address.generic(), address.length) == 0;
  if (bound) path_ = path;  // ours to remove
  // Others may connect, and are told why they are sent away.
  if (!bound || ended_fd_ < 0 || chmod(path.c_str(), 0666) != 0 || listen(listener_, kWaiting) != 0) {
    error = "'" + path + "': " + std::strerror(errno);
    return false;
  }
  memory_fd_ = memory_fd;
  thread_ = std::thread([this] { serve(); });
  return true;
}

TelemetryDoor::~TelemetryDoor() {
  const std::uint64_t one = 1;
  if (thread_.joinable() && ::write(ended_fd_, &one, sizeof one) == sizeof one) thread_.join();
  if (listener_ >= 0) close(listener_);
  if (ended_fd_ >= 0) close(ended_fd_);
  if (!path_.empty()) unlink(path_.c_str());
}

void TelemetryDoor::serve() noexcept {
  for (;;) {  // bound: the life of the controller
    pollfd wait[2] = {{ended_fd_, POLLIN, 0}, {listener_, POLLIN, 0}};
    if (poll(wait, 2, -1) < 0 && errno != EINTR) return;
    if ((wait[0].revents & POLLIN) != 0) return;
    if ((wait[1].revents & POLLIN) != 0) {
      const int reader = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
      if (reader >= 0) answer(reader, memory_fd_);
      if (reader >= 0) close(reader);
    }
    usleep(kPause_us);
  }
}

namespace {

std::runtime_error refusal(const std::string& where, const std::string& why) {
  return std::runtime_error("telemetry of " + where + ": " + why);
}

// The descriptor, from the door at `path`; `controller`: who gave it.
int ask_door(const std::string& path, pid_t& controller) {
  LocalAddress address;
  std::string error;
  if (!make_local_address(path, address, error)) throw refusal(path, "a path " + error);
  const int fd = open_local_socket();
  if (fd < 0 || connect(fd, address.generic(), address.length) != 0) {
    const int why = errno;
    if (fd >= 0) close(fd);
    throw refusal(path, why == ECONNREFUSED ? "nobody listens there: its controller has ended"
                                            : std::string(std::strerror(why)) +
                                                  "; name the path given to --telemetry, or the id of a palpate-rt of "
                                                  "your own user");
  }
  ucred peer{};
  const bool trusted = get_peer(fd, peer) && is_trusted_peer(peer.uid, geteuid());
  controller = peer.pid;
  char text[256] = {};
  pollfd wait{fd, POLLIN, 0};
  const bool answered = poll(&wait, 1, kAnswer_ms) > 0;
  const ssize_t looked = answered ? recv(fd, text, sizeof text - 1, MSG_PEEK | MSG_DONTWAIT) : 0;
  const bool refused = looked > 1;
  const int memory = trusted && !refused ? receive_descriptor(fd, 'T', kAnswer_ms, error) : -1;
  close(fd);
  if (refused) throw refusal(path, text);
  if (!trusted) throw refusal(path, "user " + std::to_string(peer.uid) + " listens there, not you or root");
  if (memory < 0) throw refusal(path, error);
  return memory;
}

// The descriptor that process `id` holds.
int find_in_process(const std::string& id) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/" + id + "/fd", error)) {
    std::error_code gone;
    const std::string target = std::filesystem::read_symlink(entry.path(), gone).string();
    if (target.find("memfd:palpate-telemetry") == std::string::npos) continue;
    if (const int fd = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC); fd >= 0) return fd;
  }
  throw refusal("process " + id, (error ? error.message() : "none there") +
                                     "; name the process id of a running palpate-rt of your own user, as `pgrep "
                                     "palpate-rt` prints it, or the path given to --telemetry");
}

}  // namespace

AttachedTelemetry attach_telemetry(const std::string& where) {
  const bool number =
      !where.empty() && std::ranges::all_of(where, [](unsigned char c) { return std::isdigit(c) != 0; });
  AttachedTelemetry attached;
  if (number) attached.controller = static_cast<pid_t>(std::stol(where));
  const int fd = number ? find_in_process(where) : ask_door(where, attached.controller);
  std::string error;
  attached.memory = SharedMemory::open_peer(fd, sizeof(TelemetryRegion), error);
  if (!attached.memory) throw refusal(where, "of another build, or none: " + error);
  if (const char* wrong = check_telemetry(attached.region()))
    throw refusal(where, std::string("of another build (") + wrong + "); docs/examples/watch.py reads any");
  return attached;
}

}  // namespace palpate
