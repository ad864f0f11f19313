#include "hal/system/syscall_filter.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>

namespace palpate {

namespace {

std::atomic<int> first_forbidden{-1};
static_assert(std::atomic<int>::is_always_lock_free, "read and written in a signal handler");

#if defined(__x86_64__)
constexpr unsigned kProcessor = AUDIT_ARCH_X86_64;
constexpr auto kPoll = SYS_poll;
void set_result(mcontext_t& registers, long value) { registers.gregs[REG_RAX] = value; }
#elif defined(__aarch64__)
constexpr unsigned kProcessor = AUDIT_ARCH_AARCH64;
constexpr auto kPoll = SYS_ppoll;  // there is no other
void set_result(mcontext_t& registers, long value) { registers.regs[0] = static_cast<unsigned long>(value); }
#endif

// What the loop needs: sleep, time, frames in and out, counting its page faults at the end, and leaving.
constexpr std::array kAllowed = {
    SYS_clock_nanosleep, SYS_clock_gettime, SYS_read,     SYS_write,     SYS_recvmsg, SYS_recvmmsg, SYS_recvfrom,
    SYS_getrusage,       SYS_sendmsg,       SYS_sendmmsg, SYS_sendto,    SYS_ppoll,   kPoll,        SYS_restart_syscall,
    SYS_futex,           SYS_rt_sigreturn,  SYS_exit,     SYS_exit_group};

// `context` is the interrupted thread's: the call's result becomes "no such call".
void on_forbidden(int, siginfo_t* info, void* context) {
  int none = -1;
  first_forbidden.compare_exchange_strong(none, info->si_syscall, std::memory_order_relaxed);
  set_result(static_cast<ucontext_t*>(context)->uc_mcontext, -ENOSYS);
}

// Of ioctl, handing a packet to a USB device and taking one back, and nothing else.
constexpr std::array<unsigned, 2> kAllowedIoctls = {USBDEVFS_SUBMITURB, USBDEVFS_REAPURBNDELAY};

sock_filter statement(unsigned code, unsigned k) { return {static_cast<__u16>(code), 0, 0, k}; }
sock_filter jump(unsigned k, unsigned if_true, unsigned if_false) {
  return {static_cast<__u16>(BPF_JMP | BPF_JEQ | BPF_K), static_cast<__u8>(if_true), static_cast<__u8>(if_false), k};
}

}  // namespace

bool install_syscall_filter(std::string& reason) {
  struct sigaction action {};
  action.sa_sigaction = on_forbidden;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return reason = std::strerror(errno), false;

  constexpr std::size_t kIoctls = kAllowedIoctls.size();
  std::array<sock_filter, kAllowed.size() + kIoctls + 8> program;
  std::size_t at = 0;
  program[at++] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch));
  program[at++] = jump(kProcessor, 1, 0);
  program[at++] = statement(BPF_RET | BPF_K, SECCOMP_RET_TRAP);  // 32-bit entry: refused
  program[at++] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (std::size_t i = 0; i < kAllowed.size(); ++i)  // a hit jumps over the remaining tests and the trap
    program[at++] =
        jump(static_cast<unsigned>(kAllowed[i]), static_cast<unsigned>(kAllowed.size() - i + kIoctls + 2), 0);
  program[at++] = jump(SYS_ioctl, 0, kIoctls + 1);
  program[at++] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args) + 8);  // the request's low half
  for (std::size_t i = 0; i < kIoctls; ++i)
    program[at++] = jump(kAllowedIoctls[i], static_cast<unsigned>(kIoctls - i), 0);
  program[at++] = statement(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
  program[at++] = statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);

  const sock_fprog filter{static_cast<unsigned short>(at), program.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &filter) != 0)
    return reason = std::strerror(errno), false;
  return true;
}

int forbidden_syscall() noexcept { return first_forbidden.load(std::memory_order_relaxed); }
void clear_forbidden_syscall() noexcept { first_forbidden.store(-1, std::memory_order_relaxed); }

}  // namespace palpate
