// A whole recording as a viewer takes it: its scene, its ticks, the state before the first of them.
#pragma once

#include <string>

#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/view/run_track.h"

namespace palpate {

class OpenedRecording {
 public:
  // `image`: scene image to use, or "" for the one the recording names or holds. Throws std::runtime_error that begins
  // with the file's name when it is no recording, its scene is not to be had, or it holds no ticks.
  OpenedRecording(const std::string& path, const std::string& image);
  const std::string& path() const { return path_; }
  const Model& model() const { return scene_->model(); }
  const RunTrack& track() const { return *track_; }
  const State& initial() const { return *initial_; }
  // A slice of a run does not know the state before its first tick.
  bool state_known() const { return reader_->state_known(); }
  // Of a file that is damaged or cut: what is wrong. The ticks before that are there.
  const std::string& damage() const { return reader_->error(); }

 private:
  void read(const std::string& image);

  std::string path_;
  MappedFile file_;
  std::unique_ptr<RecordingReader> reader_;
  std::unique_ptr<RecordedScene> scene_;
  std::unique_ptr<RunTrack> track_;
  StatePtr initial_;
};

}  // namespace palpate
