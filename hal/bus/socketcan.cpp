#include "hal/bus/socketcan.h"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "hal/bus/frame_socket.h"

namespace palpate {
namespace {

// A file descriptor closed on every way out unless released.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  int release() {
    const int fd = fd_;
    fd_ = -1;
    return fd;
  }

 private:
  int fd_;
};

ifreq request_for(const std::string& interface) {
  ifreq request{};
  interface.copy(request.ifr_name, sizeof request.ifr_name - 1);
  return request;
}

// Checks of the interface that need no CAN support in the kernel; empty if it can be used.
std::string interface_problem(int fd, const std::string& name, bool need_fd) {
  if (name.empty() || name.size() >= IFNAMSIZ) return "'" + name + "' is not an interface name (1 to 15 characters)";
  ifreq request = request_for(name);
  if (::ioctl(fd, SIOCGIFHWADDR, &request) != 0)
    return "no network interface '" + name + "': list them with 'ip link', or use --device loopback";
  if (request.ifr_hwaddr.sa_family != ARPHRD_CAN)
    return "'" + name + "' is not a CAN interface: list those with 'ip -details link show type can'";
  request = request_for(name);
  if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0 || (request.ifr_flags & IFF_UP) == 0)
    return "CAN interface '" + name + "' is down: set its bit rate and 'ip link set " + name + " up'";
  request = request_for(name);
  if (need_fd && (::ioctl(fd, SIOCGIFMTU, &request) != 0 || request.ifr_mtu < static_cast<int>(CANFD_MTU)))
    return "CAN interface '" + name + "' is not set up for CAN FD (MTU " + std::to_string(request.ifr_mtu) +
           ", needs 72): 'ip link set " + name + " type can ... fd on', or add ',classic' to the device";
  return "";
}

bool set_options(int fd, const SocketCanOptions& options) {
  std::vector<can_filter> filters;
  for (const std::uint32_t id : options.receive) {  // the full mask is what makes the match exact
    if (id <= CAN_SFF_MASK) filters.push_back({id, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK});
    if (options.extended) filters.push_back({id | CAN_EFF_FLAG, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_EFF_MASK});
  }
  const can_err_mask_t errors = CAN_ERR_MASK & ~CAN_ERR_BUSERROR;
  const int on = 1, off = 0;
  const bool filtered =
      filters.empty() || ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                                      static_cast<socklen_t>(filters.size() * sizeof(can_filter))) == 0;
  return filtered && ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) == 0 &&
         ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof off) == 0 &&
         (!options.fd || ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) == 0) &&
         ::setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on) == 0;
}

}  // namespace

std::unique_ptr<Transport> open_socketcan(const SocketCanOptions& options, std::string& error) {
  const Descriptor query(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));  // any socket answers interface requests
  error = interface_problem(query.get(), options.interface, options.fd);
  if (!error.empty()) return nullptr;
  Descriptor can(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (can.get() < 0) {
    error = "this kernel has no CAN sockets (" + std::string(std::strerror(errno)) + "): 'modprobe can_raw'";
    return nullptr;
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(options.interface.c_str()));
  if (!set_options(can.get(), options) ||
      ::bind(can.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    error = "cannot open CAN interface '" + options.interface + "': " + std::strerror(errno);
    return nullptr;
  }
  return std::make_unique<FrameSocket>(can.release());
}

std::string find_can_interface() {
  const Descriptor query(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  std::string found;
  struct if_nameindex* all = ::if_nameindex();
  if (all == nullptr) return found;
  for (const struct if_nameindex* i = all; i->if_index != 0; ++i) {
    ifreq request = request_for(i->if_name);
    if (::ioctl(query.get(), SIOCGIFHWADDR, &request) != 0 || request.ifr_hwaddr.sa_family != ARPHRD_CAN) continue;
    request = request_for(i->if_name);
    const bool up = ::ioctl(query.get(), SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
    if (up || found.empty()) found = i->if_name;
    if (up) break;
  }
  ::if_freenameindex(all);
  return found;
}

}  // namespace palpate
