// One controller per device: two that command the same node are both obeyed, in turn. The lock is a file in the
// system's lock folder, held until the process ends, however it ends.
#pragma once

#include <string>

namespace palpate {

// Movable; releases the lock in its destructor.
class DeviceLock {
 public:
  DeviceLock() = default;
  DeviceLock(DeviceLock&& other) noexcept;
  DeviceLock& operator=(DeviceLock&& other) noexcept;
  ~DeviceLock();

  // `device`: what tells it from every other on this computer, as "can-can0-node1". On failure returns an empty object
  // and says in `error` who holds it. `folder`: /run/lock, or /tmp where there is none; only tests name another one.
  static DeviceLock take(const std::string& device, std::string& error, std::string folder = "");

  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

}  // namespace palpate
