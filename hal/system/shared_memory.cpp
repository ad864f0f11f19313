#include "hal/system/shared_memory.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace palpate {

namespace {

constexpr int kRequiredSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE | F_SEAL_SEAL;
constexpr std::size_t kMostDescriptors = 4;  // accepted per message, so that surplus ones can be closed

std::string reason(const char* what) { return std::string(what) + ": " + std::strerror(errno); }

// Names the seals of `required` that `present` lacks.
std::string missing_seals(int present) {
  std::string names;
  const auto name = [&](int seal, const char* text) {
    if ((present & seal) == 0) names += (names.empty() ? "" : ", ") + std::string(text);
  };
  name(F_SEAL_SHRINK, "SHRINK");
  name(F_SEAL_GROW, "GROW");
  name(F_SEAL_FUTURE_WRITE, "FUTURE_WRITE");
  name(F_SEAL_SEAL, "SEAL");
  return names;
}

}  // namespace

SharedMemory::SharedMemory(SharedMemory&& other) noexcept { *this = std::move(other); }

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(locked_, other.locked_);
  return *this;
}

SharedMemory::~SharedMemory() {
  if (data_ != nullptr) munmap(data_, size_);
  if (fd_ >= 0) close(fd_);
}

SharedMemory SharedMemory::create(const char* name, std::size_t bytes, std::string& error) {
  SharedMemory memory;
  memory.fd_ = memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (memory.fd_ < 0) {
    error = reason("memfd_create");
    return {};
  }
  if (ftruncate(memory.fd_, static_cast<off_t>(bytes)) != 0) {
    error = reason("cannot size shared memory");
    return {};
  }
  // The writable mapping must exist before FUTURE_WRITE: it is the only one there will ever be.
  void* data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, memory.fd_, 0);
  if (data == MAP_FAILED) {
    error = reason("cannot map shared memory");
    return {};
  }
  memory.data_ = data;
  memory.size_ = bytes;
  memory.locked_ = mlock(data, bytes) == 0;
  if (fcntl(memory.fd_, F_ADD_SEALS, kRequiredSeals) != 0) {
    error = reason("cannot seal shared memory");
    return {};
  }
  return memory;
}

SharedMemory SharedMemory::open_peer(int fd, std::size_t bytes, std::string& error) {
  SharedMemory memory;
  memory.fd_ = fd;
  const int seals = fcntl(fd, F_GET_SEALS);
  if (seals < 0) {
    error = "the peer's descriptor cannot be sealed: it is not a memfd";
    return {};
  }
  if ((seals & kRequiredSeals) != kRequiredSeals) {
    error = "the peer's memory lacks the seals " + missing_seals(seals);
    return {};
  }
  // After the seals: the size cannot change any more.
  struct stat status {};
  if (fstat(fd, &status) != 0 || status.st_size != static_cast<off_t>(bytes)) {
    error = "the peer's memory has " + std::to_string(status.st_size) + " bytes, expected " + std::to_string(bytes);
    return {};
  }
  void* data = mmap(nullptr, bytes, PROT_READ, MAP_SHARED | MAP_POPULATE, fd, 0);
  if (data == MAP_FAILED) {
    error = reason("cannot map the peer's memory");
    return {};
  }
  memory.data_ = data;
  memory.size_ = bytes;
  memory.locked_ = mlock(data, bytes) == 0;
  return memory;
}

bool send_descriptor(int socket, char tag, int fd, std::string& error) {
  iovec part{&tag, 1};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof(control);
  cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof(int));
  std::memcpy(CMSG_DATA(header), &fd, sizeof(int));
  if (sendmsg(socket, &message, MSG_NOSIGNAL) == 1) return true;
  error = reason("cannot pass a descriptor to the peer");
  return false;
}

int receive_descriptor(int socket, char tag, int timeout_ms, std::string& error) {
  pollfd waiting{socket, POLLIN, 0};
  int ready;
  do {
    ready = poll(&waiting, 1, timeout_ms);
  } while (ready < 0 && errno == EINTR);
  if (ready <= 0) {
    error = ready == 0 ? "the peer sent nothing within " + std::to_string(timeout_ms) + " ms" : reason("poll");
    return -1;
  }
  char label = 0;
  iovec part{&label, 1};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int) * kMostDescriptors)] = {};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof(control);
  const ssize_t got = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  int received[kMostDescriptors];
  std::size_t count = 0;
  for (cmsghdr* header = got >= 0 ? CMSG_FIRSTHDR(&message) : nullptr; header != nullptr;
       header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t here = (header->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < here && count < kMostDescriptors; ++i, ++count) {
      std::memcpy(&received[count], CMSG_DATA(header) + i * sizeof(int), sizeof(int));
    }
  }
  if (got == 1 && label == tag && count == 1) return received[0];
  for (std::size_t i = 0; i < count; ++i) close(received[i]);
  error = got == 0  ? "the peer closed the connection"
          : got < 0 ? reason("cannot receive a descriptor")
                    : "the peer sent something else than one descriptor labelled " + std::string(1, tag);
  return -1;
}

}  // namespace palpate
