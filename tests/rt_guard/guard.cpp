#include "tests/rt_guard/guard.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>

namespace palpate::test {

namespace {

constexpr int kNone = -1;
constexpr int kBroken = -2;

int* shared_answer = nullptr;  // written by the child's signal handler, read by the parent

void on_trapped_call(int, siginfo_t* info, void*) {
  *shared_answer = info->si_syscall;
  _exit(1);
}

// Traps every call but exit_group, for this process, for good.
bool install_filter() {
  sock_filter program[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AUDIT_ARCH_X86_64, 0, 2),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog filter{sizeof(program) / sizeof(program[0]), program};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

[[noreturn]] void run_child(const std::function<void()>& work) {
  struct sigaction action {};
  action.sa_sigaction = on_trapped_call;
  action.sa_flags = SA_SIGINFO;
  *shared_answer = kBroken;
  if (sigaction(SIGSYS, &action, nullptr) != 0 || !install_filter()) _exit(2);
  work();
  *shared_answer = kNone;
  _exit(0);
}

}  // namespace

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

int first_system_call(const std::function<void()>& work) {
  void* page = mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED) return kBroken;
  shared_answer = static_cast<int*>(page);
  *shared_answer = kBroken;
  const pid_t child = fork();
  if (child == 0) run_child(work);
  if (child > 0) waitpid(child, nullptr, 0);
  const int answer = child > 0 ? *shared_answer : kBroken;
  munmap(page, sizeof(int));
  return answer;
}

}  // namespace palpate::test
