#include "sim_host/view/opened_recording.h"

#include <stdexcept>

#include "sim_host/cli.h"

namespace palpate {

OpenedRecording::OpenedRecording(const std::string& path, const std::string& image) : path_(path), file_(path) {
  try {
    read(image);
  } catch (const std::exception& error) {
    throw std::runtime_error(about_file(path, error.what()));
  }
}

void OpenedRecording::read(const std::string& image) {
  reader_ = std::make_unique<RecordingReader>(file_.bytes());
  scene_ = std::make_unique<RecordedScene>(*reader_, image);
  track_ = std::make_unique<RunTrack>(1e-9 * static_cast<double>(reader_->header().period_ns));
  TickRecord record;
  while (reader_->next(record)) track_->append(record);
  if (track_->size() == 0) throw std::runtime_error("the recording holds no ticks");
  initial_ = reader_->state_known() ? reader_->initial_state(scene_->model()) : make_state(scene_->model());
}

}  // namespace palpate
