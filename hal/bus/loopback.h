// The same CAN frames over a local socket that keeps record boundaries (AF_UNIX, SOCK_SEQPACKET): for machines without
// a CAN controller, and for tests.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "hal/bus/transport.h"

namespace palpate {

// Two connected ends inside one process (or handed to a child). Null ends and `error` set if the system refuses.
std::pair<std::unique_ptr<Transport>, std::unique_ptr<Transport>> open_loopback_pair(std::string& error);

// Waits up to timeout_ms for the other side on `name`: a path if it contains '/', otherwise a name in the abstract
// namespace (nothing in the file system). Start-up only: these wait. The listener is the controller, or the device:
// either order of starting works. A path left over by a dead process is replaced. The other end must be a program of
// this user, or of root: `error` names who it was instead.
std::unique_ptr<Transport> accept_loopback(const std::string& name, int timeout_ms, std::string& error);
std::unique_ptr<Transport> connect_loopback(const std::string& name, int timeout_ms, std::string& error);

// Takes over an already connected SOCK_SEQPACKET descriptor (inherited from a parent).
std::unique_ptr<Transport> adopt_loopback(int fd, std::string& error);

}  // namespace palpate
