#include "hal/loop/report_writer.h"

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace palpate {

ReportWriter::ReportWriter(int fd) : fd_(fd) {
  ::sem_init(&ready_, 0, 0);
  thread_ = std::thread([this] { run(); });
  sched_param parameters{};
  parameters.sched_priority = kReportWriterPriority;
  ::pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &parameters);  // refused: ordinary
}

ReportWriter::~ReportWriter() {
  stop_.store(true, std::memory_order_relaxed);  // ordered by the semaphore
  ::sem_post(&ready_);
  thread_.join();
  ::sem_destroy(&ready_);
}

bool ReportWriter::put(const Report* reports, int count) noexcept {
  Slot& slot = slot_[filling_];
  slot.count = count < kMostReports ? count : kMostReports;
  std::memcpy(slot.report, reports, static_cast<std::size_t>(slot.count) * kBytes);
  // Release: the slot's bytes are there for the thread's acquire. Acquire: what the thread read of the slot we get back
  // is over.
  const int before = between_.exchange(filling_ | kNew, std::memory_order_acq_rel);
  filling_ = before & ~kNew;
  ::sem_post(&ready_);
  return (before & kNew) == 0;
}

void ReportWriter::write_slot(const Slot& slot) noexcept {
  for (int i = 0; i < slot.count; ++i) {  // bound: kMostReports
    if (::write(fd_, slot.report[i], kBytes) == static_cast<ssize_t>(kBytes)) continue;
    error_.store(errno, std::memory_order_relaxed);
    return;
  }
}

void ReportWriter::run() noexcept {
  for (;;) {
    while (::sem_wait(&ready_) != 0) {
    }
    if (stop_.load(std::memory_order_relaxed)) return;
    if ((between_.load(std::memory_order_relaxed) & kNew) == 0) continue;  // written already, in place of an older one
    // The other end of the exchange in put().
    writing_ = between_.exchange(writing_, std::memory_order_acq_rel) & ~kNew;
    write_slot(slot_[writing_]);
  }
}

}  // namespace palpate
