// lab_readers WHAT TELEMETRY: readers of a controller's telemetry, good and bad, for as long as they live.
//   follow  reads every tick, as `palpate view --attach` does in its own process; the window alone is missing
//   flood   copies the newest record over and over, without a pause
//   knock   comes to the door as fast as it can, shouts, and never takes what it is given
//   break   tries to map the memory writable, to write, cut, grow, punch and unseal it, again and again; ends with 1
//           when any of it worked
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>

#include "hal/system/local_socket.h"
#include "sim_host/rings/telemetry_door.h"

namespace palpate {
namespace {

void follow(const TelemetryRegion& region) {
  TelemetryReader reader(region);
  TickRecord record;
  for (;;) {
    while (reader.next(record)) {
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));  // a viewer's look
  }
}

void flood(const TelemetryRegion& region) {
  const TelemetryReader reader(region);
  TickRecord record;
  for (;;) reader.newest(record);
}

void knock(const std::string& path) {
  LocalAddress address;
  std::string error;
  if (!make_local_address(path, address, error)) throw std::runtime_error(error);
  const std::string noise(1000, 'x');
  for (;;) {
    const int fd = open_local_socket();
    if (connect(fd, address.generic(), address.length) == 0)
      while (send(fd, noise.data(), noise.size(), MSG_DONTWAIT | MSG_NOSIGNAL) > 0) {
      }
    close(fd);
  }
}

// True when the memory let any of it happen.
bool violate(const SharedMemory& memory) {
  const int fd = memory.fd();
  const std::size_t bytes = memory.size();
  return mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0) != MAP_FAILED ||
         mprotect(memory.data(), bytes, PROT_READ | PROT_WRITE) == 0 || pwrite(fd, "x", 1, 0) >= 0 ||
         ftruncate(fd, 0) == 0 || ftruncate(fd, static_cast<off_t>(2 * bytes)) == 0 ||
         fallocate(fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 4096) == 0 ||
         fcntl(fd, F_ADD_SEALS, F_SEAL_WRITE) == 0;
}

int read_telemetry(const std::string& what, const std::string& path) {
  if (what == "knock") knock(path);
  const AttachedTelemetry telemetry = attach_telemetry(path);
  if (what == "follow") follow(telemetry.region());
  if (what == "flood") flood(telemetry.region());
  for (;;)
    if (violate(telemetry.memory)) return 1;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "lab_readers follow|flood|knock|break TELEMETRY\n"), 2;
  try {
    return palpate::read_telemetry(argv[1], argv[2]);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "lab_readers: %s\n", error.what()), 3;
  }
}
