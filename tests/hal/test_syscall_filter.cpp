// The real-time thread's allow-list: what the loop needs passes, anything else is refused, recorded and survivable.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <thread>

#include "hal/system/syscall_filter.h"

namespace palpate::test {
namespace {

TEST(SyscallFilter, LoopCallsPassAndAnythingElseIsRefusedAndRecorded) {
  int pair[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, pair), 0);
  bool installed = false;
  int after_loop_calls = -2, after_open = -2, open_result = 0, open_errno = 0;
  std::string reason;
  std::thread loop([&] {
    installed = install_syscall_filter(reason);
    char byte = 1;
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &now, nullptr);
    send(pair[0], &byte, 1, 0);
    recv(pair[1], &byte, 1, 0);
    after_loop_calls = forbidden_syscall();
    open_result = static_cast<int>(syscall(SYS_openat, AT_FDCWD, "/dev/null", O_RDONLY, 0));
    open_errno = errno;
    after_open = forbidden_syscall();
  });
  loop.join();
  ASSERT_TRUE(installed) << reason;
  EXPECT_EQ(after_loop_calls, -1);
  EXPECT_EQ(open_result, -1);
  EXPECT_EQ(open_errno, ENOSYS);
  EXPECT_EQ(after_open, SYS_openat);
  const int fd = open("/dev/null", O_RDONLY);  // other threads are free
  EXPECT_GE(fd, 0);
  close(fd);
  close(pair[0]);
  close(pair[1]);
  clear_forbidden_syscall();
  EXPECT_EQ(forbidden_syscall(), -1);
}

// Of ioctl, USB packets in and out pass (and are refused by what is no USB device); nothing else does.
TEST(SyscallFilter, UsbPacketsPassAndNoOtherIoctl) {
  const int fd = open("/dev/null", O_RDWR);
  ASSERT_GE(fd, 0);
  int packet_errno[2] = {}, after_packets = -2, other_errno = 0, after_other = -2;
  std::thread loop([&] {
    std::string reason;
    if (!install_syscall_filter(reason)) return;
    int at = 0;
    for (const unsigned long request : {USBDEVFS_SUBMITURB, USBDEVFS_REAPURBNDELAY}) {
      ioctl(fd, request, nullptr);
      packet_errno[at++] = errno;
    }
    after_packets = forbidden_syscall();
    ioctl(fd, USBDEVFS_CONTROL, nullptr);
    other_errno = errno;
    after_other = forbidden_syscall();
  });
  loop.join();
  close(fd);
  EXPECT_EQ(packet_errno[0], ENOTTY);
  EXPECT_EQ(packet_errno[1], ENOTTY);
  EXPECT_EQ(after_packets, -1);
  EXPECT_EQ(other_errno, ENOSYS);
  EXPECT_EQ(after_other, SYS_ioctl);
  clear_forbidden_syscall();
}

// A sanitizer's library maps memory whenever it likes, and in a filtered thread that ends the process.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(realtime_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

#if defined(__x86_64__)
// getegid of the 32-bit table has the number of futex in the other one, which the loop may call.
constexpr int kGetegid32 = 202;
static_assert(kGetegid32 == SYS_futex);
int call_32_bit(int number) {
  int result = number;
  __asm__ volatile("int $0x80" : "+a"(result) : : "memory", "r8", "r9", "r10", "r11");
  return result;
}
// In a process of its own: a kernel without 32-bit calls kills whoever tries.
bool has_32_bit_calls() {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGSEGV, SIG_DFL);
    _exit(call_32_bit(kGetegid32) == static_cast<int>(getegid()) ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(SyscallFilter, CallsOfThe32BitTableAreRefusedWhateverTheirNumber) {
  if (kSanitized || !has_32_bit_calls()) {
    std::printf("  a sanitizer, or a kernel that takes no 32-bit calls: nothing to try here\n");
    return;
  }
  bool installed = false;
  int result = 0;
  std::string reason;
  std::thread loop([&] {
    installed = install_syscall_filter(reason);
    result = call_32_bit(kGetegid32);
  });
  loop.join();
  ASSERT_TRUE(installed) << reason;
  EXPECT_EQ(result, -ENOSYS);
  EXPECT_EQ(forbidden_syscall(), kGetegid32);
  clear_forbidden_syscall();
}
#endif

}  // namespace
}  // namespace palpate::test
