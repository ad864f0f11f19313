// A connected pair of SOCK_SEQPACKET sockets, close-on-exec: one end stays here, the other goes to a child.
#pragma once

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace palpate {

class SocketPair {
 public:
  // Throws std::runtime_error when there is none to be had.
  SocketPair() {
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, end_) != 0) {
      throw std::runtime_error(fmt::format("socketpair: {}", std::strerror(errno)));
    }
  }
  ~SocketPair() {
    close_end(0);
    close_end(1);
  }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;

  int end(int which) const { return end_[which]; }
  // Once a child holds it: then its death shows as a closed connection at the other end.
  void close_end(int which) {
    if (end_[which] >= 0) close(end_[which]);
    end_[which] = -1;
  }

 private:
  int end_[2] = {-1, -1};
};

}  // namespace palpate
