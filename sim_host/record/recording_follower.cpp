#include "sim_host/record/recording_follower.h"

#include <utility>

namespace palpate {

RecordingFollower::RecordingFollower(const std::string& path)
    : path_(path),
      file_(std::make_unique<MappedFile>(path)),
      reader_(std::make_unique<RecordingReader>(file_->bytes())) {}

std::uint64_t RecordingFollower::read(const std::function<void(const TickRecord&)>& listen) {
  if (ended_) return 0;
  auto longer = std::make_unique<MappedFile>(path_);
  reader_->extend(longer->bytes());
  file_ = std::move(longer);
  TickRecord record;
  std::uint64_t number = 0;
  for (; reader_->next(record); ++number) listen(record);
  if (reader_->error().empty()) {
    ended_ = true;
  } else if (!reader_->cut()) {
    throw RecordingError(path_ + ": " + reader_->error());
  }
  return number;
}

}  // namespace palpate
