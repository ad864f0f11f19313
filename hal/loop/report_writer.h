// Writes USB reports from a thread of its own. A write to hidraw waits until the host controller has polled the device
// (measured with a high-speed gadget: 80 us typically, 145 us at most; 5 s if the device refuses), and O_NONBLOCK does
// not change that. The loop hands its newest command over here instead and never waits.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>

namespace palpate {

// At this SCHED_FIFO priority, above the loop as interrupt threads are, so that the driver has the report before the
// loop goes on. Without permission the thread stays ordinary.
inline constexpr int kReportWriterPriority = 85;

class ReportWriter {
 public:
  static constexpr int kMostReports = 2;  // of one command
  static constexpr std::size_t kBytes = 65;
  using Report = std::uint8_t[kBytes];

  explicit ReportWriter(int fd);  // which must outlive this
  ~ReportWriter();                // waits for a write in progress
  ReportWriter(const ReportWriter&) = delete;
  ReportWriter& operator=(const ReportWriter&) = delete;

  // Hands over the reports of one command; one writer, never waits. False if the command before was still unwritten:
  // this one takes its place, an old command is never sent.
  bool put(const Report* reports, int count) noexcept;
  // errno of a write that failed since the last call, or 0.
  int take_error() noexcept { return error_.exchange(0, std::memory_order_relaxed); }

 private:
  // Three slots: the loop fills one, the thread writes one, and the third lies between them with a mark if it is new.
  struct Slot {
    Report report[kMostReports];
    int count = 0;
  };
  static constexpr int kNew = 4;
  void run() noexcept;
  void write_slot(const Slot& slot) noexcept;

  int fd_;
  Slot slot_[3];
  int filling_ = 0;              // the loop's
  int writing_ = 1;              // the thread's
  std::atomic<int> between_{2};  // index, and kNew
  std::atomic<int> error_{0};
  std::atomic<bool> stop_{false};
  sem_t ready_;
  std::thread thread_;
};

}  // namespace palpate
