// Local (Unix) sockets by name: a path when the name contains a slash, otherwise a name in the abstract namespace. And
// who is at their other end, as the kernel knows it.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>
#include <sys/un.h>

#include <string>

namespace palpate {

struct LocalAddress {
  sockaddr_un un{};
  socklen_t length = 0;
  bool is_path = false;
  const sockaddr* generic() const { return reinterpret_cast<const sockaddr*>(&un); }
};

// False and `error` when the name is empty or too long.
bool make_local_address(const std::string& name, LocalAddress& address, std::string& error);
// SOCK_SEQPACKET, close-on-exec; -1 with errno.
int open_local_socket();
// Removes a socket file nobody listens on; leaves everything else alone.
void remove_stale_socket(const LocalAddress& address);

// False when the kernel does not tell.
bool get_peer(int fd, ucred& peer);
// Whether a program of `peer_user` may speak with one of `own_user`: the same user, or root.
bool is_trusted_peer(unsigned peer_user, unsigned own_user);

}  // namespace palpate
