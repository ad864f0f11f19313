// Memory in which a copy can be interrupted at a known place: the page after it is closed, and whoever reads on faults;
// what was prepared runs there, once, and the copy goes on. So the interleaving that two threads meet by luck, or
// never, happens every time.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>

#include <cstddef>
#include <functional>

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#include <sanitizer/rtsan_interface.h>
#define PALPATE_REALTIME_SANITIZER
#endif
#endif

namespace palpate::test {

// While it lives, the real-time sanitizer looks away: what runs in the fault handler is the test's, not the copy's.
#ifdef PALPATE_REALTIME_SANITIZER
using OutOfRealTime = __rtsan::ScopedDisabler;
#else
struct OutOfRealTime {};
#endif

class InterruptedCopy {
 public:
  static constexpr std::size_t kPage = 4096;

  explicit InterruptedCopy(std::size_t bytes) : bytes_((bytes / kPage + 3) * kPage) {
    void* at = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    EXPECT_NE(at, MAP_FAILED);
    memory_ = static_cast<std::byte*>(at);
    active_ = this;
    struct sigaction action {};
    action.sa_sigaction = [](int, siginfo_t* info, void*) { active_->fault(info->si_addr); };
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    sigaction(SIGSEGV, &action, &before_);
  }
  ~InterruptedCopy() {
    sigaction(SIGSEGV, &before_, nullptr);
    munmap(memory_, bytes_);
    active_ = nullptr;
  }
  InterruptedCopy(const InterruptedCopy&) = delete;
  InterruptedCopy& operator=(const InterruptedCopy&) = delete;

  std::byte* memory() { return memory_; }  // of zeros
  // Whoever next touches the page that starts at memory() + `offset` lets `then` run first.
  void interrupt_at(std::size_t offset, std::function<void()> then) {
    page_ = memory_ + offset / kPage * kPage;
    then_ = std::move(then);
    fired_ = false;
    mprotect(page_, kPage, PROT_NONE);
  }
  bool fired() const { return fired_; }

 private:
  // A fault of the test's own making may call what it likes: it comes from the copy loop, never from within a library.
  void fault(void* address) {
    [[maybe_unused]] const OutOfRealTime handler;
    auto* at = static_cast<std::byte*>(address);
    if (fired_ || at < page_ || at >= page_ + kPage) {
      sigaction(SIGSEGV, &before_, nullptr);  // a real one: the instruction runs again, unhandled
      return;
    }
    fired_ = true;
    mprotect(page_, kPage, PROT_READ | PROT_WRITE);
    then_();
  }

  inline static InterruptedCopy* active_ = nullptr;
  struct sigaction before_ {};
  std::size_t bytes_;
  std::byte* memory_ = nullptr;
  std::byte* page_ = nullptr;
  std::function<void()> then_;
  bool fired_ = false;
};

}  // namespace palpate::test
