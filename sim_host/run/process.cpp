#include "sim_host/run/process.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace palpate {

namespace {

// In the child, between fork and exec: only async-signal-safe calls. Returns only on failure.
void become(char** argv, const std::vector<std::pair<int, int>>& descriptors, std::vector<int>& moved) {
  setpgid(0, 0);
  // First out of the way of every target number, then into place without close-on-exec.
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    moved[i] = fcntl(descriptors[i].first, F_DUPFD_CLOEXEC, 64);
    if (moved[i] < 0) return;
  }
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    if (dup2(moved[i], descriptors[i].second) < 0) return;
  }
  execv(argv[0], argv);
}

}  // namespace

Process::Process(Process&& other) noexcept { *this = std::move(other); }

Process& Process::operator=(Process&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(ended_, other.ended_);
  std::swap(exit_code_, other.exit_code_);
  return *this;
}

Process::~Process() {
  if (ended_) return;
  signal(SIGKILL);
  wait(-1);
}

Process Process::start(const std::string& program, const std::vector<std::string>& arguments,
                       const std::vector<std::pair<int, int>>& descriptors) {
  if (access(program.c_str(), X_OK) != 0) {
    throw std::runtime_error("cannot start " + program + ": " + std::strerror(errno));
  }
  std::vector<std::string> texts = arguments;
  texts.insert(texts.begin(), program);
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  argv.push_back(nullptr);
  std::vector<int> moved(descriptors.size());
  Process process;
  process.pid_ = fork();
  if (process.pid_ < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (process.pid_ == 0) {
    become(argv.data(), descriptors, moved);
    _exit(127);
  }
  process.ended_ = false;
  return process;
}

bool Process::wait(int timeout_ms) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::milliseconds(timeout_ms);
  while (!ended_) {
    int status = 0;
    const pid_t got = waitpid(pid_, &status, timeout_ms < 0 ? 0 : WNOHANG);
    if (got < 0 && errno == EINTR) continue;
    if (got != 0) {
      ended_ = true;
      exit_code_ = got < 0 ? 127 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (Clock::now() >= until) {
      return false;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  return true;
}

void Process::signal(int number) const {
  if (!ended_) kill(pid_, number);
}

}  // namespace palpate
