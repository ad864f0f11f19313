#include "sim_host/record/recording_follower.h"

#include <filesystem>

#include "sim_host/record/part_file.h"

namespace palpate {

namespace {

// While it is written, a recording is NAME.part.
std::string present_name(const std::string& path) {
  const std::string part = path + kPartSuffix;
  return std::filesystem::exists(part) ? part : path;
}

}  // namespace

RecordingFollower::RecordingFollower(const std::string& path)
    : path_(path), file_(present_name(path)), reader_(file_.bytes()) {}

std::uint64_t RecordingFollower::read(const std::function<void(const TickRecord&)>& listen) {
  if (ended_) return 0;
  file_.grow();
  reader_.extend(file_.bytes());
  TickRecord record;
  std::uint64_t number = 0;
  for (; reader_.next(record); ++number) listen(record);
  if (reader_.error().empty()) {
    ended_ = true;
  } else if (!reader_.cut()) {
    throw RecordingError(path_ + ": " + reader_.error());
  }
  return number;
}

}  // namespace palpate
