#include "sim_host/record/recorder.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace palpate {

namespace {

// The ring holds 4 s; this often keeps a killed host's loss small and costs nothing.
constexpr std::chrono::milliseconds kDrainPeriod{20};

}  // namespace

Recorder::Recorder(const TelemetryRegion& region, RecordingWriter* file, std::function<void(const TickRecord&)> listen)
    : reader_(region), file_(file), listen_(std::move(listen)) {}

Recorder::~Recorder() { stop(); }

void Recorder::start() {
  thread_ = std::thread([this] { run(); });
}

void Recorder::stop() {
  if (finished_) return;
  stopping_.store(true);
  if (thread_.joinable()) thread_.join();
  finish();
}

void Recorder::run() {
  while (!stopping_.load()) {
    drain();
    std::this_thread::sleep_for(kDrainPeriod);
  }
}

void Recorder::finish() {
  finished_ = true;
  drain();
  // Records the reader had to skip after the last one it got are a loss too.
  if (reader_.lost() > lost_) {
    const std::uint64_t number = reader_.lost() - lost_;
    lost_ += number;
    on_file([&] { file_->add_lost(expected_, number); });
  }
  finish_file();
}

void Recorder::finish_file() {
  if (file_ != nullptr && file_->records() > 0) on_file([&] { file_->finish(); });
}

void Recorder::turn_at(const TickRecord& record) {
  const std::uint64_t offset = record.sequence - record.tick;
  if (!turn_ || offset == offset_) return;
  offset_ = offset;
  finish_file();
  file_ = turn_(record.sequence, record.tick == 0);
}

// The file system may refuse at any moment (disk full): said at once, while the disk may still be cleared for the next
// run; this run goes on, and what was written stays.
template <typename Action>
void Recorder::on_file(Action action) {
  if (file_ == nullptr || !error_.empty()) return;
  try {
    action();
  } catch (const RecordingError& error) {
    error_ = error.what();
    fmt::print(stderr, "\npalpate: recording stops here, the run goes on: {}\n", error_);
  }
}

void Recorder::drain() {
  TickRecord record;
  // Bound: what the ring can hold; a writer that runs on is served by the next call.
  for (std::uint64_t i = 0; i < kTelemetryCapacity && reader_.next(record); ++i) {
    if (record.sequence > expected_) {
      const std::uint64_t number = record.sequence - expected_;
      lost_ += number;
      on_file([&] { file_->add_lost(expected_, number); });
    }
    turn_at(record);
    expected_ = record.sequence + 1;
    records_ += 1;
    on_file([&] { file_->add(record); });
    if (listen_) listen_(record);
  }
  on_file([&] { file_->flush(); });
}

}  // namespace palpate
