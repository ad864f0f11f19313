#include "hal/bus/loopback.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

#include "hal/bus/frame_socket.h"

namespace palpate {
namespace {

struct Address {
  sockaddr_un un{};
  socklen_t length = 0;
  bool is_path = false;
};

bool make_address(const std::string& name, Address& address, std::string& error) {
  const std::size_t most = sizeof address.un.sun_path - 2;
  if (name.empty() || name.size() > most) {
    error = "loopback name must have 1 to " + std::to_string(most) + " characters";
    return false;
  }
  address.is_path = name.find('/') != std::string::npos;
  address.un.sun_family = AF_UNIX;
  const std::size_t offset = address.is_path ? 0 : 1;  // abstract names start with a zero byte
  name.copy(address.un.sun_path + offset, name.size());
  address.length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + offset + name.size());
  return true;
}

const sockaddr* generic(const Address& address) { return reinterpret_cast<const sockaddr*>(&address.un); }

int open_socket() { return ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0); }

std::string reason(const std::string& what, const std::string& name) {
  return what + " loopback '" + name + "': " + std::strerror(errno);
}

// Removes a socket file nobody listens on; leaves everything else alone.
void remove_stale(const Address& address) {
  struct stat info {};
  if (::lstat(address.un.sun_path, &info) != 0 || !S_ISSOCK(info.st_mode)) return;
  const int probe = open_socket();
  const bool dead = ::connect(probe, generic(address), address.length) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  if (dead) ::unlink(address.un.sun_path);
}

// A device decides what the hand feels and where it is said to be: only this user's own programs, or root's, may be
// one. An abstract name is open to everybody on the machine: user nobody once drove root's controller (2026-11-21).
bool is_own(int fd, const std::string& name, std::string& error) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) {
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

bool is_trusted_peer(unsigned peer_user, unsigned own_user) { return peer_user == own_user || peer_user == 0; }

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
  Address address;
  if (!make_address(name, address, error)) return nullptr;
  if (address.is_path) remove_stale(address);
  const int listener = open_socket();
  std::unique_ptr<Transport> transport;
  pollfd wait{listener, POLLIN, 0};
  const bool bound = listener >= 0 && ::bind(listener, generic(address), address.length) == 0;
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
  Address address;
  if (!make_address(name, address, error)) return nullptr;
  const int fd = open_socket();
  constexpr int kStep_ms = 5;
  for (int waited_ms = 0;; waited_ms += kStep_ms) {
    if (::connect(fd, generic(address), address.length) == 0) {
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
