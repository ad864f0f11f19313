// Reads a recording while another process still writes it: the recorder hands every 20 ms of ticks to the kernel as
// whole chunks, so a second process can watch a run without touching the controller.
#pragma once

#include <functional>
#include <string>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"

namespace palpate {

class RecordingFollower {
 public:
  // `path`: of the finished recording; it is found while it is still PATH.part. Throws RecordingError when the file
  // cannot be read or its header is not complete.
  explicit RecordingFollower(const std::string& path);

  // Hands every tick written since the last call to `listen`; returns how many. Throws RecordingError on damage.
  std::uint64_t read(const std::function<void(const TickRecord&)>& listen);
  // The footer was read: nothing more will come.
  bool ended() const { return ended_; }
  const RecordingHeader& header() const { return reader_.header(); }

 private:
  std::string path_;
  MappedFile file_;
  RecordingReader reader_;
  bool ended_ = false;
};

}  // namespace palpate
