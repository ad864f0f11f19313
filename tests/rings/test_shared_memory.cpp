// Sealed shared memory and descriptor passing, against the kernel.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "hal/system/shared_memory.h"
#include "sim_host/rings/telemetry.h"

namespace palpate {
namespace {

constexpr std::size_t kBytes = 1 << 16;

TEST(SharedMemory, OwnerWritesAndPeerReads) {
  std::string error;
  SharedMemory owner = SharedMemory::create("test", kBytes, error);
  ASSERT_TRUE(owner) << error;
  SharedMemory peer = SharedMemory::open_peer(dup(owner.fd()), kBytes, error);
  ASSERT_TRUE(peer) << error;
  std::memcpy(owner.data(), "hello", 6);
  EXPECT_STREQ(static_cast<const char*>(peer.data()), "hello");
}

TEST(SharedMemory, NobodyCanResizePunchOrMapItWritable) {
  std::string error;
  SharedMemory owner = SharedMemory::create("test", kBytes, error);
  ASSERT_TRUE(owner) << error;
  const int fd = owner.fd();
  EXPECT_EQ(ftruncate(fd, 0), -1);
  EXPECT_EQ(errno, EPERM);
  EXPECT_EQ(ftruncate(fd, 2 * kBytes), -1);
  EXPECT_EQ(errno, EPERM);
  EXPECT_EQ(fallocate(fd, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 4096), -1);
  EXPECT_EQ(errno, EPERM);
  auto* first = static_cast<volatile unsigned char*>(owner.data());
  *first = 0x5A;
  // Locked pages are refused even before the seals are. qemu-user takes this as a hint and says 0, having done nothing.
  for (const char* pages : {"locked", "unlocked"}) {
    const bool refused = madvise(owner.data(), 4096, MADV_REMOVE) == -1;
    EXPECT_TRUE(!refused || *pages == 'l' || errno == EPERM);
    EXPECT_EQ(*first, 0x5A) << pages;
    munlock(owner.data(), kBytes);
  }
  EXPECT_EQ(mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0), MAP_FAILED);
  EXPECT_EQ(errno, EPERM);
  EXPECT_EQ(write(fd, "x", 1), -1);
  EXPECT_EQ(fcntl(fd, F_ADD_SEALS, F_SEAL_WRITE), -1);  // the seals themselves are sealed
  SharedMemory peer = SharedMemory::open_peer(dup(fd), kBytes, error);
  ASSERT_TRUE(peer) << error;
  EXPECT_EQ(mprotect(peer.data(), kBytes, PROT_READ | PROT_WRITE), -1);
  EXPECT_EQ(errno, EACCES);
}

TEST(SharedMemory, EveryMissingSealIsRefusedByName) {
  const struct {
    int seal;
    const char* name;
  } seals[] = {{F_SEAL_SHRINK, "SHRINK"}, {F_SEAL_GROW, "GROW"}, {F_SEAL_FUTURE_WRITE, "FUTURE_WRITE"}};
  for (const auto& left_out : seals) {
    const int fd = memfd_create("test", MFD_ALLOW_SEALING);
    ASSERT_EQ(ftruncate(fd, kBytes), 0);
    int given = F_SEAL_SEAL;
    for (const auto& other : seals) given |= other.seal == left_out.seal ? 0 : other.seal;
    ASSERT_EQ(fcntl(fd, F_ADD_SEALS, given), 0);
    std::string error;
    EXPECT_FALSE(SharedMemory::open_peer(fd, kBytes, error));
    EXPECT_NE(error.find(left_out.name), std::string::npos) << error;
  }
  const int fd = memfd_create("test", MFD_ALLOW_SEALING);
  ASSERT_EQ(fcntl(fd, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE), 0);
  std::string error;
  EXPECT_FALSE(SharedMemory::open_peer(fd, kBytes, error));
  EXPECT_EQ(error, "the peer's memory lacks the seals SEAL");
}

TEST(SharedMemory, WrongSizeAndWrongKindAreRefused) {
  std::string error;
  SharedMemory owner = SharedMemory::create("test", kBytes, error);
  ASSERT_TRUE(owner) << error;
  EXPECT_FALSE(SharedMemory::open_peer(dup(owner.fd()), kBytes + 1, error));
  EXPECT_NE(error.find("65536 bytes, expected 65537"), std::string::npos) << error;
  EXPECT_FALSE(SharedMemory::open_peer(open("/dev/null", O_RDWR), kBytes, error));
  EXPECT_NE(error.find("not a memfd"), std::string::npos) << error;
  EXPECT_FALSE(SharedMemory::open_peer(-1, kBytes, error));
}

struct SocketPair {
  SocketPair() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, end), 0); }
  ~SocketPair() {
    for (const int fd : end) close(fd);
  }
  int end[2] = {-1, -1};
};

TEST(SharedMemory, DescriptorTravelsOverASocket) {
  SocketPair pair;
  std::string error;
  SharedMemory owner = SharedMemory::create("test", kBytes, error);
  std::memcpy(owner.data(), "travelled", 10);
  ASSERT_TRUE(send_descriptor(pair.end[0], 'C', owner.fd(), error)) << error;
  const int fd = receive_descriptor(pair.end[1], 'C', 1000, error);
  ASSERT_GE(fd, 0) << error;
  EXPECT_EQ(fcntl(fd, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  SharedMemory peer = SharedMemory::open_peer(fd, kBytes, error);
  ASSERT_TRUE(peer) << error;
  EXPECT_STREQ(static_cast<const char*>(peer.data()), "travelled");
}

TEST(SharedMemory, SilentDeadOrConfusedPeerIsNamed) {
  std::string error;
  {
    SocketPair pair;
    EXPECT_EQ(receive_descriptor(pair.end[1], 'C', 10, error), -1);
    EXPECT_NE(error.find("nothing within 10 ms"), std::string::npos) << error;
    SharedMemory owner = SharedMemory::create("test", kBytes, error);
    ASSERT_TRUE(send_descriptor(pair.end[0], 'T', owner.fd(), error));
    EXPECT_EQ(receive_descriptor(pair.end[1], 'C', 10, error), -1);
    EXPECT_NE(error.find("labelled C"), std::string::npos) << error;
    EXPECT_EQ(send(pair.end[0], "C", 1, 0), 1);  // the right label, but no descriptor
    EXPECT_EQ(receive_descriptor(pair.end[1], 'C', 10, error), -1);
  }
  SocketPair pair;
  close(pair.end[0]);
  pair.end[0] = -1;
  EXPECT_EQ(receive_descriptor(pair.end[1], 'C', 10, error), -1);
  EXPECT_NE(error.find("closed"), std::string::npos) << error;
}

// A reader process that is stopped, then killed in the middle of reading: the writer and another reader do not notice.
TEST(SharedMemory, StoppedAndKilledReaderDisturbsNobody) {
  std::string error;
  SharedMemory owner = SharedMemory::create("telemetry", sizeof(TelemetryRegion), error);
  ASSERT_TRUE(owner) << error;
  auto& region = *static_cast<TelemetryRegion*>(owner.data());
  TelemetryWriter writer;
  Model model;
  writer.open(region, model, 1'000'000, "build", "image");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const SharedMemory peer = SharedMemory::open_peer(dup(owner.fd()), sizeof(TelemetryRegion), error);
    if (!peer) _exit(1);
    TelemetryReader reader(*static_cast<const TelemetryRegion*>(peer.data()));
    for (TickRecord record;;) reader.next(record);
  }
  TelemetryReader reader(region);
  TickRecord record{};
  std::uint64_t received = 0;
  const auto write_some = [&] {
    for (int i = 0; i < 3000; ++i) {
      writer.write(record);
      received += reader.next(record) ? 1U : 0U;
    }
  };
  write_some();
  kill(child, SIGSTOP);
  write_some();
  kill(child, SIGKILL);
  write_some();
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(received, 9000u);
  EXPECT_EQ(reader.lost(), 0u);
}

}  // namespace
}  // namespace palpate
