#include "hal/system/local_socket.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace palpate {

bool make_local_address(const std::string& name, LocalAddress& address, std::string& error) {
  const std::size_t most = sizeof address.un.sun_path - 2;
  if (name.empty() || name.size() > most) {
    error = "must have 1 to " + std::to_string(most) + " characters";
    return false;
  }
  address.is_path = name.find('/') != std::string::npos;
  address.un.sun_family = AF_UNIX;
  const std::size_t offset = address.is_path ? 0 : 1;  // abstract names start with a zero byte
  name.copy(address.un.sun_path + offset, name.size());
  address.length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + offset + name.size());
  return true;
}

int open_local_socket() { return ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0); }

void remove_stale_socket(const LocalAddress& address) {
  struct stat info {};
  if (::lstat(address.un.sun_path, &info) != 0 || !S_ISSOCK(info.st_mode)) return;
  const int probe = open_local_socket();
  const bool dead = ::connect(probe, address.generic(), address.length) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  if (dead) ::unlink(address.un.sun_path);
}

bool get_peer(int fd, ucred& peer) {
  socklen_t size = sizeof peer;
  return ::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
}

bool is_trusted_peer(unsigned peer_user, unsigned own_user) { return peer_user == own_user || peer_user == 0; }

}  // namespace palpate
