// Who gets in: one controller per device, and only one's own programs on the loopback.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "hal/bus/device_address.h"
#include "hal/bus/loopback.h"
#include "hal/system/device_lock.h"
#include "hal/system/local_socket.h"

namespace palpate {
namespace {

class DeviceLocks : public testing::Test {
 protected:
  DeviceLocks() {
    folder_ = std::filesystem::temp_directory_path() / ("palpate_locks_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~DeviceLocks() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
  std::string error_;
};

TEST_F(DeviceLocks, TheSecondControllerIsToldWhoHasTheDevice) {
  DeviceLock first = DeviceLock::take("can-can0-node1", error_, folder_);
  ASSERT_TRUE(first) << error_;
  EXPECT_FALSE(DeviceLock::take("can-can0-node1", error_, folder_));
  EXPECT_NE(error_.find("process " + std::to_string(getpid())), std::string::npos) << error_;
  EXPECT_TRUE(DeviceLock::take("can-can0-node2", error_, folder_)) << "another node of the same bus";
  EXPECT_TRUE(DeviceLock::take("usb/dev/hidraw0", error_, folder_)) << error_;
  first = DeviceLock();
  EXPECT_TRUE(DeviceLock::take("can-can0-node1", error_, folder_)) << "given back with its holder";
}

TEST_F(DeviceLocks, AKilledHolderHoldsNothing) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    std::string error;
    const DeviceLock lock = DeviceLock::take("can-can0-node1", error, folder_);
    [[maybe_unused]] const ssize_t said = write(ready[1], "x", 1);
    pause();
  }
  char one;
  ASSERT_EQ(read(ready[0], &one, 1), 1);
  EXPECT_FALSE(DeviceLock::take("can-can0-node1", error_, folder_));
  EXPECT_NE(error_.find("process " + std::to_string(child)), std::string::npos) << error_;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(DeviceLock::take("can-can0-node1", error_, folder_)) << error_;
  close(ready[0]);
  close(ready[1]);
}

TEST_F(DeviceLocks, AnotherUsersControllerCanLockItAndNoLinkIsFollowed) {
  const mode_t before = umask(0077);
  EXPECT_TRUE(DeviceLock::take("can-can0-node1", error_, folder_)) << error_;
  umask(before);
  struct stat status {};
  ASSERT_EQ(stat((folder_ / "palpate-can-can0-node1.lock").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0644u);
  std::filesystem::create_symlink("/etc/passwd", folder_ / "palpate-can-x-node1.lock");
  EXPECT_FALSE(DeviceLock::take("can-x-node1", error_, folder_));
  EXPECT_FALSE(DeviceLock::take("can-can0-node1", error_, "/nonexistent"));
}

// With the right to name interfaces, the real thing: two names of one interface are one device.
TEST(DeviceLockName, OfAnInterfaceIsItsOwnWhateverItIsCalled) {
  EXPECT_EQ(lock_name({TransportKind::kCan, "nocan0", WireProfile::kFd, 3}), "can-nocan0-node3");
  EXPECT_EQ(lock_name({TransportKind::kCan, "lo", WireProfile::kFd, 1}), "can-lo-node1");
  const std::string other = "pal" + std::to_string(getpid());
  const std::string change = " dev lo altname " + other + " 2> /dev/null";
  if (std::system(("ip link property add" + change).c_str()) != 0) return;  // no right to
  const std::string name = lock_name({TransportKind::kCan, other, WireProfile::kFd, 1});
  EXPECT_EQ(std::system(("ip link property del" + change).c_str()), 0);
  EXPECT_EQ(name, "can-lo-node1");
}

TEST(LoopbackAccess, OnlyOnesOwnProgramsAndRootsAreTrusted) {
  EXPECT_TRUE(is_trusted_peer(1000, 1000));
  EXPECT_TRUE(is_trusted_peer(0, 1000));
  EXPECT_TRUE(is_trusted_peer(0, 0));
  EXPECT_FALSE(is_trusted_peer(1000, 0)) << "user nobody once drove root's controller";
  EXPECT_FALSE(is_trusted_peer(1001, 1000));
}

// With the right to become somebody else, the real thing: a stranger's program connects to ours.
TEST(LoopbackAccess, AStrangersDeviceIsRefusedByName) {
  const bool is_root = geteuid() == 0;
  const std::string name = "palpate-access-" + std::to_string(getpid());
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    std::string error;
    if (is_root && (setgid(kNobody) != 0 || setuid(kNobody) != 0)) _exit(1);
    const auto transport = connect_loopback(name, 5000, error);
    pause();
  }
  std::string error;
  const auto transport = accept_loopback(name, 5000, error);
  EXPECT_EQ(transport == nullptr, is_root) << error;
  if (is_root) {
    EXPECT_NE(error.find("process " + std::to_string(child) + " of user 65534"), std::string::npos) << error;
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

}  // namespace
}  // namespace palpate
