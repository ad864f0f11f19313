#include "hal/system/device_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/system/file_lock.h"

namespace palpate {

namespace {

// Readable by all, and only ever opened for reading once it is there: another user's controller must be able to lock
// it, and the kernel refuses O_CREAT on somebody else's file in a folder that all may write to (fs.protected_regular).
int open_lock_file(const std::string& path) {
  constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  const int fd = open(path.c_str(), kFlags);
  if (fd >= 0 || errno != ENOENT) return fd;
  const int created = open(path.c_str(), kFlags | O_CREAT | O_EXCL, 0644);
  if (created >= 0) fchmod(created, 0644);  // whatever the umask: the next user's controller must be able to lock it
  return created >= 0 || errno != EEXIST ? created : open(path.c_str(), kFlags);
}

}  // namespace

DeviceLock::DeviceLock(DeviceLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

DeviceLock& DeviceLock::operator=(DeviceLock&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

DeviceLock::~DeviceLock() {
  if (fd_ >= 0) close(fd_);
}

DeviceLock DeviceLock::take(const std::string& device, std::string& error, std::string folder) {
  if (folder.empty()) folder = access("/run/lock", F_OK) == 0 ? "/run/lock" : "/tmp";
  std::string name = device;
  std::replace(name.begin(), name.end(), '/', '-');
  const std::string path = folder + "/palpate-" + name + ".lock";
  DeviceLock lock;
  lock.fd_ = open_lock_file(path);
  if (lock.fd_ < 0) {
    error = path + ": cannot open the device's lock: " + std::strerror(errno);
    return {};
  }
  if (lock_exclusively(lock.fd_)) return lock;
  error = device + " is in use by " + lock_holder(lock.fd_) + ": two controllers on one device would both be obeyed";
  return {};
}

}  // namespace palpate
