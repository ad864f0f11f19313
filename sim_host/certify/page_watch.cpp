#include "sim_host/certify/page_watch.h"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <new>
#include <stdexcept>

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#include <sanitizer/rtsan_interface.h>
#define PALPATE_REALTIME_SANITIZER
#endif
#endif

namespace palpate {

namespace {

// While it lives, the real-time sanitizer looks away: what runs in the fault handler is the watch's, not the tick's.
#ifdef PALPATE_REALTIME_SANITIZER
using OutOfRealTime = __rtsan::ScopedDisabler;
#else
struct OutOfRealTime {};
#endif

constexpr std::size_t kMostBlocks = 8;
std::size_t page_bytes() {
  static const auto bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return bytes;
}

// What the handler sees: filled before the first page is closed.
struct Closed {
  std::byte* data;
  std::size_t bytes;
  volatile std::size_t touched;
};
std::array<Closed, kMostBlocks> closed;
volatile std::size_t closed_count = 0;
std::size_t handler_page = 0;

void on_fault(int, siginfo_t* info, void*) {
  [[maybe_unused]] const OutOfRealTime handler;
  auto* const at = static_cast<std::byte*>(info->si_addr);
  for (std::size_t i = 0; i < closed_count; ++i) {
    Closed& block = closed[i];
    if (at < block.data || at >= block.data + block.bytes) continue;
    const auto offset = static_cast<std::size_t>(at - block.data) / handler_page * handler_page;
    mprotect(block.data + offset, handler_page, PROT_READ | PROT_WRITE);
    block.touched = block.touched + handler_page;
    return;
  }
  std::signal(SIGSEGV, SIG_DFL);  // a fault of somebody's own
}

}  // namespace

WatchedBlock::WatchedBlock(std::size_t bytes) : bytes_((bytes + page_bytes() - 1) / page_bytes() * page_bytes()) {
  void* data = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (data == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(data);
}
WatchedBlock::~WatchedBlock() { munmap(data_, bytes_); }

std::vector<std::size_t> bytes_touched(std::span<const WatchedBlock* const> blocks, const std::function<void()>& call) {
  if (blocks.size() > kMostBlocks) throw std::runtime_error("bytes_touched: too many blocks");
  handler_page = page_bytes();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    closed[i].data = blocks[i]->data();
    closed[i].bytes = blocks[i]->bytes();
    closed[i].touched = 0;
  }
  closed_count = blocks.size();
  struct sigaction action {
  }, before{};
  action.sa_flags = SA_SIGINFO;
  action.sa_sigaction = on_fault;
  sigaction(SIGSEGV, &action, &before);
  for (const WatchedBlock* block : blocks) mprotect(block->data(), block->bytes(), PROT_NONE);
  call();
  for (const WatchedBlock* block : blocks) mprotect(block->data(), block->bytes(), PROT_READ | PROT_WRITE);
  sigaction(SIGSEGV, &before, nullptr);
  std::vector<std::size_t> touched;
  for (std::size_t i = 0; i < blocks.size(); ++i) touched.push_back(std::size_t{closed[i].touched});
  closed_count = 0;
  return touched;
}

}  // namespace palpate
