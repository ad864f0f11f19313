#include "hal/bus/loopback.h"

#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hal/bus/frame_socket.h"
#include "hal/system/local_socket.h"

namespace palpate {
namespace {

std::string reason(const std::string& what, const std::string& name) {
  return what + " loopback '" + name + "': " + std::strerror(errno);
}

bool named(const std::string& name, LocalAddress& address, std::string& error) {
  if (make_local_address(name, address, error)) return true;
  error = "loopback name " + error;
  return false;
}

// A device decides what the hand feels and where it is said to be: only this user's own programs, or root's, may be
// one. An abstract name is open to everybody on the machine: user nobody once drove root's controller (2026-11-21).
bool is_own(int fd, const std::string& name, std::string& error) {
  ucred peer{};
  if (!get_peer(fd, peer)) {
    error = reason("cannot tell who is at the other end of", name);
    return false;
  }
  if (is_trusted_peer(peer.uid, ::geteuid())) return true;
  error = "loopback '" + name + "': the other end is process " + std::to_string(peer.pid) + " of user " +
          std::to_string(peer.uid) + ", refused: only programs of user " + std::to_string(::geteuid()) +
          " or root are taken";
  return false;
}

}  // namespace

std::unique_ptr<Transport> adopt_loopback(int fd, std::string& error) {
  int type = 0;
  socklen_t size = sizeof type;
  if (::getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET) {
    error = "descriptor " + std::to_string(fd) + " is not a SOCK_SEQPACKET socket";
    return nullptr;
  }
  return std::make_unique<FrameSocket>(fd);
}

std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> open_loopback_pair(std::string& error) {
  int fd[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, fd) != 0) {
    error = reason("cannot create", "pair");
    return {};
  }
  return {std::make_unique<FrameSocket>(fd[0]), std::make_unique<FrameSocket>(fd[1])};
}

std::unique_ptr<Transport> accept_loopback(const std::string& name, int timeout_ms, std::string& error) {
  LocalAddress address;
  if (!named(name, address, error)) return nullptr;
  if (address.is_path) remove_stale_socket(address);
  const int listener = open_local_socket();
  std::unique_ptr<Transport> transport;
  pollfd wait{listener, POLLIN, 0};
  const bool bound = listener >= 0 && ::bind(listener, address.generic(), address.length) == 0;
  if (!bound || ::listen(listener, 1) != 0) {
    error = reason("cannot listen on", name);
  } else if (::poll(&wait, 1, timeout_ms) <= 0) {
    error = "nobody connected to loopback '" + name + "' within " + std::to_string(timeout_ms) +
            " ms: start the other side (palpate-device)";
  } else if (const int fd = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC); fd < 0) {
    error = reason("cannot accept on", name);
  } else if (is_own(fd, name, error)) {
    transport = std::make_unique<FrameSocket>(fd);
  } else {
    ::close(fd);
  }
  if (listener >= 0) ::close(listener);
  if (address.is_path && bound) ::unlink(address.un.sun_path);
  return transport;
}

std::unique_ptr<Transport> connect_loopback(const std::string& name, int timeout_ms, std::string& error) {
  LocalAddress address;
  if (!named(name, address, error)) return nullptr;
  const int fd = open_local_socket();
  constexpr int kStep_ms = 5;
  for (int waited_ms = 0;; waited_ms += kStep_ms) {
    if (::connect(fd, address.generic(), address.length) == 0) {
      if (is_own(fd, name, error)) return std::make_unique<FrameSocket>(fd);
      ::close(fd);
      return nullptr;
    }
    const bool not_yet = errno == ECONNREFUSED || errno == ENOENT || errno == EAGAIN;
    if (!not_yet || waited_ms >= timeout_ms) break;
    const timespec step{0, kStep_ms * 1'000'000};
    ::nanosleep(&step, nullptr);
  }
  error = reason("cannot connect to", name) + ": is the other side (palpate-rt) running?";
  ::close(fd);
  return nullptr;
}

}  // namespace palpate
