#include "sim_host/run/crash_file.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <utility>

#include "sim_host/record/recording_writer.h"

namespace palpate {

namespace {

// The ring holds 4 s; an ordinary thread that looks this often loses nothing.
constexpr int kDrainPeriod_ms = 20;

}  // namespace

CrashFile::CrashFile(int control_fd, std::string path)
    : control_fd_(control_fd), ended_fd_(eventfd(0, EFD_CLOEXEC)), path_(std::move(path)) {}

CrashFile::~CrashFile() {
  if (ended_fd_ >= 0) close(ended_fd_);
}

void CrashFile::loop_ended() noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(ended_fd_, &one, sizeof(one));  // cannot fail: the counter was 0
}

bool CrashFile::has_ended(int timeout_ms) {
  pollfd wait{ended_fd_, POLLIN, 0};
  return ::poll(&wait, 1, timeout_ms) > 0;
}

bool CrashFile::wait_for_death(const std::function<void()>& hear) {
  for (;;) {  // bound: the life of the loop
    pollfd wait[2] = {{ended_fd_, POLLIN, 0}, {control_fd_, POLLIN, 0}};
    if (::poll(wait, control_fd_ >= 0 ? 2 : 1, -1) < 0 && errno != EINTR) return false;
    if ((wait[0].revents & POLLIN) != 0) return false;
    if ((wait[1].revents & (POLLHUP | POLLERR)) != 0) return true;
    if ((wait[1].revents & POLLIN) != 0) hear();
  }
}

void CrashFile::write(const TelemetryRegion& ring, const Model& model, bool loop_runs) {
  if (path_.empty()) return;
  try {
    const StatePtr initial = make_state(model);  // every run starts after a reset
    std::unique_ptr<RecordingWriter> file;
    TelemetryReader reader(ring);
    TickRecord record;
    std::uint64_t expected = 0;
    const TelemetryScene* later = newest_scene(ring);
    const std::uint64_t first = later != nullptr ? later->first_sequence.load() : 1;
    const RecordingHeader header = recording_header(ring);
    const auto drain = [&] {
      for (std::uint64_t i = 0; i < kTelemetryCapacity && reader.next(record); ++i) {
        if (record.sequence < first) continue;  // of a scene before
        if (!file) {
          file = std::make_unique<RecordingWriter>(PartFile(path_, WhenItExists::kReplace), header, block_of(*initial));
          file->begin_slice(record.sequence, record.sequence == first);
        } else if (record.sequence > expected) {
          file->add_lost(expected, record.sequence - expected);
        }
        file->add(record);
        expected = record.sequence + 1;
      }
      if (file) file->flush();
    };
    for (; loop_runs && !has_ended(kDrainPeriod_ms);) drain();  // bound: the loop ends within its ramp
    drain();
    if (!file) return;
    file->finish();
    std::fprintf(stderr, "controller: its host is gone; the last %llu ticks are in %s\n",
                 static_cast<unsigned long long>(file->records()), path_.c_str());
  } catch (const RecordingError& error) {
    std::fprintf(stderr, "controller: its host is gone, and its last ticks could not be kept: %s\n", error.what());
  }
}

}  // namespace palpate
